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
    if (walk().armed()) {
      const auto crossing = crosses_m_line();
      const double hit_distance = glm::distance(walk().hit(), goal());
      if (crossing && glm::distance(*crossing, goal()) < hit_distance - pilot().same_place() && leads_away()) return leave();
    }
    if (walk().closed()) return unreachable("the hit point was met again without a crossing of the M-line to leave at");
    return follow("following the boundary");
  }

  /// Where the last step crossed the M-line between the hit point and the goal (what lies before the hit point is farther from the goal than it and cannot count): by
  /// a change of side, so that neither a step across nor a steep line is missed. Taken from the hit point, not from the start: a robot that leaves a boundary
  /// swings off the line a little, and a boundary that it meets beside the line need not cross it again.
  std::optional<glm::dvec2> crosses_m_line() const {
    const glm::dvec2& from = walk().hit();
    const glm::dvec2 line = goal() - from;
    const auto side = [&](const glm::dvec2& p) { return line.x * (p.y - from.y) - line.y * (p.x - from.x); };
    const double before = side(walk().previous()), after = side(walk().current());
    if ((before > 0.0) == (after > 0.0)) return std::nullopt;
    const glm::dvec2 at = glm::mix(walk().previous(), walk().current(), before / (before - after));
    const double along = glm::dot(at - from, line) / glm::dot(line, line);
    if (along <= 0.0 || along >= 1.0) return std::nullopt;
    return at;
  }
};

}  // namespace

std::unique_ptr<Planner> make_bug2(const PlannerSpec& spec, const VehicleLimits& vehicle, const glm::dvec2& start) {
  return std::make_unique<Bug2>(spec, vehicle, start);
}

}  // namespace thicket
