// Which headings are open: the robot's surroundings seen as obstacles grown by the distance it keeps (its local configuration space).
#pragma once

#include <optional>
#include <vector>

#include "thicket/nav/contour.hpp"

namespace thicket {

/// Every contour point, grown to a disc of radius `keep` (hull + clearance), blocks an interval of headings: those whose first `look_ahead` metres
/// would enter the disc. Two discs that overlap leave no heading between them, so that a gap narrower than hull + 2 clearances is a wall.
class Steering {
 public:
  /// All in metres; angles below are bearings in the vehicle's frame. The contour must outlive this.
  Steering(const Contour& contour, double keep, double look_ahead);

  /// An edge of the blocked headings, and the contour point that makes it.
  struct Edge {
    double heading = 0.0;
    std::optional<std::size_t> point;  ///< none: `from` itself was open
    double open = 0.0;                 ///< how far the headings stay open when turning on, rad
  };
  /// The first open heading when turning from `from` counter-clockwise (`turn` > 0) or clockwise; nothing if all are blocked.
  std::optional<Edge> sweep(double from, int turn) const;

  /// How far the robot's axis can go along a heading until it is nearer than `radius` to a contour point, up to `limit`; the point that stops it, if any. A point
  /// that is nearer already stops whatever goes toward it.
  struct Way {
    double distance = 0.0;
    std::optional<std::size_t> point;
  };
  Way free_way(double heading, double radius, double limit) const;

 private:
  struct Blocked {
    double bearing, half_width;
    std::size_t point;
  };
  const Contour& contour_;
  std::vector<Blocked> blocked_;
};

}  // namespace thicket
