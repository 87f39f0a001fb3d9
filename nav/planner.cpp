#include "thicket/nav/planner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "planners.hpp"
#include "thicket/base/text.hpp"

namespace thicket {

const std::vector<std::string>& planner_names() {
  static const std::vector<std::string> names = {"bug1", "bug2", "waypoints"};
  return names;
}

const Section& planner_section() {
  using S = PlannerSpec;
  static const Section section =
      SectionOf<S>("[planner]", "what drives the vehicle")
          .choice("name", &S::name, planner_names(), "bug1, bug2: to the goal, around what is in the way; waypoints: straight from one to the next")
          .key("goal_m", &S::goal_m, "m", between(-1e9, 1e9), "x, y of the goal")
          .key("waypoints_m", &S::waypoints_m, "m", between(-1e9, 1e9), "for the planner waypoints: [[x, y], ...] in order")
          .choice("hand", &S::hand, {"left", "right"}, "which hand touches the wall while following it; left turns right at a wall")
          .key("clearance_m", &S::clearance_m, "m", above_up_to(0.0, 1e3), "distance kept between hull and matter; a gap narrower than the hull and two of it is a wall. auto: the widest that leaves a way to the goal, computed from the world before the run")
          .or_word("auto", &S::clearance_auto)
          .key("clearance_privileged", &S::clearance_privileged, "told of a run whose clearance_m was computed from the world: such a mission leaves it in its mission.toml")
          .key("goal_tolerance_m", &S::goal_tolerance_m, "m", above_up_to(0.0, 1e3), "the goal is reached within this")
          .key("speed_m_s", &S::speed_m_s, "m/s", above_up_to(0.0, 1e3), "cruising speed; not given: the vehicle's own");
  return section;
}

Result<std::unique_ptr<Planner>> make_planner(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start) {
  if (spec.name == "waypoints") {
    if (spec.waypoints_m.empty()) return Error{"the planner 'waypoints' lacks way-points: give planner.waypoints_m"};
    return make_waypoints(spec, vehicle);
  }
  if (spec.name != "bug1" && spec.name != "bug2")
    return Error{fmt::format("there is no planner '{}', expected one of '{}'{}", spec.name, fmt::join(planner_names(), "', '"), did_you_mean(spec.name, planner_names()))};
  if (!spec.goal_m) return Error{fmt::format("the planner '{}' lacks a goal: give planner.goal_m or --goal X,Y", spec.name)};
  return spec.name == "bug1" ? make_bug1(spec, vehicle) : make_bug2(spec, vehicle, start.position);
}

double press_distance(const BumperSpec& bumpers, const PlannerSpec& planner, const VehicleLimits& vehicle) {
  const double speed = std::min(vehicle.speed, planner.speed_m_s.value_or(vehicle.speed));
  const double braking = speed * speed / (2.0 * vehicle.deceleration) + speed * vehicle.decision_period;
  return planner.clearance_m + bumpers.press_margin_m.value_or(std::max(0.5, braking));
}

}  // namespace thicket
