// Alg2 (Sankaranarayanan & Vidyasagar 1991): no M-line. It leaves a boundary where it is nearer to the goal than it has ever been and the way to the goal is open; where it
// meets an earlier hit point again it turns round, once a boundary, as Alg1 does.
#include <algorithm>
#include <cmath>

#include "bug.hpp"
#include "hit_memory.hpp"
#include "planners.hpp"

namespace thicket {
namespace {

class Alg2 final : public Bug {
 public:
  using Bug::Bug;
  std::unique_ptr<Planner> clone() const override { return std::make_unique<Alg2>(*this); }

 private:
  void on_hit() override {
    hits_.add(walk().hit());
    nearest_ = std::min(nearest_, distance_to_goal());
    descended_ = 0.0;
  }

  Decision on_boundary() override {
    const double nearer = nearest_ - distance_to_goal();
    nearest_ = std::min(nearest_, distance_to_goal());
    if (nearer > 0.0) descended_ += nearer;
    // Nearer than ever with this very step, and by more than a place's width since the hit: two obstacles do not pass the robot to and fro.
    if (nearer > 0.0 && descended_ > pilot().same_place() && walk().armed() && leads_away()) return leave();
    if (hits_.met_again(walk(), pilot().same_place())) {
      mark("turn", pilot().pose().position);
      turn_round();
      begin_walk();
    } else if (walk().closed()) {
      return unreachable("the whole boundary was walked, and nowhere was the way to the goal open nearer to it than ever before");
    }
    return follow("following the boundary");
  }

  HitMemory hits_;
  double nearest_ = INFINITY;  ///< least distance to the goal on any boundary
  double descended_ = 0.0;     ///< how much nearer than ever before this boundary has brought the robot
};

}  // namespace

std::unique_ptr<Planner> make_alg2(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2&) { return std::make_unique<Alg2>(spec, vehicle); }

}  // namespace thicket
