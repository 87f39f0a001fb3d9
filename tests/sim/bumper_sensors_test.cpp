// Which sensors drive the bumpers, and when the planner decides.
#include <doctest/doctest.h>

#include "finished.hpp"
#include "temporary_folder.hpp"
#include "thicket/sim/simulation.hpp"

namespace thicket {
namespace {

template <class Spec>
Spec named(const char* name, double yaw_deg = 0.0) {
  Spec spec;
  spec.name = name;
  spec.yaw_deg = yaw_deg;
  spec.position_m = {0.0, 0.0, 0.3};
  return spec;
}

Mission two_lidars() {
  Mission m;
  m.vehicle.radius_m = 0.2;
  m.planner.goal_m = glm::dvec2(9.0, 0.0);
  m.planner.clearance_m = 0.3;
  m.bumpers.press_margin_m = 0.5;
  LidarSpec front = named<LidarSpec>("front"), back = named<LidarSpec>("back", 180.0);
  front.fov_deg = back.fov_deg = 180.0;
  m.sensors = {front, back};
  m.map.enabled = false;
  return m;
}

World wall_behind_and_before() {
  World w;
  Material wall;
  wall.name = "wall";
  w.materials.push_back(wall);
  w.solids.push_back({"before", 0, {1.7, 0.0, 0.5}, 0.0, Box{{1.0, 3.0, 1.0}}});
  w.solids.push_back({"behind", 0, {-1.2, 0.0, 0.5}, 0.0, Box{{1.0, 3.0, 1.0}}});
  return w;
}

std::string fault_of(const std::string& sensors) {
  const TemporaryFolder folder;
  folder.write("w.toml", "name = \"w\"\n[material.wall]\n[[solid]]\ntype = \"box\"\nmaterial = \"wall\"\nposition_m = [5.0, 0.0, 0.5]\nsize_m = [1.0, 1.0, 1.0]\n");
  const auto mission = read_mission(folder.write("m.toml", "world = \"w.toml\"\n[planner]\ngoal_m = [1.0, 2.0]\n[bumpers]\nsensors = \"" + sensors +
                                                               "\"\n[[sensor]]\npreset = \"usarsim2012\"\nname = \"front\"\n[[sensor]]\npreset = \"urg04lx\"\nname = \"laser\"\n"),
                                    {});
  return mission ? "" : mission.error().message;
}

}  // namespace

TEST_CASE("without names the first sensor drives the bumpers, and of lobe radars all") {
  Mission m;
  m.sensors = {named<ScanningRadarSpec>("a"), named<LidarSpec>("b"), named<LobeRadarSpec>("c")};
  CHECK(bumper_sensors(m) == std::vector<std::size_t>{0});
  m.sensors = {named<LobeRadarSpec>("a"), named<LidarSpec>("b"), named<LobeRadarSpec>("c")};
  CHECK(bumper_sensors(m) == std::vector<std::size_t>{0, 2});
  m.bumpers.sensors = " c ,b";
  CHECK(bumper_sensors(m) == std::vector<std::size_t>{2, 1});
}

TEST_CASE("a name that no sensor has is told with the nearest one") {
  CHECK(fault_of("front, laser") == "");
  CHECK(fault_of("") == "");
  const std::string fault = fault_of("front,lasre");
  CHECK(fault.find("'sensors' names 'lasre'") != std::string::npos);
  CHECK(fault.find("did you mean 'laser'") != std::string::npos);
}

TEST_CASE("the bumpers are pressed by what any of their sensors sees") {
  Mission m = two_lidars();
  const auto pressed_after_first_step = [&](const char* sensors) {
    m.bumpers.sensors = sensors;
    auto simulation = Simulation::create(m, wall_behind_and_before());
    REQUIRE(simulation);
    simulation->step();
    const auto& bumpers = simulation->bumpers().bumpers();
    return std::pair{bumpers[0].pressed, bumpers[4].pressed};
  };
  CHECK(pressed_after_first_step("front") == std::pair{false, false});  // 1.2 m from the axis, 0.8 m is pressed
  CHECK(pressed_after_first_step("back") == std::pair{false, true});    // 0.7 m
  CHECK(pressed_after_first_step("front, back") == std::pair{false, true});
  m.start.x_m = 0.45;
  CHECK(pressed_after_first_step("front, back") == std::pair{true, false});
}

TEST_CASE("the planner decides when the first named sensor has scanned; older scans of the others are moved along") {
  Mission m = two_lidars();
  m.vehicle.turn_rate_max_deg_s = 30.0;
  mounted(m.sensors[0]).rate_hz = 10.0;
  mounted(m.sensors[1]).rate_hz = 1.0;
  m.planner.goal_m = glm::dvec2(0.0, 9.0);  // turns left to it: what is behind comes to the left
  m.bumpers.sensors = "front, back";
  m.bumpers.count = 36;
  auto simulation = Simulation::create(m, wall_behind_and_before());
  REQUIRE(simulation);
  while (simulation->time() < 0.96 && simulation->step()) {
  }
  CHECK(simulation->totals().decisions == 10);
  const double yaw = simulation->vehicle().pose.yaw;
  REQUIRE(yaw > radians(15.0));
  // The wall behind was seen straight behind, once; its nearest point is now 180 degrees less the turn.
  const Bumper* nearest = nullptr;
  for (const Bumper& b : simulation->bumpers().bumpers())
    if (!nearest || b.distance < nearest->distance) nearest = &b;
  CHECK(std::abs(wrap_angle(nearest->bearing - (pi - yaw))) < radians(4.0));
  CHECK(nearest->distance == doctest::Approx(0.5).epsilon(0.03));

  m.bumpers.sensors = "back, front";
  auto slow = Simulation::create(m, wall_behind_and_before());
  REQUIRE(slow);
  while (slow->time() < 0.96 && slow->step()) {
  }
  CHECK(slow->totals().decisions == 1);
}

}  // namespace thicket
