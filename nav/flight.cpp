#include "flight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace thicket {
namespace {

constexpr double altitude_held = 0.05;   // m: as near counts as held,
constexpr double climb_held = 0.1;       // m/s: as slow
constexpr double position_gain = 0.8;    // 1/s: speed back to where it hovers, per metre
constexpr double on_the_floor = 1e-3;    // m

class Flight final : public Planner {
 public:
  Flight(std::unique_ptr<Planner> planner, const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start)
      : planner_(std::move(planner)),
        vehicle_(vehicle),
        altitude_(flight_altitude(spec, vehicle.flight->start_altitude)),
        takes_off_(vehicle.flight->start_altitude < altitude_ - altitude_held),
        land_(spec.land),
        one_altitude_(spec.name != "waypoints"),
        place_(start) {}
  Flight(const Flight& other)
      : planner_(other.planner_->clone()), vehicle_(other.vehicle_), altitude_(other.altitude_), takes_off_(other.takes_off_), land_(other.land_), one_altitude_(other.one_altitude_), phase_(other.phase_), place_(other.place_), end_(other.end_) {}
  std::unique_ptr<Planner> clone() const override { return std::make_unique<Flight>(*this); }
  std::vector<Mark> marks() const override { return planner_->marks(); }

  Decision decide(const Senses& senses) override {
    if (phase_ == Phase::to_altitude) {
      const bool held = std::abs(senses.altitude - altitude_) < altitude_held && std::abs(senses.climb) < climb_held;
      if (!held) return {stay(senses, altitude_), Outcome::running, takes_off_ ? "taking off" : "going to the flight altitude", ""};
      phase_ = Phase::on_the_way;
    }
    if (phase_ == Phase::on_the_way) {
      Decision decision = planner_->decide(senses);
      if (one_altitude_ && decision.outcome != Outcome::running) decision.reason = at_this_altitude(decision);
      if (decision.outcome != Outcome::reached || !land_) {
        if (!decision.command.altitude) decision.command.altitude = altitude_;
        return decision;
      }
      phase_ = Phase::landing;
      place_ = senses.pose;
      end_ = decision;
    }
    if (senses.altitude <= on_the_floor) {
      end_.command = {};
      end_.reason += "; landed";
      return end_;
    }
    // Slower and slower toward the floor, half the hardest landing at the last.
    const double gentle = 0.5 * vehicle_.flight->landing_speed;
    Command command = stay(senses, 0.0);
    command.altitude.reset();
    command.climb = -std::clamp(0.5 * senses.altitude, gentle, std::max(gentle, 0.5 * vehicle_.flight->climb_rate));
    return {command, Outcome::running, "landing", ""};
  }

 private:
  enum class Phase { to_altitude, on_the_way, landing };

  Command stay(const Senses& senses, double altitude) const {
    glm::dvec2 back = position_gain * (place_.position - senses.pose.position);
    // On the floor nothing moves sideways.
    if (senses.altitude <= on_the_floor) back = {0.0, 0.0};
    const double fast = glm::length(back), most = std::min(0.5, vehicle_.speed);
    if (fast > most) back *= most / fast;
    Command command = move_in_world(senses.pose, back, place_.yaw, vehicle_);
    command.altitude = altitude;
    return command;
  }

  std::string at_this_altitude(const Decision& decision) const {
    if (decision.outcome == Outcome::unreachable) return fmt::format("unreachable at this altitude (z = {:.2f} m): {}", altitude_, decision.reason);
    return fmt::format("{}, at this altitude (z = {:.2f} m)", decision.reason, altitude_);
  }

  std::unique_ptr<Planner> planner_;
  VehicleLimits vehicle_;
  double altitude_;
  bool takes_off_, land_, one_altitude_;
  Phase phase_ = Phase::to_altitude;
  Pose2 place_;   ///< where it takes off or lands
  Decision end_;  ///< the planner's, to be told on the floor
};

}  // namespace

double flight_altitude(const PlannerSpec& spec, double start_altitude) {
  if (spec.altitude_m) return *spec.altitude_m;
  if (start_altitude <= on_the_floor && spec.name == "waypoints" && !spec.waypoints_m.empty()) return spec.waypoints_m.front().altitude.value_or(start_altitude);
  return start_altitude;
}

std::string flight_fault(const PlannerSpec& spec, bool flies, double start_altitude) {
  const bool waypoints = spec.name == "waypoints";
  const bool rises = std::any_of(spec.waypoints_m.begin(), spec.waypoints_m.end(), [](const Waypoint& point) { return point.altitude.has_value(); });
  if (!spec.waypoint_speeds_m_s.empty() && spec.waypoint_speeds_m_s.size() != spec.waypoints_m.size())
    return fmt::format("'waypoint_speeds_m_s' has {} numbers, expected one for each of the {} way-points", spec.waypoint_speeds_m_s.size(), spec.waypoints_m.size());
  if (!flies) {
    const char* key = spec.heading_deg ? "heading_deg" : spec.altitude_m ? "altitude_m" : spec.land ? "land" : nullptr;
    if (key) return fmt::format("'{}' needs a vehicle that flies: give vehicle.preset = \"hector_quadrotor\", or leave the key away", key);
    if (rises) return "a way-point has an altitude (z), which needs a vehicle that flies: give vehicle.preset = \"hector_quadrotor\", or leave z away";
    return "";
  }
  if (spec.heading_deg && !waypoints) return fmt::format("'heading_deg' is for the planner 'waypoints', and '{}' turns as it goes: leave the key away", spec.name);
  for (const Waypoint& point : spec.waypoints_m)
    if (waypoints && point.altitude && *point.altitude <= 0.0) return fmt::format("a way-point has the altitude {} m, expected above 0: land = true goes down to the floor", *point.altitude);
  if (flight_altitude(spec, start_altitude) <= on_the_floor) return "the quadrotor starts on the floor and is told no altitude: give planner.altitude_m, or start.z_m";
  return "";
}

Command move_in_world(const Pose2& pose, const glm::dvec2& velocity, double heading, const VehicleLimits& vehicle) {
  const glm::dvec2 ahead = direction(pose.yaw);
  const double off = wrap_angle(heading - pose.yaw), size = std::abs(off);
  const double rate = std::min({vehicle.turn_rate, 0.8 * std::sqrt(2.0 * vehicle.turn_acceleration * size), size / (2.0 * std::max(vehicle.decision_period, 0.1))});
  Command command{glm::dot(velocity, ahead), std::copysign(rate, off)};
  command.lateral = ahead.x * velocity.y - ahead.y * velocity.x;
  return command;
}

std::unique_ptr<Planner> make_flight(std::unique_ptr<Planner> planner, const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start) {
  return std::make_unique<Flight>(std::move(planner), spec, vehicle, start);
}

}  // namespace thicket
