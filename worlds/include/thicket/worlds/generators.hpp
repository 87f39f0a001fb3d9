// Foliage, so that a scene can have real leaves instead of spheres.
#pragma once

#include <cstdint>
#include <memory>

#include <glm/vec3.hpp>

#include "thicket/worlds/mesh.hpp"

namespace thicket {

/// Lengths in metres, all > 0 (`crown_base` >= 0 and < `height`); counts from 0 to 10^7. The crown is the ellipsoid between `crown_base`
/// and `height`.
struct TreeSpec {
  double height = 5.0, trunk_radius = 0.1, crown_radius = 1.5, crown_base = 1.5;
  int branches = 40;
  int leaves = 4000;
  double leaf_size = 0.08;  ///< length of a leaf; its width is 0.6 of it
  std::int64_t seed = 1;
};

/// Lengths in metres, > 0; at most 10^7 leaves in all.
struct HedgeSpec {
  glm::dvec3 size{2.0, 0.6, 1.5};
  double leaves_per_m3 = 2000.0, leaf_size = 0.05;
  int stems = 12;
  double stem_radius = 0.01;
  std::int64_t seed = 1;
};

struct Foliage {
  std::shared_ptr<const Mesh> wood;    ///< closed: tapered prisms, which overlap where a branch leaves the trunk
  std::shared_ptr<const Mesh> leaves;  ///< open: two triangles each, a kite
};

/// The area of one side of a leaf, m^2: a kite as long as `leaf_size` and 0.6 of it wide.
constexpr double leaf_area(double leaf_size) {
  return 0.3 * leaf_size * leaf_size;
}

// Leaves are inclined as the surface of a sphere is (the "spherical" distribution that most trees and shrubs come close to: Ross 1981, "The
// radiation regime and architecture of plant stands"): all directions of their normals are equally likely, and seen from anywhere a leaf
// shows half of its area on average (G = 0.5).
//
// The leaf area density is leaves x leaf_area / volume: 0.47 m^2/m^3 in the crown of the default tree (a loose crown; dense ones have 1 to
// 2), and leaves_per_m3 x leaf_area = 1.5 m^2/m^3 in the default hedge.
//
// Both are functions of their argument alone, bit for bit, on every machine: they take no more of the mathematical library than the square
// root.

/// A tree that stands on z = 0 at the origin: a tapering trunk, branches that leave it at steps of the golden angle, steeper the higher
/// they leave and as long as the crown is wide there, and leaves about their outer parts. Every leaf begins within the crown.
Foliage grow_tree(const TreeSpec& spec);

/// A hedge that fills a box evenly with leaves, centred in x and y, on z = 0; every leaf lies within the box if it is no smaller than a
/// leaf. Its stems stand in a row along x.
Foliage grow_hedge(const HedgeSpec& spec);

}  // namespace thicket
