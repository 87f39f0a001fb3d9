// Bug2 (Lumelsky 2006, p. 91): follow the obstacle from the hit point H until the M-line (the segment from start to goal) is crossed at a point Q that is closer to
// the goal than H and from where the way to the goal does not enter the obstacle; leave there. The goal cannot be reached when H is met again without
// having left (pp. 98-99). Not so in Rozeboom 2012, where a crossing that is not closer ends the search: that gives up too early (docs/navigation.md).
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "bug.hpp"
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
  /// swings off the line a little, and a boundary that it meets beside the line need not cross it again. On it: by a change of side, so that neither a step across nor a steep line is
  /// missed; or close beside it, for a boundary that the line only touches is not crossed at all.
  bool may_leave() {
    const glm::dvec2& from = walk().hit();
    const glm::dvec2 line = goal() - from;
    const double length = glm::length(line);
    const auto side = [&](const glm::dvec2& p) { return (line.x * (p.y - from.y) - line.y * (p.x - from.x)) / length; };
    const double before = side(walk().previous()), after = side(walk().current());
    if ((before > 0.0) == (after > 0.0) && std::abs(after) > 0.5 * pilot().same_place()) return false;
    const double along = glm::dot(walk().current() - from, line) / length;
    return along > 0.0 && along < length && distance_to_goal() < length - pilot().same_place() && leads_away();
  }
};

}  // namespace

std::unique_ptr<Planner> make_bug2(const PlannerSpec& spec, const VehicleLimits& vehicle, const glm::dvec2& start) {
  return std::make_unique<Bug2>(spec, vehicle, start);
}

}  // namespace thicket
