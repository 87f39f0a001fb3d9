// A given drive: straight from way-point to way-point. It does not go around anything; a way that is blocked ends it.
#include <fmt/format.h>

#include "pilot.hpp"
#include "planners.hpp"

namespace thicket {
namespace {

class Waypoints final : public Planner {
 public:
  Waypoints(const PlannerSpec& spec, const VehicleLimits& vehicle) : pilot_(spec, vehicle), points_(spec.waypoints_m) {}
  std::unique_ptr<Planner> clone() const override { return std::make_unique<Waypoints>(*this); }

  Decision decide(const Senses& senses) override {
    pilot_.look(senses);
    while (next_ < points_.size() && pilot_.at(points_[next_])) ++next_;
    if (next_ == points_.size()) return {{}, Outcome::reached, "all way-points done", fmt::format("all {} way-points were reached", points_.size())};
    if (pilot_.blocked_toward(points_[next_]))
      return {{}, Outcome::stuck, "the way is blocked", fmt::format("the straight way to way-point {} of {} is blocked", next_ + 1, points_.size())};
    return {pilot_.go_to(points_[next_]), Outcome::running, fmt::format("going to way-point {} of {}", next_ + 1, points_.size()), ""};
  }

  std::vector<Mark> marks() const override {
    std::vector<Mark> marks;
    for (std::size_t i = 0; i < points_.size(); ++i) marks.push_back({Mark::Kind::point, fmt::format("{}", i + 1), points_[i], points_[i]});
    return marks;
  }

 private:
  Pilot pilot_;
  std::vector<glm::dvec2> points_;
  std::size_t next_ = 0;
};

}  // namespace

std::unique_ptr<Planner> make_waypoints(const PlannerSpec& spec, const VehicleLimits& vehicle) { return std::make_unique<Waypoints>(spec, vehicle); }

}  // namespace thicket
