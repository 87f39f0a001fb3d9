#include "thicket/nav/planner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "flight.hpp"
#include "planners.hpp"
#include "thicket/base/text.hpp"

namespace thicket {

namespace {

struct Kind {
  const char* name;
  PlannerNeeds needs;
  const char* help;
  std::unique_ptr<Planner> (*make)(const PlannerSpec&, const VehicleLimits&, const Pose2& start);
};

const std::vector<Kind>& kinds() {
  using enum PlannerNeeds;
  static const std::vector<Kind> all = {
      {"bug1", goal, "once around what is in the way, then from the nearest point on",
       [](const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2&) { return make_bug1(spec, vehicle); }},
      {"bug2", goal, "around it until the line from start to goal is met nearer to the goal",
       [](const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start) { return make_bug2(spec, vehicle, start.position); }},
      {"bug2_2012", goal, "the same with the failure rule of 2012, which gives up too early", make_bug2_2012},
      {"tangent_bug", goal, "past that end of it by which the way is shorter, as far as it sees", make_tangent_bug},
      {"alg1", goal, "bug2 that turns round where it has hit before", make_alg1},
      {"alg2", goal, "the same without the line", make_alg2},
      {"dist_bug", goal, "leaves where the free way to the goal leads nearer than it ever was", make_dist_bug},
      {"com", goal, "leaves wherever the way to the goal is open, and may go round for ever", make_com},
      {"i_bug", goal, "leaves where it is open and nearer than the last hit", make_i_bug},
      {"wall_then_inside", nothing, "explores: once along the wall, then lanes inside of it", make_wall_then_inside},
      {"bounce", nothing, "explores: straight on, another way at each wall", make_bounce},
      {"center_out", nothing, "explores: a spiral outward from the start", make_center_out},
      {"explore", nothing, "one of these three, by what is seen at the start", make_explore},
      {"waypoints", waypoints, "straight from one to the next", [](const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2&) { return make_waypoints(spec, vehicle); }},
  };
  return all;
}

const Kind* find_kind(const std::string& name) {
  const auto found = std::find_if(kinds().begin(), kinds().end(), [&](const Kind& kind) { return kind.name == name; });
  return found == kinds().end() ? nullptr : &*found;
}

std::string help_of_kinds() {
  std::string help;
  for (const Kind& kind : kinds()) help += fmt::format("{}{}: {}", help.empty() ? "" : "; ", kind.name, kind.help);
  return help;
}

}  // namespace

const std::vector<std::string>& planner_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Kind& kind : kinds()) all.push_back(kind.name);
    return all;
  }();
  return names;
}

PlannerNeeds planner_needs(const std::string& name) {
  const Kind* kind = find_kind(name);
  return kind ? kind->needs : PlannerNeeds::nothing;
}

const Section& planner_section() {
  using S = PlannerSpec;
  static const Section section =
      SectionOf<S>("[planner]", "what drives the vehicle")
          .choice("name", &S::name, planner_names(), help_of_kinds())
          .key("goal_m", &S::goal_m, "m", between(-1e9, 1e9), "x, y of the goal")
          .key("waypoints_m", &S::waypoints_m, "m", between(-1e9, 1e9), "for the planner waypoints: [[x, y], ...] in order; of a quadrotor also [x, y, z], z: the altitude there")
          .key("waypoint_speeds_m_s", &S::waypoint_speeds_m_s, "m/s", above_up_to(0.0, 1e3), "speed on the way to each way-point, one for each; not given: speed_m_s")
          .key("hover_s", &S::hover_s, "s", between(0.0, 1e6), "time to stand at each way-point")
          .key("heading_deg", &S::heading_deg, "deg", between(-36000.0, 36000.0), "of a quadrotor on way-points: the heading that it holds while it moves, be it sideways (strafing); not given: where it goes")
          .key("altitude_m", &S::altitude_m, "m", above_up_to(0.0, 1e6), "of a quadrotor: flight altitude above z = 0, taken before anything else; not given: the start's")
          .key("land", &S::land, "of a quadrotor: down to the floor after the goal or the last way-point, then the verdict")
          .choice("hand", &S::hand, {"left", "right"}, "which hand touches the wall while following it; left turns right at a wall")
          .key("clearance_m", &S::clearance_m, "m", above_up_to(0.0, 1e3), "distance kept between hull and matter; a gap narrower than the hull and two of it is a wall. auto: the widest that leaves a way to the goal, computed from the world before the run")
          .or_word("auto", &S::clearance_auto)
          .key("clearance_privileged", &S::clearance_privileged, "told of a run whose clearance_m was computed from the world: such a mission leaves it in its mission.toml")
          .key("goal_tolerance_m", &S::goal_tolerance_m, "m", above_up_to(0.0, 1e3), "the goal is reached within this")
          .key("speed_m_s", &S::speed_m_s, "m/s", above_up_to(0.0, 1e3), "cruising speed; not given: the vehicle's own")
          .choice("follower", &S::follower, {"contour", "rules2012"}, "how a boundary is followed: contour: at the clearance from all that is seen; rules2012: by the rules of the 2012 text, on pressed bumpers alone (for comparison)")
          .key("explore_m", &S::explore_m, "m", above_up_to(0.0, 1e9), "the explorers end when they have driven this far");
  return section;
}

Result<std::unique_ptr<Planner>> make_planner(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start) {
  const Kind* kind = find_kind(spec.name);
  if (!kind)
    return Error{fmt::format("there is no planner '{}', expected one of '{}'{}", spec.name, fmt::join(planner_names(), "', '"), did_you_mean(spec.name, planner_names()))};
  if (kind->needs == PlannerNeeds::waypoints && spec.waypoints_m.empty())
    return Error{fmt::format("the planner '{}' lacks way-points: give planner.waypoints_m", spec.name)};
  if (kind->needs == PlannerNeeds::goal && !spec.goal_m)
    return Error{fmt::format("the planner '{}' lacks a goal: give planner.goal_m or --goal X,Y", spec.name)};
  if (const std::string fault = flight_fault(spec, vehicle.flight.has_value(), vehicle.flight ? vehicle.flight->start_altitude : 0.0); !fault.empty()) return Error{"[planner]: " + fault};
  if (!vehicle.flight) return kind->make(spec, vehicle, start);
  auto planner = kind->needs == PlannerNeeds::waypoints ? make_flown_waypoints(spec, vehicle, start) : kind->make(spec, vehicle, start);
  return make_flight(std::move(planner), spec, vehicle, start);
}

double press_distance(const BumperSpec& bumpers, const PlannerSpec& planner, const VehicleLimits& vehicle) {
  const double speed = std::min(vehicle.speed, planner.speed_m_s.value_or(vehicle.speed));
  const double braking = speed * speed / (2.0 * vehicle.deceleration) + speed * vehicle.decision_period;
  return planner.clearance_m + bumpers.press_margin_m.value_or(std::max(0.5, braking));
}

}  // namespace thicket
