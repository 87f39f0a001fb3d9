// Whether points lie inside closed triangles. Not a public header.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace thicket {

/// Of a closed set of triangles, which it refers to. Sorts them into cells of a grid over x and y when it is first asked.
class MeshInside {
 public:
  MeshInside(const std::vector<glm::dvec3>& vertices, const std::vector<glm::uvec3>& triangles)
      : vertices_(&vertices), triangles_(&triangles) {}

  /// By the parity of what lies above the point. A point on a surface may be told either way.
  bool holds(const glm::dvec3& point);

  /// Whether most of a few points of other triangles, spread over them, lie inside: their faces may touch, but not cross.
  bool holds(const std::vector<glm::uvec3>& others);

 private:
  struct Cells {
    std::size_t x0, y0, x1, y1;  ///< inclusive
  };
  Cells cells_of(const glm::uvec3& triangle) const;
  std::size_t cell(double value, int axis) const;
  void sort_into_cells();

  const std::vector<glm::dvec3>* vertices_;
  const std::vector<glm::uvec3>* triangles_;
  glm::dvec2 low_{0.0}, size_{0.0};
  std::size_t side_ = 0;            // cells along each axis; 0: not sorted yet
  std::vector<std::size_t> begin_;  // of each cell in `members_`, and the end
  std::vector<std::uint32_t> members_;
};

}  // namespace thicket
