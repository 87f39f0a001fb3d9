#include "thicket/sim/flight.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "thicket/base/random.hpp"
#include "thicket/sim/vehicle.hpp"

namespace thicket {

glm::dvec3 roll_pitch_yaw(const glm::dquat& q) {
  return {std::atan2(2.0 * (q.w * q.x + q.y * q.z), 1.0 - 2.0 * (q.x * q.x + q.y * q.y)), std::asin(std::clamp(2.0 * (q.w * q.y - q.z * q.x), -1.0, 1.0)),
          std::atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))};
}

// --- the path within a step ---

FlightPath FlightPath::between(const FlightState& begin, const FlightState& end, double duration) {
  return {{begin.position, begin.position + begin.velocity * (duration / 3.0), end.position - end.velocity * (duration / 3.0), end.position}, duration};
}

glm::dvec3 FlightPath::at(double time) const {
  if (time <= 0.0) return points[0];
  if (time >= duration) return points[3];
  const double t = time / duration;
  const glm::dvec3 a = glm::mix(points[0], points[1], t), b = glm::mix(points[1], points[2], t), c = glm::mix(points[2], points[3], t);
  return glm::mix(glm::mix(a, b, t), glm::mix(b, c, t), t);
}

// The derivative of a cubic lies in the hull of three times the differences of its control points.
double FlightPath::speed_bound() const {
  double most = 0.0;
  for (int i = 0; i < 3; ++i) most = std::max(most, glm::length(glm::dvec2(points[i + 1] - points[i])));
  return duration > 0.0 ? 3.0 * most / duration : 0.0;
}

double FlightPath::climb_bound() const {
  double most = 0.0;
  for (int i = 0; i < 3; ++i) most = std::max(most, std::abs(points[i + 1].z - points[i].z));
  return duration > 0.0 ? 3.0 * most / duration : 0.0;
}

// --- air and hand ---

namespace {

void advance_process(glm::dvec3& value, double sigma, double time, const std::array<double, 4>& normal, double step) {
  if (sigma <= 0.0) return;
  const double stays = std::exp(-step / time), comes = sigma * std::sqrt(-std::expm1(-2.0 * step / time));
  for (int i = 0; i < 3; ++i) value[i] = stays * value[i] + comes * normal[static_cast<std::size_t>(i)];
}

}  // namespace

void Unrest::advance(const FlightSpec& spec, std::uint64_t seed, std::uint64_t step_number, double step) {
  const Random random(seed, 0);
  if (spec.gust_m_s > 0.0) advance_process(gust, spec.gust_m_s, spec.gust_time_s, random.normal(step_number, 0, RandomUse::gust, 0), step);
  if (spec.jitter_m_s > 0.0) advance_process(jitter, spec.jitter_m_s, spec.jitter_time_s, random.normal(step_number, 0, RandomUse::jitter, 0), step);
}

// --- both models ---

namespace {

/// What is commanded, in the world.
struct Wanted {
  glm::dvec2 velocity{0.0};        ///< m/s, in the plane
  double climb = 0.0;              ///< m/s, if no altitude is held
  std::optional<double> altitude;  ///< m; with the vertical jitter in it
};

Wanted wanted(const FlightState& now, const Command& command, double turn_rate, const Unrest& unrest, const VehicleSpec& spec, double step) {
  Wanted all;
  glm::dvec2 ahead_and_left(command.speed, command.lateral);
  const double fast = glm::length(ahead_and_left);
  if (fast > spec.speed_max_m_s) ahead_and_left *= spec.speed_max_m_s / fast;
  // In the frame of the heading, which turns: its middle counts.
  const double middle = roll_pitch_yaw(now.attitude).z + 0.5 * turn_rate * step;
  all.velocity = Pose2{{0.0, 0.0}, middle}.to_outer(ahead_and_left) + glm::dvec2(unrest.jitter);
  if (command.altitude) all.altitude = *command.altitude + unrest.jitter.z / spec.altitude_gain_1_s;
  else all.climb = std::clamp(command.climb + unrest.jitter.z, -spec.climb_rate_max_m_s, spec.climb_rate_max_m_s);
  return all;
}

/// Accelerations that thrust and tilt allow: upward with all tilt, and downward as much, at most half of gravity so that there is thrust left to steer with.
double upward_max(const VehicleSpec& spec) { return spec.thrust_max_n * std::cos(radians(spec.tilt_max_deg)) / spec.mass_kg - gravity; }
double downward_max(const VehicleSpec& spec) { return std::min(upward_max(spec), 0.5 * gravity); }
double sideward_max(const VehicleSpec& spec) { return gravity * std::tan(radians(spec.tilt_max_deg)); }

double climb_asked(const Wanted& wanted, double z, const VehicleSpec& spec) {
  if (!wanted.altitude) return wanted.climb;
  return std::clamp(spec.altitude_gain_1_s * (*wanted.altitude - z), -spec.climb_rate_max_m_s, spec.climb_rate_max_m_s);
}

/// The velocity controller: the acceleration that it asks for.
glm::dvec3 acceleration_asked(const Wanted& wanted, const FlightState& state, const VehicleSpec& spec, double gain) {
  glm::dvec2 flat = gain * (wanted.velocity - glm::dvec2(state.velocity));
  const double size = glm::length(flat), most = sideward_max(spec);
  if (size > most) flat *= most / size;
  return {flat, std::clamp(gain * (climb_asked(wanted, state.position.z, spec) - state.velocity.z), -downward_max(spec), upward_max(spec))};
}

/// `force` with as little of its part in the plane as its tilt may have.
glm::dvec3 within_tilt(glm::dvec3 force, const VehicleSpec& spec) {
  force.z = std::max(force.z, 1e-3 * spec.mass_kg * gravity);
  const double flat = glm::length(glm::dvec2(force)), most = force.z * std::tan(radians(spec.tilt_max_deg));
  if (flat > most) {
    force.x *= most / flat;
    force.y *= most / flat;
  }
  return force;
}

glm::dvec3 drag_force(const glm::dquat& attitude, const glm::dvec3& through_air, const VehicleSpec& spec) { return -(attitude * (spec.drag_axes() * (glm::conjugate(attitude) * through_air))); }

// --- the kinematic model ---

/// Heading `yaw`, and the body's z axis along `up`.
glm::dquat attitude_along(const glm::dvec3& up, double yaw) {
  const glm::dquat heading = Pose::planar(0.0, 0.0, 0.0, yaw).orientation;
  const glm::dvec3 body = glm::conjugate(heading) * glm::normalize(up);
  const double roll = -std::asin(std::clamp(body.y, -1.0, 1.0)), pitch = std::atan2(body.x, body.z);
  return heading * glm::dquat(std::cos(0.5 * pitch), 0.0, std::sin(0.5 * pitch), 0.0) * glm::dquat(std::cos(0.5 * roll), std::sin(0.5 * roll), 0.0, 0.0);
}

FlightState fly_kinematic(const FlightState& now, const Wanted& wanted, double turn_rate, const glm::dvec3& wind, const VehicleSpec& spec, double step) {
  FlightState next;
  const double lag = spec.velocity_time_s;
  // The difference to the wanted velocity keeps its direction: one coordinate along it tells all.
  const glm::dvec2 was(now.velocity), change = wanted.velocity - was;
  const double size = glm::length(change);
  const glm::dvec2 along = size > 0.0 ? change / size : glm::dvec2(0.0);
  const Coordinate flat = first_order({}, size, lag, sideward_max(spec), step);
  const Coordinate begin{now.position.z, now.velocity.z};
  const bool up = wanted.climb > begin.velocity;
  const Coordinate vertical = wanted.altitude ? hold_altitude(begin, {*wanted.altitude, spec.altitude_gain_1_s, spec.climb_rate_max_m_s, lag, upward_max(spec), downward_max(spec)}, step)
                                        : first_order(begin, wanted.climb, lag, up ? upward_max(spec) : downward_max(spec), step);
  next.position = {glm::dvec2(now.position) + was * step + along * flat.position, vertical.position};
  next.velocity = {was + along * flat.velocity, vertical.velocity};
  const double yaw = roll_pitch_yaw(now.attitude).z + turn_rate * step;
  const glm::dquat level = Pose::planar(0.0, 0.0, 0.0, yaw).orientation;
  const glm::dvec3 force = spec.mass_kg * (acceleration_asked(wanted, next, spec, 1.0 / lag) + glm::dvec3(0.0, 0.0, gravity)) - drag_force(level, next.velocity - wind, spec);
  next.attitude = attitude_along(within_tilt(force, spec), yaw);
  next.rates = {0.0, 0.0, turn_rate};
  return next;
}

// --- the rigid body's controller ---

Wrench steer(const FlightState& state, const Wanted& wanted, double turn_rate, const VehicleSpec& spec) {
  const double gain = spec.velocity_gain_1_s.value_or(1.0 / spec.velocity_time_s);
  // It knows its own drag, but not the wind.
  const glm::dvec3 force =
      within_tilt(spec.mass_kg * (acceleration_asked(wanted, state, spec, gain) + glm::dvec3(0.0, 0.0, gravity)) - drag_force(state.attitude, state.velocity, spec), spec);
  const glm::dvec3 to = glm::conjugate(state.attitude) * glm::normalize(force);  // where the body's z axis should point, in the body's frame
  // The rotation from z to there: twice the vector part of its quaternion.
  const double share = std::sqrt(2.0 / std::max(1e-9, 1.0 + to.z));
  const double yaw_limit = radians(spec.turn_acceleration_deg_s2);
  const glm::dvec3 turn(-spec.attitude_gain_1_s2 * share * to.y - spec.attitude_rate_gain_1_s * state.rates.x, spec.attitude_gain_1_s2 * share * to.x - spec.attitude_rate_gain_1_s * state.rates.y,
                        std::clamp(spec.yaw_rate_gain_1_s * (turn_rate - state.rates.z), -yaw_limit, yaw_limit));
  const glm::dvec3& inertia = spec.inertia_kg_m2;
  return {std::clamp(glm::dot(force, state.attitude * glm::dvec3(0.0, 0.0, 1.0)), 0.0, spec.thrust_max_n), inertia * turn + glm::cross(state.rates, inertia * state.rates)};
}

}  // namespace

FlightState fly(const FlightState& now, const Command& command, double turn_rate, const Unrest& unrest, const VehicleSpec& spec, bool rigid_body, double step) {
  const Wanted all = wanted(now, command, turn_rate, unrest, spec, step);
  const glm::dvec3 wind = spec.wind_m_s + unrest.gust;
  if (!rigid_body) return fly_kinematic(now, all, turn_rate, wind, spec, step);
  return rigid_body_step(now, spec, wind, [&](const FlightState& state) { return steer(state, all, turn_rate, spec); }, step);
}

}  // namespace thicket
