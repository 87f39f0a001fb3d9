// What the robot knows of the matter near it: what it sees, what it saw a moment ago, and which narrow passages it has decided upon. Private to the room.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "thicket/nav/planner.hpp"

namespace thicket {

/// A place of matter grown by the distance that the robot's axis keeps from it; in the frame of the robot's own pose estimate.
struct GrownDisc {
  glm::dvec2 centre{0.0, 0.0};
  double radius = 0.0;
  bool gate = false;  ///< no matter: the middle of a passage that is taken for a wall
};

/// Obstacles near the robot, grown to discs.
///
/// A single scan is not enough for decisions that must never be taken back: its ranges are noisy, and what is thinner than the spacing of its rays shows up now and then. So points of matter are averaged over
/// the last seconds. And a passage just as wide as the robot needs must be open, or shut, each time it is met and from both sides, or "the boundary" would not be one closed curve and a
/// loop around it would prove nothing. The first decision stands: where the robot has been is free (`places`), and what it passed by as too narrow stays shut (`gates`).
class Surroundings {
 public:
  /// `keep`: distance of the robot's axis from matter, m.
  explicit Surroundings(double keep);

  /// Takes in the contour points (in the frame of `pose`) of pressed bumpers that are within `reach` of the robot's axis, and makes `discs`. Points of an arc, of which
  /// only one is matter, are not remembered.
  void look(const Contour& contour, const BumperRing& bumpers, const Pose2& pose, double time, double reach);

  /// Within reach and a little more. Radius `keep`, less where the robot has been closer in a passage; small ones for gates.
  const std::vector<GrownDisc>& discs() const { return discs_; }

  /// The passage between two discs was taken for a wall; it will be from now on. No effect on passages far too narrow, for which that goes without saying, nor where the robot has been.
  void shut(const GrownDisc& a, const GrownDisc& b);

 private:
  /// A place of matter, averaged over the times it was seen.
  struct Place {
    glm::dvec2 position{0.0, 0.0};
    double weight = 0.0;
    double seen = 0.0;  ///< s, the last time
  };
  static constexpr std::size_t side = 64;
  std::size_t slot(std::int64_t column, std::int64_t row) const { return (static_cast<std::size_t>(column) & (side - 1)) + side * (static_cast<std::size_t>(row) & (side - 1)); }
  std::uint16_t find(const glm::dvec2& position) const;
  void take(const glm::dvec2& position, double time);
  void forget(double time, const glm::dvec2& robot);
  void place(std::uint16_t index);
  void unplace(std::uint16_t index);
  /// Seen once or twice just before or behind a place that is well known: noise.
  bool stray(const Place& place) const;
  void note_squeeze(const glm::dvec2& robot);

  double keep_;
  double grain_;                       ///< m: matter nearer together than this is one place
  std::vector<Place> matter_;
  std::vector<std::uint16_t> cells_;   ///< index of the first place of each cell of a grid that repeats itself every `side` cells, or `none`
  std::vector<std::uint16_t> next_;    ///< of each place, the next of the same cell
  std::vector<glm::dvec2> been_;       ///< narrow places that the robot has been at
  std::vector<glm::dvec2> shut_;       ///< middles of passages that are taken for walls
  std::vector<GrownDisc> discs_;
  std::vector<glm::dvec2> sides_;      ///< of a decision: directions to the matter close by
};

}  // namespace thicket
