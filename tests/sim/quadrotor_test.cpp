// The quadrotor: closed forms, the rigid body, contact in space, and whole flights.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include <glm/geometric.hpp>

#include "finished.hpp"
#include "thicket/base/files.hpp"
#include "thicket/sim/flight.hpp"
#include "thicket/sim/trajectory.hpp"

namespace thicket {
namespace {

VehicleSpec quadrotor() {
  VehicleSpec spec;
  spec.type = "quadrotor";
  spec.radius_m = 0.402;
  spec.height_m = 0.2;
  spec.speed_max_m_s = 10.0;
  spec.turn_acceleration_deg_s2 = 360.0;
  return spec;
}

/// A flight by itself: one short-sighted sensor, no map.
Mission flight(const glm::dvec3& start) {
  Mission mission;
  mission.vehicle = quadrotor();
  mission.vehicle.model = "kinematic";
  mission.start = {start.x, start.y, start.z, 0.0};
  mission.step_s = 0.01;
  LidarSpec blind;
  blind.range_max_m = 0.01;
  mission.sensors = {blind};
  mission.map.enabled = false;
  mission.planner.name = "waypoints";
  mission.planner.clearance_m = 0.01;
  mission.planner.speed_m_s = 1.0;
  mission.planner.waypoints_m = {{start.x, start.y, 1.0}};
  return mission;
}

World world_of(Shape shape, const glm::dvec3& position) {
  World world;
  Material material;
  material.name = "wall";
  world.materials.push_back(material);
  world.solids.push_back({"thing", 0, position, 0.0, std::move(shape)});
  return world;
}

Simulation flown(const Mission& mission, World world) {
  auto simulation = Simulation::create(mission, std::move(world));
  if (!simulation) FAIL(simulation.error().message);
  while (simulation->step()) {
  }
  return *simulation;
}

/// Flies by hand until something is touched, or for some seconds.
Simulation driven(const Mission& mission, World world, const Command& command, double seconds) {
  auto simulation = Simulation::create(mission, std::move(world));
  if (!simulation) FAIL(simulation.error().message);
  REQUIRE_FALSE(simulation->verdict());
  simulation->drive(command);
  while (simulation->time() < seconds && simulation->step()) {
  }
  return *simulation;
}

Command climbing(double rate) {
  Command command;
  command.climb = rate;
  return command;
}

Mission shipped(const char* name, const std::vector<Override>& overrides = {}) {
  auto mission = read_mission(find_input(name), overrides);
  if (!mission) FAIL(mission.error().message);
  return *mission;
}

std::string verdict(const Simulation& simulation) { return simulation.verdict() ? to_string(simulation.verdict()->kind) : "running"; }

}  // namespace

TEST_CASE("kinematic quadrotor: a step of 1 s is a thousand of 1 ms, with limits, with drag and while an altitude is taken") {
  VehicleSpec spec = quadrotor();
  for (const auto& [speed, altitude] : {std::pair{0.5, 1.2}, {8.0, 30.0}, {-6.0, -20.0}}) {
    CAPTURE(speed);
    Command command{speed, 0.0};
    command.lateral = 0.7 * speed;
    command.altitude = altitude;
    FlightState begin;
    begin.position = {1.0, 2.0, 1.0};
    begin.velocity = {-1.0, 0.4, 0.3};
    const FlightState whole = fly(begin, command, 0.0, {}, spec, false, 1.0);
    FlightState pieces = begin;
    for (int i = 0; i < 1000; ++i) pieces = fly(pieces, command, 0.0, {}, spec, false, 1e-3);
    CHECK(glm::distance(whole.position, pieces.position) < 1e-9);
    CHECK(glm::distance(whole.velocity, pieces.velocity) < 1e-9);
    CHECK(std::abs(glm::dot(whole.attitude, pieces.attitude)) > 1.0 - 1e-9);
  }
}

TEST_CASE("kinematic quadrotor: 63 % of a step after velocity_time_s, no overshoot, and the tilt that its acceleration needs") {
  VehicleSpec spec = quadrotor();
  spec.drag = {0.0};
  const Command command{1.0, 0.0};
  FlightState state;
  state.position.z = 1.0;
  const FlightState after = fly(state, command, 0.0, {}, spec, false, spec.velocity_time_s);
  CHECK(after.velocity.x == doctest::Approx(1.0 - std::exp(-1.0)).epsilon(1e-12));
  CHECK(roll_pitch_yaw(after.attitude).y == doctest::Approx(std::atan(std::exp(-1.0) / spec.velocity_time_s / gravity)).epsilon(1e-12));
  for (int i = 0; i < 1000; ++i) {
    state = fly(state, command, 0.0, {}, spec, false, 0.01);
    CHECK(state.velocity.x <= 1.0);
  }
  CHECK(state.velocity.x == doctest::Approx(1.0).epsilon(1e-12));
  // An altitude is taken without overshoot.
  Command up;
  up.altitude = 3.0;
  for (int i = 0; i < 3000; ++i) {
    state = fly(state, up, 0.0, {}, spec, false, 0.01);
    CHECK(state.position.z <= 3.0 + 1e-12);
  }
  CHECK(state.position.z == doctest::Approx(3.0).epsilon(1e-8));
}

TEST_CASE("rigid body: free fall is exact, a torque-free tumble keeps its angular momentum and its energy to the order of RK4") {
  VehicleSpec spec = quadrotor();
  spec.drag = {0.0};
  spec.inertia_kg_m2 = {0.010, 0.014, 0.021};
  FlightState begin;
  begin.velocity = {1.0, -2.0, 3.0};
  begin.rates = {3.0, 0.2, 4.0};
  const auto momentum = [&](const FlightState& s) { return s.attitude * (spec.inertia_kg_m2 * s.rates); };
  const auto energy = [&](const FlightState& s) { return 0.5 * glm::dot(s.rates, spec.inertia_kg_m2 * s.rates) + spec.mass_kg * (0.5 * glm::dot(s.velocity, s.velocity) + gravity * s.position.z); };
  const auto off = [&](double step) {
    FlightState state = begin;
    for (int i = 0; i < static_cast<int>(std::lround(2.0 / step)); ++i) state = rigid_body_step(state, spec, glm::dvec3(0.0), [](const FlightState&) { return Wrench{}; }, step);
    CHECK(state.position.z == doctest::Approx(6.0 - 2.0 * gravity).epsilon(1e-12));
    CHECK(state.position.x == doctest::Approx(2.0).epsilon(1e-12));
    return std::pair{glm::distance(momentum(state), momentum(begin)) / glm::length(momentum(begin)), std::abs(energy(state) / energy(begin) - 1.0)};
  };
  const auto [momentum_off, energy_off] = off(1e-3);
  MESSAGE("tumbling 2 s at 1 ms: momentum off by " << momentum_off << ", energy by " << energy_off);
  CHECK(momentum_off < 1e-10);
  CHECK(energy_off < 1e-11);
  // Errors of energy fall at least with the fourth power of the step.
  CHECK(off(0.02).second / std::max(off(0.01).second, 1e-15) > 14.0);
}

TEST_CASE("rigid body: its closed loop converges with the fourth power of the step") {
  const VehicleSpec spec = quadrotor();
  const Command command{1.0, 0.0};
  const auto end = [&](double step) {
    FlightState state;
    state.position.z = 1.0;
    for (int i = 0; i < static_cast<int>(std::lround(0.4 / step)); ++i) state = fly(state, command, 0.0, {}, spec, true, step);
    return state.position;
  };
  const glm::dvec3 exact = end(1.25e-4);
  const double order = std::log2(glm::distance(end(4e-3), exact) / glm::distance(end(2e-3), exact));
  MESSAGE("order of convergence: " << order);
  CHECK(order == doctest::Approx(4.0).epsilon(0.05));
}

TEST_CASE("a step that is too long for the attitude controller is an error that says how long it may be, and just below it holds") {
  VehicleSpec spec = quadrotor();
  const double longest = longest_stable_step(spec);
  MESSAGE("longest stable step: " << longest);
  Mission mission = flight({0.0, 0.0, 1.0});
  mission.vehicle.model = "rigid_body";
  mission.step_s = 1.05 * longest;
  const auto refused = Simulation::create(mission, World{});
  REQUIRE_FALSE(refused);
  CHECK(refused.error().message.find("is too long for the attitude controller, at most") != std::string::npos);
  const auto worst = [&](double step) {
    FlightState state;
    state.position.z = 1.0;
    state.velocity.x = 1e-3;
    for (int i = 0; i < 400; ++i) state = fly(state, {}, 0.0, {}, spec, true, step);
    return glm::length(state.velocity) + glm::length(state.rates);
  };
  CHECK(worst(0.97 * longest) < 1e-5);
  CHECK_FALSE(worst(1.1 * longest) < 1e-3);  // (not a number, once it has run away)
}

TEST_CASE("auto chooses the rigid body for wind and for fast flight, and says why") {
  VehicleSpec spec = quadrotor();
  CHECK_FALSE(choose_flight_model(spec, 0.5).rigid_body);
  CHECK(choose_flight_model(spec, 3.0).rigid_body);
  CHECK(choose_flight_model(spec, 3.0).reason.find("tilts") != std::string::npos);
  spec.gust_m_s = 0.2;
  CHECK(choose_flight_model(spec, 0.5).rigid_body);
  spec.model = "kinematic";
  CHECK_FALSE(choose_flight_model(spec, 3.0).rigid_body);
}

TEST_CASE("contact in space: over and under a solid, into a plate of 1 mm, and a rotor tip at a pole") {
  // A box of 1 m on the floor in the way: over it, into it.
  for (const auto& [z, expected] : {std::pair{1.05, "reached"}, {0.95, "collided"}}) {
    Mission mission = flight({-3.0, 0.0, z});
    mission.planner.waypoints_m = {{3.0, 0.0, z}};
    CAPTURE(z);
    CHECK(verdict(flown(mission, world_of(Box{}, {0.0, 0.0, 0.5}))) == expected);
  }
  // Under a beam whose lower face is at 2 m; the hull is 0.2 m high.
  for (const auto& [z, expected] : {std::pair{1.79, "reached"}, {1.81, "collided"}}) {
    Mission mission = flight({-3.0, 0.0, z});
    mission.planner.waypoints_m = {{3.0, 0.0, z}};
    CAPTURE(z);
    CHECK(verdict(flown(mission, world_of(Box{}, {0.0, 0.0, 2.5}))) == expected);
  }
  // Up into a plate, at the full climb rate and with the longest step: it stops under it, by no more than a piece of the sweep.
  Mission up = flight({0.0, 0.0, 0.5});
  up.step_s = 0.2;
  const Simulation under = driven(up, world_of(Box{{4.0, 4.0, 0.001}}, {0.0, 0.0, 5.0}), climbing(5.0), 20.0);
  CHECK(verdict(under) == "collided");
  CHECK(under.vehicle().z + 0.2 < 5.0);
  CHECK(under.vehicle().z + 0.2 > 5.0 - 0.0005 - 0.006);
  // The rim of the hull only: the axis passes the pole at 0.43 m or 0.41 m, the pole is 0.02 m thick.
  for (const auto& [y, expected] : {std::pair{0.43, "reached"}, {0.41, "collided"}}) {
    Mission mission = flight({-2.0, 0.0, 1.0});
    mission.planner.waypoints_m = {{2.0, 0.0, 1.0}};
    CAPTURE(y);
    CHECK(verdict(flown(mission, world_of(Cylinder{0.01, 3.0}, {0.0, y, 1.5}))) == expected);
  }
}

TEST_CASE("the floor: a gentle landing is one, a hard one is a collision; what stands stays until it climbs") {
  Mission mission = flight({0.0, 0.0, 1.0});
  for (const char* model : {"kinematic", "rigid_body"}) {
    CAPTURE(model);
    mission.vehicle.model = model;
    const Simulation landed = driven(mission, World{}, climbing(-0.4), 5.0);
    CHECK(verdict(landed) == "running");
    CHECK(landed.vehicle().on_floor);
    CHECK(landed.vehicle().z == 0.0);
    const Simulation crashed = driven(mission, World{}, climbing(-2.0), 5.0);
    CHECK(verdict(crashed) == "collided");
    CHECK(crashed.verdict()->reason.find("met the floor") != std::string::npos);
    Simulation again = landed;
    const glm::dvec2 at = again.vehicle().pose.position;
    again.drive(Command{1.0, 0.0});
    for (int i = 0; i < 100; ++i) again.step();
    CHECK(again.vehicle().pose.position == at);
    again.drive(climbing(0.5));
    for (int i = 0; i < 200; ++i) again.step();
    CHECK(again.vehicle().z > 0.5);
  }
}

TEST_CASE("gusts have the standard deviation and the correlation time that are asked for, whatever the step") {
  VehicleSpec spec = quadrotor();
  spec.gust_m_s = 0.7;
  spec.gust_time_s = 0.5;
  for (const double step : {0.01, 0.1}) {
    CAPTURE(step);
    Unrest unrest;
    double square = 0.0, product = 0.0;
    const int count = 100000, apart = static_cast<int>(std::lround(0.5 / step));
    std::vector<double> x;
    for (int i = 0; i < count; ++i) {
      unrest.advance(spec, 7, static_cast<std::uint64_t>(i), step);
      x.push_back(unrest.gust.y);
    }
    for (std::size_t i = 1000; i + static_cast<std::size_t>(apart) < x.size(); ++i) {
      square += x[i] * x[i];
      product += x[i] * x[i + static_cast<std::size_t>(apart)];
    }
    const double n = static_cast<double>(x.size() - 1000);
    // About n * step / (2 * 0.5 s) independent values: four sigmas of the variance.
    const double tolerance = 4.0 * std::sqrt(2.0 / (n * step / (2.0 * 0.5)));
    CHECK(std::sqrt(square / n) == doctest::Approx(0.7).epsilon(tolerance));
    CHECK(product / square == doctest::Approx(std::exp(-1.0)).epsilon(2.0 * tolerance));
  }
}

TEST_CASE("keys that need a quadrotor, wrong counts and a flight without an altitude are told") {
  const auto fault = [](const std::vector<Override>& overrides) {
    const auto mission = read_mission(find_input("quadrotor/waypoints"), overrides);
    return mission ? std::string() : mission.error().message;
  };
  CHECK(fault({}).empty());
  CHECK(fault({{"vehicle.preset", "p3at", "test"}}).find("needs a vehicle that flies") != std::string::npos);
  CHECK(fault({{"planner.waypoint_speeds_m_s", "[1.0]", "test"}}).find("one for each of the 4") != std::string::npos);
  CHECK(fault({{"planner.waypoints_m", "[[1.0, 2.0, 3.0, 4.0]]", "test"}}).find("[x, y] or [x, y, z]") != std::string::npos);
  CHECK(fault({{"vehicle.drag", "[1.0, 2.0]", "test"}}).find("expected one, or three") != std::string::npos);
  CHECK(fault({{"vehicle.drag", "0.2", "test"}}).empty());
  // What is written reads back.
  const Mission mission = shipped("quadrotor/waypoints");
  CHECK(write_mission(mission).find("waypoints_m = [[2.5, 0.0, 3.0], [2.5, -3.0, 1.0], [-3.0, -3.0], [-3.0, 0.0, 1.5]]") != std::string::npos);
}

TEST_CASE("the quadrotor's shipped missions end as they say") {
  for (const auto& [name, expected] : {std::pair{"quadrotor/hover", "reached"}, {"quadrotor/waypoints", "reached"}, {"quadrotor/bug2", "reached"}, {"quadrotor/closed_here", "unreachable"}}) {
    CAPTURE(name);
    const Simulation simulation = finished(shipped(name, {{"map.enabled", "false", "test"}}));
    CAPTURE(simulation.verdict()->reason);
    CHECK(verdict(simulation) == expected);
    CHECK(simulation.totals().least_clearance > 0.1);
    MESSAGE(std::string(name) << ": " << simulation.time() << " s, least clearance " << simulation.totals().least_clearance << " m: " << simulation.verdict()->reason);
    const bool bug = std::string(name) == "quadrotor/bug2" || std::string(name) == "quadrotor/closed_here";
    CHECK((simulation.verdict()->reason.find("at this altitude (z = 1.00 m)") != std::string::npos) == bug);
    if (simulation.mission().planner.land) CHECK(simulation.vehicle().on_floor);
  }
}

TEST_CASE("strafing: the heading is held while the vehicle moves sideways, and the sensors tilt with it") {
  Mission mission = flight({0.0, -3.0, 1.0});
  mission.planner.waypoints_m = {{0.0, 3.0, 1.0}};
  mission.planner.heading_deg = 0.0;
  auto simulation = Simulation::create(mission, World{});
  REQUIRE(simulation);
  double turned = 0.0, aside = 0.0, tilted = 0.0;
  do {
    turned = std::max(turned, std::abs(simulation->vehicle().pose.yaw));
    aside = std::max(aside, std::abs(simulation->vehicle().pose.position.x));
    tilted = std::max(tilted, std::abs(roll_pitch_yaw(simulation->platform().pose.orientation).x));
  } while (simulation->step());
  CHECK(verdict(*simulation) == "reached");
  CHECK(turned < 1e-9);
  CHECK(aside < 1e-9);
  CHECK(degrees(tilted) == doctest::Approx(18.8).epsilon(0.05));  // atan(1 m/s / 0.3 s / g), and a little for drag
}

TEST_CASE("one flight with steps of 1 to 50 ms ends at the same place") {
  for (const char* model : {"kinematic", "rigid_body"}) {
    CAPTURE(model);
    std::vector<glm::dvec3> ends;
    for (const double step : {1e-3, 2e-3, 5e-3, 1e-2, 2e-2, 5e-2}) {
      Mission mission = flight({0.0, 0.0, 1.0});
      mission.vehicle.model = model;
      mission.step_s = step;
      mission.limits.time_s = 12.0;
      mission.planner.waypoints_m = {{3.0, 0.0, 2.0}, {3.0, 3.0}};
      mission.planner.hover_s = 100.0;
      mission.planner.goal_tolerance_m = 0.05;
      mission.planner.heading_deg = 0.0;
      auto& sensor = mission.sensors.front();
      std::get<LidarSpec>(sensor).rate_hz = 10.0;
      const Simulation end = flown(mission, World{});
      ends.emplace_back(end.vehicle().pose.position, end.vehicle().z);
    }
    double apart = 0.0;
    for (const glm::dvec3& end : ends) apart = std::max(apart, glm::distance(end, ends.front()));
    MESSAGE(std::string(model) << ": at most " << apart << " m apart");
    CHECK(apart < 1e-8);
  }
}

TEST_CASE("flights in gusts are the same bits again, and a copy in mid-air goes on the same way") {
  Mission mission = shipped("quadrotor/waypoints", {{"map.enabled", "false", "test"}, {"vehicle.gust_m_s", "0.3", "test"}, {"vehicle.jitter_m_s", "0.05", "test"}, {"limits.time_s", "8.0", "test"}, {"sensor.azimuth_rays", "4", "test"}, {"sensor.elevation_rays", "4", "test"}});
  auto first = Simulation::create(mission), second = Simulation::create(mission);
  REQUIRE(first);
  REQUIRE(second);
  for (int i = 0; i < 400; ++i) first->step();
  Simulation copy = *first;
  while (first->step()) {
  }
  while (copy.step()) {
  }
  while (second->step()) {
  }
  CHECK(state_hash(*first) == state_hash(*second));
  CHECK(state_hash(*first) == state_hash(copy));
  Trajectory trajectory;
  trajectory.note(*first);
  CHECK(trajectory.csv().find("turn_rate_deg_s,roll_deg,pitch_deg,state") != std::string::npos);
}

}  // namespace thicket
