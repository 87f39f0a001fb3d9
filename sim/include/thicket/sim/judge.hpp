// What a planner has to find out, from the world itself: whether the goal can be reached, by how short a way, and how long theory lets a Bug planner's way be.
//
// All of it holds for the robot's axis in free space after growth by `Robot::keep()`, hull radius and clearance (Lumelsky, "Sensing, Intelligence, Motion", 2006, ch. 3). It
// shares no code with planners and sensors.
#pragma once

#include <memory>
#include <vector>

#include "thicket/base/result.hpp"
#include "thicket/sim/problem.hpp"
#include "thicket/worlds/free_space.hpp"

namespace thicket {

/// Ambiguous: it changes with the growth within its doubt, +- (0.1 x clearance + one cell of the oracle + 3 sigma of range noise).
enum class Expected { reachable, unreachable, ambiguous };
const char* to_string(Expected expected);

struct Judgement {
  Expected expected = Expected::ambiguous;
  double straight_m = 0.0;  ///< from start to goal
  /// The shortest way in the free space after growth by `keep()`, to a few parts in a hundred (A* over cells, pulled taut); +inf: there is none, or the start is not free.
  double shortest_m = 0.0;
  // Upper bounds of the way's length, each the greatest of those for growth by keep() - doubt, keep() and keep() + doubt: a gap just as wide as the robot needs may be open or shut.
  double bug1_bound_m = 0.0;     ///< D + 1.5 sum p_i over contours that meet the disc of radius D around the goal (Lumelsky 2006, theorem 3.3.2)
  double bug2_bound_m = 0.0;     ///< D + 1/2 sum n_i p_i (eq. 3.9), an odd n_i (of a start in the band) rounded up
  double tangent_bound_m = 0.0;  ///< D + sum p_i + sum p_i m_i over the contours of Bug1's (Kamon, Rimon & Rivlin 1998; LaValle 2006, 12.3.3)
  double cell_m = 0.0;           ///< of the oracle
  double doubt_m = 0.0;          ///< of the growth
};

/// A world as a robot's axis may move in it, for any number of problems. A value that copies share; using one from many threads is safe.
class Oracle {
 public:
  /// `points` (starts and goals) widen the window, which holds the solids and 3 keep() around all of it. The cell is `cell_m`, but for a grid map a whole odd part of
  /// its cell, so that the middle of a corridor has nodes; it is coarser where the window would have more than `max_cells`.
  static Result<Oracle> create(const World& world, const std::vector<glm::dvec2>& points, const Robot& robot, double noise_sigma_m, double cell_m = 0.05);
  static constexpr double max_cells = 6e6;

  /// `start` and `goal` lie in the window, or outside of it in the open.
  ///
  /// The goal is reached within the robot's goal tolerance: by a free cell no farther from it, or its own. A start nearer to matter than the growth is one that the robot drives
  /// away from: it may come to any free cell within growth - distance + 3 cells in a straight line that stays clear of matter, or, if there is
  /// none (in a gap that is too narrow), to any that is joined to it within 3 times the growth by ways that come no nearer to matter; if those lie in different components with
  /// different verdicts, the problem is ambiguous.
  Judgement judge(const glm::dvec2& start, const glm::dvec2& goal) const;

  double cell() const;

 private:
  struct State;
  explicit Oracle(std::shared_ptr<const State> state) : state_(std::move(state)) {}
  std::shared_ptr<const State> state_;
};

/// An oracle for one problem alone.
Result<Judgement> judge(const Problem& problem, const Robot& robot, double noise_sigma_m, double cell_m = 0.05);

}  // namespace thicket
