// A given flight: along the straight legs from way-point to way-point. It does not go around anything; a way that is blocked ends it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "flight.hpp"
#include "pilot.hpp"

namespace thicket {
namespace {

constexpr double aligned = radians(10.0);  // a heading that is off by less is held
constexpr double same_heading = radians(5.0);

class FlownWaypoints final : public Planner {
 public:
  FlownWaypoints(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start)
      : pilot_(spec, vehicle), spec_(spec), vehicle_(vehicle), from_(start.position, flight_altitude(spec, vehicle.flight->start_altitude)), heading_(start.yaw) {
    double altitude = from_.z;
    for (const Waypoint& point : spec.waypoints_m) {
      altitude = point.altitude.value_or(altitude);
      points_.emplace_back(point.position, altitude);
    }
    begin_leg();
  }
  std::unique_ptr<Planner> clone() const override { return std::make_unique<FlownWaypoints>(*this); }

  Decision decide(const Senses& senses) override {
    pilot_.look(senses);
    const glm::dvec3 here(senses.pose.position, senses.altitude);
    while (next_ < points_.size() && done(senses, here)) {
      from_ = points_[next_++];
      arrived_.reset();
      begin_leg();
    }
    if (next_ == points_.size()) return {stay(senses), Outcome::reached, "all way-points done", fmt::format("all {} way-points were reached", points_.size())};
    if (arrived_) return {stay(senses), Outcome::running, fmt::format("hovering at way-point {} of {}", next_ + 1, points_.size()), "", true};
    if (leg_length() > spec_.goal_tolerance_m && pilot_.blocked_toward(glm::dvec2(points_[next_])))
      return {stay(senses), Outcome::stuck, "the way is blocked", fmt::format("the straight way to way-point {} of {} is blocked", next_ + 1, points_.size())};
    return {go(senses), Outcome::running, fmt::format("{} way-point {} of {}", strafes_ ? "strafing to" : "flying to", next_ + 1, points_.size()), ""};
  }

  std::vector<Mark> marks() const override {
    std::vector<Mark> marks;
    for (std::size_t i = 0; i < points_.size(); ++i) marks.push_back({Mark::Kind::point, fmt::format("{}", i + 1), glm::dvec2(points_[i]), glm::dvec2(points_[i])});
    return marks;
  }

 private:
  glm::dvec2 leg() const { return glm::dvec2(points_[next_]) - glm::dvec2(from_); }
  double leg_length() const { return glm::length(leg()); }

  void begin_leg() {
    under_way_ = false;
    if (next_ == points_.size()) return;
    strafes_ = spec_.heading_deg.has_value();
    if (strafes_) heading_ = radians(*spec_.heading_deg);
    else if (leg_length() > spec_.goal_tolerance_m) heading_ = bearing(leg());
  }

  /// It must stand at the end of the leg: to hover, at the last one, to climb there, and to turn into the next leg.
  bool stops_at_end() const {
    if (spec_.hover_s > 0.0 || next_ + 1 == points_.size()) return true;
    const glm::dvec2 onward = glm::dvec2(points_[next_ + 1]) - glm::dvec2(points_[next_]);
    if (glm::length(onward) <= spec_.goal_tolerance_m) return true;
    return !strafes_ && std::abs(wrap_angle(bearing(onward) - heading_)) > same_heading;
  }

  bool done(const Senses& senses, const glm::dvec3& here) {
    if (!arrived_) {
      const bool near = glm::distance(glm::dvec2(here), glm::dvec2(points_[next_])) <= spec_.goal_tolerance_m;
      // What flies on at its speed passes by, and need not come as near to the middle.
      const bool past = !stops_at_end() && leg_length() > 0.0 && glm::dot(glm::dvec2(here) - glm::dvec2(from_), leg()) >= leg_length() * leg_length();
      if (!(near || past) || std::abs(here.z - points_[next_].z) > std::max(0.05, spec_.goal_tolerance_m)) return false;
      arrived_ = senses.time;
    }
    return senses.time >= *arrived_ + spec_.hover_s - 1e-9;
  }

  Command stay(const Senses& senses) const {
    const glm::dvec3& place = points_[std::min(next_, points_.size() - 1)];
    glm::dvec2 back = 0.8 * (glm::dvec2(place) - senses.pose.position);
    const double fast = glm::length(back), most = cruising_speed();
    if (fast > most) back *= most / fast;
    Command command = move_in_world(senses.pose, back, heading_, vehicle_);
    command.altitude = place.z;
    return command;
  }

  double cruising_speed() const {
    const double speed = next_ < spec_.waypoint_speeds_m_s.size() ? spec_.waypoint_speeds_m_s[next_] : spec_.speed_m_s.value_or(vehicle_.speed);
    return std::min(speed, vehicle_.speed);
  }

  Command go(const Senses& senses) {
    const glm::dvec2 here = senses.pose.position;
    if (leg_length() <= spec_.goal_tolerance_m) return stay(senses);
    const glm::dvec2 along = leg() / leg_length();
    const double way = glm::dot(here - glm::dvec2(from_), along), left = leg_length() - way;
    const double aside = along.x * (here - glm::dvec2(from_)).y - along.y * (here - glm::dvec2(from_)).x;
    // First it turns, then it goes; it waits for an altitude that is far behind the leg's.
    under_way_ = under_way_ || std::abs(wrap_angle(heading_ - senses.pose.yaw)) < aligned;
    const double cruise = cruising_speed(), share = std::clamp(way / leg_length(), 0.0, 1.0);
    double speed = under_way_ ? cruise : 0.0;
    const double slowing = std::max(3.0 * vehicle_.flight->velocity_time, vehicle_.decision_period * 4.0);
    if (stops_at_end()) speed = std::clamp(left / slowing, -0.2, std::min(speed, std::sqrt(2.0 * vehicle_.deceleration * std::max(0.0, left))));
    const glm::dvec2 across(-along.y, along.x);
    const double back = std::clamp(-0.8 * aside, -0.5 * cruise, 0.5 * cruise);
    Command command = move_in_world(senses.pose, speed * along + back * across, heading_, vehicle_);
    // The altitude that the leg has here; ahead by what the altitude hold is behind.
    command.altitude = from_.z + share * (points_[next_].z - from_.z);
    if (left < spec_.goal_tolerance_m) command.altitude = points_[next_].z;
    return command;
  }

  Pilot pilot_;
  PlannerSpec spec_;
  VehicleLimits vehicle_;
  std::vector<glm::dvec3> points_;
  std::size_t next_ = 0;
  glm::dvec3 from_;  ///< where the leg begins
  double heading_;   ///< rad, to be held
  bool strafes_ = false, under_way_ = false;
  std::optional<double> arrived_;  ///< s: when it came to the next way-point
};

}  // namespace

std::unique_ptr<Planner> make_flown_waypoints(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start) { return std::make_unique<FlownWaypoints>(spec, vehicle, start); }

}  // namespace thicket
