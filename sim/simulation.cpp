#include "thicket/sim/simulation.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <chrono>
#include <cmath>

#include <glm/geometric.hpp>

#include "thicket/base/probability_file.hpp"
#include "thicket/sim/auto_clearance.hpp"
#include "thicket/sim/fidelity.hpp"
#include "scan_clock.hpp"
#include "vehicle_limits.hpp"

namespace thicket {
namespace {

/// Adds the wall time of its own life to a phase.
class Stopwatch {
 public:
  explicit Stopwatch(double& seconds) : seconds_(seconds), start_(std::chrono::steady_clock::now()) {}
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;
  ~Stopwatch() { seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  double& seconds_;
  std::chrono::steady_clock::time_point start_;
};

/// How much farther than the least clearance so far is looked, m: the farther, the rarer the next look, but the dearer this one.
constexpr double look_ahead = 0.5;

BumperRing make_bumpers(const Mission& mission) {
  return {mission.bumpers, mission.vehicle.radius_m, press_distance(mission.bumpers, mission.planner, vehicle_limits(mission)), mission.planner.clearance_m};
}

Pose2 start_pose(const Mission& mission) { return {{mission.start.x_m, mission.start.y_m}, wrap_angle(radians(mission.start.yaw_deg))}; }

}  // namespace

/// The fastest that the mission asks for, m/s.
static double fastest_asked_for(const Mission& mission) {
  if (planner_needs(mission.planner.name) == PlannerNeeds::waypoints && !mission.planner.waypoint_speeds_m_s.empty()) return *std::ranges::max_element(mission.planner.waypoint_speeds_m_s);
  return mission.planner.speed_m_s.value_or(mission.vehicle.speed_max_m_s);
}

VehicleLimits vehicle_limits(const Mission& mission) {
  VehicleLimits limits = mission.vehicle.limits(std::max(mission.step_s, 1.0 / mounted(mission.sensors[bumper_sensors(mission).front()]).rate_hz));
  const VehicleSpec& vehicle = mission.vehicle;
  // A planner looks as far as braking takes: from what could be flown that may be far, and dear.
  if (vehicle.flies()) {
    limits.speed = std::min(limits.speed, fastest_asked_for(mission));
    limits.flight = FlightLimits{mission.start.z_m, vehicle.climb_rate_max_m_s, vehicle.landing_speed_max_m_s, vehicle.velocity_time_s};
  }
  return limits;
}

FlightModel flight_model(const Mission& mission) {
  return choose_flight_model(at_fidelity(mission.vehicle, mission.fidelity), fastest_asked_for(mission));
}

const char* to_string(Verdict::Kind kind) {
  switch (kind) {
    case Verdict::Kind::reached: return "reached";
    case Verdict::Kind::unreachable: return "unreachable";
    case Verdict::Kind::stopped: return "stopped";
    case Verdict::Kind::collided: return "collided";
  }
  return "";
}

Result<Simulation> Simulation::create(const Mission& mission) {
  auto world = read_mission_world(mission);
  if (!world) return world.error();
  return create(mission, std::move(*world));
}

Result<Simulation> Simulation::create(const Mission& mission, World world) {
  auto scene = Scene::build(std::move(world));
  if (!scene) return scene.error();
  return create(mission, std::move(*scene));
}

Result<Simulation> Simulation::create(const Mission& given, Scene scene) {
  const Mission mission = with_clearance(given, scene.world());
  const FlightModel flight = mission.vehicle.flies() ? flight_model(mission) : FlightModel{};
  if (mission.vehicle.flies())
    if (const auto fault = vehicle_fault(mission.vehicle, flight, mission.step_s)) return Error{*fault};
  std::vector<std::shared_ptr<const Sensor>> sensors;
  for (const SensorSpec& spec : mission.sensors) sensors.push_back(make_sensor(at_fidelity(spec, mission.fidelity), static_cast<std::uint16_t>(sensors.size())));
  auto planner = make_planner(mission.planner, vehicle_limits(mission), start_pose(mission));
  if (!planner) return planner.error();
  Simulation simulation(std::make_shared<const Stage>(Stage{mission, std::move(scene), std::move(sensors), bumper_sensors(mission), mission.sar.enabled ? sar_sensor(mission) : std::nullopt, flight}), std::move(*planner));
  if (!mission.initial_map_file.empty()) {
    ProbabilityReading reading;
    if (mission.initial_map_file.extension() == ".npy") reading.cell_size = mission.map.resolution_m;  // it has none of its own
    const auto known = read_probabilities(mission.initial_map_file, reading);
    if (!known) return known.error();
    if (auto begun = simulation.map_.start_from(*known); !begun) return Error{fmt::format("{}: {}", mission.initial_map_file.string(), begun.error().message)};
  }
  return simulation;
}

Simulation::Simulation(std::shared_ptr<const Stage> stage, std::unique_ptr<Planner> planner)
    : stage_(std::move(stage)),
      odometry_(stage_->mission.odometry, start_pose(stage_->mission), static_cast<std::uint64_t>(stage_->mission.seed)),
      planner_(std::move(planner)),
      bumpers_(make_bumpers(stage_->mission)),
      readers_(stage_->sensors.size()),
      map_(stage_->mission.map),
      sar_(begin_sar(stage_->mission)),
      scans_(stage_->sensors.size()),
      scan_counts_(stage_->sensors.size()),
      scan_estimates_(stage_->sensors.size()),
      scan_aloft_(stage_->sensors.size()),
      scene_(stage_->scene) {
  vehicle_.pose = start_pose(stage_->mission);
  vehicle_.z = stuck_z_ = stage_->mission.start.z_m;
  vehicle_.attitude = Pose::planar(0.0, 0.0, 0.0, vehicle_.pose.yaw).orientation;
  vehicle_.on_floor = stage_->mission.vehicle.flies() && vehicle_.z <= 0.0;
  stuck_pose_ = vehicle_.pose;
  place_ = vehicle_.pose.position;
  clearance_ = scene_.clearance(stage_->mission.vehicle.hull(), vehicle_pose().position, infinity);
  totals_.least_clearance = clear_of_ = clearance_.distance;
  if (clearance_.distance <= 0.0)
    end(Verdict::Kind::collided, fmt::format("the hull touches '{}' at the start", stage_->scene.world().solids[clearance_.solid].name));
}

Simulation::Simulation(const Simulation& other)
    : stage_(other.stage_),
      steps_(other.steps_),
      vehicle_(other.vehicle_),
      odometry_(other.odometry_),
      planner_(other.planner_->clone()),
      bumpers_(other.bumpers_),
      contour_(other.contour_),
      readers_(other.readers_),
      map_(other.map_),
      sar_(other.sar_),
      scans_(other.scans_),
      scan_counts_(other.scan_counts_),
      scan_estimates_(other.scan_estimates_),
      scan_aloft_(other.scan_aloft_),
      decision_(other.decision_),
      manual_(other.manual_),
      scene_(other.scene_),
      clearance_(other.clearance_),
      clear_of_(other.clear_of_),
      totals_(other.totals_),
      times_(other.times_),
      verdict_(other.verdict_),
      stuck_pose_(other.stuck_pose_),
      stuck_z_(other.stuck_z_),
      stuck_step_(other.stuck_step_),
      place_(other.place_),
      place_step_(other.place_step_) {}

Simulation& Simulation::operator=(const Simulation& other) {
  if (this != &other) *this = Simulation(other);
  return *this;
}

Pose Simulation::in_space(const Pose2& pose) const {
  Pose space = Pose::planar(pose.position.x, pose.position.y, vehicle_.z, pose.yaw);
  if (stage_->mission.vehicle.flies()) space.orientation = space.orientation * vehicle_.tilt();
  return space;
}

Platform Simulation::platform() const {
  if (stage_->mission.vehicle.flies()) return {vehicle_pose(), vehicle_.velocity, vehicle_.attitude * vehicle_.rates};
  return {vehicle_pose(), vehicle_.speed * glm::dvec3(direction(vehicle_.pose.yaw), 0.0), {0.0, 0.0, vehicle_.turn_rate}};
}

void Simulation::stop(const std::string& reason) {
  if (!verdict_) end(Verdict::Kind::stopped, reason);
}

void Simulation::end(Verdict::Kind kind, const std::string& reason) {
  verdict_ = {kind, reason, std::nullopt};
  if (const auto& goal = stage_->mission.planner.goal_m) verdict_->true_distance_to_goal_m = glm::distance(vehicle_.pose.position, *goal);
}

bool Simulation::step() {
  if (verdict_) return false;
  sense();
  if (!verdict_) move();
  if (!verdict_) check_limits();
  return !verdict_;
}

void Simulation::sense() {
  std::vector<std::size_t> due;
  for (std::size_t i = 0; i < stage_->sensors.size(); ++i) {
    if (!scan_due(time(), stage_->sensors[i]->spec().rate_hz, scan_counts_[i])) continue;
    due.push_back(i);
  }
  if (due.empty()) return;
  measure(due);
  bool decides = false;
  const bool flies = stage_->mission.vehicle.flies();
  for (const std::size_t i : due) {
    ++totals_.scans;
    totals_.rays += scans_[i].rays;
    scan_estimates_[i] = estimate();
    if (flies) scan_aloft_[i] = {vehicle_.tilt(), vehicle_.z};
    decides = decides || i == stage_->bumper_sensors.front();
    if (stage_->mission.map.enabled) {
      const Stopwatch watch(times_.map);
      map_.integrate(scans_[i], in_space(estimate()));
    }
    if (stage_->sar_sensor == i) {
      const Stopwatch watch(times_.sar);
      sar_->add(scans_[i], platform().pose * Pose{scans_[i].mount_position, scans_[i].mount_orientation});
    }
  }
  if (decides) decide();
}

void Simulation::measure(const std::vector<std::size_t>& due) {
  const Stopwatch watch(times_.trace);
  const Platform carrier = platform();
  const auto one = [&](std::size_t d) {
    const std::size_t i = due[d];
    const Random random(static_cast<std::uint64_t>(stage_->mission.seed), static_cast<std::uint16_t>(i));
    stage_->sensors[i]->measure(scene_, carrier, time(), scan_counts_[i] - 1, random, scans_[i]);
  };
  if (due.size() == 1) one(0);
  else tbb::parallel_for(std::size_t{0}, due.size(), one);
}

void Simulation::decide() {
  const Stopwatch watch(times_.plan);
  const Pose2& now = estimate();
  contour_.clear();
  const bool flies = stage_->mission.vehicle.flies();
  Scan level;
  for (const std::size_t i : stage_->bumper_sensors) {
    // What was sensed a while ago is where it was, and the robot has moved since, as it believes.
    const bool fresh = scans_[i].time == time();
    if (flies) make_level(scans_[i], scan_aloft_[i], level);
    const Scan& scan = flies ? level : scans_[i];
    if (fresh) readers_[i].add(scan, contour_);
    else readers_[i].add(scan, {now.to_inner(scan_estimates_[i].position), wrap_angle(scan_estimates_[i].yaw - now.yaw)}, contour_);
  }
  bumpers_.read(contour_);
  if (manual_) return;
  decision_ = planner_->decide({time(), now, vehicle_.speed, vehicle_.turn_rate, contour_, bumpers_, vehicle_.lateral(), vehicle_.z, vehicle_.velocity.z});
  ++totals_.decisions;
  switch (decision_.outcome) {
    case Outcome::running: break;
    case Outcome::reached: end(Verdict::Kind::reached, decision_.reason); break;
    case Outcome::unreachable: end(Verdict::Kind::unreachable, decision_.reason); break;
    case Outcome::stuck: end(Verdict::Kind::stopped, decision_.reason); break;
  }
}

void Simulation::move() {
  if (stage_->mission.vehicle.flies()) fly_on();
  else drive_on();
}

void Simulation::drive_on() {
  const Mission& mission = stage_->mission;
  const Arc arc = vehicle_.step(decision_.command, mission.step_s, mission.vehicle);
  const double length = std::abs(arc.speed) * mission.step_s;
  // The way that the hull and the fastest solid make together, and where both are along it.
  const double way = length + scene_.fastest() * mission.step_s, began = time();
  const auto share = [&](double s) { return way > 0.0 ? s / way : 0.0; };
  const auto moment_at = [&](double s) {
    const double t = mission.step_s * share(s);
    return Moment{{length > 0.0 ? arc.at(t).position : arc.start.position, mission.start.z_m}, began + t};
  };
  odometry_.advance(arc, mission.step_s, steps_);
  ++steps_;
  scene_.set_time(time());
  // While nothing can have come nearer than the least so far, there is nothing to look for.
  clear_of_ -= way;
  if (clear_of_ <= std::max(0.0, totals_.least_clearance)) {
    const Stopwatch watch(times_.contact);
    const double limit = totals_.least_clearance + look_ahead;
    const double contact = scene_.first_contact(mission.vehicle.hull(), moment_at, way, limit, clearance_, totals_.least_clearance);
    clear_of_ = std::min(clearance_.distance, limit);
    if (contact <= way) {
      vehicle_.pose = arc.at(mission.step_s * share(contact));
      scene_.set_time(began + mission.step_s * share(contact));
      totals_.path_length += length * share(contact);
      end(Verdict::Kind::collided, fmt::format("the hull touched '{}' with the robot at ({:.2f}, {:.2f})", scene_.world().solids[clearance_.solid].name, vehicle_.pose.position.x,
                                               vehicle_.pose.position.y));
      return;
    }
  }
  vehicle_.pose = arc.at(mission.step_s);
  totals_.path_length += length;
}

void Simulation::check_limits() {
  const LimitSpec& limits = stage_->mission.limits;
  if (time() >= limits.time_s) return stop(fmt::format("time limit of {} s", limits.time_s));
  if (limits.distance_m && totals_.path_length >= *limits.distance_m) return stop(fmt::format("distance limit of {} m", *limits.distance_m));
  check_progress();
}

void Simulation::check_progress() {
  const LimitSpec& limits = stage_->mission.limits;
  const auto since = [&](std::uint64_t step) { return static_cast<double>(steps_ - step) * stage_->mission.step_s; };
  const bool moved = manual_ || decision_.waiting || std::abs(vehicle_.z - stuck_z_) > 0.05 || glm::distance(vehicle_.pose.position, stuck_pose_.position) > 0.05 || std::abs(wrap_angle(vehicle_.pose.yaw - stuck_pose_.yaw)) > radians(5.0);
  if (moved) {
    stuck_pose_ = vehicle_.pose;
    stuck_z_ = vehicle_.z;
    stuck_step_ = steps_;
  } else if (since(stuck_step_) >= limits.stuck_s) {
    return stop(fmt::format("stuck for {} s: {}", limits.stuck_s, decision_.state));
  }
  // One that turns for ever, or twitches, gets to no new place. Turning to look takes seconds, and a vehicle too slow for a quarter of a metre in that time is asked for less.
  const double patience = 4.0 * limits.stuck_s, speed = stage_->mission.planner.speed_m_s.value_or(stage_->mission.vehicle.speed_max_m_s);
  if (manual_ || decision_.waiting || (stage_->mission.vehicle.flies() && std::abs(vehicle_.velocity.z) > 0.02) || glm::distance(vehicle_.pose.position, place_) > std::min(0.25, 0.25 * patience * std::min(speed, stage_->mission.vehicle.speed_max_m_s))) {
    place_ = vehicle_.pose.position;
    place_step_ = steps_;
  } else if (since(place_step_) >= patience) {
    stop(fmt::format("moved on the spot for {} s without getting anywhere: {}", patience, decision_.state));
  }
}

}  // namespace thicket
