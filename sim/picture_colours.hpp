// How a material looks in a picture of a world. Private to the room.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "thicket/worlds/material.hpp"

namespace thicket {

struct Look {
  enum class Kind : std::uint8_t { solid, medium, pane };
  Kind kind = Kind::solid;
  glm::dvec3 colour{0.5};   ///< of diffuse light, linear
  double extinction = 0.0;  ///< of a medium, 1/m
  double gloss = 0.0;       ///< 0 dull ... 1 polished
  bool leafy = false;       ///< light shines through its sheets
};

/// By the words in its name (leaf, wood, smoke, brick, red, ...), else by what it does to light and robots and a hash of the name.
Look look_of(const Material& material);

/// From the 0...1 of a display (gamma 2.2) to light and back.
glm::dvec3 to_linear(const glm::dvec3& display);
std::uint32_t to_pixel(const glm::dvec3& linear);

}  // namespace thicket
