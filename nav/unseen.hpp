// What a robot whose sensors leave gaps has seen lately around itself. Private to the room.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "thicket/base/pose.hpp"
#include "thicket/nav/contour.hpp"
#include "thicket/nav/coverage.hpp"

namespace thicket {

/// Between lobes there are bearings that no beam covers, and a robot that drives there drives blind. This is a small map of where beams have looked, in the frame of the robot's own odometry, so
/// that what was in view a moment ago counts as seen while the robot drives past it; and of the matter that they met there, so that it is not forgotten as soon as it comes into a gap. Of a robot
/// without gaps it costs nothing.
class Unseen {
 public:
  /// `reach`: how far from the robot's axis it looks at all, m. `cell`: the size of a spot that is seen or not, m. `memory`: for how long a spot counts as seen, s. Good values for a robot that keeps
  /// its axis `keep` from matter and looks `look_ahead` ahead: 2 keep + look_ahead, keep / 6, 10.
  Unseen(double reach, double cell, double memory);

  /// Takes in what is seen now. `pose` is the robot's own estimate; only how it changed in the last moments matters.
  void look(const Contour& contour, const Pose2& pose, double time);

  /// Whether beams leave any bearing out now.
  bool has_gaps() const { return !coverage_.gaps().empty(); }
  const Coverage& coverage() const { return coverage_; }

  /// Adds to a contour in the vehicle's frame of now the matter that was seen lately and lies in a gap now.
  void complete(Contour& contour) const;

  /// Whether nothing is left to look for before driving `length` m along a heading (vehicle's frame): every spot that a robot as wide as 2 x `half_width` comes over is in view or was in view lately.
  /// Spots nearer to the axis than `hull` count as seen: the robot stands there.
  bool seen(double heading, double half_width, double hull, double length) const { return !turn_to_see(heading, half_width, hull, length); }
  /// Else how far to turn on the spot (rad, > 0 counter-clockwise) until the spots that come into view first are, with all that lie beside them. Turning that way does not make another way the
  /// shorter one, so that a robot that asks again while it turns does not twitch.
  std::optional<double> turn_to_see(double heading, double half_width, double hull, double length) const;

 private:
  struct Spot {
    std::int32_t column = 0, row = 0;  ///< which spot of the plane this is: the window wraps around
    double seen = -1e300;              ///< when last in view, s
    double met = -1e300;               ///< when matter was met in it, s
    glm::dvec2 matter{0.0, 0.0};       ///< where, in the odometry's frame
  };
  struct Index {
    std::int32_t column, row;
  };
  Index index_of(const glm::dvec2& position) const;
  glm::dvec2 centre_of(Index index) const { return {(index.column + 0.5) * cell_, (index.row + 0.5) * cell_}; }
  Spot& slot(Index index);
  /// Nothing if the window shows another spot there.
  const Spot* find(Index index) const;
  void fill_ranges(const Contour& contour);
  bool in_view(const Spot* spot) const { return spot && time_ - spot->seen <= memory_; }

  double reach_, cell_, memory_;
  std::int32_t edge_;  ///< spots along an edge of the window
  std::vector<Spot> window_;
  Coverage coverage_;
  std::vector<float> ranges_;  ///< per bin of the coverage: how far it is to matter, m
  Pose2 pose_;
  double time_ = 0.0;
};

}  // namespace thicket
