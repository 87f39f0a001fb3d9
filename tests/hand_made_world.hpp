// Worlds that tests build by hand, and dice whose throws are the same on every machine.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "thicket/base/pose.hpp"
#include "thicket/worlds/scene.hpp"
#include "thicket/worlds/world.hpp"

namespace thicket {

/// A world under construction: first materials, then solids of them.
struct HandMadeWorld {
  World world;

  std::uint32_t material(std::string name, double reflectivity, double attenuation_db_per_m, bool stops_light = true,
                         bool stops_motion = true) {
    world.materials.push_back({std::move(name), reflectivity, attenuation_db_per_m, 1.0, stops_light, stops_motion});
    return static_cast<std::uint32_t>(world.materials.size() - 1);
  }
  /// Returns the solid's index. Without a material of its own yet, the world gets an opaque one.
  std::uint32_t add(Shape shape, const glm::dvec3& position, double yaw = 0.0, std::uint32_t material_index = 0) {
    if (world.materials.empty()) material("stuff", 0.5, infinity);
    const auto index = static_cast<std::uint32_t>(world.solids.size());
    world.solids.push_back({"solid " + std::to_string(index), material_index, position, yaw, std::move(shape)});
    return index;
  }
};

inline Scene traced(World world) {
  auto scene = Scene::build(std::move(world));
  REQUIRE_MESSAGE(static_cast<bool>(scene), (scene ? "" : scene.error().message));
  return std::move(*scene);
}
inline Scene traced(HandMadeWorld hand_made) {
  return traced(std::move(hand_made.world));
}

/// A map of one character a cell, the top row first: '#' occupied, '?' unknown, anything else free. Blocks are merged.
inline MapSolid map_of(const std::vector<std::string>& rows, double resolution, double height = 2.5, bool unknown_is_matter = true) {
  MapSolid map;
  map.grid.height = static_cast<int>(rows.size());
  map.grid.width = static_cast<int>(rows.at(0).size());
  map.grid.resolution = resolution;
  map.height = height;
  map.unknown_is_matter = unknown_is_matter;
  for (auto row = rows.rbegin(); row != rows.rend(); ++row)
    for (const char letter : *row)
      map.grid.cells.push_back(letter == '#' ? CellState::occupied : letter == '?' ? CellState::unknown : CellState::free);
  map.blocks = merge_cells(map);
  return map;
}

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}

  double between(double low, double high) { return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53; }
  /// 0 ... count - 1
  std::uint32_t pick(std::uint32_t count) { return static_cast<std::uint32_t>((engine_() >> 32) * count >> 32); }
  bool chance(double probability) { return between(0.0, 1.0) < probability; }
  glm::dvec2 point(const glm::dvec2& low, const glm::dvec2& high) {
    const double x = between(low.x, high.x);
    return {x, between(low.y, high.y)};
  }
  glm::dvec3 point(const glm::dvec3& low, const glm::dvec3& high) {
    const glm::dvec2 plan = point(glm::dvec2(low), glm::dvec2(high));
    return {plan, between(low.z, high.z)};
  }
  /// Uniform on the unit sphere (Archimedes: the height is uniform).
  glm::dvec3 direction() {
    const double z = between(-1.0, 1.0), bearing = between(-pi, pi), r = std::sqrt(1.0 - z * z);
    return glm::normalize(glm::dvec3(r * std::cos(bearing), r * std::sin(bearing), z));
  }
  std::mt19937_64& engine() { return engine_; }

 private:
  std::mt19937_64 engine_;
};

}  // namespace thicket
