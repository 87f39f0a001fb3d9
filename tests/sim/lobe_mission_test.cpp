// Missions with lobe radars: several on one vehicle, as the receiver sees it or as traced.
#include <doctest/doctest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <fstream>

#include "finished.hpp"
#include "temporary_folder.hpp"
#include "thicket/sim/outputs.hpp"
#include "thicket/sim/simulation.hpp"

namespace thicket {
namespace {

/// A small vehicle that drives 3 m through the test room, with four x4m05 looking to all sides.
Mission four_lobes(const std::vector<Override>& overrides = {}) {
  std::string text = R"(
world = "test_room/test_room.toml"
step_s = 0.05
[vehicle]
preset = "small"
[start]
x_m = -3.0
y_m = -2.0
[planner]
name = "waypoints"
waypoints_m = [[0.0, -2.0]]
clearance_m = 0.3
)";
  for (const char* yaw : {"0", "90", "180", "270"})
    text += std::string("[[sensor]]\npreset = \"x4m05\"\nname = \"lobe") + yaw + "\"\nyaw_deg = " + yaw + ".0\nposition_m = [0.0, 0.0, 1.0]\nrate_hz = 10.0\nazimuth_rays = 20\nelevation_rays = 20\n";
  const TemporaryFolder folder;
  const auto file = folder.path() / "lobes.toml";
  std::ofstream(file) << text;
  auto mission = read_mission(file, overrides);
  if (!mission) FAIL(mission.error().message);
  return *mission;
}

std::string map_of(const Simulation& simulation) {
  const GridMap grid = simulation.map().to_grid();
  std::string text;
  for (const CellState cell : grid.cells) text += static_cast<char>('0' + static_cast<int>(cell));
  return text;
}

}  // namespace

TEST_CASE("four lobes on a vehicle: all of them scan, and threads do not change a cell of the map") {
  const auto run = [](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    return finished(four_lobes());
  };
  const Simulation one = run(1), two = run(2);
  REQUIRE(one.verdict());
  CHECK(std::string(to_string(one.verdict()->kind)) == "reached");
  CHECK(one.scans().size() == 4);
  for (const Scan& scan : one.scans()) {
    CHECK(scan.number > 20);
    CHECK(scan.profiles.bins == 1536);
    CHECK(scan.rays == 400);
  }
  CHECK(one.scans()[1].mount_orientation.z > 0.5);  // to the left
  CHECK(map_of(one) == map_of(two));
  CHECK(one.totals().path_length == two.totals().path_length);
  CHECK(one.map().known_cells() > 1000);
}

TEST_CASE("by a mission key maps get what the receiver detects or what the rays met") {
  const Simulation received = finished(four_lobes()), traced = finished(four_lobes({{"sensor.echoes", "traced", "test"}}));
  CHECK(received.scans()[0].beams.size() == 1);
  CHECK(traced.scans()[0].beams.size() == 400);
  CHECK(map_of(received) != map_of(traced));
}

TEST_CASE("the radar of a driving robot tells how fast what it drives to comes nearer") {
  Mission mission = four_lobes({{"sensor.radial_velocity", "true", "test"}, {"sensor.echoes", "traced", "test"}});
  auto simulation = Simulation::create(mission);
  REQUIRE(simulation);
  while (simulation->time() < 2.0 && simulation->step()) {
  }
  const double speed = glm::length(simulation->platform().velocity);
  REQUIRE(speed > 0.2);
  const auto velocities = [&](std::size_t sensor) {
    std::vector<double> list;
    for (const Echo& echo : simulation->scans()[sensor].echoes) list.push_back(static_cast<double>(echo.radial_velocity));
    std::ranges::sort(list);
    return list;
  };
  // Ahead everything comes nearer, by the cosine of up to 46 degrees off the axis; behind it goes away; aside both.
  CHECK(velocities(0).front() >= -1.01 * speed);
  CHECK(velocities(0).front() < -0.98 * speed);
  CHECK(velocities(0).back() < -0.65 * speed);
  CHECK(velocities(2).front() > 0.65 * speed);
  CHECK(velocities(1).front() < 0.0);
  CHECK(velocities(1).back() > 0.0);
}

}  // namespace thicket
