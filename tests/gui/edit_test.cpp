#include <doctest/doctest.h>

#include <filesystem>
#include <set>

#include <glm/geometric.hpp>

#include "core/editor.hpp"
#include "core/editor_keys.hpp"
#include "core/editor_shapes.hpp"
#include "edit_screen.hpp"
#include "missions.hpp"
#include "temporary_folder.hpp"
#include "thicket/base/files.hpp"
#include "thicket/radar/sensor.hpp"
#include "thicket/worlds/truth.hpp"
#include "thicket/worlds/world_text.hpp"
#include "views/edit_tool.hpp"

namespace thicket::gui {
namespace {

std::string text_of(const World& world) {
  const auto text = write_world(world);
  if (!text) FAIL(text.error().message);
  return *text;
}

}  // namespace

TEST_CASE("editor: whatever is changed is undone to the same world, and redone") {
  Runner runner;
  const auto now = opened(runner, "rooms/u");
  Editor editor;
  editor.follow(*now);
  std::vector<std::string> states{text_of(editor.world())};
  const auto note = [&] { states.push_back(text_of(editor.world())); };
  editor.new_material = "glass";
  const auto box = editor.add(new_box({0.0, 0.0}, {1.0, 0.5}, 0.0, 2.0));
  note();
  editor.replace(box, moved(editor.world().solids[box], {0.25, -0.5}));
  note();
  editor.replace(box, dragged(editor.world().solids[box], {Grip::Kind::turn, 0, {}}, glm::dvec2(editor.world().solids[box].position) + glm::dvec2(0.0, 2.0), 0.0));
  CHECK(editor.world().solids[box].yaw == doctest::Approx(radians(90.0)));
  note();
  const auto copy = editor.copy(box, {1.0, 0.0});
  CHECK(editor.world().solids[copy].name != editor.world().solids[box].name);
  note();
  REQUIRE(editor.set_material(copy, "wood"));
  note();
  editor.erase(0);
  note();
  CHECK(std::set<std::string>(states.begin(), states.end()).size() == states.size());
  for (std::size_t i = states.size(); i-- > 1;) {
    REQUIRE(editor.undo());
    CHECK(text_of(editor.world()) == states[i - 1]);
  }
  CHECK_FALSE(editor.undo());
  for (std::size_t i = 1; i < states.size(); ++i) {
    REQUIRE(editor.redo());
    CHECK(text_of(editor.world()) == states[i]);
  }
  CHECK_FALSE(editor.redo());
  editor.undo();
  editor.add(new_sphere({2.0, 2.0}, {2.5, 2.0}, 0.0));
  CHECK_FALSE(editor.redo());  // what was undone is forgotten
}

TEST_CASE("editor: a replacement that changes nothing is no change, and no material is made up") {
  Runner runner;
  Editor editor;
  editor.follow(*opened(runner, "rooms/u"));
  editor.replace(0, editor.world().solids[0]);
  CHECK(editor.undoable() == 0);
  CHECK_FALSE(editor.set_material(0, "unobtainium"));
  CHECK_FALSE(editor.take());
}

TEST_CASE("editor: the stack follows a run that is gone back and forth in, and is forgotten with another world") {
  Runner runner;
  Editor editor;
  opened(runner, "rooms/u");
  runner.post(StepBy{10});
  editor.follow(*runner.settled());
  const auto box = editor.add(new_box({2.0, 2.0}, {2.2, 2.2}, 0.0, 2.0));
  runner.post(ChangeWorld{*editor.take()});
  runner.post(StepBy{5});
  editor.follow(*runner.settled());
  CHECK(editor.undoable() == 1);
  const std::string name = editor.world().solids[box].name;
  runner.post(SeekTo{5});
  editor.follow(*runner.settled());
  CHECK(editor.redoable() == 1);  // before the box was there
  runner.post(SeekTo{12});
  editor.follow(*runner.settled());
  CHECK(editor.undoable() == 1);
  CHECK(editor.world().solids[box].name == name);
  editor.follow(*opened(runner, "rooms/convex"));
  CHECK(editor.undoable() + editor.redoable() == 0);
}

TEST_CASE("editor: a world that cannot be is refused by the run, and the one before is edited on") {
  Runner runner;
  Editor editor;
  editor.follow(*opened(runner, "rooms/u"));
  const std::string before = text_of(editor.world());
  editor.add(new_box({2.0, 2.0}, {INFINITY, 3.0}, 0.0, 2.0));
  runner.post(ChangeWorld{*editor.take()});
  const auto now = runner.settled();
  REQUIRE(now->message.error);
  editor.follow(*now);
  CHECK(text_of(editor.world()) == before);
  CHECK(editor.message == now->message.text);
}

TEST_CASE("editor: a saved world loads to the same world, and the same scan") {
  Runner runner;
  const auto now = opened(runner, "foliage_wall/bug2");
  Editor editor;
  editor.follow(*now);
  editor.new_material = "metal";
  editor.add(new_box({1.0, 1.0}, {1.5, 1.25}, 0.0, 2.0));
  editor.add(new_sphere({-1.0, 0.5}, {-0.6, 0.5}, 0.0));
  editor.add(new_cylinder({0.5, -1.5}, {0.8, -1.5}, 0.0, 2.0));
  editor.add(new_wall({{2.0, 0.0}, {3.0, 0.5}, {3.0, 1.5}}, 0.0, 0.1, 2.5));
  editor.add(new_prism({{-2.0, -2.0}, {-1.0, -2.0}, {-1.5, -1.0}}, 0.0, 2.0));
  editor.replace(0, dragged(editor.world().solids[0], {Grip::Kind::turn, 0, {}}, {5.0, 7.0}, 0.0));
  TemporaryFolder folder;
  const auto file = folder.path() / "edited.toml";
  const auto saved = save_world(editor.world(), file);
  if (!saved) FAIL(saved.error().message);
  const auto read = read_world(file);
  if (!read) FAIL(read.error().message);
  CHECK(same_world(*read, editor.world()));
  auto before = Simulation::create(now->simulation->mission(), editor.world()), after = Simulation::create(now->simulation->mission(), *read);
  REQUIRE(before);
  REQUIRE(after);
  auto plain = *now->simulation;
  for (Simulation* s : {&*before, &*after, &plain}) s->step();
  CHECK(state_hash(*before) == state_hash(*after));
  CHECK(state_hash(*before) != state_hash(plain));
}

TEST_CASE("editor: what a world file cannot hold is named") {
  Runner runner;
  TemporaryFolder folder;
  for (const char* name : {"solids/mesh", "solids/map"}) {
    const auto now = opened(runner, name);
    const auto saved = save_world(now->simulation->scene().world(), folder.path() / "w.toml");
    REQUIRE_FALSE(saved);
    const World& world = now->simulation->scene().world();
    bool named = false;
    for (const Solid& solid : world.solids) named = named || saved.error().message.find("'" + solid.name + "'") != std::string::npos;
    INFO(saved.error().message);
    CHECK(named);
    CHECK_FALSE(std::filesystem::exists(folder.path() / "w.toml"));
  }
}

TEST_CASE("editor: a map with a box in it is saved by the map's name, unless the map was moved") {
  Runner runner;
  TemporaryFolder folder;
  const auto now = opened(runner, "solids/maze.map");
  Editor editor;
  editor.follow(*now);
  editor.add(new_box({1.0, 1.0}, {1.5, 1.25}, 0.0, 2.0));
  const auto file = folder.path() / "w.toml";
  const auto saved = save_world(editor.world(), file);
  if (!saved) FAIL(saved.error().message);
  const auto read = read_world(file);
  if (!read) FAIL(read.error().message);
  CHECK(same_world(*read, editor.world()));
  editor.replace(0, moved(editor.world().solids[0], {1.0, 0.0}));
  const auto again = save_world(editor.world(), folder.path() / "x.toml");
  REQUIRE_FALSE(again);
  CHECK(again.error().message.find("maze.map") != std::string::npos);
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), std::filesystem::directory_iterator()) == 1);
}

TEST_CASE("editor: the solid at a point is the one whose matter is above or below it") {
  World world;
  world.materials.emplace_back().name = "wall";
  const auto add = [&](const Shape& shape, const glm::dvec3& at, double yaw, double pitch = 0.0, double roll = 0.0) { world.solids.push_back({"s", 0, at, yaw, shape, pitch, roll}); };
  add(Box{{2.0, 1.0, 1.0}}, {0.0, 0.0, 0.5}, 0.7);
  add(Box{{1.0, 1.0, 3.0}}, {3.0, 0.0, 0.5}, 0.3, 0.6, -0.4);
  add(Sphere{0.7}, {0.0, 3.0, 0.7}, 0.0);
  add(Cylinder{0.5, 2.0}, {3.0, 3.0, 1.0}, 0.2, 1.0, 0.3);
  add(Wall{{{0.0, 0.0}, {1.0, 0.5}, {1.0, 2.0}}, 0.2, 2.5}, {-4.0, 0.0, 0.0}, 0.5);
  add(Prism{{{0.0, 0.0}, {2.0, 0.0}, {2.0, 2.0}, {0.0, 2.0}}, {{{0.5, 0.5}, {1.5, 0.5}, {1.0, 1.5}}}, 1.0}, {-4.0, 3.0, 0.0}, 0.2);
  add(Prism{{{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}}, {}, 2.0}, {-4.0, -4.0, 0.0}, 0.2, 0.5, 0.3);
  // The oracle: points above each other, closely.
  std::size_t covered = 0;
  for (double x = -5.5; x < 5.5; x += 0.113)
    for (double y = -5.5; y < 5.5; y += 0.117)
      for (const Solid& solid : world.solids) {
        bool any = false;
        for (double z = -3.0; z < 4.0 && !any; z += 0.01) any = inside(solid, {x, y, z});
        const bool told = covers(solid, {x, y}, 0.0);
        covered += told;
        if (any && !told) FAIL_CHECK("missed at " << x << ", " << y);
        if (told && !any) {
          // Too thin there for the oracle's steps, or wrong.
          for (double z = -3.0; z < 4.0 && !any; z += 0.0002) any = inside(solid, {x, y, z});
          if (!any) FAIL_CHECK("made up at " << x << ", " << y);
        }
      }
  CHECK(covered > 500);
  CHECK(solid_at(world, {0.0, 3.0}, 0.0, 0.0) == 2u);
  CHECK_FALSE(solid_at(world, {5.0, 5.0}, 0.0, 0.0));
}

TEST_CASE("editor: the floor is not in the way, and of two solids the smaller is taken") {
  World world;
  world.materials.emplace_back().name = "wall";
  world.solids.push_back({"floor", 0, {0.0, 0.0, -0.25}, 0.0, Box{{100.0, 100.0, 0.5}}});
  world.solids.push_back({"hall", 0, {0.0, 0.0, 1.0}, 0.0, Box{{10.0, 10.0, 2.0}}});
  world.solids.push_back({"crate", 0, {1.0, 0.0, 0.5}, 0.0, Box{{1.0, 1.0, 1.0}}});
  CHECK(solid_at(world, {1.0, 0.0}, 0.0, 0.0) == 2u);
  CHECK(solid_at(world, {-3.0, 0.0}, 0.0, 0.0) == 1u);
  CHECK_FALSE(solid_at(world, {30.0, 0.0}, 0.0, 0.0));
}

TEST_CASE("editor: a corner that is dragged leaves the opposite one where it was") {
  Solid solid{"b", 0, {1.0, 2.0, 0.5}, 0.6, Box{{2.0, 1.0, 1.0}}};
  const auto all = grips(solid, 0.0, 0.3);
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec2 away = glm::normalize(all[i].at - glm::dvec2(solid.position));
    const auto after = grips(dragged(solid, all[i], all[i].at + 0.5 * away, 0.0), 0.0, 0.3);
    CHECK(glm::distance(after[(i + 2) % 4].at, all[(i + 2) % 4].at) < 1e-3);
    CHECK(glm::distance(after[i].at, all[i].at + 0.5 * away) < 2e-3);
  }
}

TEST_CASE("editor: the corner where a wall closes stays closed when it is dragged") {
  const Solid wall = new_wall({{0.0, 0.0}, {2.0, 0.0}, {2.0, 2.0}, {0.0, 0.0}}, 0.0, 0.1, 2.5);
  const auto all = grips(wall, 0.0, 0.3);
  REQUIRE(all.size() == 4);  // three corners, and the knob
  const Wall after = std::get<Wall>(dragged(wall, all[0], {-1.0, 0.5}, 0.0).shape);
  CHECK(after.points.front() == glm::dvec2(-1.0, 0.5));
  CHECK(after.points.back() == after.points.front());
}

TEST_CASE("editor: keys of a solid are judged as those of a world file are") {
  Runner runner;
  const auto now = opened(runner, "rooms/u");
  World world = now->simulation->scene().world();
  world.solids.push_back(new_wall({{0.0, 0.0}, {1.0, 0.0}}, 0.0, 0.1, 2.5));
  const Solid& wall = world.solids.back();
  const Section section = solid_section(wall);
  const auto typed = [&](const char* key, const char* text) { return with_key(world, wall, section, *section.find(key), text); };
  const auto yaw = typed("yaw_deg", "30");
  REQUIRE(yaw);
  CHECK(yaw->solid.yaw == radians(30.0));
  CHECK(std::get<Wall>(typed("height_m", "1.5")->solid.shape).height == 1.5);
  CHECK(typed("thickness_m", "-1").error().message.find("'thickness_m' is -1, expected a number in m, above 0") != std::string::npos);
  CHECK(typed("points_m", "[[0, 0]]").error().message.find("expected two or more") != std::string::npos);
}

TEST_CASE("edit view: a solid that is clicked in the list is selected, and a number typed in its form changes it") {
  Screen screen;
  const auto view = make_edit_view();
  Runner runner;
  auto now = opened(runner, "foliage_wall/bug2");
  const auto frame = [&] { screen.draw(*now, [&](const Frame& f) { view->draw(f); }); };
  const auto click = [&](const ImVec2& at) {
    screen.mouse(at, false), frame();
    screen.mouse(at, true), frame();
    screen.mouse(at, false), frame();
  };
  std::set<std::uint32_t> chosen;
  for (float y = 60.0f; y < 300.0f && chosen.size() < 3; y += 7.0f) {
    click({100.0f, y});
    if (screen.desk.solid) chosen.insert(*screen.desk.solid);
  }
  REQUIRE(chosen.size() == 3);
  CHECK(screen.posted.empty());
  // All fields under the list, as the mouse would find them.
  bool resized = false;
  for (float y = 200.0f; y < 500.0f && !resized; y += 7.0f) {
    click({600.0f, y});
    ImGui::GetIO().AddInputCharactersUTF8("0.625");
    frame();
    screen.key(257, true), frame();
    screen.key(257, false), frame();
    if (screen.posted.empty()) continue;
    now = screen.pass_on(runner);
    REQUIRE(screen.desk.solid);
    const auto* sphere = std::get_if<Sphere>(&now->simulation->scene().world().solids[*screen.desk.solid].shape);
    resized = sphere && sphere->radius == 0.625;
  }
  CHECK(resized);
}

TEST_CASE("edit view: drawn with nothing open, and for every shipped world and mission") {
  Screen screen;
  const auto view = make_edit_view();
  const Snapshot nothing;
  screen.draw(nothing, [&](const Frame& frame) { view->draw(frame); });
  Runner runner;
  for (const auto& file : shipped_missions()) {
    CAPTURE(file.string());
    const auto now = opened(runner, file);
    screen.desk.solid = 0;
    for (int i = 0; i < 2; ++i) screen.draw(*now, [&](const Frame& frame) { view->draw(frame); });
    CHECK(ImGui::GetDrawData()->TotalVtxCount > 100);
  }
  CHECK(screen.posted.empty());
}

}  // namespace thicket::gui
