#include "bug.hpp"

#include <fmt/format.h>

namespace thicket {

namespace {
/// As often a boundary may turn out not to be the one that was hit before the planner says so instead of trying again.
constexpr int most_strays = 10;
/// To turn round and roll back to where a boundary was left, s.
constexpr double longest_return = 6.0;
}  // namespace

Bug::Bug(const PlannerSpec& spec, const VehicleLimits& vehicle)
    : pilot_(spec, vehicle), goal_(*spec.goal_m), first_hand_(spec.hand == "right" ? Hand::right : Hand::left), hand_(first_hand_) {}

Decision Bug::decide(const Senses& senses) {
  pilot_.look(senses);
  time_ = senses.time;
  if (!start_) start_ = pilot_.pose().position;
  look_far(senses);
  if (pilot_.at(goal_)) return {{}, Outcome::reached, "at the goal", fmt::format("{:.3f} m from the goal", distance_to_goal())};
  if (!on_boundary_) {
    // What rolled on past the place where it left goes back there first: it is that place that the way is open from.
    const double beyond = returning_ ? distance_to_goal() - glm::distance(*left_at_, goal_) : 0.0;
    if (returning_ && (beyond < 0.25 * pilot_.same_place() || beyond > pilot_.keep() || pilot_.distance_to(*left_at_) < pilot_.same_place() || senses.time > left_time_ + longest_return)) returning_ = false;
    const glm::dvec2 target = returning_ ? *left_at_ : aim();
    if (returning_ || !pilot_.blocked_toward(target)) return {pilot_.go_to(target), Outcome::running, "going to the goal", ""};
    on_boundary_ = true;
    hand_ = choose_hand(first_hand_);
    pilot_.touch_wall_toward(target);
    begin_walk();
    mark("hit", walk_.hit());
    on_hit();
  }
  walk_.advance(pilot_.pose());
  if (pilot_.wall_is_gone()) return lost("the boundary was not there any more");
  if (walk_.strayed() && !walk_.closed()) return lost("the boundary that was followed did not lead back to where it was hit");
  return on_boundary();
}

Hand Bug::choose_hand(Hand first) {
  if (!left_at_ || pilot_.distance_to(*left_at_) > pilot_.keep()) return first;
  const int nearer = pilot_.nearer_side(goal_);
  return nearer == 0 ? first : nearer > 0 ? Hand::right : Hand::left;
}

void Bug::begin_walk() { walk_ = BoundaryWalk(pilot_.pose(), goal_, pilot_.same_place(), pilot_.keep(), pilot_.stopping_distance(), *start_); }

bool Bug::leads_away() {
  if (pilot_.open_toward(goal_)) return true;
  // Only ever nearer to the goal, so that two obstacles cannot pass the robot from one to the other for ever.
  if (!pilot_.blocked_by_other(goal_) || distance_to_goal() > left_for_other_ - pilot_.same_place()) return false;
  left_for_other_ = distance_to_goal();
  return true;
}

Decision Bug::lost(const char* how) {
  if (++strays_ > most_strays) return {{}, Outcome::stuck, "lost the boundary", fmt::format("{} times {}", strays_, how)};
  return leave();
}

Decision Bug::follow(const char* state) {
  Decision decision{pilot_.follow(hand_), Outcome::running, state, ""};
  if (pilot_.boxed_in()) decision.state = "boxed in: no heading keeps the clearance";
  else decision.state += hand_ == Hand::left ? ", wall on the left hand" : ", wall on the right hand";
  if (*pilot_.following()) decision.state += fmt::format(" ({})", pilot_.following());
  return decision;
}

Decision Bug::leave() {
  on_boundary_ = false;
  left_at_ = pilot_.pose().position;
  returning_ = true;
  left_time_ = time_;
  mark("leave", pilot_.pose().position);
  return {pilot_.go_to(aim()), Outcome::running, "leaving the boundary for the goal", ""};
}

Decision Bug::unreachable(const std::string& why) const {
  return {{},
          Outcome::unreachable,
          "gave up: there is no way",
          fmt::format("{}; the boundary hit at ({:.2f}, {:.2f}) was followed for {:.1f} m, at the closest {:.2f} m from the goal at ({:.2f}, {:.2f})", why,
                      walk_.hit().x, walk_.hit().y, walk_.length(), walk_.closest_distance(), walk_.closest().x, walk_.closest().y)};
}

void Bug::mark(const char* label, const glm::dvec2& at) { marks_.push_back({Mark::Kind::point, label, at, at}); }

void Bug::mark_segment(const char* label, const glm::dvec2& from, const glm::dvec2& to) { marks_.push_back({Mark::Kind::segment, label, from, to}); }

}  // namespace thicket
