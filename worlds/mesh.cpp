#include "thicket/worlds/mesh.hpp"

#include <algorithm>
#include <cstring>
#include <unordered_map>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "edges.hpp"
#include "polygon.hpp"

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

}  // namespace

Welded weld(std::span<const glm::dvec3> vertices) {
  Welded welded;
  std::unordered_map<glm::dvec3, std::uint32_t, SamePlace> places;
  places.reserve(vertices.size());
  welded.index.reserve(vertices.size());
  for (const glm::dvec3& vertex : vertices) {
    const glm::dvec3 p = vertex + 0.0;  // -0 and 0 are one place
    const auto [found, added] = places.try_emplace(p, static_cast<std::uint32_t>(welded.vertices.size()));
    if (added) welded.vertices.push_back(p);
    welded.index.push_back(found->second);
  }
  return welded;
}

std::vector<EdgePass> edge_passes(std::span<const glm::uvec3> triangles, std::span<const std::uint32_t> groups) {
  // Counted into place by their smaller ends, since few share one, and sorted only there: several times quicker than sorting millions.
  std::uint32_t last = 0;
  for (const glm::uvec3& t : triangles) last = std::max({last, t.x, t.y, t.z});
  std::vector<std::uint32_t> end(std::size_t{last} + 2, 0);  // of each place; while they are filled, where the next goes
  const auto for_each_pass = [&](auto&& visit) {
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (int i = 0; i < 3; ++i) visit(t, triangles[t][i], triangles[t][(i + 1) % 3]);
  };
  for_each_pass([&](std::size_t, std::uint32_t a, std::uint32_t b) { ++end[std::min(a, b) + 1]; });
  for (std::size_t i = 1; i < end.size(); ++i) end[i] += end[i - 1];
  std::vector<EdgePass> passes(3 * triangles.size());
  for_each_pass([&](std::size_t t, std::uint32_t a, std::uint32_t b) {
    const std::uint64_t edge = (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
    passes[end[std::min(a, b)]++] = {edge, groups.empty() ? 0 : groups[t], static_cast<std::uint32_t>(2 * t + (a < b ? 0 : 1))};
  });
  for (std::size_t i = 0; i <= last; ++i)
    std::sort(passes.begin() + (i == 0 ? 0 : end[i - 1]), passes.begin() + end[i], [](const EdgePass& p, const EdgePass& q) {
      return p.edge != q.edge ? p.edge < q.edge : p.group != q.group ? p.group < q.group : p.code < q.code;
    });
  return passes;
}

bool is_closed(std::span<const glm::uvec3> triangles) {
  if (triangles.empty()) return false;
  bool closed = true;
  for_each_edge(edge_passes(triangles), [&](std::span<const EdgePass> edge) {
    int sum = 0;
    for (const EdgePass& pass : edge) sum += pass.way();
    closed = closed && sum == 0;
  });
  return closed;
}

std::shared_ptr<const Mesh> make_mesh(std::vector<glm::dvec3> vertices, std::vector<glm::uvec3> triangles) {
  auto mesh = std::make_shared<Mesh>();
  Welded welded = weld(vertices);
  mesh->vertices = std::move(welded.vertices);
  const std::vector<std::uint32_t>& index = welded.index;
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

std::shared_ptr<const Mesh> prism_mesh(const std::vector<glm::dvec2>& outline, const std::vector<std::vector<glm::dvec2>>& holes, double height) {
  std::vector<glm::dvec3> vertices;  // the lower and the upper end of each point's edge
  std::vector<glm::uvec3> triangles;
  const auto add_side = [&](const Ring& ring, bool left_is_inside) {
    const auto first = static_cast<std::uint32_t>(vertices.size()), n = static_cast<std::uint32_t>(ring.size());
    for (const glm::dvec2& p : ring) {
      vertices.emplace_back(p, 0.0);
      vertices.emplace_back(p, height);
    }
    for (std::uint32_t i = 0; i < n; ++i) {
      std::uint32_t a = first + 2 * i, b = first + 2 * ((i + 1) % n);
      if (!left_is_inside) std::swap(a, b);
      triangles.emplace_back(a, b, b + 1);
      triangles.emplace_back(a, b + 1, a + 1);
    }
  };
  add_side(outline, counter_clockwise(outline));
  for (const Ring& hole : holes) add_side(hole, !counter_clockwise(hole));
  for (const glm::uvec3& t : triangulate(outline, holes)) {
    triangles.emplace_back(2 * t.z, 2 * t.y, 2 * t.x);
    triangles.emplace_back(2 * t.x + 1, 2 * t.y + 1, 2 * t.z + 1);
  }
  return make_mesh(std::move(vertices), std::move(triangles));
}

}  // namespace thicket
