#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/editor.hpp"
#include "core/editor_shapes.hpp"
#include "core/mission_form.hpp"
#include "edit_screen.hpp"
#include "missions.hpp"
#include "temporary_folder.hpp"
#include "thicket/base/files.hpp"

namespace thicket::gui {
namespace {

Mission mission_of(const std::filesystem::path& file) {
  const auto read = read_mission(find_input(file), {});
  if (!read) FAIL(read.error().message);
  return *read;
}

/// A valid value that is another one than now.
std::string other_value(const Key& key, const Value& now) {
  const auto within = [&](double wish) {
    double x = std::clamp(wish, key.range.minimum, key.range.maximum);
    if (key.range.above_minimum && x <= key.range.minimum) x = key.range.minimum + 0.5 * std::min(1.0, key.range.maximum - key.range.minimum);
    return x;
  };
  switch (key.kind) {
    case KeyKind::flag:
      return std::get_if<bool>(&now) && std::get<bool>(now) ? "false" : "true";
    case KeyKind::integer:
      return to_toml(Value(static_cast<std::int64_t>(within(static_cast<double>(std::holds_alternative<std::int64_t>(now) ? std::get<std::int64_t>(now) : 0) + 1.0))));
    case KeyKind::number: {
      const double was = std::holds_alternative<double>(now) && std::isfinite(std::get<double>(now)) ? std::get<double>(now) : 1.0;
      return to_toml(Value(within(was + 1.0) != was ? within(was + 1.0) : within(0.5 * was)));
    }
    case KeyKind::text:
      for (const std::string& choice : key.choices)
        if (now != Value(choice)) return toml_string(choice);
      return toml_string("another text");
    case KeyKind::numbers: {
      std::vector<double> list;
      for (std::size_t i = 0; i < std::max<std::size_t>(1, key.length_min); ++i) list.push_back(within(static_cast<double>(i) + 0.25));
      return to_toml(Value(list));
    }
    case KeyKind::points:
      return to_toml(Value(std::vector<std::vector<double>>{std::vector<double>(key.length_min, within(0.0)), std::vector<double>(key.length_min, within(2.0))}));
  }
  return "";
}

/// Keys of what flies.
bool needs_flight(const std::string& name) {
  for (const char* known : {"vehicle.type", "planner.heading_deg", "planner.altitude_m", "planner.land"})
    if (name == known) return true;
  return false;
}

/// Keys whose values must fit to those of others, or to files, and are tried by themselves below.
bool depends(const std::string& name) {
  for (const char* known : {"mission.world", "mission.world_image", "map.initial", "bumpers.sensors", "output.map_formats", "map.cell_bits", "planner.name", "planner.waypoint_speeds_m_s", "sar.enabled"})
    if (name == known) return true;
  if (needs_flight(name)) return true;
  // Of sensors: those that need another first.
  return name.ends_with(".gain_table_db") || (name.ends_with("radar.elevation_rays") && !name.starts_with("sensor lobe"));
}

}  // namespace

TEST_CASE("form: every key of every table can be set, and the written mission reads back the same") {
  TemporaryFolder folder;
  Mission mission = mission_of("rooms/u");
  for (const std::string& type : sensor_types()) {
    mission.sensors.push_back(default_sensor(type));
    mounted(mission.sensors.back()).name = type;
  }
  std::size_t count = 0;
  const auto all = mission_parts(mission);
  CHECK(all.size() == 10 + mission.sensors.size());
  for (std::size_t p = 0; p < all.size(); ++p)
    for (std::size_t k = 0; k < all[p].section->keys.size(); ++k) {
      const Key& key = all[p].section->keys[k];
      const std::string name = all[p].title + "." + key.name;
      if (depends(name)) continue;
      const std::string typed = other_value(key, key.get(all[p].object));
      CAPTURE(name);
      CAPTURE(typed);
      auto next = with_key(mission, {}, {p, k}, typed);
      if (!next) FAIL_CHECK(next.error().message);
      if (!next) continue;
      const auto there = mission_parts(*next)[p];
      const Value set = key.get(there.object);
      CHECK(set != key.get(all[p].object));
      const auto file = folder.write("m.toml", write_mission(*next));
      auto read = read_mission(file, {});
      if (!read) FAIL_CHECK(read.error().message);
      if (!read) continue;
      CHECK(key.get(mission_parts(*read)[p].object) == set);
      CHECK(write_mission(*read) == write_mission(*next));
      ++count;
    }
  CHECK(count > 150);
}

TEST_CASE("form: keys of what flies can be set where it flies, and are refused where it drives") {
  const Mission flying = mission_of("quadrotor/waypoints"), driving = mission_of("rooms/u");
  Mission copy = flying;
  const auto all = mission_parts(copy);
  int count = 0;
  for (std::size_t p = 0; p < all.size(); ++p)
    for (std::size_t k = 0; k < all[p].section->keys.size(); ++k) {
      const Key& key = all[p].section->keys[k];
      const std::string name = all[p].title + "." + key.name;
      if (!needs_flight(name) || key.name == "type") continue;
      CAPTURE(name);
      const std::string typed = key.kind == KeyKind::flag ? "true" : other_value(key, key.get(all[p].object));
      CHECK(with_key(flying, {}, {p, k}, typed));
      const auto refused = with_key(driving, {}, {p, k}, typed);
      REQUIRE_FALSE(refused);
      CHECK(refused.error().message.find("hector_quadrotor") != std::string::npos);
      ++count;
    }
  CHECK(count == 3);
}

TEST_CASE("form: values out of range are refused with the words of the file reader") {
  const Mission mission = mission_of("rooms/u");
  Mission copy = mission;
  const auto all = mission_parts(copy);
  std::size_t count = 0;
  TemporaryFolder folder;
  for (std::size_t p = 0; p < all.size(); ++p)
    for (std::size_t k = 0; k < all[p].section->keys.size(); ++k) {
      const Key& key = all[p].section->keys[k];
      if (key.kind != KeyKind::number || !std::isfinite(key.range.minimum)) continue;
      CAPTURE(all[p].title + "." + key.name);
      const std::string typed = to_toml(Value(key.range.minimum - 1.0));
      const auto next = with_key(mission, {}, {p, k}, typed);
      REQUIRE_FALSE(next);
      // The same from a file.
      const std::string where = p == 0 ? "" : all[p].title.starts_with("sensor") ? "sensor." : all[p].title + ".";
      const auto read = read_mission(find_input("rooms/u"), {{where + key.name, typed, "it"}});
      REQUIRE_FALSE(read);
      const std::string told = next.error().message.substr(next.error().message.find(": '") + 2);
      INFO(told);
      CHECK(read.error().message.find(told) != std::string::npos);
      ++count;
    }
  CHECK(count > 30);
}

TEST_CASE("form: what is no value, no choice, or does not fit to the other keys is refused") {
  const Mission mission = mission_of("rooms/u");
  Mission copy = mission;
  const auto all = mission_parts(copy);
  const auto set = [&](const std::string& name, const std::optional<std::string>& typed) -> Result<Mission> {
    for (std::size_t p = 0; p < all.size(); ++p)
      for (std::size_t k = 0; k < all[p].section->keys.size(); ++k)
        if (all[p].title + "." + all[p].section->keys[k].name == name) return with_key(mission, find_input("rooms/u"), {p, k}, typed);
    FAIL("no key " << name);
    return mission;
  };
  const auto message = [&](const std::string& name, const std::optional<std::string>& typed) {
    const auto next = set(name, typed);
    return next ? std::string("accepted") : next.error().message;
  };
  CHECK(message("mission.step_s", "fast").find("a text ('fast')") != std::string::npos);
  CHECK(message("planner.name", "\"bug3\"").find("did you mean 'bug") != std::string::npos);
  CHECK(message("planner.goal_m", "[1.0]").find("an array of 2 numbers") != std::string::npos);
  CHECK(message("map.cell_bits", "9").find("expected 8 or 16") != std::string::npos);
  CHECK(message("mission.world", "\"nowhere.toml\"").find("nowhere.toml") != std::string::npos);
  CHECK(message("bumpers.sensors", "\"ear\"").find("'ear'") != std::string::npos);
  CHECK(message("sensor radar.elevation_rays", "3").find("expected an 'elevation_opening_deg' above 0") != std::string::npos);
  CHECK(message("mission.step_s", "0.01\nseed = 4").find("step_s") != std::string::npos);
  CHECK(set("planner.clearance_m", "\"auto\"")->planner.clearance_auto);
  // A file beside the mission's own, and one that is shipped.
  CHECK(set("mission.world", "\"convex_room.toml\"")->world_file.filename() == "convex_room.toml");
  CHECK(set("mission.world", "\"foliage_wall/divided_room.toml\"")->world_file.filename() == "divided_room.toml");
}

TEST_CASE("form: an optional key is taken back, and nothing else with it") {
  const Mission mission = mission_of("rooms/u");
  Mission copy = mission;
  const auto all = mission_parts(copy);
  std::size_t count = 0;
  Mission defaults = defaults_of(mission);
  const auto usual = mission_parts(defaults);
  for (std::size_t p = 0; p < all.size(); ++p)
    for (std::size_t k = 0; k < all[p].section->keys.size(); ++k) {
      const Key& key = all[p].section->keys[k];
      if (!is_optional(key, usual[p].object)) continue;
      CAPTURE(all[p].title + "." + key.name);
      if (needs_flight(all[p].title + "." + key.name)) continue;
      // The goal, which the mission's planner needs, is not taken back.
      if (key.name == "goal_m") {
        CHECK_FALSE(with_key(mission, {}, {p, k}, std::nullopt));
        continue;
      }
      const auto given = with_key(mission, {}, {p, k}, first_value(key));
      if (!given) FAIL(given.error().message);
      const auto back = with_key(*given, {}, {p, k}, std::nullopt);
      if (!back) FAIL(back.error().message);
      CHECK(write_mission(*given) != write_mission(mission));
      CHECK(write_mission(*back) == write_mission(mission));
      ++count;
    }
  CHECK(count >= 3);
}

TEST_CASE("form: the search looks at names, tables and help") {
  const Key key{"clearance_m", KeyKind::number, "m", {}, 0, 0, {}, "", false, "Distance that it keeps", {}, {}};
  CHECK(matches("", "planner", key));
  CHECK(matches("CLEAR", "planner", key));
  CHECK(matches("planner distance", "planner", key));
  CHECK_FALSE(matches("planner speed", "planner", key));
  CHECK(matches("planner." + key.name, "planner", key));
}

TEST_CASE("form: a mission that was changed while it ran, saved and run headless, ends as it does here after Reset") {
  TemporaryFolder folder;
  Runner runner;
  auto now = opened(runner, "rooms/u", 30);
  Mission mission = now->simulation->mission();
  const auto all = mission_parts(mission);
  for (std::size_t p = 0; p < all.size(); ++p)
    for (std::size_t k = 0; k < all[p].section->keys.size(); ++k) {
      const std::string name = all[p].title + "." + all[p].section->keys[k].name;
      if (name == "planner.name") mission = *with_key(mission, {}, {p, k}, "\"bug1\"");
      if (name == "mission.seed") mission = *with_key(mission, {}, {p, k}, "7");
    }
  runner.post(ChangeMission{mission});
  SUBCASE("in the mission's own world") {}
  SUBCASE("in a world that was edited too") {
    Editor editor;
    editor.follow(*runner.settled());
    const glm::dvec2 at = glm::dvec2(mission.start.x_m, mission.start.y_m) + glm::dvec2(0.0, 0.9);
    editor.add(new_box(at, at + glm::dvec2(0.3, 0.3), 0.0, 2.0));
    runner.post(ChangeWorld{*editor.take()});
  }
  now = runner.settled();
  INFO(now->message.text);
  const auto saved = save_mission(now->simulation->mission(), now->simulation->scene().world(), folder.path() / "m.toml", folder.path() / "w.toml");
  if (!saved) FAIL(saved.error().message);
  CHECK(saved->world.empty() == !now->world_changed);
  CHECK(std::filesystem::exists(folder.path() / "w.toml") == now->world_changed);
  runner.post(Reset{});
  runner.post(SetSpeed{0.0});
  now = runner.finished();
  const auto read = read_mission(folder.path() / "m.toml", {});
  if (!read) FAIL(read.error().message);
  CHECK(read->planner.name == "bug1");
  auto headless = Simulation::create(*read);
  REQUIRE(headless);
  while (headless->step()) {
  }
  REQUIRE(now->simulation->verdict());
  CHECK(headless->verdict()->reason == now->simulation->verdict()->reason);
  CHECK(state_hash(*headless) == state_hash(*now->simulation));
}

TEST_CASE("mission view: what is typed in a field and entered is posted, and what the reader would refuse is not") {
  Screen screen;
  const auto view = make_mission_view();
  Runner runner;
  const auto now = opened(runner, "rooms/u");
  const auto frame = [&] { screen.draw(*now, [&](const Frame& f) { view->draw(f); }); };
  const auto type_everywhere = [&](const char* text) {
    std::vector<Mission> posted;
    // Whatever is in the column of values, from top to bottom: as the mouse would.
    for (float y = 80.0f; y < 590.0f; y += 7.0f) {
      const ImVec2 at{450.0f, y};
      screen.mouse(at, false), frame();
      screen.mouse(at, true), frame();
      screen.mouse(at, false), frame();
      ImGui::GetIO().AddInputCharactersUTF8(text);
      frame();
      for (const int key : {257, 256}) {
        screen.key(key, true), frame();
        screen.key(key, false), frame();
      }
    }
    for (const Action& action : screen.posted)
      if (const auto* change = std::get_if<ChangeMission>(&action)) posted.push_back(change->mission);
    screen.posted.clear();
    return posted;
  };
  const auto good = type_everywhere("0.125");
  CHECK(std::ranges::any_of(good, [](const Mission& m) { return m.step_s == 0.125; }));
  const auto bad = type_everywhere("-3");
  CHECK(std::ranges::none_of(bad, [](const Mission& m) { return m.step_s < 0.0 || m.seed < 0; }));
}

TEST_CASE("form: a sensor is added from each preset and removed again, and the run goes on with it") {
  Runner runner;
  auto now = opened(runner, "rooms/u", 10);
  const Mission first = now->simulation->mission();
  for (const std::string& preset : sensor_presets()) {
    CAPTURE(preset);
    const auto next = with_sensor(now->simulation->mission(), now->file, preset);
    if (!next) FAIL(next.error().message);
    const std::size_t count = next->sensors.size();
    runner.post(ChangeMission{*next});
    runner.post(StepBy{4});
    now = runner.settled();
    INFO(now->message.text);
    REQUIRE_FALSE(now->message.error);
    CHECK(now->simulation->scans().size() == count);
  }
  CHECK(now->simulation->steps() == 10 + 4 * sensor_presets().size());
  // The slowest scans once a second.
  runner.post(StepBy{20});
  now = runner.settled();
  for (const Scan& scan : now->simulation->scans()) CHECK_FALSE(scan.beams.empty());
  Mission mission = now->simulation->mission();
  CHECK(mounted(mission.sensors[1]).name == "radar2");
  // The one in the middle, then all that were added.
  while (mission.sensors.size() > 1) {
    const std::size_t which = mission.sensors.size() / 2;
    const std::string gone = mounted(mission.sensors[which]).name;
    const auto less = without_sensor(mission, now->file, which);
    if (!less) FAIL(less.error().message);
    CHECK(std::ranges::none_of(less->sensors, [&](const SensorSpec& sensor) { return mounted(sensor).name == gone; }));
    mission = *less;
  }
  CHECK(write_mission(mission) == write_mission(first));
  const auto none = without_sensor(mission, now->file, 0);
  REQUIRE_FALSE(none);
  CHECK(none.error().message.find("add another one first") != std::string::npos);
  const auto unknown = with_sensor(mission, now->file, "k2pie");
  REQUIRE_FALSE(unknown);
  CHECK(unknown.error().message.find("did you mean 'k2pi'") != std::string::npos);
  // One that the bumpers name is not removed behind their back.
  Mission two = *with_sensor(mission, now->file, "bumpers");
  two.bumpers.sensors = "radar2";
  CHECK_FALSE(without_sensor(two, now->file, 1));
  CHECK(without_sensor(two, now->file, 0));
}

TEST_CASE("mission view: a sensor of another kind in the place of one that was there is drawn") {
  Screen screen;
  const auto view = make_mission_view();
  Runner runner;
  auto now = opened(runner, "rooms/u");
  const auto draw = [&] {
    for (int i = 0; i < 2; ++i) screen.draw(*now, [&](const Frame& frame) { view->draw(frame); });
  };
  draw();
  const auto both = with_sensor(now->simulation->mission(), now->file, "utm30lx");
  REQUIRE(both);
  const auto other = without_sensor(*both, now->file, 0);
  REQUIRE(other);
  for (const Mission& mission : {*both, *other}) {
    runner.post(ChangeMission{mission});
    now = runner.settled();
    REQUIRE_FALSE(now->message.error);
    draw();
    CHECK(ImGui::GetDrawData()->TotalVtxCount > 500);
  }
}

TEST_CASE("mission view: drawn with nothing open, and for every shipped mission") {
  Screen screen;
  const auto view = make_mission_view();
  const Snapshot nothing;
  screen.draw(nothing, [&](const Frame& frame) { view->draw(frame); });
  Runner runner;
  for (const auto& file : shipped_missions()) {
    CAPTURE(file.string());
    const auto now = opened(runner, file);
    for (int i = 0; i < 2; ++i) screen.draw(*now, [&](const Frame& frame) { view->draw(frame); });
    CHECK(ImGui::GetDrawData()->TotalVtxCount > 500);
  }
  CHECK(screen.posted.empty());
}

}  // namespace thicket::gui
