// Bug1 (Lumelsky 2006, p. 85): walk once around the obstacle, return the shorter way to the point L that is closest to the goal, leave there. The goal
// cannot be reached if and only if the way from L to it enters the obstacle at L (p. 89).
#include <algorithm>

#include "bug.hpp"
#include "planners.hpp"

namespace thicket {
namespace {

class Bug1 final : public Bug {
 public:
  using Bug::Bug;
  std::unique_ptr<Planner> clone() const override { return std::make_unique<Bug1>(*this); }

 private:
  void on_hit() override { returning_ = false; }

  Decision on_boundary() override {
    if (!returning_) {
      if (!walk().closed()) return follow("walking around the obstacle");
      start_return();
    }
    const double away = pilot().distance_to(closest_);
    const double walked = walk().length() - length_at_return_;
    // L may be passed beside by a step; the place where the way opens may lie a little before or behind it.
    const bool near = away <= 2.0 * pilot().same_place() && walked >= expected_ - slack_;
    const bool going_by = near && was_near_ && away > last_away_;
    if (near && (going_by || away <= pilot().same_place()) && pilot().open_toward(goal())) return leave();
    const bool passed = (going_by && away > pilot().same_place()) || walked > expected_ + 2.0 * slack_;
    was_near_ = near;
    last_away_ = away;
    if (passed) return unreachable("the whole boundary was walked, and at its point closest to the goal the way to the goal leads into the obstacle");
    return follow("returning to the point closest to the goal");
  }

  void start_return() {
    returning_ = true;
    was_near_ = false;
    closest_ = walk().closest();
    mark("closest", closest_);
    length_at_return_ = walk().length();
    const double onward = walk().length_at_closest(), loop = walk().length();
    if (loop - onward < onward) turn_round();
    expected_ = std::min(onward, loop - onward);
    slack_ = 4.0 * pilot().same_place() + 0.1 * expected_;
  }

  bool returning_ = false, was_near_ = false;
  glm::dvec2 closest_{0.0, 0.0};
  double length_at_return_ = 0.0, expected_ = 0.0, slack_ = 0.0, last_away_ = 0.0;
};

}  // namespace

std::unique_ptr<Planner> make_bug1(const PlannerSpec& spec, const VehicleLimits& vehicle, const glm::dvec2& start) {
  return std::make_unique<Bug1>(spec, vehicle, start);
}

}  // namespace thicket
