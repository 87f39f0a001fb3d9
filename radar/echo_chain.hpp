// From the solids along a ray to the echoes of a beam. Private to the room.
#pragma once

#include <span>
#include <vector>

#include "thicket/scan/scan.hpp"
#include "thicket/worlds/scene.hpp"

namespace thicket {

/// What the receiver and the wave can do.
struct EchoLimits {
  double range_min = 0.0, range_max = 0.0;  ///< m
  double budget_db = 0.0;                   ///< loss inside matter, one way
  double floor_power = 0.0;                 ///< least power that is detected
};

/// Whether a receiver with this floor sees matter of a reflectivity, met squarely from the open. What it does not see (smoke) is open to it.
inline bool visible(const Material& material, double floor_power) { return material.reflectivity > 0.0 && material.reflectivity >= floor_power; }

/// Follows one ray through the solids that it crosses and appends its echoes; sets the beam's echo list, end and sensed range.
///
/// At every point the solid of highest attenuation counts. Where that changes from one material to another there is an interface that reflects
/// the fraction `reflectivity` of the denser side; power returned is reflectivity * cos(incidence) (a Lambertian surface per ray of fixed solid angle) times
/// what has passed the interfaces and the matter before it, both ways. `materials` are the world's as the wave meets them (`at_frequency`). The ray ends at an opaque surface, when the loss inside
/// matter reaches the budget, or when not even a perfect reflector would be detected any more.
void trace_echoes(const World& world, std::span<const Material> materials, std::span<const Crossing> crossings, const glm::dvec3& direction, const EchoLimits& limits, Beam& beam,
                  std::vector<Echo>& echoes);

}  // namespace thicket
