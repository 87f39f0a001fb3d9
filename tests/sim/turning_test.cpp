// Turning on the spot next to a wall. The maps of 2018 had space behind walls after it.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>

#include "temporary_folder.hpp"
#include "thicket/sim/simulation.hpp"

namespace thicket {
namespace {

// The room is closed: 8 x 6 m inside, walls of 0.2 m. The robot stands half a metre from the south wall, not in the middle.
constexpr double half_length = 4.0, half_width = 3.0;
constexpr glm::dvec2 stand{0.7, -half_width + 0.5};
constexpr double step_deg = 3.7;  // no part of a turn, so that no turn repeats another
constexpr int turns = 3, scans = static_cast<int>(turns * 360.0 / step_deg);

constexpr const char* room = R"(
name = "closed room"
bounds_m = [-4.2, -3.2, 4.2, 3.2]
[floor]
material = "concrete"
[ceiling]
material = "concrete"
z_m = 3.0
[[solid]]
type = "wall"
material = "concrete"
points_m = [[-4.1, -3.1], [4.1, -3.1], [4.1, 3.1], [-4.1, 3.1], [-4.1, -3.1]]
thickness_m = 0.2
height_m = 3.0
)";

/// The room with a robot that has these sensors.
Simulation in_the_room(const std::string& sensors) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "room.toml") << room;
  std::ofstream(folder.path() / "mission.toml") << "world = \"room.toml\"\n[start]\nx_m = 0.7\ny_m = -2.5\n[planner]\nname = \"waypoints\"\nwaypoints_m = [[0.7, 0.0]]\n" << sensors;
  const auto mission = read_mission(folder.path() / "mission.toml", {});
  if (!mission) FAIL(mission.error().message);
  auto simulation = Simulation::create(*mission);
  if (!simulation) FAIL(simulation.error().message);
  return *simulation;
}

/// Cells behind the walls, farther out than noise and the size of cells explain, which the map ever knew as free or claimed. A lobe's echo is anywhere on its arc: it gives all cells there that nothing is known of the
/// least evidence that there is, which is no claim; so claimed is what has more than 0.55.
class Behind {
 public:
  Behind(const OccupancyMap& map, double sigma) : limit_(2.0 * sigma + map.resolution() * std::sqrt(2.0)) {
    constexpr double reach = 10.0;
    const double cell = map.resolution();
    for (double y = -reach + 0.5 * cell; y < reach; y += cell)
      for (double x = -reach + 0.5 * cell; x < reach; x += cell)
        if (out(x, y) > limit_) cells_.push_back({map.cell_at({x, y}), out(x, y)});
    CHECK(cells_.size() > 1000);
  }
  void look(const OccupancyMap& map) {
    std::erase_if(cells_, [&](const auto& entry) {
      const CellView view = map.view(entry.first);
      if (!view.known || (view.probability >= 0.5 && view.probability <= 0.55)) return false;
      ++(view.probability < 0.5 ? free : claimed);
      deepest = std::max(deepest, entry.second);
      return true;
    });
  }
  int free = 0, claimed = 0;
  double deepest = 0.0;  ///< m

 private:
  static double out(double x, double y) { return std::max(std::abs(x) - half_length, std::abs(y) - half_width); }
  double limit_;
  std::vector<std::pair<CellIndex, double>> cells_;
};

/// Turns, and counts cells behind the walls. `scans_at(pose, number)` gives what the robot senses there.
template <class ScansAt>
Behind turned(double resolution, double sigma, ScansAt&& scans_at, const char* evidence = "views") {
  MapSpec spec;
  spec.evidence = evidence;
  spec.resolution_m = resolution;
  OccupancyMap map(spec);
  Behind behind(map, sigma);
  for (int i = 0; i < scans; ++i) {
    const Pose pose = Pose::planar(stand.x, stand.y, 0.0, radians(i * step_deg));
    for (const Scan& scan : scans_at(pose, static_cast<std::uint64_t>(i))) map.integrate(scan, pose);
    if (i % 8 == 0 || i + 1 == scans) behind.look(map);
  }
  // It did map: the middle of the room and the side of the robot are free, and the wall beside it is claimed.
  CHECK(map.view(map.cell_at({0.0, 0.0})).probability < 0.5);
  CHECK(map.view(map.cell_at({stand.x, stand.y - 0.15})).probability < 0.5);
  bool claimed = false;
  for (double off = -resolution; off <= resolution; off += 0.5 * resolution) claimed |= map.view(map.cell_at({stand.x, -half_width + off})).probability > 0.5;
  CHECK(claimed);
  MESSAGE("cells of ", resolution, " m: behind walls known free ", behind.free, ", claimed ", behind.claimed, ", as far as ", behind.deepest, " m");
  return behind;
}

/// What the sensors of a simulation sense.
Behind turned(const Simulation& simulation, double resolution, double sigma) {
  const auto& sensors = simulation.stage().sensors;
  std::vector<Scan> scans_here(sensors.size());
  return turned(resolution, sigma, [&](const Pose& pose, std::uint64_t number) -> const std::vector<Scan>& {
    for (std::size_t i = 0; i < sensors.size(); ++i)
      sensors[i]->measure(simulation.scene(), pose, 0.05 * static_cast<double>(number), number, Random(1, static_cast<std::uint16_t>(i)), scans_here[i]);
    return scans_here;
  });
}

/// Four lobes of 65 degrees and 10 m that each tell the range of the nearest wall in them, whatever its angle.
class NearestInLobes {
 public:
  explicit NearestInLobes(double sigma) : sigma_(sigma), noise_(0.0, sigma) {}
  std::vector<Scan> at(const Pose& pose, double yaw, std::uint64_t number) {
    std::vector<Scan> list;
    for (int lobe = 0; lobe < 4; ++lobe) {
      const double axis = lobe * 0.5 * pi;
      double nearest = 10.0;
      for (int ray = 0; ray <= 650; ++ray) nearest = std::min(nearest, wall_at(glm::dvec2(pose.position), yaw + axis + radians(0.1 * ray - 32.5)));
      Scan scan;
      scan.sensor = static_cast<std::uint16_t>(lobe);
      scan.number = number;
      scan.mount_orientation = Pose::planar(0.0, 0.0, 0.0, axis).orientation;
      scan.range_max = 10.0;
      scan.range_noise = sigma_;
      scan.azimuth_opening = radians(65.0);
      Beam beam;
      beam.direction = {1.0, 0.0, 0.0};
      beam.echo_count = 1;
      beam.end = BeamEnd::stopped;
      scan.echoes.push_back({.range = std::max(0.05, nearest + (sigma_ > 0.0 ? noise_(engine_) : 0.0)), .amplitude = 1.0f});
      beam.sensed_range = scan.echoes.front().range;
      scan.beams.push_back(beam);
      list.push_back(std::move(scan));
    }
    return list;
  }

 private:
  static double wall_at(const glm::dvec2& from, double bearing) {
    const double c = std::cos(bearing), s = std::sin(bearing);
    return std::min((std::copysign(half_length, c) - from.x) / c, (std::copysign(half_width, s) - from.y) / s);
  }
  double sigma_;
  std::mt19937 engine_{5};
  std::normal_distribution<double> noise_;
};

std::string four_x4m05() {
  std::string text;
  for (const char* yaw : {"0", "90", "180", "270"})  // 30 x 30 rays, as 2018
    text += std::string("[[sensor]]\npreset = \"x4m05\"\nname = \"lobe") + yaw + "\"\nyaw_deg = " + yaw + ".0\nposition_m = [0.0, 0.0, 1.0]\nazimuth_rays = 30\nelevation_rays = 30\n";
  return text;
}

constexpr const char* beam_radar = "[[sensor]]\npreset = \"usarsim2012\"\n";

Behind turned_lobes(double resolution, double sigma, const char* evidence) {
  NearestInLobes lobes(sigma);
  return turned(resolution, sigma, [&](const Pose& pose, std::uint64_t number) { return lobes.at(pose, radians(static_cast<double>(number) * step_deg), number); }, evidence);
}

void check_nothing(const Behind& behind) {
  CHECK(behind.free == 0);
  CHECK(behind.claimed == 0);
}

}  // namespace

TEST_CASE("a beam radar that turns beside a wall maps nothing behind it") {
  for (const double resolution : {0.2, 0.1}) check_nothing(turned(in_the_room(beam_radar), resolution, 0.0));
}

TEST_CASE("lobes of 65 degrees that turn beside a wall map nothing behind it, where every look counts") {
  for (const double resolution : {0.2, 0.1}) check_nothing(turned_lobes(resolution, 0.0, "scans"));
}

TEST_CASE("lobes of 65 degrees that turn beside a wall map nothing behind it, where repeated looks are one witness") {
  for (const double resolution : {0.2, 0.1}) check_nothing(turned_lobes(resolution, 0.0, "views"));
}
TEST_CASE("a beam radar that turns beside a wall maps nothing behind it, in cells of 5 cm") {
  check_nothing(turned(in_the_room(beam_radar), 0.05, 0.0));
}

TEST_CASE("lobes of 65 degrees whose ranges are off by 0.15 m turn beside a wall and map nothing behind it") { check_nothing(turned_lobes(0.1, 0.15, "scans")); }

// A wall that a lobe sees under more than 75 degrees gives no first top: the range is that of another wall. So not all of the opening may be freed.
TEST_CASE("four X4M05 that turn beside a wall map nothing behind it") { 
  constexpr double bin = 0.0514;  // m: a range is that of a bin's middle
  check_nothing(turned(in_the_room(four_x4m05()), 0.1, 0.5 * bin));
}

}  // namespace thicket
