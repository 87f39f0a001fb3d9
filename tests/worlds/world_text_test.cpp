// Worlds as text: what is written reads back as the same world.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "temporary_folder.hpp"
#include "thicket/base/pose.hpp"
#include "thicket/worlds/world_text.hpp"

namespace thicket {
namespace {

World read_back(const World& world) {
  const TemporaryFolder folder;
  const auto text = write_world(world);
  REQUIRE_MESSAGE(text, text.error().message);
  auto read = read_world(folder.write("world.toml", *text));
  REQUIRE_MESSAGE(read, (*text + read.error().message));
  CHECK(*write_world(*read) == *text);
  return *read;
}

Solid solid(const char* name, std::uint32_t material, Shape shape) {
  Solid made;
  made.name = name;
  made.material = material;
  made.position = {1.0 / 3.0, -2e-7, 12345678.901234567};
  made.shape = std::move(shape);
  return made;
}

Material material(const char* name) {
  Material made;
  made.name = name;
  return made;
}

World world_of(Shape shape) {
  World world;
  world.materials = {material("wall")};
  world.solids = {solid("thing", 0, std::move(shape))};
  return world;
}

const Prism triangle_with_a_hole = {{{0.0, 0.0}, {3.0, 0.1}, {0.1, 3.0}}, {{{0.5, 0.5}, {1.0, 0.5}, {0.5, 1.0 / 3.0 + 0.7}}}, 1.7};

}  // namespace

TEST_CASE("world text: shapes come back to the bits of their numbers") {
  World world;
  world.name = "a \"name\" with \\ and\na new line";
  world.source = "measured";
  world.bounds = glm::dvec4(-1.0 / 3.0, -2.0, 3.5, 4.0);
  world.materials = {material("wall"), material("dense bush.1")};
  world.solids = {solid("box", 0, Box{{0.1, 0.2, 1.0 / 7.0}}), solid("sphere", 1, Sphere{std::nextafter(0.3, 1.0)}), solid("cylinder", 0, Cylinder{1e-5, 0.7}),
                  solid("wall", 1, Wall{{{0.0, 0.1}, {1.0 / 3.0, -5.5}, {2.0, 2.0}}, 0.013, 3.3}), solid("prism", 0, triangle_with_a_hole)};
  const World read = read_back(world);
  CHECK(read.name == world.name);
  CHECK(read.source == world.source);
  CHECK(read.bounds == world.bounds);
  REQUIRE(read.materials.size() == 2);
  CHECK(read.materials[1].name == "dense bush.1");
  REQUIRE(read.solids.size() == 5);
  for (std::size_t i = 0; i < 5; ++i) {
    CHECK(read.solids[i].name == world.solids[i].name);
    CHECK(read.solids[i].material == world.solids[i].material);
    CHECK(read.solids[i].position == world.solids[i].position);
    CHECK(read.solids[i].motion == nullptr);
  }
  CHECK(std::get<Box>(read.solids[0].shape).size == std::get<Box>(world.solids[0].shape).size);
  CHECK(std::get<Sphere>(read.solids[1].shape).radius == std::nextafter(0.3, 1.0));
  CHECK(std::get<Cylinder>(read.solids[2].shape).radius == 1e-5);
  CHECK(std::get<Cylinder>(read.solids[2].shape).height == 0.7);
  const Wall& wall = std::get<Wall>(read.solids[3].shape);
  CHECK(wall.points == std::get<Wall>(world.solids[3].shape).points);
  CHECK(wall.thickness == 0.013);
  CHECK(wall.height == 3.3);
  const Prism& prism = std::get<Prism>(read.solids[4].shape);
  CHECK(prism.outline == triangle_with_a_hole.outline);
  CHECK(prism.holes == triangle_with_a_hole.holes);
  CHECK(prism.height == 1.7);
}

TEST_CASE("world text: all that a material has comes back") {
  World world = world_of(Box{});
  Material& plain = world.materials[0];
  plain.reflectivity = 0.1234567890123456789;
  plain.attenuation_db_per_m = 17.25;
  plain.attenuation_exponent = 0.7;
  plain.roughness = 0.0;
  plain.stops_light = false;
  plain.stops_motion = false;
  plain.light_extinction_per_m = 0.31;
  plain.leaves_per_m = 2.5;
  plain.source = "nowhere";
  world.materials.push_back(material("opaque"));
  Material wood = material("wood");
  wood.dielectric = {1.99, 0.01, 0.0047, 1.0718};
  world.materials.push_back(wood);
  const World read = read_back(world);
  REQUIRE(read.materials.size() == 3);
  const Material& p = read.materials[0];
  CHECK(p.reflectivity == plain.reflectivity);
  CHECK(p.attenuation_db_per_m == 17.25);
  CHECK(p.attenuation_exponent == 0.7);
  CHECK(p.roughness == 0.0);
  CHECK_FALSE(p.stops_light);
  CHECK_FALSE(p.stops_motion);
  CHECK(p.light_extinction_per_m == 0.31);
  CHECK(p.leaves_per_m == 2.5);
  CHECK(p.source == "nowhere");
  CHECK_FALSE(p.dielectric);
  CHECK(read.materials[1].opaque());
  CHECK(std::isinf(read.materials[1].light_extinction_per_m));
  REQUIRE(read.materials[2].dielectric);
  CHECK(read.materials[2].dielectric->a == 1.99);
  CHECK(read.materials[2].dielectric->b == 0.01);
  CHECK(read.materials[2].dielectric->c == 0.0047);
  CHECK(read.materials[2].dielectric->d == 1.0718);
}

TEST_CASE("world text: angles that came from degrees come back to their bits, any other to the last place but one") {
  for (int i = 0; i < 500; ++i) {
    World world = world_of(Box{});
    Solid& box = world.solids[0];
    box.yaw = radians(-720.0 + i * 2.9371);
    box.pitch = radians(i * 0.1);
    box.roll = i * 0.0131;
    const Solid read = read_back(world).solids[0];
    CHECK(read.yaw == box.yaw);
    CHECK(read.pitch == box.pitch);
    CHECK(std::abs(read.roll - box.roll) <= std::abs(box.roll) * 0x1p-51);
  }
}

TEST_CASE("world text: motions come back") {
  World world = world_of(Box{});
  world.solids.push_back(world.solids[0]);
  auto motion = std::make_shared<Motion>();
  motion->points = {{1.0, 2.0, 0.5}, {1.0 / 3.0, 7.0, 0.5}};
  motion->speed = 0.7;
  motion->start_s = 3.1;
  motion->spin = radians(12.5);
  motion->mode = Motion::Mode::back_and_forth;
  world.solids[1].motion = motion;
  world.solids[1].position = motion->points.front();
  const World read = read_back(world);
  CHECK(read.solids[0].motion == nullptr);
  REQUIRE(read.solids[1].motion != nullptr);
  const Motion& m = *read.solids[1].motion;
  CHECK(m.points == motion->points);
  CHECK(m.speed == 0.7);
  CHECK(m.start_s == 3.1);
  CHECK(m.spin == motion->spin);
  CHECK(m.mode == Motion::Mode::back_and_forth);
  CHECK(read.solids[1].position == motion->points.front());
}

TEST_CASE("world text: what has a file of its own, or none of its name, is told") {
  const auto message = [](const World& world) {
    const auto text = write_world(world);
    REQUIRE_FALSE(text);
    return text.error().message;
  };
  CHECK(message(world_of(MapSolid{})).find("'thing' is a map, which is kept in a file of its own") != std::string::npos);
  CHECK(message(world_of(MeshSolid{})).find("'thing' is a mesh, which is kept in a file of its own") != std::string::npos);
  World twice = world_of(Box{});
  twice.materials.push_back(twice.materials[0]);
  CHECK(message(twice).find("two materials 'wall'") != std::string::npos);
  World lost = world_of(Box{});
  lost.solids[0].material = 1;
  CHECK(message(lost).find("a material that the world does not have") != std::string::npos);
  World tilted = world_of(Sphere{});
  tilted.solids[0].roll = 0.1;
  CHECK(message(tilted).find("tilted") != std::string::npos);
}

}  // namespace thicket
