#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "../temporary_folder.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/pose.hpp"
#include "thicket/worlds/scene.hpp"
#include "thicket/worlds/truth.hpp"
#include "thicket/worlds/world.hpp"

using namespace thicket;
namespace fs = std::filesystem;

namespace {

constexpr const char* map_yaml =
    "image: m.pgm\nresolution: 0.5\norigin: [1.0, 2.0, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";

/// A world with every shape; the places of its lines matter to nobody.
constexpr const char* good = R"(
name = "all shapes"
source = "ours"
bounds_m = [-1.0, -2.0, 30.0, 40]

[material.wall]
attenuation_db_per_m = inf

[material.foliage]
reflectivity = 0.05
attenuation_db_per_m = 7.5
roughness = 0.25
stops_light = false
stops_motion = false

[[solid]]
type = "box"
name = "crate"
material = "wall"
position_m = [1.0, 2.0, 3.0]
yaw_deg = 90
size_m = [1.0, 2.0, 0.5]

[[solid]]
type = "sphere"
material = "foliage"
radius_m = 0.75

[[solid]]
type = "cylinder"
material = "wall"
radius_m = 0.25
height_m = 3

[[solid]]
type = "wall"
material = "wall"
points_m = [[0.0, 0.0], [5.0, 0.0], [5.0, 5.0]]
thickness_m = 0.2
height_m = 2.0

[[solid]]
type = "map"
material = "wall"
file = "maps/m.yaml"
position_m = [10.0, 20.0, 0.5]
yaw_deg = 90.0
height_m = 1.5
unknown_is_matter = false
)";

struct Reading {
  World world;
  std::string error;  ///< without the folder's name; empty if there is none
};

Reading read_file(const TemporaryFolder& folder, const fs::path& file, const MapOptions& options = {}) {
  const auto world = read_world(file, options);
  if (world) return {*world, ""};
  std::string message = world.error().message;
  const std::string prefix = folder.path().string() + "/";
  for (auto at = message.find(prefix); at != std::string::npos; at = message.find(prefix)) message.erase(at, prefix.size());
  return {{}, message};
}

Reading read(std::string_view text) {
  const TemporaryFolder folder;
  folder.write("maps/m.yaml", map_yaml);
  folder.write("maps/m.pgm", "P2 3 2 255  0 254 205  254 0 254");  // the top row first
  return read_file(folder, folder.write("w.toml", text));
}

/// What is put below a good head: `name` on line 1, a material "wall" on lines 2 and 3, so that this text begins on line 4.
std::string error_below_head(const std::string& text) {
  return read("name = \"n\"\n[material.wall]\nreflectivity = 0.5\n" + text).error;
}

std::size_t lines_in(const std::string& text) {
  return text.empty() ? 0 : 1 + static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

}  // namespace

TEST_CASE("a good file is read as it stands") {
  const Reading reading = read(good);
  CHECK(reading.error == "");
  const World& world = reading.world;
  CHECK(world.name == "all shapes");
  CHECK(world.source == "ours");
  CHECK(world.file.filename() == "w.toml");
  REQUIRE(world.bounds.has_value());
  CHECK(*world.bounds == glm::dvec4(-1.0, -2.0, 30.0, 40.0));

  REQUIRE(world.materials.size() == 2);
  CHECK(world.materials[0].name == "wall");
  CHECK(world.materials[0].reflectivity == 0.5);  // the defaults
  CHECK(world.materials[0].opaque());
  CHECK(world.materials[0].roughness == 1.0);
  CHECK(world.materials[0].stops_light);
  CHECK(world.materials[0].stops_motion);
  CHECK(world.materials[1].name == "foliage");
  CHECK(world.materials[1].reflectivity == 0.05);
  CHECK(world.materials[1].attenuation_db_per_m == 7.5);
  CHECK(world.materials[1].roughness == 0.25);
  CHECK_FALSE(world.materials[1].stops_light);
  CHECK_FALSE(world.materials[1].stops_motion);

  REQUIRE(world.solids.size() == 5);
  const Solid &box = world.solids[0], &ball = world.solids[1], &pillar = world.solids[2], &wall = world.solids[3], &map = world.solids[4];
  CHECK(box.name == "crate");
  CHECK(box.material == 0);
  CHECK(box.position == glm::dvec3(1.0, 2.0, 3.0));
  CHECK(box.yaw == doctest::Approx(pi / 2).epsilon(1e-15));
  CHECK(std::get<Box>(box.shape).size == glm::dvec3(1.0, 2.0, 0.5));
  CHECK(ball.name == "sphere 2");
  CHECK(ball.material == 1);
  CHECK(ball.position == glm::dvec3(0.0));
  CHECK(std::get<Sphere>(ball.shape).radius == 0.75);
  CHECK(std::get<Cylinder>(pillar.shape).radius == 0.25);
  CHECK(std::get<Cylinder>(pillar.shape).height == 3.0);
  CHECK(std::get<Wall>(wall.shape).points == std::vector<glm::dvec2>{{0.0, 0.0}, {5.0, 0.0}, {5.0, 5.0}});
  CHECK(std::get<Wall>(wall.shape).thickness == 0.2);
  CHECK(std::get<Wall>(wall.shape).height == 2.0);

  const auto& grid = std::get<MapSolid>(map.shape);
  CHECK(grid.height == 1.5);
  CHECK_FALSE(grid.unknown_is_matter);
  CHECK(grid.blocks.size() == 2);
  // The map's own origin (1, 2) is turned by a quarter and moved to (10, 20): its corner comes to (8, 21), its rows run west.
  CHECK(glm::distance(map.position, glm::dvec3(8.0, 21.0, 0.5)) < 1e-12);
  CHECK(inside(map, {7.25, 21.25, 1.0}));        // cell (0, 1), upper left
  CHECK(inside(map, {7.75, 21.75, 1.0}));        // cell (1, 0)
  CHECK_FALSE(inside(map, {7.75, 21.25, 1.0}));  // cell (0, 0) is free
  CHECK_FALSE(inside(map, {7.25, 22.25, 1.0}));  // cell (2, 1) is unknown
  CHECK(static_cast<bool>(Scene::build(world)));
}

TEST_CASE("defaults of shapes that leave them to us") {
  const Reading reading = read(R"(name = "n"
[material.wall]
[[solid]]
type = "wall"
material = "wall"
points_m = [[0, 0], [1, 0]]
[[solid]]
type = "map"
material = "wall"
file = "maps/m.yaml"
)");
  CHECK(reading.error == "");
  REQUIRE(reading.world.solids.size() == 2);
  CHECK(std::get<Wall>(reading.world.solids[0].shape).thickness == 0.1);
  CHECK(std::get<Wall>(reading.world.solids[0].shape).height == 2.5);
  const auto& map = std::get<MapSolid>(reading.world.solids[1].shape);
  CHECK(map.unknown_is_matter);
  CHECK(map.height == 2.5);
  CHECK(reading.world.solids[1].position == glm::dvec3(1.0, 2.0, 0.0));
  CHECK_FALSE(reading.world.bounds.has_value());
}

TEST_CASE("a closed wall may end where it began, and a world may hold nothing") {
  CHECK(error_below_head("[[solid]]\ntype = \"wall\"\nmaterial = \"wall\"\npoints_m = [[0, 0], [1, 0], [1, 1], [0, 0]]\n") == "");
  const Reading empty = read("name = \"nothing\"\n");
  CHECK(empty.error == "");
  CHECK(empty.world.solids.empty());
  CHECK(empty.world.materials.empty());
}

TEST_CASE("broken files are told with their place, what is wrong and what was expected") {
  struct Broken {
    const char* what;
    const char* text;   ///< from line 4 on
    const char* error;  ///< the whole message
  };
  static constexpr Broken table[] = {
      {"unknown key of a solid", "[[solid]]\ntype = \"sphere\"\nmaterial = \"wall\"\nradius_m = 1\nradus_m = 2\n",
       "w.toml:8:1: unknown key 'radus_m' in [[solid]] of type \"sphere\" (did you mean 'radius_m'?)"},
      {"key of another shape", "[[solid]]\ntype = \"sphere\"\nmaterial = \"wall\"\nradius_m = 1\nthickness_m = 2\n",
       "w.toml:8:1: unknown key 'thickness_m' in [[solid]] of type \"sphere\""},
      {"unknown key of a material", "[material.fog]\n  atenuation_db_per_m = 1\n",
       "w.toml:5:3: unknown key 'atenuation_db_per_m' in [material.NAME] (did you mean 'attenuation_db_per_m'?)"},
      {"unknown table", "[materials.fog]\n", "w.toml:4:2: unknown key 'materials' in world file (did you mean 'material'?)"},
      {"text for a number", "[[solid]]\ntype = \"sphere\"\nmaterial = \"wall\"\nradius_m = \"1 m\"\n",
       "w.toml:7:12: 'radius_m' is a text ('1 m'), expected a number in m, above 0 and at most 1000000000"},
      {"number for a text", "[[solid]]\ntype = \"sphere\"\nname = 5\nmaterial = \"wall\"\nradius_m = 1\n",
       "w.toml:6:8: 'name' is an integer, expected a text in quotes"},
      {"number for a flag", "[material.fog]\nstops_light = 1\n", "w.toml:5:15: 'stops_light' is an integer, expected true or false"},
      {"two numbers for three", "[[solid]]\ntype = \"sphere\"\nmaterial = \"wall\"\nposition_m = [0, 0]\nradius_m = 1\n",
       "w.toml:7:14: 'position_m' has an array of length 2, expected an array of 3 numbers in m, at least -1000000000 and at most "
       "1000000000"},
      {"reflectivity above 1", "[material.fog]\nreflectivity = 1.5\n",
       "w.toml:5:16: 'reflectivity' is 1.5, expected a number, at least 0 and at most 1"},
      {"negative attenuation", "[material.fog]\nattenuation_db_per_m = -1\n",
       "w.toml:5:24: 'attenuation_db_per_m' is -1, expected a number in dB/m, at least 0"},
      {"position out of range", "[[solid]]\ntype = \"sphere\"\nmaterial = \"wall\"\nposition_m = [0, 2e9, 0]\nradius_m = 1\n",
       "w.toml:7:18: 'position_m' is 2000000000, expected an array of 3 numbers in m, at least -1000000000 and at most 1000000000"},
      {"NaN", "[[solid]]\ntype = \"sphere\"\nmaterial = \"wall\"\nradius_m = nan\n",
       "w.toml:7:12: 'radius_m' is nan, expected a number in m, above 0 and at most 1000000000"},
      {"NaN attenuation", "[material.fog]\nattenuation_db_per_m = nan\n",
       "w.toml:5:24: 'attenuation_db_per_m' is nan, expected a number in dB/m, at least 0"},
      {"infinite size", "[[solid]]\ntype = \"box\"\nmaterial = \"wall\"\nsize_m = [1, inf, 1]\n", "w.toml:7:14: 'size_m' is inf, expected"},
      {"negative radius", "[[solid]]\ntype = \"cylinder\"\nmaterial = \"wall\"\nradius_m = -0.5\nheight_m = 1\n",
       "w.toml:7:12: 'radius_m' is -0.5, expected a number in m, above 0 and at most 1000000000"},
      {"no thickness", "[[solid]]\ntype = \"wall\"\nmaterial = \"wall\"\npoints_m = [[0, 0], [1, 0]]\nthickness_m = 0\n",
       "w.toml:8:15: 'thickness_m' is 0, expected a number in m, above 0 and at most 1000000000"},
      {"missing material", "[[solid]]\ntype = \"sphere\"\nradius_m = 1\n",
       "w.toml:4:1: [[solid]] of type \"sphere\" lacks the key 'material', expected a text in quotes"},
      {"unknown material", "[[solid]]\ntype = \"sphere\"\nmaterial = \"wal\"\nradius_m = 1\n",
       "w.toml:6:12: there is no material 'wal', expected a table [material.wal] or one of `thicket materials` (did you mean 'wall'?)"},
      {"material of a wrong type", "[[solid]]\ntype = \"sphere\"\nmaterial = 3\nradius_m = 1\n",
       "w.toml:6:12: 'material' is an integer, expected a text in quotes"},
      {"missing radius", "[[solid]]\ntype = \"sphere\"\nmaterial = \"wall\"\n",
       "w.toml:4:1: [[solid]] of type \"sphere\" lacks the key 'radius_m', expected a number in m, above 0 and at most 1000000000"},
      {"missing type", "[[solid]]\nmaterial = \"wall\"\nradius_m = 1\n",
       "w.toml:4:1: [[solid]] lacks a 'type', expected one of 'box', 'sphere', 'cylinder', 'wall', 'prism', 'map', 'mesh', 'tree', 'hedge'"},
      {"type that is no text", "[[solid]]\ntype = 1\nmaterial = \"wall\"\n",
       "w.toml:5:8: 'type' is an integer, expected one of 'box', 'sphere', 'cylinder', 'wall', 'prism', 'map', 'mesh', 'tree', 'hedge'"},
      {"unknown type", "[[solid]]\ntype = \"sphare\"\nmaterial = \"wall\"\nradius_m = 1\n",
       "w.toml:5:8: 'type' is 'sphare', expected one of 'box', 'sphere', 'cylinder', 'wall', 'prism', 'map', 'mesh', 'tree', 'hedge' (did you mean 'sphere'?)"},
      {"solid that is one table", "[solid]\ntype = \"sphere\"\n",
       "w.toml:4:1: 'solid' is not an array of tables, expected entries [[solid]]"},
      {"one point", "[[solid]]\ntype = \"wall\"\nmaterial = \"wall\"\npoints_m = [[0, 0]]\n",
       "w.toml:7:12: 'points_m' has 1 points, expected two or more"},
      {"no points", "[[solid]]\ntype = \"wall\"\nmaterial = \"wall\"\n",
       "w.toml:4:1: [[solid]] of type \"wall\" lacks the key 'points_m', expected"},
      {"points that repeat", "[[solid]]\ntype = \"wall\"\nmaterial = \"wall\"\npoints_m = [[0, 0], [1, 0], [1.0, 0.0], [2, 0]]\n",
       "w.toml:7:12: points 2 and 3 of 'points_m' are the same, expected different ones"},
      {"empty points", "[[solid]]\ntype = \"wall\"\nmaterial = \"wall\"\npoints_m = []\n",
       "w.toml:7:12: 'points_m' has 0 points, expected two or more"},
      {"point of three numbers", "[[solid]]\ntype = \"wall\"\nmaterial = \"wall\"\npoints_m = [[0, 0], [1, 0, 0]]\n",
       "w.toml:7:21: 'points_m' has an array of length 3"},
      {"map without a file", "[[solid]]\ntype = \"map\"\nmaterial = \"wall\"\n",
       "w.toml:4:1: [[solid]] of type \"map\" lacks the key 'file', expected a text in quotes"},
  };
  for (const Broken& broken : table) {
    CAPTURE(std::string(broken.what));
    const std::string error = error_below_head(broken.text);
    CAPTURE(error);
    CHECK(error.find(broken.error) == 0);
    CHECK(lines_in(error) == 1);  // one fault, told once
  }
}

TEST_CASE("broken heads of files") {
  CHECK(read("").error == "w.toml:1:1: world file lacks the key 'name', expected a text in quotes");
  CHECK(read("name = \"n\"\nbounds_m = [0, 0, 5, 0]\n").error ==
        "w.toml:2:12: 'bounds_m' is empty, expected x_min < x_max and y_min < y_max");
  CHECK(read("name = \"n\"\nbounds_m = [5, 0, 0, 5]\n").error ==
        "w.toml:2:12: 'bounds_m' is empty, expected x_min < x_max and y_min < y_max");
  CHECK(
      read("name = \"n\"\nbounds_m = [0, 0, nan, 5]\n").error.find("w.toml:2:19: 'bounds_m' is nan, expected an array of 4 numbers in m") ==
      0);
  CHECK(read("name = \"n\"\nmaterial = 3\n").error == "w.toml:2:12: 'material' is not a table, expected tables [material.NAME]");
  CHECK(read("name = \"n\"\n[material]\nfog = 3\n").error == "w.toml:3:7: '[material.NAME]' is an integer, expected a table");
  CHECK(read("name = \"n\"\nsolid = [1]\n").error.find("w.toml:2:10: [[solid]] ") == 0);
}

TEST_CASE("what is no TOML at all is told by its place") {
  CHECK(read("name = \"a\"\nname = \"b\"\n").error.find("w.toml:2:") == 0);
  CHECK(read("name = \"n\"\n[material.wall]\n[material.wall]\n").error.find("w.toml:3:") == 0);
  CHECK(read("name = \"n\"\nsource = \n").error.find("w.toml:2:10: ") == 0);
  CHECK(read("name = \"n\"\nbounds_m = [1, 2\n").error.find("w.toml:") == 0);
  CHECK(read(std::string("name = \"n\"\n\0\n", 13)).error.find("w.toml:2:1: ") == 0);
  CHECK(read("name = \"\xff\"\n").error.find("w.toml:1:") == 0);
}

TEST_CASE("maps that cannot be read") {
  const std::string entry = "[[solid]]\ntype = \"map\"\nmaterial = \"wall\"\n";
  const std::string missing = error_below_head(entry + "file = \"maps/none.yaml\"\n");
  CAPTURE(missing);
  CHECK(missing.find("maps/none.yaml") != std::string::npos);
  CHECK(lines_in(missing) == 1);
  const std::string no_image = error_below_head(entry + "file = \"maps/m.yaml\"\nimage = \"maps/none.pgm\"\n");
  CAPTURE(no_image);
  CHECK(no_image.find("maps/none.pgm") != std::string::npos);
  // An image of ours instead of the one that the YAML names; both relative to the world file.
  CHECK(error_below_head(entry + "file = \"maps/m.yaml\"\nimage = \"maps/m.pgm\"\n") == "");
}

TEST_CASE("all faults of a file are told at once, in its order") {
  const std::string error = error_below_head(
      "colour = \"red\"\n"
      "[[solid]]\ntype = \"sphere\"\nmaterial = \"wall\"\nradius_m = -1\n"
      "[[solid]]\ntype = \"ball\"\n"
      "[[solid]]\ntype = \"box\"\nmaterial = \"gloss\"\nsize_m = [1, 1]\n"
      "[[solid]]\ntype = \"wall\"\nmaterial = \"wall\"\npoints_m = [[0, 0], [0, 0]]\nheight_m = 0\n"
      "[[solid]]\ntype = \"map\"\nmaterial = \"wall\"\nfile = \"none.yaml\"\n");
  CAPTURE(error);
  std::size_t from = 0;
  for (const char* part :
       {"w.toml:4:1: unknown key 'colour'", "w.toml:8:12: 'radius_m' is -1", "w.toml:10:8: 'type' is 'ball'", "w.toml:14:10: 'size_m' has",
        "w.toml:13:12: there is no material 'gloss'", "w.toml:19:12: 'height_m' is 0", "w.toml:18:12: points 1 and 2", "none.yaml"}) {
    CAPTURE(std::string(part));
    const std::size_t at = error.find(part, from);
    CHECK(at != std::string::npos);
    if (at != std::string::npos) from = at;
  }
  CHECK(lines_in(error) == 8);
}

TEST_CASE("files that are not there, and files that are no worlds") {
  const TemporaryFolder folder;
  CHECK(read_file(folder, folder.path() / "none.toml").error.find("none.toml") == 0);
  CHECK(read_file(folder, folder.path()).error != "");
  MapOptions options;
  options.image = folder.path() / "m.pgm";
  CHECK(read_file(folder, folder.write("w.toml", "name = \"n\"\n"), options).error ==
        "w.toml: a map image is given, but the world is not a map_server YAML file");
}

TEST_CASE("a map_server file is a world of its own") {
  const TemporaryFolder folder;
  folder.write("m.pgm", "P2 3 2 255  0 254 205  254 0 254");
  folder.write("other.pgm", "P2 3 2 255  0 0 0  0 0 0");
  const fs::path file = folder.write("depot.yaml", map_yaml);
  SUBCASE("with unknown cells as matter") {
    const Reading reading = read_file(folder, file);
    CHECK(reading.error == "");
    CHECK(reading.world.name == "depot");
    REQUIRE(reading.world.solids.size() == 1);
    CHECK(reading.world.materials.at(0).opaque());
    CHECK(in_matter(reading.world, {1.25, 2.75, 1.0}));
    CHECK(in_matter(reading.world, {1.75, 2.25, 1.0}));
    CHECK(in_matter(reading.world, {2.25, 2.75, 2.4}));
    CHECK_FALSE(in_matter(reading.world, {2.25, 2.75, 2.6}));
    CHECK_FALSE(in_matter(reading.world, {1.25, 2.25, 1.0}));
  }
  SUBCASE("without, lower, and from another image") {
    MapOptions options;
    options.unknown_is_matter = false;
    options.height = 1.0;
    CHECK_FALSE(in_matter(read_file(folder, file, options).world, {2.25, 2.75, 0.5}));
    CHECK(in_matter(read_file(folder, file, options).world, {1.25, 2.75, 0.5}));
    CHECK_FALSE(in_matter(read_file(folder, file, options).world, {1.25, 2.75, 1.5}));
    options.image = folder.path() / "other.pgm";
    CHECK(in_matter(read_file(folder, file, options).world, {1.25, 2.25, 0.5}));
  }
  SUBCASE("not there") {
    CHECK(read_file(folder, folder.path() / "none.yml").error.find("none.yml") == 0);
  }
}

TEST_CASE("the worlds that are shipped can be read and traced") {
  const fs::path folder = shipped_root() / "worlds" / "data";
  std::size_t worlds = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".toml") continue;
    const auto text = read_text_file(entry.path());
    REQUIRE(static_cast<bool>(text));
    if (text->find("[[solid]]") == std::string::npos) continue;  // a mission
    const auto world = read_world(entry.path());
    CHECK_MESSAGE(static_cast<bool>(world), (world ? "" : world.error().message));
    if (!world) continue;
    ++worlds;
    CHECK(world->source != "");
    CHECK(static_cast<bool>(Scene::build(*world)));
  }
  CHECK(worlds >= 3);
}

TEST_CASE("the help on world files names every key") {
  const std::string help = describe_world_file();
  for (const char* key : {"name",
                          "source",
                          "bounds_m",
                          "[material.NAME]",
                          "reflectivity",
                          "attenuation_db_per_m",
                          "attenuation_exponent",
                          "preset",
                          "permittivity",
                          "permittivity_exponent",
                          "conductivity_s_per_m",
                          "conductivity_exponent",
                          "light_extinction_per_m",
                          "roughness",
                          "stops_light",
                          "stops_motion",
                          "[[solid]] of type \"box\"",
                          "size_m",
                          "[[solid]] of type \"sphere\"",
                          "radius_m",
                          "[[solid]] of type \"cylinder\"",
                          "height_m",
                          "[[solid]] of type \"wall\"",
                          "points_m",
                          "thickness_m",
                          "[[solid]] of type \"map\"",
                          "file",
                          "image",
                          "unknown_is_matter",
                          "position_m",
                          "yaw_deg"}) {
    CAPTURE(std::string(key));
    CHECK(help.find(key) != std::string::npos);
  }
}
