// A soup of triangles taken apart into what is a volume and what is a sheet. Not a public header.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "thicket/worlds/mesh_file.hpp"

namespace thicket {

struct TriangleSoup {
  std::vector<glm::dvec3> vertices;      ///< none twice
  std::vector<glm::uvec3> triangles;     ///< without equal corners
  std::vector<std::uint32_t> materials;  ///< of each triangle
  std::vector<std::string> names;        ///< of the materials
};

/// As `read_obj` describes it. Notices are sentences that begin with `name`.
std::vector<MeshPiece> take_apart(const TriangleSoup& soup, const std::string& name, std::vector<std::string>& notices);

}  // namespace thicket
