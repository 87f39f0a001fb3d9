// Bug2 with the failure rule of Rozeboom 2012: "if the agent is not closer to the goal once it crosses the line, conclude there is no path". That is not
// Lumelsky's rule and not true: a boundary may cross the M-line behind the hit point first and before the goal later. Kept to show where it is wrong
// (docs/navigation.md). In everything else this is bug2.cpp.
#include "bug.hpp"
#include "m_line.hpp"
#include "planners.hpp"

namespace thicket {
namespace {

class Bug2Of2012 final : public Bug {
 public:
  Bug2Of2012(const PlannerSpec& spec, const VehicleLimits& vehicle, const glm::dvec2& start) : Bug(spec, vehicle), start_(start) {
    mark_segment("M-line", start, goal());
  }
  std::unique_ptr<Planner> clone() const override { return std::make_unique<Bug2Of2012>(*this); }

 private:
  Decision on_boundary() override {
    const double hit_distance = glm::distance(walk().hit(), goal()), tolerance = pilot().same_place();
    // In front of the hit point the line is taken from there (why: bug2.cpp), behind it from the start.
    if (on_m_line(walk(), walk().hit(), goal(), 0.5 * tolerance) && distance_to_goal() < hit_distance - tolerance && leads_away()) return leave();
    if (walk().armed() && on_m_line(walk(), start_, goal(), 0.0) && distance_to_goal() > hit_distance + 2.0 * tolerance)
      return unreachable("the M-line was crossed farther from the goal than where the boundary was hit (the rule of 2012, which proves nothing)");
    if (walk().closed()) return unreachable("the hit point was met again without a crossing of the M-line to leave at");
    return follow("following the boundary");
  }

  glm::dvec2 start_;
};

}  // namespace

std::unique_ptr<Planner> make_bug2_2012(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start) {
  return std::make_unique<Bug2Of2012>(spec, vehicle, start.position);
}

}  // namespace thicket
