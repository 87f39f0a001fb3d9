#include <doctest/doctest.h>

#include <string>

#include "temporary_folder.hpp"
#include "thicket/base/files.hpp"
#include "thicket/sim/mission.hpp"

namespace thicket {
namespace {

const char* const small_world = R"(name = "w"
[material.wall]
[[solid]]
type = "box"
material = "wall"
position_m = [5.0, 0.0, 0.5]
size_m = [1.0, 1.0, 1.0]
)";

const char* const good = R"(world = "w.toml"
[vehicle]
preset = "small"
radius_m = 0.2
[start]
x_m = 1.0
[planner]
goal_m = [3.0, 4.0]
)";

std::string fault_of(const std::string& text, const std::vector<Override>& overrides = {}) {
  const TemporaryFolder folder;
  folder.write("w.toml", small_world);
  const auto mission = read_mission(folder.write("m.toml", text), overrides);
  return mission ? "" : mission.error().message;
}

}  // namespace

TEST_CASE("a mission takes presets, its own keys on top, and defaults for the rest") {
  const TemporaryFolder folder;
  folder.write("w.toml", small_world);
  const auto mission = read_mission(folder.write("m.toml", good), {});
  REQUIRE(mission);
  CHECK(mission->name == "m");
  CHECK(mission->vehicle.name == "small");
  CHECK(mission->vehicle.radius_m == 0.2);
  CHECK(mission->vehicle.speed_max_m_s == 0.5);
  CHECK(mission->start.x_m == 1.0);
  CHECK(mission->planner.name == "bug2");
  CHECK(mission->planner.goal_m->y == 4.0);
  REQUIRE(mission->sensors.size() == 1);
  CHECK(scanner(mission->sensors[0])->step_deg == 1.0);
  CHECK(mounted(mission->sensors[0]).name == "radar");
  CHECK(mission->world_file == folder.path() / "w.toml");
}

TEST_CASE("what is wrong with a mission is told with its place and a remedy") {
  struct Case {
    const char* text;
    const char* place;
    const char* words;
  };
  const std::string ok = good;
  const Case cases[] = {
      {"world = \"w.toml\"\n[planer]\ngoal_m = [1.0, 2.0]\n", "m.toml:2:2", "did you mean 'planner'?"},
      {"world = \"w.toml\"\n[planner]\ngoal_m = [1.0, 2.0]\nclearence_m = 1\n", "m.toml:4:1", "did you mean 'clearance_m'?"},
      {"world = \"w.toml\"\n[planner]\ngoal_m = [1.0]\n", "m.toml:3:10", "expected an array of 2 numbers in m"},
      {"world = \"w.toml\"\n[planner]\ngoal_m = [1.0, nan]\n", "m.toml:3:16", "expected an array of 2 numbers"},
      {"world = \"w.toml\"\n[planner]\nname = \"bug3\"\ngoal_m = [1.0, 2.0]\n", "m.toml:3:8", "expected one of 'bug1', 'bug2', 'bug2_2012'"},
      {"world = \"w.toml\"\n", "m.toml", "lacks a goal"},
      {"world = \"w.toml\"\n[planner]\nname = \"waypoints\"\n", "m.toml:2:1", "lacks way-points"},
      {"[planner]\ngoal_m = [1.0, 2.0]\n", "m.toml", "lacks the key 'world'"},
      {"world = \"nowhere.toml\"\n[planner]\ngoal_m = [1.0, 2.0]\n", "m.toml:1:9", "there is no file 'nowhere.toml'"},
      {"world = \"w.toml\"\nseed = -1\n[planner]\ngoal_m = [1.0, 2.0]\n", "m.toml:2:8", "at least 0"},
      {"world = \"w.toml\"\nseed = 1.5\n[planner]\ngoal_m = [1.0, 2.0]\n", "m.toml:2:8", "expected an integer"},
      {"world = \"w.toml\"\n[vehicle]\npreset = \"p3att\"\n[planner]\ngoal_m = [1.0, 2.0]\n", "m.toml:3:10", "did you mean 'p3at'?"},
      {"world = \"w.toml\"\n[vehicle]\nradius_m = 0.0\n[planner]\ngoal_m = [1.0, 2.0]\n", "m.toml:3:12", "above 0"},
      {"world = \"w.toml\"\n[planner]\ngoal_m = [1.0, 2.0]\n[[sensor]]\npreset = \"usarsim\"\n", "m.toml:5:10", "there is no sensor preset 'usarsim'"},
      {"world = \"w.toml\"\n[planner]\ngoal_m = [1.0, 2.0]\n[[sensor]]\nrate_hz = 5\n", "m.toml:4:1", "lacks 'type' or 'preset'"},
      {"world = \"w.toml\"\n[planner]\ngoal_m = [1.0, 2.0]\n[sensor]\ntype = \"lidar\"\n", "m.toml:4:1", "expected entries [[sensor]]"},
      {"world = \"w.toml\"\n[planner]\ngoal_m = [1.0, 2.0]\n[[sensor]]\ntype = \"lidar\"\npenetration_budget_db = 3\n", "m.toml:6:1", "unknown key 'penetration_budget_db'"},
      {"world = \"w.toml\"\n[planner]\ngoal_m = [1.0, 2.0]\n[map]\nresolution_m = 0.001\n", "m.toml:4:1", "make map.resolution_m coarser"},
      {"world = \"w.toml\"\n[planner]\ngoal_m = [1.0, 2.0]\n[[sensor]]\ntype = \"lidar\"\n[[sensor]]\ntype = \"lidar\"\n", "m.toml:4:", "two sensors are named 'sensor'"},
      {"world = \"w.toml\"\nworld = \"w.toml\"\n", "m.toml:2:", "cannot redefine"},
      {"world = \"w.toml\"\n[planner\n", "m.toml:2:", ""},
  };
  for (const Case& c : cases) {
    CAPTURE(c.text);
    const std::string message = fault_of(c.text);
    CAPTURE(message);
    CHECK(message.find(c.place) != std::string::npos);
    CHECK(message.find(c.words) != std::string::npos);
  }
  CHECK(fault_of(good).empty());
}

TEST_CASE("all faults of a file are told at once") {
  const std::string message = fault_of("world = \"w.toml\"\nseed = -1\n[planner]\nclearance_m = 0\nhand = \"both\"\n[map]\nresolution = 0.1\n");
  CHECK(message.find(":2:8") != std::string::npos);
  CHECK(message.find(":4:15") != std::string::npos);
  CHECK(message.find(":5:8") != std::string::npos);
  CHECK(message.find(":7:1") != std::string::npos);
}

TEST_CASE("overrides are read like the file, and their faults name the flag") {
  const TemporaryFolder folder;
  folder.write("w.toml", small_world);
  const auto file = folder.write("m.toml", good);
  const auto mission = read_mission(file, {{"planner.hand", "right", "--set planner.hand"},
                                           {"planner.clearance_m", "0.5", "--set planner.clearance_m"},
                                           {"sensor.range_max_m", "12", "--set sensor.range_max_m"},
                                           {"seed", "7", "--seed"}});
  REQUIRE(mission);
  CHECK(mission->planner.hand == "right");
  CHECK(mission->planner.clearance_m == 0.5);
  CHECK(mounted(mission->sensors[0]).range_max_m == 12.0);
  CHECK(mission->seed == 7);
  CHECK(fault_of(good, {{"planner.clearance", "0.5", "--set planner.clearance"}}).find("--set planner.clearance: unknown key 'clearance' in [planner] (did you mean") != std::string::npos);
  CHECK(fault_of(good, {{"planner.clearance_m", "wide", "--set planner.clearance_m"}}).find("--set planner.clearance_m: 'clearance_m' is a text") != std::string::npos);
  CHECK(fault_of(good, {{"sensor.front.rate_hz", "1", "--set sensor.front.rate_hz"}}).find("no sensor named 'front'") != std::string::npos);
  CHECK(fault_of(good, {{"planner.", "1", "--set planner."}}).find("expected key=value") != std::string::npos);
}

TEST_CASE("a mission written out reads back to the same mission, from anywhere") {
  for (const char* shipped : {"foliage_wall/bug2.toml", "foliage_wall/map_lidar.toml", "rooms/spiral.toml"}) {
    const auto file = find_input(shipped);
    REQUIRE_FALSE(file.empty());
    const auto mission = read_mission(file, {{"sensor.range_noise_m", "0.03333333333333333", "--set"}, {"start.yaw_deg", "0.1", "--set"}});
    REQUIRE(mission);
    const TemporaryFolder folder;
    const std::string text = write_mission(*mission);
    const auto again = read_mission(folder.write("deep/er/mission.toml", text), {});
    if (!again) FAIL(again.error().message);
    CHECK(write_mission(*again) == text);
    CHECK(again->world_file == mission->world_file);
    CHECK(again->name == mission->name);
  }
}

TEST_CASE("the help names every key of a mission") {
  const std::string help = describe_mission_file();
  for (const char* key : {"clearance_m", "goal_tolerance_m", "turn_acceleration_deg_s2", "penetration_budget_db", "side_offset_m", "resolution_m", "stuck_s", "observed_region_m",
                          "press_margin_m", "step_s", "usarsim2012", "p3at"})
    CHECK(help.find(key) != std::string::npos);
}

}  // namespace thicket
