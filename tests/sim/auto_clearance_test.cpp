#include "thicket/sim/auto_clearance.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "temporary_folder.hpp"
#include "thicket/base/files.hpp"
#include "thicket/sim/outputs.hpp"
#include "thicket/sim/simulation.hpp"

namespace thicket {
namespace {

constexpr double radius = 0.2, length = 0.2828427, cell = 0.05;

Mission across(double goal_x = 4.0) {
  Mission m;
  m.vehicle.radius_m = radius;
  m.start.x_m = -4.0;
  m.planner.goal_m = glm::dvec2(goal_x, 0.0);
  m.planner.clearance_auto = true;
  m.sensors = {ScanningRadarSpec{}};
  m.map.enabled = false;
  m.output.picture = false;
  return m;
}

/// A room of 12 x 8 m with a wall across it that has two gaps, at y = 2 and y = -2.
World room(double upper_gap, double lower_gap) {
  World w;
  Material wall;
  wall.name = "wall";
  w.materials.push_back(wall);
  const auto box = [&](const char* name, double x_low, double x_high, double y_low, double y_high) {
    if (y_high > y_low) w.solids.push_back({name, 0, {0.5 * (x_low + x_high), 0.5 * (y_low + y_high), 0.5}, 0.0, Box{{x_high - x_low, y_high - y_low, 1.0}}});
  };
  w.solids.push_back({"room", 0, {0.0, 0.0, 0.0}, 0.0, Wall{{{-6.0, -4.0}, {6.0, -4.0}, {6.0, 4.0}, {-6.0, 4.0}, {-6.0, -4.0}}, 0.2, 1.0}});
  box("upper", -0.1, 0.1, 2.0 + 0.5 * upper_gap, 4.0);
  box("middle", -0.1, 0.1, -2.0 + 0.5 * lower_gap, 2.0 - 0.5 * upper_gap);
  box("lower", -0.1, 0.1, -4.0, -2.0 - 0.5 * lower_gap);
  return w;
}

}  // namespace

TEST_CASE("the widest gap decides, less the margin") {
  for (const auto& [upper, lower] : {std::pair{0.6, 1.0}, std::pair{1.0, 0.6}, std::pair{1.0, 0.0}}) {
    const double clearance = auto_clearance(across(), room(upper, lower));
    CAPTURE(upper);
    // Half the gap is hull + 1.1 clearance + a cell; the grid tells it to a cell or so.
    CHECK(clearance <= (0.5 - radius - cell) / 1.1 + 0.01);
    CHECK(clearance >= (0.5 - radius - 2.0 * cell) / 1.1 - 0.01);
  }
}

TEST_CASE("at most three vehicle lengths, and in the open that") {
  World open = room(0.0, 0.0);
  open.solids.resize(1);
  open.solids[0].shape = Box{{0.1, 0.1, 1.0}};
  open.solids[0].position = {50.0, 50.0, 0.5};
  CHECK(auto_clearance(across(), open) == doctest::Approx(3.0 * length));
}

TEST_CASE("without a way: two vehicle lengths, or what start and goal allow") {
  const World shut = room(0.0, 0.0);
  CHECK(auto_clearance(across(), shut) == doctest::Approx(2.0 * length));
  Mission near_wall = across(5.4);  // the wall's face is 0.5 m from the goal
  const double clearance = auto_clearance(near_wall, shut);
  CHECK(clearance <= (0.5 - radius - cell) / 1.1 + 0.01);
  CHECK(clearance >= (0.5 - radius - 2.0 * cell) / 1.1 - 0.01);
  CHECK(auto_clearance(across(20.0), shut) == doctest::Approx(2.0 * length));       // outside
  CHECK(auto_clearance(across(0.0), shut) == doctest::Approx(2.0 * length));        // in matter
  CHECK(auto_clearance(across(), room(0.42, 0.0)) == doctest::Approx(2.0 * length));  // for the bare hull, but not with the margin
}

TEST_CASE("a run with an automatic clearance gets there, says that it is privileged, and its mission.toml gives the same bytes again") {
  auto simulation = Simulation::create(across(), room(1.2, 0.0));
  REQUIRE(simulation);
  const double used = simulation->mission().planner.clearance_m;
  CHECK(used > 0.25);
  while (simulation->step()) {
  }
  CHECK(simulation->verdict()->kind == Verdict::Kind::reached);
  const auto json = nlohmann::json::parse(result_json(*simulation));
  CHECK(json["clearance"]["m"].get<double>() == used);
  CHECK(json["clearance"]["auto"].get<bool>());
  CHECK(json["clearance"]["privileged"].get<bool>());
  const std::string resolved = write_mission(simulation->mission());
  CHECK(resolved.find("clearance_m = \"auto\"") == std::string::npos);
  CHECK(resolved.find("clearance_privileged = true") != std::string::npos);

  Mission plain = across();
  plain.planner.clearance_auto = false;
  CHECK(nlohmann::json::parse(result_json(*Simulation::create(plain, room(1.2, 0.0)))).contains("clearance") == false);
}

TEST_CASE("clearance_m takes a number or the word auto, and nothing else") {
  const auto read = [](const std::string& value) { return read_mission(find_input("foliage_wall/bug2"), {{"planner.clearance_m", value, "--set planner.clearance_m"}}); };
  const auto automatic = read("auto");
  REQUIRE(automatic);
  CHECK(automatic->planner.clearance_auto);
  CHECK(write_mission(*automatic).find("clearance_m = \"auto\"") != std::string::npos);
  const auto number = read("0.7");
  REQUIRE(number);
  CHECK_FALSE(number->planner.clearance_auto);
  CHECK(number->planner.clearance_m == 0.7);
  const auto wrong = read("wide");
  REQUIRE_FALSE(wrong);
  CHECK(wrong.error().message.find("or 'auto'") != std::string::npos);
}

}  // namespace thicket
