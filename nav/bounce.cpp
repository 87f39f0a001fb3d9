// Explorer: straight on until something is in the way, then another way by chance, and so on. It needs no border and no map, and comes everywhere in the end.
#include <fmt/format.h>

#include "explorer.hpp"
#include "planners.hpp"

namespace thicket {
namespace {

class Bounce final : public Explorer {
 public:
  Bounce(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start) : Explorer(spec, vehicle), bearing_(start.yaw) {}
  std::unique_ptr<Planner> clone() const override { return std::make_unique<Bounce>(*this); }

 private:
  Decision drive() override {
    if (!target_) target_ = far_away(bearing_);
    if (pilot().blocked_toward(*target_)) {
      mark("bounce", position());
      bearing_ = another_way(bearing_, bounces_++);
      target_ = far_away(bearing_);
    }
    return go_to(*target_, fmt::format("straight on, {} walls met", bounces_));
  }

  double bearing_;
  std::size_t bounces_ = 0;
  std::optional<glm::dvec2> target_;  ///< far away
};

}  // namespace

std::unique_ptr<Planner> make_bounce(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start) { return std::make_unique<Bounce>(spec, vehicle, start); }

}  // namespace thicket
