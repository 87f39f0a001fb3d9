// Bug2 (Lumelsky 2006, p. 91): follow the obstacle from the hit point H until the M-line (the segment from start to goal) is crossed at a point Q that is closer to
// the goal than H and from where the way to the goal does not enter the obstacle; leave there. The goal cannot be reached when H is met again without
// having left (pp. 98-99). Not so in Rozeboom 2012, where a crossing that is not closer ends the search: that gives up too early (docs/navigation.md).
#include <glm/geometric.hpp>

#include "bug.hpp"
#include "m_line.hpp"
#include "planners.hpp"

namespace thicket {
namespace {

class Bug2 final : public Bug {
 public:
  Bug2(const PlannerSpec& spec, const VehicleLimits& vehicle, const glm::dvec2& start) : Bug(spec, vehicle) { mark_segment("M-line", start, goal()); }
  std::unique_ptr<Planner> clone() const override { return std::make_unique<Bug2>(*this); }

 private:
  Decision on_boundary() override {
    if (may_leave()) return leave();
    if (walk().closed()) return unreachable("the hit point was met again without a crossing of the M-line to leave at");
    return follow("following the boundary");
  }

  /// On the M-line between the hit point and the goal, nearer to the goal than the hit point, and the way is open. The line is taken from the hit point, not from the start: a robot that leaves a boundary
  /// swings off the line a little, and a boundary that it meets beside the line need not cross it again.
  bool may_leave() {
    const double same_place = pilot().same_place();
    return on_m_line(walk(), walk().hit(), goal(), 0.5 * same_place) && distance_to_goal() < glm::distance(walk().hit(), goal()) - same_place && leads_away();
  }
};

}  // namespace

std::unique_ptr<Planner> make_bug2(const PlannerSpec& spec, const VehicleLimits& vehicle, const glm::dvec2& start) {
  return std::make_unique<Bug2>(spec, vehicle, start);
}

}  // namespace thicket
