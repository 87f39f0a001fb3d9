// The tables of docs/quadrotor.md: `ninja study_quadrotor && build/release/tests/bench/study_quadrotor`. Wall times depend on the machine, nothing else does.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include <glm/geometric.hpp>

#include "or_exit.hpp"
#include "thicket/base/files.hpp"
#include "thicket/sim/flight.hpp"
#include "thicket/sim/simulation.hpp"

namespace thicket {
namespace {

VehicleSpec quadrotor() { return or_exit(read_mission(find_input("quadrotor/hover"), {})).vehicle; }

/// A flight by hand of one model, from 1 m of altitude.
void step_response() {
  fmt::print("\n## A step of 1 m/s\n\n| model | step | 63 % after | overshoot | largest tilt |\n|---|---|---|---|---|\n");
  const VehicleSpec spec = quadrotor();
  for (const bool rigid : {false, true})
    for (const double step : {0.001, 0.01, 0.05}) {
      FlightState state;
      state.position.z = 1.0;
      double reached = 0.0, most = 0.0, tilt = 0.0;
      for (int i = 1; i <= static_cast<int>(5.0 / step); ++i) {
        const double before = state.velocity.x;
        state = fly(state, Command{1.0, 0.0}, 0.0, {}, spec, rigid, step);
        const double level = 1.0 - std::exp(-1.0);
        if (reached == 0.0 && state.velocity.x >= level - 1e-12) reached = step * (i - 1 + (level - before) / (state.velocity.x - before));
        most = std::max(most, state.velocity.x);
        tilt = std::max(tilt, std::abs(roll_pitch_yaw(state.attitude).y));
      }
      fmt::print("| {} | {:g} ms | {:.3f} s | {:.2f} % | {:.1f}° |\n", rigid ? "rigid_body" : "kinematic", 1e3 * step, reached, 100.0 * std::max(0.0, most - 1.0), degrees(tilt));
    }
}

/// What a run of a mission came to.
struct Flown {
  double time = 0.0, path = 0.0, wall = 0.0, tilt = 0.0, drift = 0.0;
  glm::dvec3 end{0.0};
  std::vector<glm::dvec3> way;  ///< with every step
  std::string verdict;
};

Flown flown(const std::string& name, const std::vector<Override>& changes) {
  auto simulation = or_exit(Simulation::create(or_exit(read_mission(find_input(name), changes))));
  Flown run;
  const glm::dvec3 start(simulation.vehicle().pose.position, simulation.vehicle().z);
  const auto began = std::chrono::steady_clock::now();
  do {
    const glm::dvec3 here(simulation.vehicle().pose.position, simulation.vehicle().z);
    run.way.push_back(here);
    run.drift = std::max(run.drift, glm::distance(here, start));
    const glm::dvec3 angles = roll_pitch_yaw(simulation.vehicle().attitude);
    run.tilt = std::max(run.tilt, std::acos(std::clamp(std::cos(angles.x) * std::cos(angles.y), -1.0, 1.0)));
  } while (simulation.step());
  run.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  run.time = simulation.time();
  run.path = simulation.totals().path_length;
  run.end = {simulation.vehicle().pose.position, simulation.vehicle().z};
  run.verdict = to_string(simulation.verdict()->kind);
  if (simulation.verdict()->kind == Verdict::Kind::stopped) run.verdict += ": " + simulation.verdict()->reason;
  return run;
}

double farthest_from(const std::vector<glm::dvec3>& way, const std::vector<glm::dvec3>& other) {
  double farthest = 0.0;
  for (std::size_t i = 0; i < way.size(); i += 10) {
    double nearest = INFINITY;
    for (const glm::dvec3& there : other) nearest = std::min(nearest, glm::distance(way[i], there));
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

void models() {
  fmt::print("\n## kinematic against rigid_body\n\n| mission | model | verdict | time | path | largest tilt | µs per simulated second, without sensors and map | ends apart | ways apart |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const char* name : {"hover", "waypoints", "bug2", "closed_here"}) {
    const std::string mission = std::string("quadrotor/") + name;
    Flown first;
    for (const char* model : {"kinematic", "rigid_body"}) {
      const std::vector<Override> changes = {{"vehicle.model", model, "study"}, {"map.enabled", "false", "study"}};
      const Flown run = flown(mission, changes);
      // What the model itself costs: steps of it alone.
      const VehicleSpec spec = quadrotor();
      FlightState state;
      state.position.z = 1.0;
      const bool rigid = model == std::string("rigid_body");
      const double step = or_exit(read_mission(find_input(mission), {})).step_s;
      const int steps = 20000;
      const auto began = std::chrono::steady_clock::now();
      for (int i = 0; i < steps; ++i) state = fly(state, Command{0.5, 0.0}, 0.1, {}, spec, rigid, step);
      const double cost = 1e6 * std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count() / (steps * step);
      const bool second = rigid;
      fmt::print("| {} | {} | {} | {:.1f} s | {:.2f} m | {:.1f}° | {:.0f} | {} | {} |\n", name, model, run.verdict, run.time, run.path, degrees(run.tilt), cost,
                 second ? fmt::format("{:.3f} m", glm::distance(run.end, first.end)) : "", second ? fmt::format("{:.3f} m", farthest_from(run.way, first.way)) : "");
      if (!rigid) first = run;
    }
  }
}

void hover() {
  fmt::print("\n## Hovering for 20 s\n\n| model | air and hand | farthest from the place | largest tilt |\n|---|---|---|---|\n");
  struct Air {
    const char* words;
    std::vector<Override> changes;
  };
  const std::vector<Air> airs = {{"still", {}},
                                 {"wind of 3 m/s", {{"vehicle.wind_m_s", "[3.0, 0.0, 0.0]", "study"}}},
                                 {"gusts of 1 m/s", {{"vehicle.gust_m_s", "1.0", "study"}}},
                                 {"jitter of 0.1 m/s", {{"vehicle.jitter_m_s", "0.1", "study"}}}};
  for (const char* model : {"kinematic", "rigid_body"})
    for (const Air& air : airs) {
      std::vector<Override> changes = air.changes;
      changes.push_back({"vehicle.model", model, "study"});
      changes.push_back({"map.enabled", "false", "study"});
      changes.push_back({"sensor.azimuth_rays", "4", "study"});
      changes.push_back({"sensor.elevation_rays", "4", "study"});
      const Flown run = flown("quadrotor/hover", changes);
      fmt::print("| {} | {} | {:.4f} m | {:.2f}° |\n", model, air.words, run.drift, degrees(run.tilt));
    }
}

void steps() {
  fmt::print("\n## One flight (way-points) with different steps\n\n| model | step | verdict | ends at | from the end at 1 ms |\n|---|---|---|---|---|\n");
  for (const char* model : {"kinematic", "rigid_body"}) {
    glm::dvec3 first{0.0};
    for (const char* step : {"0.001", "0.002", "0.005", "0.01", "0.02", "0.05"}) {
      const Flown run = flown("quadrotor/waypoints", {{"vehicle.model", model, "study"}, {"map.enabled", "false", "study"}, {"step_s", step, "study"}});
      if (step == std::string("0.001")) first = run.end;
      fmt::print("| {} | {} s | {} | ({:.3f}, {:.3f}, {:.3f}) | {:.4f} m |\n", model, step, run.verdict, run.end.x, run.end.y, run.end.z, glm::distance(run.end, first));
    }
  }
}

}  // namespace
}  // namespace thicket

int main() {
  using namespace thicket;
  fmt::print("The longest stable step of the rigid body: {:.4f} s\n", longest_stable_step(quadrotor()));
  step_response();
  hover();
  models();
  steps();
}
