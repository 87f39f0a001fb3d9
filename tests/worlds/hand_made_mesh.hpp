// Meshes that tests build by hand.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "thicket/worlds/mesh.hpp"

namespace thicket {

/// Vertices and triangles before they are a mesh.
struct Soup {
  std::vector<glm::dvec3> vertices;
  std::vector<glm::uvec3> triangles;

  void add(const Soup& other) {
    const auto offset = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const glm::uvec3& t : other.triangles) triangles.push_back(t + offset);
  }
  Soup moved(const glm::dmat3& turn, const glm::dvec3& by, double scale = 1.0) const {
    Soup other = *this;
    for (glm::dvec3& v : other.vertices) v = turn * (scale * v) + by;
    return other;
  }
  Soup flipped() const {
    Soup other = *this;
    for (glm::uvec3& t : other.triangles) std::swap(t.y, t.z);
    return other;
  }
  std::shared_ptr<const Mesh> mesh() const { return make_mesh(vertices, triangles); }
};

/// The area of a mesh, of one side of each triangle.
inline double area(const Mesh& mesh) {
  double sum = 0.0;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a = mesh.vertices[t.x];
    sum += 0.5 * glm::length(glm::cross(mesh.vertices[t.y] - a, mesh.vertices[t.z] - a));
  }
  return sum;
}

/// A box about the origin.
inline Soup box_soup(const glm::dvec3& size) {
  Soup soup;
  for (unsigned i = 0; i < 8; ++i) soup.vertices.push_back(glm::dvec3(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5) * size);
  constexpr std::array<std::array<std::uint32_t, 4>, 6> faces = {{{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (const auto& f : faces) {
    soup.triangles.emplace_back(f[0], f[1], f[2]);
    soup.triangles.emplace_back(f[0], f[2], f[3]);
  }
  return soup;
}

/// A sphere of triangles: an icosahedron, each triangle cut into four `times` times.
inline Soup sphere_soup(double radius, int times) {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  Soup soup;
  soup.vertices = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0}, {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g}, {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  soup.triangles = {{0, 11, 5}, {0, 5, 1}, {0, 1, 7}, {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                    {3, 9, 4}, {3, 4, 2}, {3, 2, 6}, {3, 6, 8}, {3, 8, 9}, {4, 9, 5}, {2, 4, 11}, {6, 2, 10}, {8, 6, 7}, {9, 8, 1}};
  for (int i = 0; i < times; ++i) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [found, added] = middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(soup.vertices.size()));
      if (added) soup.vertices.push_back(0.5 * (soup.vertices[a] + soup.vertices[b]));
      return found->second;
    };
    std::vector<glm::uvec3> finer;
    for (const glm::uvec3& t : soup.triangles) {
      const std::uint32_t a = middle(t.x, t.y), b = middle(t.y, t.z), c = middle(t.z, t.x);
      finer.insert(finer.end(), {{t.x, a, c}, {t.y, b, a}, {t.z, c, b}, {a, b, c}});
    }
    soup.triangles = std::move(finer);
    for (glm::dvec3& v : soup.vertices) v = glm::normalize(v);
  }
  for (glm::dvec3& v : soup.vertices) v = radius * glm::normalize(v);
  return soup;
}

}  // namespace thicket
