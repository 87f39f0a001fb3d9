// A step of a vehicle that flies: free flight, the floor, and contact of its hull with what is around, above and under it.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include <glm/geometric.hpp>

#include "thicket/sim/simulation.hpp"

namespace thicket {
namespace {

/// How much farther than the least clearance so far is looked, m.
constexpr double look_ahead = 0.5;
/// Clearance is horizontal. What goes up or down is swept in pieces that rise by no more than this, m, with a hull as high as the piece and itself.
constexpr double highest_piece = 0.005;

/// The yaw rate that follows a commanded one within the limits, as a differential drive has it.
double yaw_rate(double now, double wanted, double step, const VehicleSpec& limits) {
  const double most = radians(limits.turn_rate_max_deg_s), change = radians(limits.turn_acceleration_deg_s2) * step;
  return std::clamp(std::clamp(wanted, -most, most), now - change, now + change);
}

/// The first time, s, at which a path that begins above the floor and ends under it meets it.
double meets_floor(const FlightPath& path) {
  double low = 0.0, high = path.duration;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (path.at(middle).z > 0.0 ? low : high) = middle;
  }
  return low;
}

}  // namespace

double Simulation::flight_contact(const FlightPath& path, double began) {
  const Hull& hull = stage_->mission.vehicle.hull();
  const double duration = path.duration, speed = path.speed_bound() + scene_.fastest(), limit = totals_.least_clearance + look_ahead;
  // Over a part of the step the hull reaches from the lowest to the highest place that it comes by; nothing of it is under the floor.
  const auto sweep = [&](double from, double until, Clearance& nearest, double& least) {
    const double middle = path.at(0.5 * (from + until)).z, rise = 0.5 * path.climb_bound() * (until - from);
    const double low = std::max(0.0, middle - rise), high = std::max(low, middle + rise);
    const Hull swept{hull.radius, hull.z_low, hull.z_high + (high - low)};
    const double way = speed * (until - from);
    const auto moment_at = [&](double s) {
      const double t = way > 0.0 ? from + (until - from) * s / way : from;
      return Moment{{glm::dvec2(path.at(t)), low}, began + t};
    };
    const double contact = scene_.first_contact(swept, moment_at, way, limit, nearest, least);
    return contact > way ? infinity : way > 0.0 ? from + (until - from) * contact / way : from;
  };
  const double rise = path.climb_bound() * duration;
  Clearance nearest;
  double least = totals_.least_clearance;
  // All of it at once, if that neither touches nor is nearer than anything before.
  const double coarse = sweep(0.0, duration, nearest, least);
  if (rise <= highest_piece || (coarse == infinity && least >= totals_.least_clearance)) {
    clearance_ = nearest;
    totals_.least_clearance = least;
    return coarse;
  }
  const int pieces = static_cast<int>(std::ceil(rise / highest_piece));
  for (int i = 0; i < pieces; ++i) {
    const double contact = sweep(duration * i / pieces, duration * (i + 1) / pieces, clearance_, totals_.least_clearance);
    if (contact != infinity) return contact;
  }
  return infinity;
}

void Simulation::fly_on() {
  const Mission& mission = stage_->mission;
  const VehicleSpec& spec = mission.vehicle;
  const double began = time();
  const Command& command = decision_.command;
  vehicle_.unrest.advance(spec, static_cast<std::uint64_t>(mission.seed), steps_, mission.step_s);
  const bool wants_up = command.altitude ? *command.altitude > vehicle_.z : command.climb > 0.0;
  if (vehicle_.on_floor && !wants_up) {
    // It stands, whatever is commanded.
    odometry_.advance(vehicle_.pose, vehicle_.pose, mission.step_s, steps_);
    ++steps_;
    scene_.set_time(time());
    const FlightState here = vehicle_.flight();
    const double contact = flight_contact(FlightPath::between(here, here, mission.step_s), began);
    if (contact != infinity) end(Verdict::Kind::collided, fmt::format("'{}' touched the hull, which stands on the floor at ({:.2f}, {:.2f})", scene_.world().solids[clearance_.solid].name, here.position.x, here.position.y));
    return;
  }
  const FlightState before = vehicle_.flight();
  const Pose2 pose_before = vehicle_.pose;
  FlightState after = fly(before, command, yaw_rate(vehicle_.turn_rate, command.turn_rate, mission.step_s, spec), vehicle_.unrest, spec, stage_->flight.rigid_body, mission.step_s);
  FlightPath path = FlightPath::between(before, after, mission.step_s);
  const bool meets = after.position.z <= 0.0 && !(vehicle_.on_floor && after.velocity.z > 0.0);
  // What takes off is still pressed to the floor while its thrust grows.
  if (vehicle_.on_floor && meets) {
    after = before;
    path = FlightPath::between(before, after, mission.step_s);
  }
  vehicle_.on_floor = vehicle_.on_floor && meets;
  const bool lands = meets && !vehicle_.on_floor;
  const double down_at = lands ? meets_floor(path) : infinity;
  ++steps_;
  scene_.set_time(time());
  double contact = infinity;
  {
    const auto start = std::chrono::steady_clock::now();
    contact = flight_contact(path, began);
    times_.contact += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  if (contact < down_at) {
    const std::string what = scene_.world().solids[clearance_.solid].name;
    after.position = path.at(contact);
    vehicle_.take(after);
    scene_.set_time(began + contact);
    totals_.path_length += glm::distance(before.position, after.position);
    end(Verdict::Kind::collided, fmt::format("the hull touched '{}' with the robot at ({:.2f}, {:.2f}, {:.2f})", what, after.position.x, after.position.y, after.position.z));
    return;
  }
  if (lands) {
    const double fall = -after.velocity.z;
    after.position = path.at(down_at);
    after.position.z = 0.0;
    const double yaw = roll_pitch_yaw(after.attitude).z;
    after.velocity = after.rates = glm::dvec3(0.0);
    after.attitude = Pose::planar(0.0, 0.0, 0.0, yaw).orientation;
    vehicle_.on_floor = true;
    vehicle_.take(after);
    totals_.path_length += glm::distance(before.position, after.position);
    odometry_.advance(pose_before, vehicle_.pose, mission.step_s, steps_ - 1);
    if (fall > spec.landing_speed_max_m_s)
      end(Verdict::Kind::collided, fmt::format("met the floor at ({:.2f}, {:.2f}) with {:.2f} m/s, a landing has at most {:.2f} m/s", after.position.x, after.position.y, fall, spec.landing_speed_max_m_s));
    return;
  }
  vehicle_.take(after);
  odometry_.advance(pose_before, vehicle_.pose, mission.step_s, steps_ - 1);
  totals_.path_length += glm::distance(before.position, after.position);
}

}  // namespace thicket
