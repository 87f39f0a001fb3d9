// TangentBug (Kamon, Rimon & Rivlin 1998; Choset et al. 2005, ch. 2; LaValle 2006, 12.3.3): with ranges. T is the goal, x the robot.
// Motion to the goal: straight where the way is free as far as seen, else toward that end n of what stands in it which makes d(x, n) + d(n, T) least, as long as n is
// nearer to T than x is (so that d(x, T) only ever decreases), else straight on until the obstacle is met. Then it follows the boundary, in the sense
// of the better end. d_followed: the least distance to T on any boundary so far. d_reach: the least distance to T of a place that can be reached
// straight. It leaves for that place where d_reach < d_followed by a margin; there, motion to the goal goes on. Each boundary is left for a place nearer to T than
// it ever was on one, so that it ends. A closed loop means that there is no way: were there one, the point of the loop nearest to T would have it.
// Different from the paper: d_followed is of where the robot has been, not of what it saw of the boundary. It leaves earlier then, for a nearer place of the same boundary.
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
    if (view_.is_free(goal())) {
      side_ = 0;
      return goal();
    }
    const auto end = better_end();
    if (!end || glm::distance(end->at, goal()) > distance_to_goal() - 0.1 * pilot().distance_to(end->at)) return goal();
    return pilot().pose().position + std::max(4.0 * pilot().keep(), pilot().distance_to(end->at)) * direction(end->heading);
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
    if (place_ && distance_to_goal() > nearest_ - 0.5 * margin()) {  // The way to it was not free after all.
      failed_.push_back(*place_);
      view_.trust_less();
    } else {
      view_.trust_more();
    }
    place_.reset();
    if (side_ == 0) better_end();
    return side_ == 0 ? first : side_ > 0 ? Hand::right : Hand::left;
  }

  void on_hit() override {
    side_ = 0;
    second_lap_ = false;
  }

  Decision on_boundary() override {
    nearest_ = std::min(nearest_, walk().closest_distance());
    if (walk().armed()) {
      const double followed = second_lap_ ? walk().closest_distance() : nearest_;
      const FarView::Place place = view_.nearest_place(goal());
      const bool goal_in_reach = view_.sight() > distance_to_goal() && view_.is_free(goal());
      const glm::dvec2 reach = goal_in_reach ? goal() : place.at;
      if ((goal_in_reach || place.distance < followed - margin()) && pilot().open_toward(reach) && !failed_often(reach)) {
        place_ = reach;
        mark("reach", reach);
        return leave();
      }
    }
    if (!walk().closed()) return follow("following the boundary");
    // A way that only seemed free has brought it to a boundary that is farther from the goal than an earlier one: what counts now is this one.
    if (!second_lap_ && walk().closest_distance() > nearest_ + margin()) {
      second_lap_ = true;
      begin_walk();
      return follow("following the boundary for the second time");
    }
    return unreachable("the whole boundary was walked, and no place nearer to the goal could be reached straight from it");
  }

  /// A place seen free again and again, and never: in a gap just as wide as the robot needs.
  bool failed_often(const glm::dvec2& place) const {
    return std::count_if(failed_.begin(), failed_.end(), [&](const glm::dvec2& at) { return glm::distance(at, place) < 0.5 * pilot().keep(); }) >= 3;
  }

  /// So much nearer to the goal each boundary is left, m.
  double margin() const { return 2.0 * pilot().same_place(); }

  FarView view_;
  int side_ = 0;                     ///< of what stands in the way: +1 past its left end, -1 past its right one, 0 undecided
  std::optional<glm::dvec2> place_;  ///< where it goes straight after it left a boundary
  double nearest_ = INFINITY;        ///< least distance to the goal on any boundary so far, m
  bool second_lap_ = false;
  std::vector<glm::dvec2> failed_;   ///< places for which it left, and which it did not reach
};

}  // namespace

std::unique_ptr<Planner> make_tangent_bug(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2&) { return std::make_unique<TangentBug>(spec, vehicle); }

}  // namespace thicket
