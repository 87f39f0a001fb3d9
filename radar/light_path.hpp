// How far light gets through smoke and the like. Private to the room.
#pragma once

#include <span>
#include <vector>

#include "thicket/worlds/scene.hpp"

namespace thicket {

/// Where the light of a ray ends: at a surface, or inside a medium (its normal is then against the ray, for the medium scatters back what comes).
struct LightEnd {
  double range = infinity;       ///< m; +inf: nowhere
  glm::dvec3 normal{0.0};
  double through = 1.0;          ///< fraction of the power that gets there, one way
};

/// Follows rays; keeps its memory from one to the next.
class LightPath {
 public:
  /// `extinction_per_m`: of the world's materials, in 1/m: 0 passes light, infinite is a surface. Where media overlap the highest counts.
  LightEnd end(const World& world, std::span<const double> extinction_per_m, std::span<const Crossing> crossings, const glm::dvec3& direction, double optical_depth_max);

 private:
  struct Medium {
    double enter, leave, extinction;
  };
  std::vector<Medium> media_;
  std::vector<double> borders_;
};

}  // namespace thicket
