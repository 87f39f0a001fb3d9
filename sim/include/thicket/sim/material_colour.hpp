// How a material is drawn in plans.
#pragma once

#include <glm/vec3.hpp>

#include "thicket/worlds/material.hpp"

namespace thicket {

struct MaterialColour {
  glm::dvec3 display{0.5};   ///< red, green, blue, 0...1, as a display has them; that of `thicket picture`
  bool penetrable = false;   ///< to a radar of 24 GHz, which 0.2 m of it cost less than 10 dB
};
MaterialColour material_colour(const Material& material);

}  // namespace thicket
