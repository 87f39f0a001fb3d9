// DistBug (Kamon & Rivlin 1997): with the free range F toward the goal T. Leave the boundary where T is in straight reach, or where d(x, T) - F <= d_min - STEP, d_min being the least
// distance to T on this boundary (here: on any so far, so that it ends): then the robot will be nearer to T, by STEP, than it ever was on one. STEP is two widths of a place, because a greater one
// would not see the way out between two obstacles. A closed loop means that there is no way.
#include <algorithm>
#include <cmath>

#include "bug.hpp"
#include "far_view.hpp"
#include "planners.hpp"

namespace thicket {
namespace {

class DistBug final : public Bug {
 public:
  DistBug(const PlannerSpec& spec, const VehicleLimits& vehicle) : Bug(spec, vehicle), view_(pilot().keep() - 0.25 * pilot().same_place()) {}
  std::unique_ptr<Planner> clone() const override { return std::make_unique<DistBug>(*this); }

 private:
  void look_far(const Senses& senses) override { view_.look(senses.pose, senses.contour); }

  /// The way was not as free as it looked: where a wall is seen at a low angle and far away, its echoes are far apart.
  void on_hit() override {
    if (distance_to_goal() > promised_ + pilot().same_place()) view_.trust_less();
    else view_.trust_more();
    promised_ = INFINITY;
    second_lap_ = false;
  }

  Decision on_boundary() override {
    nearest_ = std::min(nearest_, walk().closest_distance());
    const double step = 2.0 * pilot().same_place(), distance = distance_to_goal(), range = view_.free_toward(goal());
    const bool in_reach = range >= distance - 1e-9, nearer = distance - range <= (second_lap_ ? walk().closest_distance() : nearest_) - step;
    if (walk().armed() && (in_reach || nearer) && pilot().open_toward(goal())) {
      promised_ = distance - range;
      return leave();
    }
    // A way that only seemed free has brought it to a boundary that is farther from the goal than an earlier one: what counts now is this one.
    if (walk().closed() && !second_lap_ && walk().closest_distance() > nearest_ + step) {
      second_lap_ = true;
      begin_walk();
    }
    if (walk().closed()) return unreachable("the whole boundary was walked, and from nowhere does the free way to the goal lead nearer to it than the boundary itself");
    return follow("following the boundary");
  }

  FarView view_;
  double promised_ = INFINITY;  ///< distance to the goal that leaving was to bring, m
  double nearest_ = INFINITY;   ///< least distance to the goal on any boundary so far, m
  bool second_lap_ = false;
};

}  // namespace

std::unique_ptr<Planner> make_dist_bug(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2&) { return std::make_unique<DistBug>(spec, vehicle); }

}  // namespace thicket
