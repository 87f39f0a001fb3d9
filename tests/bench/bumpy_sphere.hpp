// A closed mesh of any number of triangles.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "thicket/base/pose.hpp"
#include "thicket/worlds/world.hpp"

namespace thicket::bench {

using SharedMesh = std::shared_ptr<const Mesh>;

/// A closed mesh of 2 `around` (`rings` - 1) triangles: a sphere of radius 1 m with bumps.
inline SharedMesh bumpy_sphere(std::uint32_t around, std::uint32_t rings) {
  std::vector<glm::dvec3> vertices = {{0.0, 0.0, -1.0}};
  std::vector<glm::uvec3> triangles;
  const auto at = [&](std::uint32_t ring, std::uint32_t i) { return 1 + (ring - 1) * around + i % around; };
  for (std::uint32_t ring = 1; ring < rings; ++ring) {
    for (std::uint32_t i = 0; i < around; ++i) {
      const double u = 2.0 * pi * i / around, v = pi * ring / rings - 0.5 * pi, radius = 1.0 + 0.05 * std::sin(9.0 * u) * std::cos(7.0 * v);
      vertices.push_back(radius * glm::dvec3(std::cos(u) * std::cos(v), std::sin(u) * std::cos(v), std::sin(v)));
    }
  }
  vertices.emplace_back(0.0, 0.0, 1.0);
  const auto top = static_cast<std::uint32_t>(vertices.size() - 1);
  for (std::uint32_t i = 0; i < around; ++i) {
    triangles.emplace_back(0, at(1, i + 1), at(1, i));
    for (std::uint32_t ring = 1; ring + 1 < rings; ++ring) {
      triangles.emplace_back(at(ring, i), at(ring, i + 1), at(ring + 1, i + 1));
      triangles.emplace_back(at(ring, i), at(ring + 1, i + 1), at(ring + 1, i));
    }
    triangles.emplace_back(at(rings - 1, i), at(rings - 1, i + 1), top);
  }
  return make_mesh(std::move(vertices), std::move(triangles));
}

}  // namespace thicket::bench
