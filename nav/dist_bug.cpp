// DistBug (Kamon & Rivlin 1997): with the free range F toward the goal T. Leave the boundary where T is in straight reach, or where d(x, T) - F <= d_min - STEP, d_min being the least distance to T on
// this boundary: then the next one is hit nearer to T, by STEP, than any place of this one, so that it ends. A closed loop means that there is no way, but for two things that the paper does not have:
// a free range that was none (a wall seen at a low angle is a row of far echoes), and a way out that is free by less than STEP. Where a hit is not nearer to T than all before, or
// where a loop has passed a way out like that, the next one is left by the rule of i_bug.cpp, which needs no range.
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

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

  void on_hit() override {
    believes_ = distance_to_goal() < best_hit_ - 0.5 * pilot().same_place();
    best_hit_ = std::min(best_hit_, distance_to_goal());
    passed_way_out_ = false;
  }

  Decision on_boundary() override {
    const bool nearer = distance_to_goal() < glm::distance(walk().hit(), goal()) - pilot().same_place();
    if (believes_) {
      if (walk().armed() && pilot().open_toward(goal())) {
        const double distance = distance_to_goal(), range = view_.free_toward(goal()), step = pilot().keep();
        if (range >= distance - 1e-9 || distance - range <= walk().closest_distance() - step) return leave();
      }
      passed_way_out_ = passed_way_out_ || (nearer && (pilot().open_toward(goal()) || pilot().blocked_by_other(goal())));
    } else if (nearer && leads_away()) {
      return leave();
    }
    if (!walk().closed()) return follow("following the boundary");
    if (!passed_way_out_) return unreachable("the whole boundary was walked, and from nowhere does the free way to the goal lead nearer to it than the boundary itself");
    believes_ = passed_way_out_ = false;
    begin_walk();
    return follow("following the boundary for the second time");
  }

  FarView view_;
  double best_hit_ = INFINITY;   ///< least distance to the goal at a hit so far, m
  bool believes_ = true;         ///< what is seen far away
  bool passed_way_out_ = false;  ///< by the rule of I-Bug
};

}  // namespace

std::unique_ptr<Planner> make_dist_bug(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2&) { return std::make_unique<DistBug>(spec, vehicle); }

}  // namespace thicket
