#include <doctest/doctest.h>

#include <glm/geometric.hpp>

#include "core/editor_shapes.hpp"
#include "edit_screen.hpp"
#include "views/edit_tool.hpp"

namespace thicket::gui {
namespace {

/// A plan with the tool in it, a run, and a mouse whose places are of the world.
class Plan {
 public:
  Plan() : editing(std::make_shared<Editing>()), tool_(make_edit_tool(editing)) {
    camera.size = {800.0f, 600.0f};
    camera.pixels_per_metre = 50.0;
    runner.post(Open{"rooms/u", {}});
    now = runner.settled();
    // A world by itself, so that what is where is known.
    World world;
    world.name = "one box";
    world.materials.emplace_back().name = "wall";
    world.solids.push_back({"crate", 0, {1.0, 1.0, 0.5}, 0.0, Box{{1.0, 1.0, 1.0}}});
    runner.post(ChangeWorld{world});
    now = runner.settled();
  }
  void frame() {
    screen.draw(*now, [&](const Frame& f) { tool_->use(f, camera, hovered, *ImGui::GetWindowDrawList()); });
  }
  void mouse(const glm::dvec2& at, bool down) {
    screen.mouse(camera.to_screen(at), down);
    frame();
  }
  void drag(const glm::dvec2& from, const glm::dvec2& to) {
    mouse(from, false);
    mouse(from, true);
    mouse(0.5 * (from + to), true);
    mouse(to, true);
    mouse(to, false);
  }
  void click(const glm::dvec2& at) {
    mouse(at, false);
    mouse(at, true);
    mouse(at, false);
  }
  void key(int index, bool control = false) {
    screen.key(index, true, control);
    frame();
    screen.key(index, false, false);
    frame();
  }
  /// The only world that was posted since the last time, and done.
  const World& changed() {
    REQUIRE(screen.posted.size() == 1);
    REQUIRE(std::holds_alternative<ChangeWorld>(screen.posted[0]));
    now = screen.pass_on(runner);
    REQUIRE_FALSE(now->message.error);
    return now->simulation->scene().world();
  }
  const Solid& solid(std::size_t i) const { return now->simulation->scene().world().solids[i]; }

  Screen screen;
  Runner runner;
  std::shared_ptr<const Snapshot> now;
  PlanCamera camera;
  std::shared_ptr<Editing> editing;
  bool hovered = true;

 private:
  std::unique_ptr<PlanTool> tool_;
};

}  // namespace

TEST_CASE("edit tool: a click selects and changes nothing, a click beside lets go") {
  Plan plan;
  plan.click({1.2, 0.8});
  CHECK(plan.screen.desk.solid == 0u);
  CHECK(plan.screen.posted.empty());
  plan.click({3.0, -3.0});
  CHECK_FALSE(plan.screen.desk.solid);
  plan.hovered = false;
  plan.click({1.0, 1.0});
  CHECK_FALSE(plan.screen.desk.solid);
}

TEST_CASE("edit tool: a drag moves the solid, to the grid with Ctrl") {
  Plan plan;
  plan.drag({1.2, 0.8}, {2.22, 1.8});
  CHECK(glm::distance(glm::dvec2(plan.changed().solids[0].position), glm::dvec2(2.02, 2.0)) < 2e-3);
  plan.screen.key(0, false, true);
  plan.drag({2.0, 2.0}, {2.9, 2.4});
  plan.screen.key(0, false, false);
  CHECK(glm::dvec2(plan.changed().solids[0].position) == glm::dvec2(3.0, 2.5));
}

TEST_CASE("edit tool: a corner resizes, the knob turns") {
  Plan plan;
  plan.click({1.0, 1.0});
  plan.drag({1.5, 1.5}, {2.5, 2.0});
  const Box& box = std::get<Box>(plan.changed().solids[0].shape);
  CHECK(box.size.x == doctest::Approx(2.0).epsilon(1e-6));
  CHECK(box.size.y == doctest::Approx(1.5).epsilon(1e-6));
  CHECK(glm::distance(glm::dvec2(plan.solid(0).position), glm::dvec2(1.5, 1.25)) < 1e-6);
  const auto all = grips(plan.solid(0), 0.0, 28.0 / plan.camera.pixels_per_metre);
  REQUIRE(all.back().kind == Grip::Kind::turn);
  plan.drag(all.back().at, glm::dvec2(1.5, 1.25) + 2.0 * direction(radians(40.0)));
  CHECK(degrees(plan.changed().solids[0].yaw) == doctest::Approx(40.0).epsilon(0.01));
}

TEST_CASE("edit tool: Del, Ctrl+D, Ctrl+Z and Ctrl+Y") {
  Plan plan;
  plan.click({1.0, 1.0});
  plan.key('D', true);
  CHECK(plan.changed().solids.size() == 2);
  CHECK(plan.screen.desk.solid == 1u);
  plan.key(261);
  CHECK(plan.changed().solids.size() == 1);
  CHECK_FALSE(plan.screen.desk.solid);
  plan.key('Z', true);
  CHECK(plan.changed().solids.size() == 2);
  plan.key('Z', true);
  CHECK(plan.changed().solids.size() == 1);
  plan.key('Y', true);
  CHECK(plan.changed().solids.size() == 2);
  plan.key('Y', true);
  CHECK(plan.changed().solids.size() == 1);
  plan.key('Y', true);
  CHECK(plan.screen.posted.empty());
}

TEST_CASE("edit tool: boxes, spheres and cylinders are drawn by a drag") {
  Plan plan;
  plan.editing->editor.new_material = "glass";
  plan.editing->drawing = Drawing::box;
  plan.drag({-3.0, -2.0}, {-2.0, -1.5});
  const World& boxed = plan.changed();
  REQUIRE(boxed.solids.size() == 2);
  CHECK(boxed.material_of(1).name == "glass");
  const Box box = std::get<Box>(boxed.solids[1].shape);
  CHECK(box.size.x == doctest::Approx(1.0).epsilon(0.002));
  CHECK(box.size.y == doctest::Approx(0.5).epsilon(0.002));
  CHECK(boxed.solids[1].position.z - 0.5 * box.size.z == doctest::Approx(plan.now->simulation->mission().start.z_m));
  CHECK(plan.screen.desk.solid == 1u);
  plan.editing->drawing = Drawing::sphere;
  plan.drag({-3.0, 2.0}, {-2.5, 2.0});
  CHECK(std::get<Sphere>(plan.changed().solids[2].shape).radius == doctest::Approx(0.5).epsilon(0.002));
  plan.editing->drawing = Drawing::cylinder;
  plan.drag({3.0, -2.0}, {3.0, -2.4});
  CHECK(std::get<Cylinder>(plan.changed().solids[3].shape).radius == doctest::Approx(0.4).epsilon(0.002));
  // A click without a drag draws nothing.
  plan.click({4.0, 4.0});
  CHECK(plan.screen.posted.empty());
}

TEST_CASE("edit tool: walls and prisms are drawn by clicks, and dropped by Escape") {
  Plan plan;
  plan.editing->drawing = Drawing::wall;
  for (const glm::dvec2& p : {glm::dvec2(-3.0, -2.0), glm::dvec2(-2.0, -2.0), glm::dvec2(-2.0, -3.0)}) plan.click(p);
  CHECK(plan.screen.posted.empty());
  plan.key(257);
  const World& walled = plan.changed();
  REQUIRE(walled.solids.size() == 2);
  const Wall& wall = std::get<Wall>(walled.solids[1].shape);
  REQUIRE(wall.points.size() == 3);
  CHECK(glm::distance(glm::dvec2(walled.solids[1].position) + wall.points[2], glm::dvec2(-2.0, -3.0)) < 2e-3);
  plan.editing->drawing = Drawing::prism;
  for (const glm::dvec2& p : {glm::dvec2(3.0, 0.0), glm::dvec2(4.0, 0.0), glm::dvec2(3.5, 1.0), glm::dvec2(3.0, 0.5)}) plan.click(p);
  plan.click({3.0, 0.5});  // the second of a double click ends it
  CHECK(std::get<Prism>(plan.changed().solids[2].shape).outline.size() == 4);
  for (const glm::dvec2& p : {glm::dvec2(-4.0, 3.0), glm::dvec2(-3.0, 4.0), glm::dvec2(-3.0, 3.0), glm::dvec2(-4.0, 4.0)}) plan.click(p);
  plan.key(257);
  CHECK(plan.screen.posted.empty());  // it crosses itself
  CHECK(plan.editing->editor.message.find("simple polygon") != std::string::npos);
  plan.click({-4.0, 3.0});
  plan.key(256);
  CHECK(plan.editing->drawing == Drawing::prism);
  plan.key(256);
  CHECK(plan.editing->drawing == Drawing::nothing);
  plan.key(257);
  CHECK(plan.screen.posted.empty());
}

TEST_CASE("edit tool: a drag that Escape ends leaves the solid where it was") {
  Plan plan;
  plan.mouse({1.0, 1.0}, false);
  plan.mouse({1.0, 1.0}, true);
  plan.mouse({3.0, 1.0}, true);
  plan.key(256);
  plan.mouse({3.0, 1.0}, false);
  CHECK(plan.screen.posted.empty());
}

}  // namespace thicket::gui
