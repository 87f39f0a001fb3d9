// The hit points of a run, for planners that turn round where they have been before (Sankaranarayanan & Vidyasagar 1990). Private to the room.
#pragma once

#include <vector>

#include "boundary_walk.hpp"

namespace thicket {

class HitMemory {
 public:
  /// At every hit.
  void add(const glm::dvec2& hit) {
    hits_.push_back(hit);
    turned_ = false;
  }
  /// The last step of the walk passed an earlier hit point than its own, for the first time on this walk: the robot has been there, the other way leads where it has not.
  bool met_again(const BoundaryWalk& walk, double same_place) {
    if (turned_ || !walk.armed()) return false;
    for (std::size_t i = 0; i + 1 < hits_.size(); ++i)
      if (distance_to_segment(hits_[i], walk.previous(), walk.current()) <= same_place) return turned_ = true;
    return false;
  }

 private:
  std::vector<glm::dvec2> hits_;
  bool turned_ = false;
};

}  // namespace thicket
