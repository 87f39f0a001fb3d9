// What the quadrotor's two models are made of: closed forms of one coordinate, the rigid body's equations, and when they can be integrated.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "thicket/sim/vehicle.hpp"

namespace thicket {

Coordinate first_order(const Coordinate& begin, double wanted, double lag, double limit, double time) {
  Coordinate now = begin;
  const double difference = wanted - begin.velocity, far = std::abs(difference) - limit * lag;
  if (far > 0.0) {
    // Until the difference is what the limit allows, the acceleration is the limit.
    const double t = std::min(time, far / limit), a = std::copysign(limit, difference);
    now.position += (now.velocity + 0.5 * a * t) * t;
    now.velocity += a * t;
    time -= t;
    if (time <= 0.0) return now;
  }
  const double left = wanted - now.velocity, gone = -std::expm1(-time / lag);
  now.position += wanted * time - left * lag * gone;
  now.velocity += left * gone;
  return now;
}

namespace {

/// One piece of an altitude hold: while it lasts, altitude and climb rate are a closed form of time.
struct HoldPiece {
  enum class Kind { limited, far, near } kind;  ///< acceleration at its limit; climb rate asked for at its limit; neither
  Coordinate begin;
  double value = 0.0;  ///< the acceleration or the climb rate that is at its limit

  Coordinate at(const AltitudeHold& hold, double t) const {
    if (kind == Kind::limited) return {begin.position + (begin.velocity + 0.5 * value * t) * t, begin.velocity + value * t};
    if (kind == Kind::far) return first_order(begin, value, hold.lag, INFINITY, t);
    // e'' + e'/lag + gain/lag e = 0, e = altitude - target.
    const double b = 0.5 / hold.lag, square = b * b - hold.gain / hold.lag, e = begin.position - hold.target, v = begin.velocity, s = std::sqrt(std::abs(square));
    // sinh(st)/s and sin(st)/s without loss where s is small.
    const double c = square > 0.0 ? std::cosh(s * t) : std::cos(s * t);
    const double f = s * t < 1e-4 ? t * (1.0 + square * t * t / 6.0) : (square > 0.0 ? std::sinh(s * t) : std::sin(s * t)) / s;
    const double fade = std::exp(-b * t);
    return {hold.target + fade * (e * c + (v + b * e) * f), fade * (v * c - (b * v + hold.gain / hold.lag * e) * f)};
  }
};

/// Which piece a state is in.
HoldPiece piece_of(const AltitudeHold& hold, const Coordinate& now) {
  const double asked = hold.gain * (hold.target - now.position), climb = std::clamp(asked, -hold.rate_max, hold.rate_max), a = (climb - now.velocity) / hold.lag;
  if (a >= hold.up_max) return {HoldPiece::Kind::limited, now, hold.up_max};
  if (a <= -hold.down_max) return {HoldPiece::Kind::limited, now, -hold.down_max};
  if (std::abs(asked) >= hold.rate_max) return {HoldPiece::Kind::far, now, climb};
  return {HoldPiece::Kind::near, now, 0.0};
}

bool same_piece(const HoldPiece& a, const HoldPiece& b) { return a.kind == b.kind && (a.kind == HoldPiece::Kind::near || a.value == b.value); }

}  // namespace

Coordinate hold_altitude(const Coordinate& begin, const AltitudeHold& hold, double time) {
  constexpr double exact = 1e-14;
  // A piece is looked at in stretches that are short against how fast pieces can come and go.
  const double stretch = 0.25 * hold.lag;
  Coordinate now = begin;
  HoldPiece piece = piece_of(hold, now);
  double in_piece = 0.0;
  while (time > 0.0) {
    const double t = std::min(time, stretch);
    if (same_piece(piece_of(hold, piece.at(hold, in_piece + t)), piece)) {
      in_piece += t;
      time -= t;
      continue;
    }
    double low = 0.0, high = t;
    while (high - low > exact) {
      const double middle = 0.5 * (low + high);
      if (middle <= low || middle >= high) break;
      (same_piece(piece_of(hold, piece.at(hold, in_piece + middle)), piece) ? low : high) = middle;
    }
    time -= high;
    now = piece.at(hold, in_piece + high);
    piece = piece_of(hold, now);
    in_piece = 0.0;
  }
  return piece.at(hold, in_piece);
}

// --- the rigid body ---

namespace {

struct Slope {
  glm::dvec3 position, velocity;
  glm::dquat attitude;
  glm::dvec3 rates;
};

Slope slope(const FlightState& state, const VehicleSpec& spec, const glm::dvec3& wind, const Wrench& wrench) {
  // Between the stages the quaternion is not of unit length; made so there, RK4 would lose its order. What it turns is turned by its direction.
  const glm::dquat attitude = glm::normalize(state.attitude);
  const glm::dvec3 through_air = glm::conjugate(attitude) * (state.velocity - wind);
  const glm::dvec3 force = attitude * (glm::dvec3(0.0, 0.0, wrench.thrust) - spec.drag_axes() * through_air);
  const glm::dvec3& inertia = spec.inertia_kg_m2;
  return {state.velocity, force / spec.mass_kg - glm::dvec3(0.0, 0.0, gravity), 0.5 * (state.attitude * glm::dquat(0.0, state.rates.x, state.rates.y, state.rates.z)),
          (wrench.torque - glm::cross(state.rates, inertia * state.rates)) / inertia};
}

FlightState moved(const FlightState& state, const Slope& slope, double step) {
  return {state.position + step * slope.position, state.velocity + step * slope.velocity, state.attitude + step * slope.attitude, state.rates + step * slope.rates};
}

}  // namespace

FlightState rigid_body_step(const FlightState& now, const VehicleSpec& spec, const glm::dvec3& wind, const std::function<Wrench(const FlightState&)>& wrench, double step) {
  const auto at = [&](const FlightState& state) {
    FlightState unit = state;
    unit.attitude = glm::normalize(state.attitude);
    return slope(state, spec, wind, wrench(unit));
  };
  const Slope a = at(now), b = at(moved(now, a, 0.5 * step)), c = at(moved(now, b, 0.5 * step)), d = at(moved(now, c, step));
  const Slope mean{(a.position + 2.0 * b.position + 2.0 * c.position + d.position) / 6.0, (a.velocity + 2.0 * b.velocity + 2.0 * c.velocity + d.velocity) / 6.0,
                   (a.attitude + 2.0 * b.attitude + 2.0 * c.attitude + d.attitude) / 6.0, (a.rates + 2.0 * b.rates + 2.0 * c.rates + d.rates) / 6.0};
  FlightState next = moved(now, mean, step);
  next.attitude = glm::normalize(next.attitude);
  return next;
}

// --- what can fly ---

namespace {

using Complex = std::complex<double>;

/// The roots of s^3 + a s^2 + b s + c, by the iteration of Durand and Kerner.
std::array<Complex, 3> cubic_roots(double a, double b, double c) {
  const double size = 1.0 + std::max({std::abs(a), std::abs(b), std::abs(c)});
  const double scale = std::max({std::abs(a), std::sqrt(std::abs(b)), std::cbrt(std::abs(c)), 1e-9 * size});
  std::array<Complex, 3> roots = {scale * Complex(1.0, 0.0), scale * Complex(0.4, 0.9), scale * Complex(-0.65, 0.72)};
  for (int round = 0; round < 200; ++round)
    for (std::size_t i = 0; i < 3; ++i) {
      const Complex s = roots[i];
      roots[i] -= (((s + a) * s + b) * s + c) / ((s - roots[(i + 1) % 3]) * (s - roots[(i + 2) % 3]));
    }
  return roots;
}

/// Eigenvalues of the closed loop about hovering.
std::array<Complex, 9> closed_loop(const VehicleSpec& spec) {
  const double gain = spec.velocity_gain_1_s.value_or(1.0 / spec.velocity_time_s);
  // In the plane: acceleration g * tilt - d * velocity (d: drag by mass), with a tilt that follows the one that is asked for, ((d - gain) * velocity) / g, by the attitude's PD:
  // (s + d) (s^2 + rate_gain s + attitude_gain) + attitude_gain (gain - d) = 0. Vertically the velocity's first order and the altitude's gain before it.
  const auto plane = [&](double d) {
    return cubic_roots(spec.attitude_rate_gain_1_s + d, spec.attitude_gain_1_s2 + spec.attitude_rate_gain_1_s * d, spec.attitude_gain_1_s2 * gain);
  };
  const auto along = plane(spec.drag_axes().x / spec.mass_kg), across = plane(spec.drag_axes().y / spec.mass_kg);
  const Complex root = std::sqrt(Complex(0.25 * gain * gain - gain * spec.altitude_gain_1_s, 0.0));
  return {along[0], along[1], along[2], across[0], across[1], across[2], -0.5 * gain + root, -0.5 * gain - root, Complex(-spec.yaw_rate_gain_1_s, 0.0)};
}

bool decays(const std::array<Complex, 9>& values, double step) {
  return std::all_of(values.begin(), values.end(), [step](const Complex& value) {
    const Complex z = value * step;
    return std::abs(1.0 + z * (1.0 + z * (0.5 + z * (1.0 / 6.0 + z / 24.0)))) <= 1.0;
  });
}

}  // namespace

double longest_stable_step(const VehicleSpec& spec) {
  const auto values = closed_loop(spec);
  if (std::any_of(values.begin(), values.end(), [](const Complex& value) { return value.real() >= 0.0; })) return 0.0;
  // From a short step on, in steps of a hundredth: the region has no holes on the way out that are narrower.
  double largest = 0.0;
  for (const Complex& value : values) largest = std::max(largest, std::abs(value));
  double stable = 0.01 / largest;
  while (decays(values, 1.01 * stable)) stable *= 1.01;
  return stable;
}

FlightModel choose_flight_model(const VehicleSpec& spec, double speed) {
  if (spec.model == "kinematic") return {false, "vehicle.model says so"};
  if (spec.model == "rigid_body") return {true, "vehicle.model says so"};
  if (spec.wind_m_s != glm::dvec3(0.0) || spec.gust_m_s > 0.0) return {true, "auto: there is wind"};
  constexpr double matters = 15.0;  // degrees
  const double tilt = degrees(std::atan(std::min(speed, spec.speed_max_m_s) / spec.velocity_time_s / gravity));
  if (tilt > matters || tilt > spec.tilt_max_deg) return {true, fmt::format("auto: to take up {:g} m/s it tilts by {:.0f} degrees", std::min(speed, spec.speed_max_m_s), std::min(tilt, spec.tilt_max_deg))};
  return {false, fmt::format("auto: no wind, and at most {:.0f} degrees of tilt", std::ceil(tilt))};
}

std::optional<std::string> vehicle_fault(const VehicleSpec& spec, const FlightModel& model, double step) {
  const double lift = spec.thrust_max_n * std::cos(radians(spec.tilt_max_deg)) / (spec.mass_kg * gravity);
  if (lift <= 1.0)
    return fmt::format("vehicle.thrust_max_n = {} lifts only {:.0f} % of the weight at a tilt of tilt_max_deg = {}: give more than {:.1f} N, or less tilt", spec.thrust_max_n, 100.0 * lift, spec.tilt_max_deg, spec.thrust_max_n / lift);
  const glm::dvec3& i = spec.inertia_kg_m2;
  if (i.x > i.y + i.z || i.y > i.x + i.z || i.z > i.x + i.y) return std::string("vehicle.inertia_kg_m2 belongs to no body: none of the three may be more than the sum of the two others");
  if (!model.rigid_body) return std::nullopt;
  const double longest = longest_stable_step(spec);
  if (longest <= 0.0)
    return std::string("the quadrotor's controllers are not stable together: make velocity_time_s longer (or velocity_gain_1_s smaller), or attitude_rate_gain_1_s larger");
  if (step > longest) return fmt::format("step_s = {} is too long for the attitude controller, at most {:.3g}", step, std::floor(longest * 1e4) / 1e4);
  return std::nullopt;
}

}  // namespace thicket
