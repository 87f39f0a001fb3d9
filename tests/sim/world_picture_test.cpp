#include <doctest/doctest.h>
#include <tbb/global_control.h>

#include <cstdlib>
#include <limits>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "temporary_folder.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/image.hpp"
#include "thicket/sim/world_picture.hpp"

namespace thicket {
namespace {

World world_of(const std::string& material, Shape shape, const glm::dvec3& position = glm::dvec3(0.0)) {
  World world;
  world.name = "test";
  world.materials.emplace_back().name = material;
  world.solids.push_back({"thing", 0, position, 0.0, std::move(shape)});
  return world;
}

Scene scene_of(World world) {
  auto scene = Scene::build(std::move(world));
  REQUIRE(scene);
  return *scene;
}

/// Looks north at the origin, from 10 m away, at its own height.
PictureView level() {
  PictureView view;
  view.from = glm::dvec3(0.0, -10.0, 0.0);
  view.at = glm::dvec3(0.0);
  view.fov_deg = 40.0;
  view.width = 80;
  view.height = 60;
  return view;
}

GreyImage drawn(const Scene& scene, const PictureView& view, const TemporaryFolder& folder) {
  const auto file = folder.path() / "picture.png";
  const auto done = draw_world(scene, view, file);
  REQUIRE_MESSAGE(static_cast<bool>(done), (done ? "" : done.error().message));
  const auto image = read_image(file);
  REQUIRE(image);
  return *image;
}

}  // namespace

TEST_CASE("a picture shows a box where it is, and the sky elsewhere") {
  const TemporaryFolder folder;
  const GreyImage image = drawn(scene_of(world_of("black_paint", Box{{2.0, 2.0, 2.0}})), level(), folder);
  CHECK(image.width == 80);
  CHECK(image.height == 60);
  // Its front is 2 m wide and 9 m away: 2 / (2 * 9 * tan 20) = 0.305 of the width, 24.4 pixels.
  int dark = 0;
  for (int column = 0; column < 80; ++column) {
    dark += image.at(column, 30) < 100 ? 1 : 0;
    CHECK(image.at(column, 1) > 180);
    CHECK(image.at(column, 58) > 180);
  }
  CHECK(dark == 24);
  CHECK(image.at(28, 30) < 100);
  CHECK(image.at(51, 30) < 100);
}

TEST_CASE("the same picture has the same bytes, with one thread and with all") {
  const TemporaryFolder folder;
  World world = world_of("wood", Sphere{1.0});
  world.materials.emplace_back().name = "smoke";
  world.materials[1].stops_motion = false;
  world.solids.push_back({"cloud", 1, {0.5, -1.0, 0.5}, 0.0, Sphere{0.8}});
  const Scene scene = scene_of(std::move(world));
  REQUIRE(draw_world(scene, level(), folder.path() / "a.png"));
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    REQUIRE(draw_world(scene, level(), folder.path() / "b.png"));
  }
  CHECK(*read_text_file(folder.path() / "a.png") == *read_text_file(folder.path() / "b.png"));
}

TEST_CASE("a picture shows through what robots or light pass") {
  const TemporaryFolder folder;
  const int wall = drawn(scene_of(world_of("black_paint", Box{{9.0, 0.1, 9.0}})), level(), folder).at(40, 30);
  for (const char* name : {"smoke", "glass"}) {
    CAPTURE(name);
    World world = world_of("black_paint", Box{{9.0, 0.1, 9.0}});
    Material& veil = world.materials.emplace_back();
    veil.name = name;
    if (veil.name == "smoke") {
      veil.stops_motion = false;
      veil.light_extinction_per_m = 0.2;
    } else {
      veil.stops_light = false;
    }
    world.solids.push_back({"veil", 1, {0.0, -3.0, 0.0}, 0.0, Box{{1.0, 1.0, 1.0}}});
    const GreyImage image = drawn(scene_of(world), level(), folder);
    CHECK(image.at(40, 30) > wall + 15);   // some of the veil
    CHECK(image.at(40, 30) < 160);         // and much of what is behind it
    CHECK(std::abs(image.at(70, 30) - wall) <= 12);
  }
}

TEST_CASE("a picture without a camera holds the whole world, and leaves out the ceiling") {
  World world = world_of("wood", Box{{6.0, 2.0, 1.0}}, {100.0, 50.0, 0.5});
  world.solids.push_back({"ceiling", 0, {100.0, 50.0, 3.0}, 0.0, Box{{60.0, 60.0, 0.2}}});
  const PictureView view = fitted(world, {});
  REQUIRE(view.from);
  CHECK(view.from->x < 97.0);
  CHECK(view.from->y < 49.0);
  CHECK(view.from->z > 3.5);
  CHECK(glm::distance(*view.at, glm::dvec3(100.0, 50.0, 0.5)) < 1.0);
  PictureView aimed;
  aimed.at = glm::dvec3(99.0, 50.0, 0.0);
  CHECK(*fitted(world, aimed).at == *aimed.at);
  CHECK(glm::distance(*view.from, *view.at) < 20.0);

  const TemporaryFolder folder;
  const Scene scene = scene_of(world);
  PictureView small;
  small.width = 48;
  small.height = 30;
  const GreyImage above = drawn(scene, small, folder);
  CHECK(above.at(24, 15) < 150);  // the box
  CHECK(above.at(1, 1) > 180);    // the sky, where the ceiling would be
  small.hide = {"thing"};
  CHECK(drawn(scene, small, folder).at(24, 15) > 180);
}

TEST_CASE("a picture shows moving solids where they are at the scene's time") {
  World world = world_of("black_paint", Box{{2.0, 2.0, 2.0}});
  Motion motion;
  motion.points = {{0.0, 0.0, 0.0}, {70.0, 70.0, 0.0}};
  world.solids[0].motion = std::make_shared<const Motion>(motion);
  Scene scene = scene_of(std::move(world));
  const TemporaryFolder folder;
  CHECK(drawn(scene, level(), folder).at(40, 30) < 100);
  scene.set_time(30.0);
  CHECK(drawn(scene, level(), folder).at(40, 30) > 180);
}

TEST_CASE("a picture that cannot be drawn is refused in words") {
  const TemporaryFolder folder;
  const Scene scene = scene_of(world_of("wood", Sphere{1.0}));
  const auto refused = [&](const PictureView& view, const char* words) {
    const auto drawn = draw_world(scene, view, folder.path() / "p.png");
    REQUIRE_FALSE(drawn);
    CHECK_MESSAGE(drawn.error().message.find(words) != std::string::npos, drawn.error().message);
  };
  PictureView view = level();
  view.fov_deg = 180.0;
  refused(view, "expected 1 to 150");
  view = level();
  view.width = 0;
  refused(view, "expected 1 to 8192");
  view = level();
  view.at = view.from;
  refused(view, "expected two different points");
  view = level();
  view.from->x = std::numeric_limits<double>::quiet_NaN();
  refused(view, "expected finite metres");
  view = level();
  view.hide = {"thin"};
  refused(view, "there is no solid 'thin' to hide");
  CHECK_FALSE(std::filesystem::exists(folder.path() / "p.png"));
}

TEST_CASE("pixels: the solid's colour and its distance in the middle, sky and no distance elsewhere") {
  const Scene scene = scene_of(world_of("red_paint", Box{{2.0, 2.0, 2.0}}));
  PictureView view = level();
  view.width = 81;
  view.height = 61;
  for (const int samples : {1, 4}) {
    CAPTURE(samples);
    std::vector<std::uint32_t> pixels;
    std::vector<float> depth;
    REQUIRE(draw_world_pixels(scene, view, samples, pixels, &depth));
    REQUIRE(pixels.size() == 81 * 61);
    const std::size_t middle = 30 * 81 + 40, corner = 0;
    const auto channel = [&](std::size_t pixel, int shift) { return static_cast<int>(pixels[pixel] >> shift & 255u); };
    CHECK(2 * channel(middle, 16) > 3 * channel(middle, 0));
    CHECK(2 * channel(middle, 16) > 3 * channel(middle, 8));
    CHECK(channel(corner, 0) >= channel(corner, 16));
    CHECK(depth[middle] == doctest::Approx(9.0).epsilon(1e-6));
    CHECK(depth[corner] == std::numeric_limits<float>::infinity());
    // Ten columns from the middle: the ray of that pixel, to the front at y = -1.
    const PictureCamera camera(view);
    const glm::dvec3 ray = camera.direction(2.0 * 50.5 / 81.0 - 1.0, 0.0);
    CHECK(depth[middle + 10] == doctest::Approx(9.0 / ray.y).epsilon(1e-6));
  }
  std::vector<std::uint32_t> pixels;
  CHECK_FALSE(draw_world_pixels(scene, view, 3, pixels));
}

TEST_CASE("a camera sees points where its rays go") {
  PictureView view = level();
  view.from = glm::dvec3(3.0, -7.0, 4.0);
  const PictureCamera camera(view);
  const glm::dvec3 seen = camera.seen(*view.from + 5.0 * camera.direction(0.3, -0.8));
  CHECK(seen.x == doctest::Approx(0.3));
  CHECK(seen.y == doctest::Approx(-0.8));
  CHECK(camera.seen(*view.at).z == doctest::Approx(glm::distance(*view.from, *view.at)));
}

}  // namespace thicket
