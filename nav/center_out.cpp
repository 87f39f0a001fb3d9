// Explorer: from the start outward in a square spiral, whose arms are 1, 1, 2, 2, 3, 3 ... lanes long; for where there is no border. Where an arm is blocked it goes on to the end of
// the next one; when all arms of four turns of the spiral are blocked, there is no outside left.
#include <fmt/format.h>

#include "explorer.hpp"
#include "planners.hpp"

namespace thicket {
namespace {

class CenterOut final : public Explorer {
 public:
  CenterOut(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start)
      : Explorer(spec, vehicle), yaw_(start.yaw), corner_(start.position) {
    next_arm();
  }
  std::unique_ptr<Planner> clone() const override { return std::make_unique<CenterOut>(*this); }

 private:
  Decision drive() override {
    if (pilot().at(corner_)) {
      blocked_ = 0;
      next_arm();
    }
    for (int i = 0; i < 8 && pilot().blocked_toward(corner_); ++i) {
      if (++blocked_ > 16) return explored("every arm of the spiral is blocked");
      mark("blocked", position());
      next_arm();
    }
    return go_to(corner_, fmt::format("arm {} of the spiral", arm_));
  }

  void next_arm() {
    const glm::dvec2 from = corner_;
    corner_ += lane() * static_cast<double>(arm_ / 2 + 1) * direction(yaw_ + 0.5 * pi * static_cast<double>(arm_ % 4));
    mark_segment("arm", from, corner_);
    ++arm_;
  }

  double yaw_;
  std::size_t arm_ = 0;
  glm::dvec2 corner_;  ///< the end of this arm
  int blocked_ = 0;    ///< arms in a row
};

}  // namespace

std::unique_ptr<Planner> make_center_out(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start) { return std::make_unique<CenterOut>(spec, vehicle, start); }

}  // namespace thicket
