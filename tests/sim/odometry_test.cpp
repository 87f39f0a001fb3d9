// What the robot believes about its pose, and what of it gets where.
#include <doctest/doctest.h>

#include <cmath>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "finished.hpp"
#include "thicket/sim/odometry.hpp"
#include "thicket/sim/outputs.hpp"
#include "thicket/sim/run.hpp"

namespace thicket {
namespace {

/// Believed and true pose after `seconds` on an arc, in steps of `dt`.
struct Drive {
  Pose2 believed, truth;
};
Drive drive(const OdometrySpec& spec, double speed, double turn_rate, double seconds, double dt, std::uint64_t seed = 1) {
  Drive d;
  Odometry odometry(spec, d.truth, seed);
  for (std::uint64_t step = 0; static_cast<double>(step) * dt < seconds - 1e-9; ++step) {
    const Arc arc{d.truth, speed, turn_rate};
    odometry.advance(arc, dt, step);
    d.truth = arc.at(dt);
  }
  d.believed = odometry.pose();
  return d;
}

/// A box beside the way of 4 m and one behind the goal.
Mission mission() {
  Mission m;
  m.vehicle.radius_m = 0.2;
  m.planner.goal_m = glm::dvec2(4.0, 0.0);
  m.planner.clearance_m = 0.3;
  m.sensors = {ScanningRadarSpec{}};
  m.limits.time_s = 200.0;
  return m;
}
World world() {
  World w;
  Material wall;
  wall.name = "wall";
  w.materials.push_back(wall);
  w.solids.push_back({"beside", 0, {2.0, 2.0, 0.5}, 0.0, Box{{1.0, 1.0, 1.0}}});
  w.solids.push_back({"behind", 0, {7.0, 0.0, 0.5}, 0.0, Box{{1.0, 4.0, 1.0}}});
  return w;
}
Simulation ended(const Mission& m, Trajectory* trajectory = nullptr) {
  auto simulation = Simulation::create(m, world());
  if (!simulation) FAIL(simulation.error().message);
  Trajectory ignored;
  run(*simulation, trajectory ? *trajectory : ignored, {});
  return std::move(*simulation);
}

}  // namespace

TEST_CASE("scales make the believed way longer and the believed turn larger") {
  OdometrySpec spec;
  spec.speed_scale = 1.1;
  CHECK(glm::distance(drive(spec, 0.5, 0.0, 10.0, 0.05).believed.position, glm::dvec2(5.5, 0.0)) < 1e-9);
  spec = {};
  spec.turn_scale = 0.9;
  CHECK(drive(spec, 0.0, 0.1, 10.0, 0.05).believed.yaw == doctest::Approx(0.9));
  CHECK(drive(spec, 0.0, 0.1, 10.0, 0.05).believed.position == glm::dvec2(0.0, 0.0));
}

TEST_CASE("noise spreads the believed way by sigma x sqrt(0.1 s x time), whatever the step") {
  OdometrySpec spec;
  spec.speed_noise_m_s = 0.2;
  spec.turn_noise_rad_s = 0.0;
  for (const double dt : {0.02, 0.1}) {
    double sum = 0.0, squares = 0.0;
    constexpr int runs = 1000;
    for (int i = 0; i < runs; ++i) {
      const double x = drive(spec, 0.5, 0.0, 4.0, dt, static_cast<std::uint64_t>(i)).believed.position.x - 2.0;
      sum += x;
      squares += x * x;
    }
    const double sigma = 0.2 * std::sqrt(0.1 * 4.0);
    CAPTURE(dt);
    CHECK(std::abs(sum / runs) < 4.0 * sigma / std::sqrt(1.0 * runs));
    CHECK(std::sqrt(squares / runs) == doctest::Approx(sigma).epsilon(0.1));
  }
  spec = {};
  spec.turn_noise_rad_s = 0.1;
  CHECK(drive(spec, 0.0, 0.0, 4.0, 0.1).believed.yaw != 0.0);
  CHECK(drive(spec, 0.0, 0.0, 4.0, 0.1, 7).believed.yaw == drive(spec, 0.0, 0.0, 4.0, 0.1, 7).believed.yaw);
  CHECK(drive(spec, 0.0, 0.0, 4.0, 0.1, 7).believed.yaw != drive(spec, 0.0, 0.0, 4.0, 0.1, 8).believed.yaw);
}

TEST_CASE("perfect odometry is the truth, and leaves no trace in the outputs") {
  Trajectory trajectory;
  const Simulation simulation = ended(mission(), &trajectory);
  CHECK(simulation.verdict()->kind == Verdict::Kind::reached);
  CHECK(simulation.estimate().position == simulation.vehicle().pose.position);
  CHECK(simulation.verdict()->true_distance_to_goal_m.value() <= 0.1);
  CHECK(trajectory.csv().find("estimate") == std::string::npos);
  CHECK(result_json(simulation).find("estimate") == std::string::npos);
  CHECK(result_json(simulation).find("true_distance") == std::string::npos);
}

TEST_CASE("a robot that believes to be faster than it is stops short of the goal, says reached, and the verdict tells how far it really is") {
  Mission m = mission();
  m.odometry.speed_scale = 1.25;
  Trajectory trajectory;
  const Simulation simulation = ended(m, &trajectory);
  CHECK(simulation.verdict()->kind == Verdict::Kind::reached);
  CHECK(simulation.verdict()->true_distance_to_goal_m.value() == doctest::Approx(0.8).epsilon(0.12));
  CHECK(glm::distance(simulation.estimate().position, glm::dvec2(4.0, 0.0)) <= 0.1);
  const auto json = nlohmann::json::parse(result_json(simulation));
  CHECK(json["true_distance_to_goal_m"].get<double>() == *simulation.verdict()->true_distance_to_goal_m);
  CHECK(json["final_estimate"]["x_m"].get<double>() > 3.8);
  const TrajectoryPoint& last = trajectory.points().back();
  CHECK(last.estimate.position.x == doctest::Approx(1.25 * last.pose.position.x));
  CHECK(trajectory.csv().find("turn_rate_deg_s,estimate_x_m,estimate_y_m,estimate_yaw_deg,state\n") != std::string::npos);
  // The map is drawn where the robot believes to be: the wall that begins at 6.5 m seems to move with it.
  std::int64_t occupied_beyond = 0;
  const OccupancyMap& map = simulation.map();
  for (double y = -1.5; y <= 1.5; y += 0.05)
    for (double x = 6.9; x <= 7.4; x += 0.05) occupied_beyond += map.view(map.cell_at({x, y})).probability > 0.6;
  CHECK(occupied_beyond > 10);
}

TEST_CASE("drift does not move the truth: contact is where the matter is") {
  Mission m = mission();
  m.odometry.turn_noise_rad_s = 0.1;
  m.odometry.speed_noise_m_s = 0.1;
  const Simulation simulation = ended(m), again = ended(m);
  CHECK(simulation.vehicle().pose.position == again.vehicle().pose.position);
  CHECK(simulation.estimate().position == again.estimate().position);
  CHECK(simulation.estimate().position != simulation.vehicle().pose.position);
  CHECK(simulation.verdict()->kind != Verdict::Kind::collided);
}

}  // namespace thicket
