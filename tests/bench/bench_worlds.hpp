// What the measurements share: worlds, rays, and how a figure is stated.
#pragma once

#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "or_exit.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/pose.hpp"
#include "thicket/sim/simulation.hpp"
#include "thicket/worlds/generators.hpp"
#include "thicket/worlds/scene.hpp"
#include "thicket/worlds/world.hpp"

namespace thicket::bench {

// One a file, called by main.
void register_scene();
void register_radar();
void register_lobes();
void register_nav();
void register_mapping();
void register_sar();
void register_snapshots();
void register_missions();
void register_worlds();

/// `name` is room/what/.../peer.
template <class Work>
benchmark::internal::Benchmark* measure(const std::string& name, Work work) {
  return benchmark::RegisterBenchmark(name.c_str(), std::move(work));
}

/// States a measurement as nanoseconds per item, `items` being worked on in every iteration.
inline void per_item(benchmark::State& state, const std::string& item, double items) {
  state.counters["ns per " + item] = benchmark::Counter(items * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// Numbers that are the same on every machine.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  double between(double low, double high) { return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 engine_;
};

constexpr std::uint32_t concrete = 0, foliage = 1;

inline World empty_world() {
  World world;
  world.materials.push_back({"concrete", 0.5, infinity, 1.0, true, true});
  world.materials.push_back({"foliage", 0.05, 7.5, 1.0, true, true});
  return world;
}
inline void add(World& world, Shape shape, const glm::dvec3& position, double yaw = 0.0, std::uint32_t material = concrete) {
  world.solids.push_back({"solid " + std::to_string(world.solids.size()), material, position, yaw, std::move(shape)});
}

/// Floor, ceiling and four walls of 20 x 20 x 3 m inside, centred on the origin, the floor's top at z = 0.
inline void add_room(World& world) {
  add(world, Box{{20.4, 20.4, 0.2}}, {0.0, 0.0, -0.1});
  add(world, Box{{20.4, 20.4, 0.2}}, {0.0, 0.0, 3.1});
  for (const double side : {-10.1, 10.1}) {
    add(world, Box{{0.2, 20.4, 3.0}}, {side, 0.0, 1.5});
    add(world, Box{{20.0, 0.2, 3.0}}, {0.0, side, 1.5});
  }
}

/// A place in the room that leaves 1.5 m about its middle, where the sensor stands, free.
inline glm::dvec2 place_in_room(Dice& dice) {
  for (;;) {
    const double x = dice.between(-9.5, 9.5), y = dice.between(-9.5, 9.5);
    if (std::hypot(x, y) > 1.5) return {x, y};
  }
}

/// A room with 200 boxes that stand on its floor.
inline World box_room() {
  World world = empty_world();
  add_room(world);
  Dice dice(1);
  for (int i = 0; i < 200; ++i) {
    const glm::dvec2 at = place_in_room(dice);
    const double height = dice.between(0.2, 2.5);
    add(world, Box{{dice.between(0.1, 0.8), dice.between(0.1, 0.8), height}}, {at.x, at.y, 0.5 * height}, dice.between(-pi, pi));
  }
  return world;
}

/// 100 spheres in the open.
inline World sphere_field() {
  World world = empty_world();
  Dice dice(2);
  for (int i = 0; i < 100; ++i) {
    const glm::dvec2 at = place_in_room(dice);
    add(world, Sphere{dice.between(0.2, 0.8)}, {at.x, at.y, dice.between(0.0, 2.0)});
  }
  return world;
}

/// 80 bushes that overlap, in a room.
inline World thicket_room() {
  World world = empty_world();
  add_room(world);
  Dice dice(3);
  for (int i = 0; i < 80; ++i) {
    const glm::dvec2 at = place_in_room(dice);
    add(world, Sphere{dice.between(0.3, 1.2)}, {at.x, at.y, dice.between(0.3, 1.0)}, 0.0, foliage);
  }
  return world;
}

/// Trees of some 4000 leaves each, as meshes.
inline World leafy_thicket(int trees, double half_width) {
  World world = empty_world();
  const Foliage tree = grow_tree({});
  Dice dice(7);
  for (int i = 0; i < trees; ++i) {
    const double x = dice.between(-half_width, half_width), y = dice.between(-half_width, half_width), yaw = dice.between(-pi, pi);
    add(world, MeshSolid{tree.wood}, {x, y, -2.5}, yaw);
    add(world, MeshSolid{tree.leaves}, {x, y, -2.5}, yaw, foliage);
  }
  return world;
}

/// What a mapper leaves of an office of 20 x 15 m at 0.05 m, as in the maps that come with nav2: unknown outside, ragged walls with doors, shelves,
/// and specks of one cell. Centred on the origin.
inline World office_map() {
  MapSolid map;
  map.grid.width = 400;
  map.grid.height = 300;
  map.grid.resolution = 0.05;
  map.grid.cells.assign(400 * 300, CellState::unknown);
  Dice dice(4);
  const auto fill = [&](int column, int row, int columns, int rows, CellState state) {
    for (int y = row; y < row + rows; ++y)
      for (int x = column; x < column + columns; ++x) map.grid.cells[static_cast<std::size_t>(y * map.grid.width + x)] = state;
  };
  fill(20, 20, 360, 260, CellState::free);
  // A wall is two cells thick; each of its cells has a chance of a bump on either side.
  const auto wall = [&](int column, int row, int length, bool along_x) {
    for (int i = 0; i < length; ++i) {
      const int low = dice.between(0.0, 1.0) < 0.15 ? 1 : 0, high = dice.between(0.0, 1.0) < 0.15 ? 1 : 0;
      if (along_x) fill(column + i, row - low, 1, 2 + low + high, CellState::occupied);
      else fill(column - low, row + i, 2 + low + high, 1, CellState::occupied);
    }
  };
  wall(20, 20, 360, true);
  wall(20, 278, 360, true);
  wall(20, 20, 260, false);
  wall(378, 20, 260, false);
  for (int room = 0; room < 4; ++room) {  // four rooms on either side of a corridor, a door each
    const int column = 20 + 90 * room;
    for (const int row : {120, 180}) {
      wall(column, row, 30, true);
      wall(column + 50, row, 40, true);
    }
    if (room == 0) continue;
    wall(column, 20, 100, false);
    wall(column, 180, 100, false);
  }
  for (int shelf = 0; shelf < 16; ++shelf) fill(40 + 22 * shelf, shelf % 2 ? 50 : 220, 8, 30, CellState::occupied);
  for (int speck = 0; speck < 250; ++speck) {
    const int column = static_cast<int>(dice.between(25.0, 375.0)), row = static_cast<int>(dice.between(25.0, 275.0));
    if (std::hypot(column - 200.0, row - 150.0) > 15.0) fill(column, row, 1, 1, CellState::occupied);
  }
  map.blocks = merge_cells(map);
  World world = empty_world();
  add(world, std::move(map), {-10.0, -7.5, 0.0});
  return world;
}

constexpr double sensor_height = 0.5;

/// 58 x 58 rays in an opening of 65 degrees both ways: the lobe that was too much for the simulator of Billdal 2018.
inline std::vector<Ray> fan() {
  std::vector<Ray> rays;
  for (int row = 0; row < 58; ++row) {
    for (int column = 0; column < 58; ++column) {
      const double elevation = radians(-32.5 + 65.0 * row / 57.0), azimuth = radians(-32.5 + 65.0 * column / 57.0);
      const double c = std::cos(elevation);
      rays.push_back({{0.0, 0.0, sensor_height}, {c * std::cos(azimuth), c * std::sin(azimuth), std::sin(elevation)}, infinity});
    }
  }
  return rays;
}

/// A full horizontal circle, a degree apart.
inline std::vector<Ray> circle() {
  std::vector<Ray> rays;
  for (int i = 0; i < 360; ++i) {
    const double azimuth = radians(i - 180.0);
    rays.push_back({{0.0, 0.0, sensor_height}, {std::cos(azimuth), std::sin(azimuth), 0.0}, infinity});
  }
  return rays;
}

/// Scans of a sensor from a platform that stands still, one after another, on so many threads; stated per item, of which a scan has `items`.
inline void scans(benchmark::State& state, const Scene& scene, const SensorSpec& spec, const Pose& from, std::size_t threads, const std::string& item, double items) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
  const auto sensor = make_sensor(spec, 0);
  const Random random(1, 0);
  Scan scan;
  std::uint64_t number = 0;
  for (auto _ : state) {
    sensor->measure(scene, from, 0.0, number++, random, scan);
    benchmark::DoNotOptimize(scan.echoes.data());
    benchmark::ClobberMemory();
  }
  per_item(state, item, items);
}

inline Scene shipped_scene(const char* world) { return or_exit(Scene::build(or_exit(read_world(find_input(world))))); }
inline Mission shipped_mission(const char* mission, const std::vector<Override>& changes = {}) { return or_exit(read_mission(find_input(mission), changes)); }

}  // namespace thicket::bench
