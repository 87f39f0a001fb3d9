// Alg1 (Sankaranarayanan & Vidyasagar 1990): Bug2 that remembers its hit points. Where it meets an earlier one again it turns round, once a boundary, and follows the
// other way: no part of a boundary is passed more than twice. It leaves where the M-line is crossed nearer to the goal than at any crossing or hit
// before. After the turn the walk is counted anew, so that the loop that proves "there is no way" is a whole one in one sense.
#include <algorithm>
#include <cmath>

#include "bug.hpp"
#include "hit_memory.hpp"
#include "m_line.hpp"
#include "planners.hpp"

namespace thicket {
namespace {

class Alg1 final : public Bug {
 public:
  Alg1(const PlannerSpec& spec, const VehicleLimits& vehicle, const glm::dvec2& start) : Bug(spec, vehicle) { mark_segment("M-line", start, goal()); }
  std::unique_ptr<Planner> clone() const override { return std::make_unique<Alg1>(*this); }

 private:
  void on_hit() override {
    hit_ = walk().hit();
    hits_.add(hit_);
    nearest_ = std::min(nearest_, distance_to_goal());
  }

  Decision on_boundary() override {
    // The line is taken from the hit point, not from the start, as in bug2.cpp.
    if (on_m_line(walk(), hit_, goal(), 0.5 * pilot().same_place()) && distance_to_goal() < nearest_ - pilot().same_place() && leads_away()) {
      nearest_ = distance_to_goal();
      return leave();
    }
    if (hits_.met_again(walk(), pilot().same_place())) {
      mark("turn", pilot().pose().position);
      turn_round();
      begin_walk();
    } else if (walk().closed()) {
      return unreachable("the whole boundary was walked without a crossing of the M-line to leave at");
    }
    return follow("following the boundary");
  }

  glm::dvec2 hit_{0.0, 0.0};  ///< `walk().hit()` moves to where it turns round
  HitMemory hits_;
  double nearest_ = INFINITY;  ///< least distance to the goal at a hit or a leave point
};

}  // namespace

std::unique_ptr<Planner> make_alg1(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start) {
  return std::make_unique<Alg1>(spec, vehicle, start.position);
}

}  // namespace thicket
