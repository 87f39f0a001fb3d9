// Bug1 (Lumelsky 2006, p. 85): walk once around the obstacle, return the shorter way to the point L that is closest to the goal, leave there. The goal
// cannot be reached if and only if the way from L to it enters the obstacle at L (p. 89).
#include <algorithm>
#include <cmath>

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
    // L is reached where the distance to it is least; the tracks of two walks along the same boundary are a little apart.
    const double away = pilot().distance_to(closest_), walked = walk().length() - length_at_return_;
    const bool here = away <= pilot().same_place() || (away > last_away_ && last_away_ < 4.0 * pilot().same_place());
    last_away_ = away;
    if (here && leads_away()) return leave();
    // Where the boundary's two sides are near together L may be near before it is reached.
    if (here && walked >= expected_ - slack_)
      return unreachable("the whole boundary was walked, and at its point closest to the goal the way to the goal leads into the obstacle");
    if (walked > 2.0 * walk().loop_length() + slack_) return lost("the point closest to the goal was not met again");
    return follow("returning to the point closest to the goal");
  }

  void start_return() {
    returning_ = true;
    last_away_ = INFINITY;
    closest_ = walk().closest();
    mark("closest", closest_);
    length_at_return_ = walk().length();
    const double onward = walk().onward_to_closest(), back = walk().loop_length() - onward;
    if (back < onward) turn_round();
    expected_ = std::min(onward, back);
    slack_ = 4.0 * pilot().same_place() + 0.1 * expected_;
  }

  bool returning_ = false;
  glm::dvec2 closest_{0.0, 0.0};
  double length_at_return_ = 0.0, expected_ = 0.0, slack_ = 0.0, last_away_ = 0.0;
};

}  // namespace

std::unique_ptr<Planner> make_bug1(const PlannerSpec& spec, const VehicleLimits& vehicle) {
  return std::make_unique<Bug1>(spec, vehicle);
}

}  // namespace thicket
