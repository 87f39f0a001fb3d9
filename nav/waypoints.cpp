// A given drive: straight from way-point to way-point. It does not go around anything; a way that is blocked ends it.
#include <fmt/format.h>

#include <algorithm>

#include "pilot.hpp"
#include "planners.hpp"

namespace thicket {
namespace {

class Waypoints final : public Planner {
 public:
  Waypoints(const PlannerSpec& spec, const VehicleLimits& vehicle) : pilot_(with_fastest_leg(spec), vehicle), points_(spec.waypoints_m.begin(), spec.waypoints_m.end()), speeds_(spec.waypoint_speeds_m_s), stand_(spec.hover_s) {}
  std::unique_ptr<Planner> clone() const override { return std::make_unique<Waypoints>(*this); }

  Decision decide(const Senses& senses) override {
    pilot_.look(senses);
    while (next_ < points_.size() && (arrived_ || pilot_.at(points_[next_]))) {
      if (!arrived_) arrived_ = senses.time;
      if (senses.time < *arrived_ + stand_ - 1e-9) return {{}, Outcome::running, fmt::format("standing at way-point {} of {}", next_ + 1, points_.size()), "", true};
      arrived_.reset();
      ++next_;
    }
    if (next_ == points_.size()) return {{}, Outcome::reached, "all way-points done", fmt::format("all {} way-points were reached", points_.size())};
    if (pilot_.blocked_toward(points_[next_]))
      return {{}, Outcome::stuck, "the way is blocked", fmt::format("the straight way to way-point {} of {} is blocked", next_ + 1, points_.size())};
    Command command = pilot_.go_to(points_[next_]);
    if (next_ < speeds_.size()) command.speed = std::min(command.speed, speeds_[next_]);
    return {command, Outcome::running, fmt::format("going to way-point {} of {}", next_ + 1, points_.size()), ""};
  }

  std::vector<Mark> marks() const override {
    std::vector<Mark> marks;
    for (std::size_t i = 0; i < points_.size(); ++i) marks.push_back({Mark::Kind::point, fmt::format("{}", i + 1), points_[i], points_[i]});
    return marks;
  }

 private:
  /// The pilot's cruising speed is that of the fastest leg.
  static PlannerSpec with_fastest_leg(PlannerSpec spec) {
    if (!spec.waypoint_speeds_m_s.empty()) spec.speed_m_s = *std::ranges::max_element(spec.waypoint_speeds_m_s);
    return spec;
  }

  Pilot pilot_;
  std::vector<glm::dvec2> points_;
  std::vector<double> speeds_;  ///< m/s, of the legs; empty: the cruising speed
  double stand_;                ///< s
  std::size_t next_ = 0;
  std::optional<double> arrived_;  ///< s: when it came to the next way-point
};

}  // namespace

std::unique_ptr<Planner> make_waypoints(const PlannerSpec& spec, const VehicleLimits& vehicle) { return std::make_unique<Waypoints>(spec, vehicle); }

}  // namespace thicket
