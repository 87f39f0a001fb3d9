// Maps and meshes that nobody here made, as worlds of their own: read, built and traced, and what the tracer meets compared with what is there.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "../outside_data.hpp"
#include "thicket/base/pose.hpp"
#include "thicket/worlds/scene.hpp"
#include "thicket/worlds/truth.hpp"
#include "thicket/worlds/world.hpp"

using namespace thicket;
namespace fs = std::filesystem;

namespace {

std::optional<World> world_of(const char* name, const MapOptions& options = {}) {
  const auto file = outside_data(name);
  if (!file) {
    MESSAGE("skipped: no outside data");
    return std::nullopt;
  }
  const auto world = read_world(*file, options);
  INFO((world ? "" : world.error().message));
  REQUIRE(static_cast<bool>(world));
  REQUIRE_FALSE(world->solids.empty());
  return *world;
}

/// A place without matter, about the middle of a world, found on a spiral (off the borders of cells).
glm::dvec3 free_place(const World& world, double height) {
  const Bounds box = extent(world).value();
  const glm::dvec3 size = box.high - box.low;
  for (int i = 0; i < 1000; ++i) {
    const double turn = 2.4 * i + 0.7, reach = 0.015 * std::sqrt(i + 0.3);
    const glm::dvec3 p(0.5 * (box.low.x + box.high.x) + reach * size.x * std::cos(turn), 0.5 * (box.low.y + box.high.y) + reach * size.y * std::sin(turn), box.low.z + height * std::max(size.z, 1.0));
    if (!in_matter(world, p)) return p;
  }
  FAIL("there is no free place");
  return {};
}

/// Traces 360 rays, level or up and down by turns, and compares every `every`th with steps along it. Returns how many met something.
int check_rays(const World& world, const glm::dvec3& origin, bool level, int every, double step, double depth) {
  const auto scene = Scene::build(world);
  REQUIRE(static_cast<bool>(scene));
  std::vector<Ray> rays;
  for (int i = 0; i < 360; ++i) {
    const double elevation = level ? 0.0 : 0.4 * (i % 3 - 1), bearing = radians(i + 0.37);
    rays.push_back({origin, {std::cos(bearing) * std::cos(elevation), std::sin(bearing) * std::cos(elevation), std::sin(elevation)}});
  }
  std::vector<Hit> hits(rays.size());
  CHECK(scene->closest_hits(rays, Stops::everything, hits) == 0);
  const Bounds box = extent(world).value();
  const double diagonal = glm::distance(box.low, box.high);
  int met = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Hit& hit = hits[i];
    CAPTURE(i);
    CAPTURE(hit.range);
    const auto at = [&](double range) { return origin + range * rays[i].direction; };
    const double end = std::min(hit.range, diagonal);
    if (hit.range < infinity) {
      ++met;
      CHECK(hit.range > 0.0);
      CHECK(hit.range <= diagonal);
      REQUIRE(hit.solid < world.solids.size());
      CHECK(glm::length(hit.normal) == doctest::Approx(1.0).epsilon(1e-9));
      CHECK(glm::dot(hit.normal, rays[i].direction) <= 1e-9);
    } else {
      CHECK(hit.range == infinity);
      CHECK(hit.solid == no_solid);
    }
    if (i % static_cast<std::size_t>(every) != 0) continue;
    for (double range = 0.0; range < end - 1e-6 * diagonal; range += step) {
      CAPTURE(range);
      const bool early = in_matter(world, at(range));
      CHECK_FALSE(early);
      if (early) break;
    }
    if (hit.range == infinity) continue;
    bool there = false;
    for (const double part : {1e-6, 0.01, 0.25, 0.5, 1.0}) there = there || in_matter(world, at(hit.range + part * depth));
    CHECK_MESSAGE(there, "nothing where the ray met something");
  }
  return met;
}

}  // namespace

TEST_CASE("MovingAI maps of others are traced as they are") {
  for (const char* name : {"64room_000", "Berlin_0_256", "maze-32-32-4", "random-32-32-20", "room-64-64-16", "warehouse-10-20-10-2-1"}) {
    CAPTURE(std::string(name));
    const auto world = world_of(("movingai/" + std::string(name) + ".map").c_str());
    if (!world) return;
    REQUIRE(world->solids.size() == 1);
    CHECK(check_rays(*world, free_place(*world, 0.5), true, 6, 0.125, 1e-3) >= 240);
  }
}

TEST_CASE("map_server maps of others are traced as they are, with the image that is there") {
  for (const char* name : {"aws_small_house", "nav2_TenByTen", "nav2_depot", "turtlebot3_world", "tuw_test04"}) {
    CAPTURE(std::string(name));
    const std::string stem = "ros_maps/" + std::string(name);
    const auto image = outside_data((stem + ".pgm").c_str());
    MapOptions options;
    if (image) options.image = *image;
    const auto world = world_of((stem + ".yaml").c_str(), options);
    if (!world) return;
    REQUIRE(world->solids.size() == 1);
    const double cell = std::get<MapSolid>(world->solids[0].shape).grid.resolution;
    CHECK(check_rays(*world, free_place(*world, 0.5), true, 6, cell / 8.0, 1e-3 * cell) >= 240);
    // The image that each of them names is called otherwise here.
    const auto broken = read_world(*outside_data((stem + ".yaml").c_str()));
    REQUIRE_FALSE(static_cast<bool>(broken));
    CHECK(broken.error().message.find("is beside it: correct the line, or add --map-image") != std::string::npos);
  }
}

TEST_CASE("OBJ files of others are traced as they are") {
  for (const char* name : {"cornell_box", "cornell_box_multimaterial", "floor_1", "wall_1", "stadium", "missing_material_file"}) {
    CAPTURE(std::string(name));
    const auto world = world_of(("obj/" + std::string(name) + ".obj").c_str());
    if (!world) return;
    const Bounds box = extent(*world).value();
    CHECK(check_rays(*world, free_place(*world, 0.45), false, 12, glm::distance(box.low, box.high) / 200.0, 1e-3) >= 1);
    CHECK_FALSE(world->notices.empty());
  }
}
