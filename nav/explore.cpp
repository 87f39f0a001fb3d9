// Explorer: chooses one of the others by what is seen at the start. A border all around: the wall, then the inside. Nothing at all: from the centre outward. Something here and there: bounce.
#include <algorithm>
#include <cmath>

#include "planners.hpp"

namespace thicket {
namespace {

class Explore final : public Planner {
 public:
  Explore(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start) : spec_(spec), vehicle_(vehicle), start_(start) {}
  Explore(const Explore& other)
      : spec_(other.spec_), vehicle_(other.vehicle_), start_(other.start_), name_(other.name_), chosen_(other.chosen_ ? other.chosen_->clone() : nullptr) {}
  Explore& operator=(const Explore&) = delete;
  std::unique_ptr<Planner> clone() const override { return std::make_unique<Explore>(*this); }

  Decision decide(const Senses& senses) override {
    if (!chosen_) choose(senses.contour);
    Decision decision = chosen_->decide(senses);
    decision.state = name_ + (": " + decision.state);
    return decision;
  }
  std::vector<Mark> marks() const override { return chosen_ ? chosen_->marks() : std::vector<Mark>{}; }

 private:
  void choose(const Contour& contour) {
    const auto seen = std::count_if(contour.begin(), contour.end(), [](const ContourPoint& point) { return std::isfinite(point.distance); });
    const double share = contour.empty() ? 0.0 : static_cast<double>(seen) / static_cast<double>(contour.size());
    name_ = share > 0.95 ? "wall_then_inside" : share > 0.0 ? "bounce" : "center_out";
    chosen_ = (share > 0.95 ? make_wall_then_inside : share > 0.0 ? make_bounce : make_center_out)(spec_, vehicle_, start_);
  }

  PlannerSpec spec_;
  VehicleLimits vehicle_;
  Pose2 start_;
  const char* name_ = "";
  std::unique_ptr<Planner> chosen_;
};

}  // namespace

std::unique_ptr<Planner> make_explore(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start) { return std::make_unique<Explore>(spec, vehicle, start); }

}  // namespace thicket
