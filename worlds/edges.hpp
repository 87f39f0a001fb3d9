// How the triangles of a mesh hang together. Not a public header.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace thicket {

/// Points without repetition, and for each of the given ones which of them it is. Two are the same if their coordinates are equal.
struct Welded {
  std::vector<glm::dvec3> vertices;
  std::vector<std::uint32_t> index;
};
Welded weld(std::span<const glm::dvec3> vertices);

/// One of a triangle's passages along an edge.
struct EdgePass {
  std::uint64_t edge;   ///< its ends, the smaller index in the upper half
  std::uint32_t group;  ///< the triangle's
  std::uint32_t code;   ///< twice the triangle's index, plus 1 if it runs from the larger index to the smaller

  std::uint32_t triangle() const { return code >> 1; }
  int way() const { return (code & 1u) != 0 ? -1 : 1; }
};

/// All passages, sorted by edge, group and triangle. `groups` has a number per triangle, or is empty for all 0. Fewer than 2^31 triangles.
std::vector<EdgePass> edge_passes(std::span<const glm::uvec3> triangles, std::span<const std::uint32_t> groups = {});

/// Calls `visit` with each run of passages along one edge in one group.
template <class Visit>
void for_each_edge(std::span<const EdgePass> passes, Visit&& visit) {
  for (std::size_t i = 0; i < passes.size();) {
    std::size_t end = i + 1;
    while (end < passes.size() && passes[end].edge == passes[i].edge && passes[end].group == passes[i].group) ++end;
    visit(passes.subspan(i, end - i));
    i = end;
  }
}

/// Whether every edge is passed as often one way as the other: then the triangles bound a volume, and a line enters it as often as it
/// leaves.
bool is_closed(std::span<const glm::uvec3> triangles);

}  // namespace thicket
