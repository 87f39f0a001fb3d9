#include "thicket/worlds/mesh.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <unordered_map>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace thicket {
namespace {

struct SamePlace {
  std::size_t operator()(const glm::dvec3& p) const {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (int i = 0; i < 3; ++i) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &p[i], sizeof bits);
      hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 29;
    }
    return static_cast<std::size_t>(hash);
  }
};

/// Whether every edge is passed as often one way as the other: then the triangles bound a volume, and a line enters it as often as it leaves.
bool is_closed(const std::vector<glm::uvec3>& triangles) {
  if (triangles.empty()) return false;
  // (edge, +1 or -1), sorted: quicker than a hash table for millions.
  struct Pass {
    std::uint64_t edge;
    int way;
  };
  std::vector<Pass> passes;
  passes.reserve(3 * triangles.size());
  for (const glm::uvec3& t : triangles)
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      passes.push_back({(std::uint64_t{std::min(a, b)} << 32) | std::max(a, b), a < b ? 1 : -1});
    }
  std::sort(passes.begin(), passes.end(), [](const Pass& p, const Pass& q) { return p.edge < q.edge; });
  for (std::size_t i = 0; i < passes.size();) {
    const std::uint64_t edge = passes[i].edge;
    int sum = 0;
    for (; i < passes.size() && passes[i].edge == edge; ++i) sum += passes[i].way;
    if (sum != 0) return false;
  }
  return true;
}

}  // namespace

std::shared_ptr<const Mesh> make_mesh(std::vector<glm::dvec3> vertices, std::vector<glm::uvec3> triangles) {
  auto mesh = std::make_shared<Mesh>();
  std::unordered_map<glm::dvec3, std::uint32_t, SamePlace> places;
  places.reserve(vertices.size());
  std::vector<std::uint32_t> index(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const glm::dvec3 p = vertices[i] + 0.0;  // -0 and 0 are one place
    const auto [found, added] = places.try_emplace(p, static_cast<std::uint32_t>(mesh->vertices.size()));
    if (added) mesh->vertices.push_back(p);
    index[i] = found->second;
  }
  mesh->triangles.reserve(triangles.size());
  for (const glm::uvec3& t : triangles) {
    const glm::uvec3 u(index[t.x], index[t.y], index[t.z]);
    if (u.x == u.y || u.y == u.z || u.z == u.x) continue;
    mesh->triangles.push_back(u);
  }
  mesh->closed = is_closed(mesh->triangles);
  if (!mesh->triangles.empty()) {
    mesh->low = mesh->high = mesh->vertices[mesh->triangles.front().x];
    for (const glm::uvec3& t : mesh->triangles)
      for (int i = 0; i < 3; ++i) {
        mesh->low = glm::min(mesh->low, mesh->vertices[t[i]]);
        mesh->high = glm::max(mesh->high, mesh->vertices[t[i]]);
      }
  }
  return mesh;
}

double signed_volume(const Mesh& mesh) {
  const glm::dvec3 middle = 0.5 * (mesh.low + mesh.high);
  double six = 0.0;
  for (const glm::uvec3& t : mesh.triangles)
    six += glm::dot(mesh.vertices[t.x] - middle, glm::cross(mesh.vertices[t.y] - middle, mesh.vertices[t.z] - middle));
  return six / 6.0;
}

}  // namespace thicket
