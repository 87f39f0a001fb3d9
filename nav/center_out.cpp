// Explorer: from the start outward in a square spiral, whose arms are 1, 1, 2, 2, 3, 3 ... lanes long; for where there is no border. Each arm is entered at its place nearest to the robot, which is its
// beginning if the one before was driven to its end, and driven to its end. Where an entry or an arm is blocked the next one is tried; when all of four turns of the spiral are
// blocked, there is no outside left.
#include <algorithm>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "explorer.hpp"
#include "planners.hpp"

namespace thicket {
namespace {

class CenterOut final : public Explorer {
 public:
  CenterOut(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start)
      : Explorer(spec, vehicle), yaw_(start.yaw), corner_(start.position) {
    next_arm(start.position);
  }
  std::unique_ptr<Planner> clone() const override { return std::make_unique<CenterOut>(*this); }

 private:
  Decision drive() override {
    if (pilot().at(target_)) {
      blocked_ = 0;
      if (target_ == corner_) next_arm(position());
      else target_ = corner_;
    }
    for (int i = 0; i < 8 && pilot().blocked_toward(target_); ++i) {
      if (++blocked_ > 16) return explored("every arm of the spiral is blocked");
      mark("blocked", position());
      next_arm(position() - 0.5 * lane() * glm::normalize(target_ - position()));  // off what blocks it, or the way along that would be blocked too
    }
    return go_to(target_, fmt::format("arm {} of the spiral", arm_));
  }

  /// To be entered at its place nearest to `robot`.
  void next_arm(const glm::dvec2& robot) {
    const glm::dvec2 from = corner_;
    corner_ += lane() * static_cast<double>(arm_ / 2 + 1) * direction(yaw_ + 0.5 * pi * static_cast<double>(arm_ % 4));
    mark_segment("arm", from, corner_);
    ++arm_;
    const glm::dvec2 along = glm::normalize(corner_ - from), entry = from + std::clamp(glm::dot(robot - from, along), 0.0, glm::distance(from, corner_)) * along;
    target_ = pilot().at(entry) ? corner_ : entry;
  }

  double yaw_;
  std::size_t arm_ = 0;
  glm::dvec2 corner_;  ///< the end of this arm
  glm::dvec2 target_;  ///< its nearest place on the way to it, then its end
  int blocked_ = 0;    ///< entries and arms in a row
};

}  // namespace

std::unique_ptr<Planner> make_center_out(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start) { return std::make_unique<CenterOut>(spec, vehicle, start); }

}  // namespace thicket
