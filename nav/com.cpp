// Com, "common sense" (Sankaranarayanan & Vidyasagar 1990): follow the boundary until the way to the goal is open, leave there. Not complete: with nothing remembered it
// may go round and round between the same leave and hit points (a U whose mouth faces away from the goal is enough), until the run's limits end it. A
// boundary walked all around with the way open nowhere is a true "unreachable".
#include "bug.hpp"
#include "planners.hpp"

namespace thicket {
namespace {

class Com final : public Bug {
 public:
  using Bug::Bug;
  std::unique_ptr<Planner> clone() const override { return std::make_unique<Com>(*this); }

 private:
  Decision on_boundary() override {
    if (walk().armed() && pilot().open_toward(goal())) return leave();
    if (walk().closed()) return unreachable("the whole boundary was walked, and nowhere was the way to the goal open");
    return follow("following the boundary");
  }
};

}  // namespace

std::unique_ptr<Planner> make_com(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2&) { return std::make_unique<Com>(spec, vehicle); }

}  // namespace thicket
