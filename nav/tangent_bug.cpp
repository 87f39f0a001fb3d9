// TangentBug (Kamon, Rimon & Rivlin 1998; Choset et al. 2005, ch. 2; LaValle 2006, 12.3.3): with ranges. T is the goal, x the robot.
// Motion to the goal: straight where the way is free as far as seen, else toward that end n of what stands in it which makes d(x, n) + d(n, T) least, as long as n is
// nearer to T than x is (so that d(x, T) only ever decreases), else straight on until the obstacle is met. Then it follows the boundary, in the sense
// of the better end. d_followed: the least distance to T on this boundary. d_reach: the least distance to T of a place that can be reached straight. It leaves for that place where
// d_reach < d_followed by a margin; there, motion to the goal goes on. So the next boundary is hit nearer to T than any place of this one, and it ends.
// What the paper does not have is a far place that only seemed free: a wall seen at a low angle is a row of far echoes, and a gap just as wide as the robot needs is open in one scan and
// not in the next. So a boundary is also left by a rule that needs no range: where the way to the goal is open, at a place nearer to it than all of the walk before (I-Bug's, but with the least distance so far for that at the hit). And a hit that is not nearer to T
// than all before was on the way to a place that only seemed free: that boundary is left by the rule of I-Bug alone. Every hit is then nearer to T than the one before, until one is nearer than
// all: so it ends. A closed loop proves that there is no way as it does for I-Bug.
#include <algorithm>
#include <cmath>

#include "bug.hpp"
#include "far_view.hpp"
#include "planners.hpp"

namespace thicket {
namespace {

class TangentBug final : public Bug {
 public:
  TangentBug(const PlannerSpec& spec, const VehicleLimits& vehicle) : Bug(spec, vehicle), view_(pilot().keep() - 0.25 * pilot().same_place()) {}
  std::unique_ptr<Planner> clone() const override { return std::make_unique<TangentBug>(*this); }

 private:
  void look_far(const Senses& senses) override { view_.look(senses.pose, senses.contour); }

  glm::dvec2 aim() override {
    if (place_ && !pilot().at(*place_) && pilot().distance_to(*place_) > pilot().same_place()) return *place_;
    place_.reset();
    // In contact with what stands in the way, it is followed; past its end it would go in free space only.
    if (pilot().blocked_toward(goal())) return goal();
    if (view_.is_free(goal())) {
      side_ = 0;
      return goal();
    }
    const auto end = better_end();
    if (!end || glm::distance(end->at, goal()) > distance_to_goal() - 0.1 * pilot().distance_to(end->at)) return goal();
    // Past the end, so that it does not brake for it; but no faster than it can brake for what stands before the goal, to which it turns beside the end, or within a quarter of the distance that it keeps.
    const double past = std::max(4.0 * pilot().keep(), pilot().distance_to(end->at)), before = std::max(view_.free_toward(goal()), 0.25 * pilot().keep());
    return pilot().pose().position + std::min(past, before) * direction(end->heading);
  }

  /// That end of what stands in the way by which the way to the goal is shorter; the same one as before unless the other is clearly better.
  std::optional<FarView::Tangent> better_end() {
    const auto left = view_.tangent(goal(), +1), right = view_.tangent(goal(), -1);
    if (!left && !right) {
      side_ = 0;
      return std::nullopt;
    }
    const double handicap = 0.1 * side_ * distance_to_goal();
    side_ = !right || (left && left->way - handicap <= right->way + handicap) ? +1 : -1;
    return side_ > 0 ? left : right;
  }

  Hand choose_hand(Hand first) override {
    place_.reset();
    // Where only one end is in sight, that is not what makes it the better one: on along the side that leads nearer, as the motion to the goal would.
    if (!view_.tangent(goal(), +1) || !view_.tangent(goal(), -1))
      if (const int nearer = pilot().nearer_side(goal())) side_ = nearer;
    if (side_ == 0) better_end();
    return side_ == 0 ? first : side_ > 0 ? Hand::right : Hand::left;
  }

  void on_hit() override {
    side_ = 0;
    believes_ = distance_to_goal() < best_hit_ - 0.5 * pilot().same_place();
    best_hit_ = std::min(best_hit_, distance_to_goal());
  }

  Decision on_boundary() override {
    const bool nearest_so_far = distance_to_goal() < walk().closest_distance() + 0.5 * pilot().same_place();
    if (nearest_so_far && distance_to_goal() < glm::distance(walk().hit(), goal()) - pilot().same_place() && leads_away()) return leave();
    if (believes_ && walk().armed()) {
      const auto reach = view_.place_nearer(goal(), walk().closest_distance() - 2.0 * pilot().same_place());
      if (reach && pilot().open_toward(reach->at)) {
        place_ = reach->at;
        mark("reach", *place_);
        return leave();
      }
    }
    if (walk().closed()) return unreachable("the whole boundary was walked, and no place nearer to the goal could be reached straight from it");
    return follow("following the boundary");
  }

  FarView view_;
  int side_ = 0;                     ///< of what stands in the way: +1 past its left end, -1 past its right one, 0 undecided
  std::optional<glm::dvec2> place_;  ///< where it goes straight after it left a boundary
  double best_hit_ = INFINITY;       ///< least distance to the goal at a hit so far, m
  bool believes_ = true;             ///< what is seen far away
};

}  // namespace

std::unique_ptr<Planner> make_tangent_bug(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2&) { return std::make_unique<TangentBug>(spec, vehicle); }

}  // namespace thicket
