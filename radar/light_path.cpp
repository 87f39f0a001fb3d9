#include "light_path.hpp"

#include <algorithm>
#include <cmath>

namespace thicket {

LightEnd LightPath::end(const World& world, std::span<const double> extinction_per_m, std::span<const Crossing> crossings, const glm::dvec3& direction, double optical_depth_max) {
  LightEnd surface;
  media_.clear();
  borders_.clear();
  for (const Crossing& crossing : crossings) {
    const double extinction = extinction_per_m[world.solids[crossing.solid].material];
    if (extinction == infinity) {
      surface = {crossing.enter, crossing.starts_inside ? -direction : crossing.enter_normal, 1.0};
      break;  // they come by range
    }
    if (extinction <= 0.0) continue;
    media_.push_back({crossing.enter, crossing.leave, extinction});
    borders_.insert(borders_.end(), {crossing.enter, crossing.leave});
  }
  std::sort(borders_.begin(), borders_.end());
  double depth = 0.0;
  for (std::size_t b = 1; b < borders_.size() && borders_[b - 1] < surface.range; ++b) {
    const double from = borders_[b - 1], to = borders_[b];
    double extinction = 0.0;
    for (const Medium& medium : media_)
      if (medium.enter <= from && to <= medium.leave) extinction = std::max(extinction, medium.extinction);
    if (extinction == 0.0) continue;
    const double more = extinction * (std::min(to, surface.range) - from);
    if (depth + more >= optical_depth_max) return {from + (optical_depth_max - depth) / extinction, -direction, std::exp(-optical_depth_max)};
    depth += more;
  }
  surface.through = std::exp(-depth);
  return surface;
}

}  // namespace thicket
