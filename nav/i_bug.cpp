// I-Bug (Taylor & LaValle 2009, as McGuire et al. 2019 build it): leave the boundary where the way to the goal is open and the goal is nearer than at the last hit. Each hit is
// nearer to the goal than the one before, so that it ends; a boundary walked all around without leaving means that there is no way.
#include <glm/geometric.hpp>

#include "bug.hpp"
#include "planners.hpp"

namespace thicket {
namespace {

class IBug final : public Bug {
 public:
  using Bug::Bug;
  std::unique_ptr<Planner> clone() const override { return std::make_unique<IBug>(*this); }

 private:
  Decision on_boundary() override {
    const double hit_distance = glm::distance(walk().hit(), goal());
    if (walk().armed() && distance_to_goal() < hit_distance - pilot().same_place() && leads_away()) return leave();
    if (walk().closed()) return unreachable("the whole boundary was walked, and nowhere was the way to the goal open nearer to it than at the hit");
    return follow("following the boundary");
  }
};

}  // namespace

std::unique_ptr<Planner> make_i_bug(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2&) { return std::make_unique<IBug>(spec, vehicle); }

}  // namespace thicket
