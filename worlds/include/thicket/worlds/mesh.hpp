// Triangle meshes: what CAD programs export, and what the generators make.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace thicket {

/// A triangle mesh in its own frame, metres. Immutable once made, so that many solids can share it.
struct Mesh {
  std::vector<glm::dvec3> vertices;    ///< finite
  std::vector<glm::uvec3> triangles;   ///< indices of vertices, counter-clockwise seen from outside; none has two equal corners
  bool closed = false;                 ///< a volume: every edge is passed as often one way as the other. Otherwise a thin sheet.
  glm::dvec3 low{0.0}, high{0.0};      ///< the box that holds the triangles
};

/// Takes the vertices and triangles as they are and finds `closed` and the box. Vertices at the same place (bit for bit) become one, triangles with two equal corners go.
std::shared_ptr<const Mesh> make_mesh(std::vector<glm::dvec3> vertices, std::vector<glm::uvec3> triangles);

/// The volume that the mesh holds, m^3; negative if its triangles face inward. By the divergence theorem.
double signed_volume(const Mesh& mesh);

/// A polygon, possibly with holes, extruded from z = 0 to `height` (m, > 0): closed and facing outward, whichever way the rings run. They are simple, and the
/// holes lie inside the outline and meet nothing.
std::shared_ptr<const Mesh> prism_mesh(const std::vector<glm::dvec2>& outline, const std::vector<std::vector<glm::dvec2>>& holes, double height);

}  // namespace thicket
