// Explorer: straight on until a wall is met, along it once around, then lanes to and fro inside, along x and then along y; a lane that is blocked is cut short. A wall that turns out
// to be an island is left for the next one. For where there is a border.
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "boundary_walk.hpp"
#include "explorer.hpp"
#include "planners.hpp"

namespace thicket {
namespace {

class WallThenInside final : public Explorer {
 public:
  WallThenInside(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start)
      : Explorer(spec, vehicle), hand_(spec.hand == "right" ? Hand::right : Hand::left), bearing_(start.yaw) {}
  std::unique_ptr<Planner> clone() const override { return std::make_unique<WallThenInside>(*this); }

 private:
  enum class Phase { to_wall, along_wall, inside };

  Decision drive() override {
    if (phase_ == Phase::to_wall) {
      if (!target_) target_ = far_away(bearing_);
      if (!pilot().blocked_toward(*target_)) return go_to(*target_, "looking for a wall");
      start_wall();
    }
    if (phase_ == Phase::along_wall) {
      walk_along();
      if (!walk_.closed()) return {pilot().follow(hand_), Outcome::running, "along the wall", ""};
      mark("closed", position());
      // With the wall on the left hand the inside of a room is walked around clockwise, an island counter-clockwise.
      const bool island = (turned_ > 0.0) == (hand_ == Hand::left);
      if (!island || ++islands_ > most_islands) start_lanes();
      else {
        phase_ = Phase::to_wall;
        bearing_ = another_way(bearing(to_wall_), islands_);
        target_ = far_away(bearing_);
        return go_to(*target_, "leaving an island");
      }
    }
    return sweep();
  }

  void start_wall() {
    phase_ = Phase::along_wall;
    mark("wall", position());
    pilot().touch_wall_toward(*target_);
    to_wall_ = *target_ - position();
    walk_ = BoundaryWalk(pilot().pose(), *target_, pilot().same_place(), pilot().keep(), 0.0, pilot().pose().position);
    yaw_ = pilot().pose().yaw;
    turned_ = 0.0;
  }

  void walk_along() {
    walk_.advance(pilot().pose());
    turned_ += wrap_angle(pilot().pose().yaw - yaw_);
    yaw_ = pilot().pose().yaw;
    low_ = glm::min(low_, position());
    high_ = glm::max(high_, position());
  }

  void start_lanes() {
    phase_ = Phase::inside;
    const double inset = 2.0 * pilot().same_place();  // a lane that ended on the wall's own way would be blocked before its end
    for (const int across : {1, 0}) {
      const int along = 1 - across;
      bool back = false;
      for (double at = low_[across] + lane(); at < high_[across]; at += lane(), back = !back) {
        glm::dvec2 from, to;
        from[across] = to[across] = at;
        from[along] = back ? high_[along] - inset : low_[along] + inset;
        to[along] = back ? low_[along] + inset : high_[along] - inset;
        lanes_.push_back(from);
        lanes_.push_back(to);
      }
    }
    once_ = lanes_.size();
  }

  Decision sweep() {
    while (next_ < lanes_.size()) {
      const glm::dvec2 end = lanes_[next_];
      if (!pilot().at(end)) {
        if (!pilot().blocked_toward(end)) break;
        if (next_ < once_) lanes_.push_back(end);  // again when all others are done: from elsewhere the way to it may be open
      }
      ++next_;
    }
    if (next_ == lanes_.size()) return explored("the wall and the inside are done");
    return go_to(lanes_[next_], "lanes inside of the wall");
  }

  static constexpr std::size_t most_islands = 8;
  Hand hand_;
  double bearing_;
  Phase phase_ = Phase::to_wall;
  std::optional<glm::dvec2> target_;  ///< far away
  BoundaryWalk walk_;
  glm::dvec2 to_wall_{1.0, 0.0};
  double yaw_ = 0.0, turned_ = 0.0;  ///< since the wall was met, rad
  std::size_t islands_ = 0;
  glm::dvec2 low_{INFINITY, INFINITY}, high_{-INFINITY, -INFINITY};  ///< of all walls that were followed
  std::vector<glm::dvec2> lanes_;                                    ///< their ends, in order
  std::size_t next_ = 0, once_ = 0;                                  ///< of these: the one that it goes to, and how many there were at first
};

}  // namespace

std::unique_ptr<Planner> make_wall_then_inside(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start) {
  return std::make_unique<WallThenInside>(spec, vehicle, start);
}

}  // namespace thicket
