// What the keys of solids, includes, floors and ceilings make, as `thicket help world` tells it.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "../temporary_folder.hpp"
#include "thicket/base/pose.hpp"
#include "thicket/worlds/scene.hpp"
#include "thicket/worlds/truth.hpp"
#include "thicket/worlds/world.hpp"

using namespace thicket;
namespace fs = std::filesystem;

namespace {

const std::string brick_box = "[[solid]]\ntype = \"box\"\nname = \"crate\"\nmaterial = \"brick\"\nsize_m = [2, 1, 0.5]\n";

World read_good(const fs::path& file, const MapOptions& options = {}) {
  const auto world = read_world(file, options);
  INFO((world ? "" : world.error().message));
  REQUIRE(static_cast<bool>(world));
  return *world;
}

World world_of(const TemporaryFolder& folder, const std::string& text) { return read_good(folder.write("w.toml", "name = \"n\"\n" + text)); }

World world_of(const std::string& text) { return world_of(TemporaryFolder{}, text); }

void check_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-12) {
  CAPTURE(a.x); CAPTURE(a.y); CAPTURE(a.z);
  CAPTURE(b.x); CAPTURE(b.y); CAPTURE(b.z);
  CHECK(glm::distance(a, b) <= tolerance);
}

/// Where a point of a solid's frame lies.
glm::dvec3 placed(const Solid& solid, const glm::dvec3& p) { return solid.position + rotation_of(solid) * p; }

bool noticed(const World& world, const std::string& part) {
  return std::any_of(world.notices.begin(), world.notices.end(), [&](const std::string& notice) { return notice.find(part) != std::string::npos; });
}

const Solid* named(const World& world, const std::string& name) {
  const auto found = std::find_if(world.solids.begin(), world.solids.end(), [&](const Solid& solid) { return solid.name == name; });
  return found == world.solids.end() ? nullptr : &*found;
}

/// A closed tetrahedron "v 0 0 0 ... 1" of a material.
std::string tetrahedron(const std::string& material, double x) {
  const std::string at = std::to_string(x), end = std::to_string(x + 1.0);
  return "v " + at + " 0 0\nv " + end + " 0 0\nv " + at + " 1 0\nv " + at + " 0 2\n" + (material.empty() ? "" : "usemtl " + material + "\n") +
         "f -4 -2 -3\nf -4 -3 -1\nf -3 -2 -1\nf -2 -4 -1\n";
}

}  // namespace

TEST_CASE("a prism of a file has its outline, its holes and its pose") {
  const World world = world_of(
      "[[solid]]\ntype = \"prism\"\nmaterial = \"brick\"\nposition_m = [10, 0, 1]\nyaw_deg = 90\nheight_m = 3\n"
      "points_m = [[0, 0], [4, 0], [4, 4], [0, 4]]\n[[solid.hole]]\npoints_m = [[1, 1], [2, 1], [2, 2], [1, 2]]\n[[solid.hole]]\npoints_m = [[3, 3], [3.5, 3], [3, 3.5]]\n");
  REQUIRE(world.solids.size() == 1);
  const Solid& solid = world.solids[0];
  CHECK(std::get<Prism>(solid.shape).holes.size() == 2);
  CHECK(std::get<Prism>(solid.shape).height == 3.0);
  // (0.5, 0.5) of its frame comes to (9.5, 0.5).
  CHECK(inside(solid, placed(solid, {0.5, 0.5, 0.1})));
  CHECK(inside(solid, {9.5, 0.5, 3.9}));
  CHECK_FALSE(inside(solid, {9.5, 0.5, 4.1}));
  CHECK_FALSE(inside(solid, {9.5, 0.5, 0.9}));
  CHECK_FALSE(inside(solid, placed(solid, {1.5, 1.5, 1.0})));
  CHECK_FALSE(inside(solid, placed(solid, {3.1, 3.1, 1.0})));
  CHECK(inside(solid, placed(solid, {2.5, 2.5, 1.0})));
  CHECK(std::get<Prism>(world_of("[[solid]]\ntype = \"prism\"\nmaterial = \"brick\"\npoints_m = [[0, 0], [4, 0], [4, 4]]\n").solids[0].shape).height == 2.5);
}

TEST_CASE("a repeat stands along the axes of the solid's frame, x first, and is numbered") {
  const World world = world_of(brick_box + "position_m = [1, 2, 3]\nyaw_deg = 90\nroll_deg = 90\n[solid.repeat]\ncount = [3, 2, 2]\nspacing_m = [10, 20, 30]\n");
  REQUIRE(world.solids.size() == 12);
  int number = 0;
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 3; ++i) {
        const Solid& solid = world.solids[static_cast<std::size_t>(number)];
        CHECK(solid.name == "crate " + std::to_string(++number));
        // Rolled by a quarter and then turned by one: its x axis points north, its y axis up, its z axis east.
        check_near(solid.position, glm::dvec3(1, 2, 3) + 10.0 * i * glm::dvec3(0, 1, 0) + 20.0 * j * glm::dvec3(0, 0, 1) + 30.0 * k * glm::dvec3(1, 0, 0));
        CHECK(solid.roll == doctest::Approx(pi / 2));
      }
}

TEST_CASE("a repeat of a solid without a name, and of one solid only") {
  const World world = world_of("[[solid]]\ntype = \"sphere\"\nmaterial = \"brick\"\nradius_m = 1\n[solid.repeat]\ncount = [1, 1, 1]\nspacing_m = [0, 0, 0]\n");
  REQUIRE(world.solids.size() == 1);
  CHECK(world.solids[0].name == "sphere 1 1");
}

TEST_CASE("poses of a table come on top of the solid's own, tilts and all") {
  const TemporaryFolder folder;
  // A byte order mark, blanks, another order, comments and Windows' ends of lines.
  folder.write("poses.csv", "\xef\xbb\xbfyaw_deg, x_m ,y_m,z_m,pitch_deg,roll_deg,scale\r\n# one\r\n30,1,2,3,0,0,1\r\n\r\n-40,+5,-6,7e0,20,-10,1.0\n0,0,0,0,90,0,1\n15,0,0,0,45,25,1\n");
  const std::string own_pose = "position_m = [0.5, 0.25, -1]\nyaw_deg = 20\npitch_deg = 45\nroll_deg = 30\n";
  const World one = world_of(folder, brick_box + own_pose), level = world_of(folder, brick_box + "pitch_deg = 45\n" + "instances = \"poses.csv\"\n"),
              world = world_of(folder, brick_box + own_pose + "instances = \"poses.csv\"\n");
  struct Row {
    glm::dvec3 position;
    double yaw, pitch, roll;
  };
  const std::vector<Row> rows = {{{1, 2, 3}, 30, 0, 0}, {{5, -6, 7}, -40, 20, -10}, {{0, 0, 0}, 0, 90, 0}, {{0, 0, 0}, 15, 45, 25}};
  REQUIRE(world.solids.size() == rows.size());
  REQUIRE(level.solids.size() == rows.size());
  Solid own = one.solids[0], own_level = own;
  own_level.position = glm::dvec3(0.0);
  own_level.yaw = own_level.roll = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    CAPTURE(i);
    CHECK(world.solids[i].name == "crate " + std::to_string(i + 1));
    const glm::dmat3 turn = rotation_of(radians(rows[i].yaw), radians(rows[i].pitch), radians(rows[i].roll));
    for (const double x : {-1.0, 1.0})
      for (const double y : {-0.5, 0.5})
        for (const double z : {-0.25, 0.25}) {
          const glm::dvec3 corner(x, y, z);
          check_near(placed(world.solids[i], corner), rows[i].position + turn * placed(own, corner), 1e-12);
          check_near(placed(level.solids[i], corner), rows[i].position + turn * placed(own_level, corner), 1e-12);
        }
  }
}

TEST_CASE("poses whose sum points straight up or down lose nothing") {
  for (const double sign : {1.0, -1.0})
    for (const double own_roll : {0.0, 35.0}) {
      CAPTURE(sign);
      CAPTURE(own_roll);
      const TemporaryFolder folder;
      folder.write("poses.csv", "x_m,y_m,yaw_deg,pitch_deg\n0,0,70," + std::to_string(45.0 * sign) + "\n");
      const World world = world_of(folder, brick_box + "instances = \"poses.csv\"\npitch_deg = " + std::to_string(45.0 * sign) + "\nroll_deg = " + std::to_string(own_roll) + "\n");
      const glm::dmat3 turn = rotation_of(radians(70.0), radians(45.0 * sign), 0.0) * rotation_of(0.0, radians(45.0 * sign), radians(own_roll));
      for (int i = 0; i < 3; ++i) check_near(rotation_of(world.solids.at(0))[i], turn[i], 1e-8);
    }
}

TEST_CASE("a table scales meshes, with their places") {
  const TemporaryFolder folder;
  folder.write("t.obj", tetrahedron("", 0.0));
  folder.write("poses.csv", "x_m,y_m,scale,yaw_deg\n10,0,3,90\n20,0,0.5,0\n");
  const World world = world_of(folder, "[[solid]]\ntype = \"mesh\"\nmaterial = \"brick\"\nfile = \"t.obj\"\nscale = 2\nposition_m = [1, 0, 0]\ninstances = \"poses.csv\"\n");
  REQUIRE(world.solids.size() == 2);
  const auto &first = std::get<MeshSolid>(world.solids[0].shape), &second = std::get<MeshSolid>(world.solids[1].shape);
  CHECK(first.scale == 6.0);
  CHECK(second.scale == 1.0);
  CHECK(first.mesh == second.mesh);
  check_near(world.solids[0].position, {10, 3, 0});
  check_near(world.solids[1].position, {20.5, 0, 0});
}

TEST_CASE("a repeat within a table is an array at every pose") {
  const TemporaryFolder folder;
  folder.write("poses.csv", "x_m,y_m,yaw_deg\n100,0,90\n200,0,0\n");
  const World world = world_of(folder, brick_box + "instances = \"poses.csv\"\n[solid.repeat]\ncount = [2, 1, 1]\nspacing_m = [5, 0, 0]\n");
  REQUIRE(world.solids.size() == 4);
  check_near(world.solids[0].position, {100, 0, 0});
  check_near(world.solids[1].position, {100, 5, 0});
  check_near(world.solids[3].position, {205, 0, 0});
  CHECK(world.solids[0].name == "crate 1 1");
  CHECK(world.solids[3].name == "crate 2 2");
}

TEST_CASE("a motion leads along its way-points, in each of its modes") {
  const std::string way = "[solid.motion]\nwaypoints_m = [[0, 0, 1], [4, 0, 1], [4, 3, 1]]\nspeed_m_s = 2\nstart_s = 10\nspin_deg_s = 18\n";
  const auto at = [&](const std::string& mode, double time) {
    const World world = world_of(brick_box + way + mode);
    REQUIRE(world.solids.size() == 1);
    return standing_at(world.solids[0], time);
  };
  for (const char* mode : {"", "mode = \"once\"\n"}) {
    check_near(at(mode, 0).position, {0, 0, 1});
    check_near(at(mode, 10).position, {0, 0, 1});
    check_near(at(mode, 11).position, {2, 0, 1});
    check_near(at(mode, 13).position, {4, 2, 1});
    check_near(at(mode, 100).position, {4, 3, 1});
  }
  check_near(at("mode = \"loop\"\n", 10 + 3.5 + 1).position, {4 - 1.6, 3 - 1.2, 1});  // straight back, 2 m of 5
  check_near(at("mode = \"loop\"\n", 10 + 6 + 1).position, {2, 0, 1});
  check_near(at("mode = \"back_and_forth\"\n", 10 + 3.5 + 1).position, {4, 1, 1});
  check_near(at("mode = \"back_and_forth\"\n", 10 + 7 + 1).position, {2, 0, 1});
  CHECK(at("", 5).yaw == doctest::Approx(pi / 2).epsilon(1e-12));
  const World defaults = world_of(brick_box + "yaw_deg = 90\n[solid.motion]\nwaypoints_m = [[0, 0, 0], [9, 0, 0]]\n");
  check_near(standing_at(defaults.solids[0], 3.0).position, {3, 0, 0});
  CHECK(standing_at(defaults.solids[0], 3.0).yaw == doctest::Approx(pi / 2).epsilon(1e-12));
}

TEST_CASE("what is repeated or stands in a table takes its way with it") {
  const TemporaryFolder folder;
  folder.write("poses.csv", "x_m,y_m,yaw_deg\n100,0,90\n");
  const World world = world_of(folder, brick_box + "instances = \"poses.csv\"\n[solid.motion]\nwaypoints_m = [[1, 0, 0], [5, 0, 0]]\n[solid.repeat]\ncount = [1, 2, 1]\nspacing_m = [0, 10, 0]\n");
  REQUIRE(world.solids.size() == 2);
  check_near(standing_at(world.solids[0], 0.0).position, {100, 1, 0});
  check_near(standing_at(world.solids[0], 4.0).position, {100, 5, 0});
  check_near(standing_at(world.solids[1], 0.0).position, {90, 1, 0});
  check_near(standing_at(world.solids[1], 4.0).position, {90, 5, 0});
  check_near(world.solids[1].position, {90, 1, 0});
}

TEST_CASE("a map that moves keeps its own origin") {
  const TemporaryFolder folder;
  folder.write("m.pgm", "P2 1 1 255\n0\n");
  folder.write("m.yaml", "image: m.pgm\nresolution: 1\norigin: [-0.5, -0.5, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
  const World world = world_of(folder, "[[solid]]\ntype = \"map\"\nmaterial = \"brick\"\nfile = \"m.yaml\"\n[solid.motion]\nwaypoints_m = [[10, 0, 0], [20, 0, 0]]\n");
  CHECK(in_matter(world_at(world, 0.0), {9.6, -0.4, 1.0}));
  CHECK(in_matter(world_at(world, 5.0), {15.4, 0.4, 1.0}));
  CHECK_FALSE(in_matter(world_at(world, 5.0), {15.6, 0.4, 1.0}));
}

TEST_CASE("an include is placed, named after it or its file, and wears this file's materials") {
  const TemporaryFolder folder;
  folder.write("parts/other.toml",
               "name = \"o\"\nbounds_m = [0, 0, 1, 1]\n[material.paint]\nreflectivity = 0.125\n[material.own]\nreflectivity = 0.25\n"
               "[[solid]]\ntype = \"box\"\nname = \"a\"\nmaterial = \"paint\"\nsize_m = [2, 1, 0.5]\nposition_m = [1, 0, 0]\nyaw_deg = 10\npitch_deg = 30\n"
               "[[solid]]\ntype = \"sphere\"\nname = \"b\"\nmaterial = \"own\"\nradius_m = 1\n[solid.motion]\nwaypoints_m = [[0, 0, 0], [2, 0, 0]]\n");
  const World world = world_of(folder,
                               "[material.paint]\nreflectivity = 0.75\n" + brick_box +
                                   "[[include]]\nfile = \"parts/other.toml\"\nname = \"left\"\nposition_m = [10, 20, 1]\nyaw_deg = 90\n[[include]]\nfile = \"parts/other.toml\"\n");
  REQUIRE(world.solids.size() == 5);
  CHECK(world.name == "n");
  CHECK_FALSE(world.bounds.has_value());
  CHECK(world.solids[0].name == "crate");
  CHECK(world.solids[1].name == "left/a");
  CHECK(world.solids[2].name == "left/b");
  CHECK(world.solids[3].name == "other/a");
  CHECK(world.material_of(1).reflectivity == 0.75);
  CHECK(world.material_of(2).reflectivity == 0.25);
  CHECK(world.solids[2].material == world.solids[4].material);
  CHECK(world.materials.size() == 3);
  const glm::dvec3 corner(1, 0.5, 0.25);
  check_near(placed(world.solids[1], corner), glm::dvec3(10, 20, 1) + rotation_of(radians(90.0), 0, 0) * placed(world.solids[3], corner));
  check_near(standing_at(world.solids[2], 1.0).position, {10, 21, 1});
  check_near(standing_at(world.solids[4], 1.0).position, {1, 0, 0});
}

TEST_CASE("the floor of an include counts where this file has none") {
  const TemporaryFolder folder;
  folder.write("o.toml", "name = \"o\"\n[floor]\nmaterial = \"wood\"\nz_m = -1\n[ceiling]\nmaterial = \"wood\"\nz_m = 3\n" + brick_box);
  const std::string include = "[[include]]\nfile = \"o.toml\"\nposition_m = [0, 0, 5]\n";
  const World adopted = world_of(folder, include), own = world_of(folder, "[floor]\nmaterial = \"brick\"\n" + include);
  REQUIRE(adopted.solids.size() == 3);
  CHECK(adopted.solids[1].name == "floor");
  CHECK(extent(adopted.solids[1]).high.z == doctest::Approx(4.0));
  CHECK(extent(adopted.solids[2]).low.z == doctest::Approx(8.0));
  CHECK(adopted.material_of(1).name == "wood");
  REQUIRE(own.solids.size() == 3);
  CHECK(extent(own.solids[1]).high.z == doctest::Approx(0.0));
  CHECK(own.material_of(1).name == "brick");
  CHECK(own.material_of(2).name == "wood");
}

TEST_CASE("a floor and a ceiling go beyond the bounds or beyond all solids") {
  const std::string slabs = "[floor]\nmaterial = \"concrete\"\nz_m = -0.25\n[ceiling]\nmaterial = \"concrete\"\nz_m = 4\nthickness_m = 0.2\nmargin_m = 1\n";
  const auto check = [](const World& world, const glm::dvec4& around, double margin) {
    const Solid *floor = named(world, "floor"), *ceiling = named(world, "ceiling");
    REQUIRE(floor);
    REQUIRE(ceiling);
    check_near(extent(*floor).low, {around.x - 50, around.y - 50, -0.75});
    check_near(extent(*floor).high, {around.z + 50, around.w + 50, -0.25});
    check_near(extent(*ceiling).low, {around.x - 1, around.y - 1, 4});
    check_near(extent(*ceiling).high, {around.z + 1, around.w + 1, 4.2});
    REQUIRE(world.bounds.has_value());
    // Pictures, scores and maps are about what they were about.
    CHECK(*world.bounds == around + glm::dvec4(-margin, -margin, margin, margin));
  };
  check(world_of(slabs + brick_box + "position_m = [3, 0, 1]\n"), {2, -0.5, 4, 0.5}, 1.0);
  check(world_of("bounds_m = [-7, -8, 9, 10]\n" + slabs + brick_box), {-7, -8, 9, 10}, 0.0);
  check(world_of(slabs), {-1, -1, 1, 1}, 0.0);
}

TEST_CASE("a mesh takes the materials that are given, those of its names, and its own for the rest") {
  const TemporaryFolder folder;
  folder.write("m.obj", "mtllib m.mtl\n" + tetrahedron("red", 0) + tetrahedron("concrete", 5) + tetrahedron("blue", 10) + "usemtl glassy\nv 20 0 0\nv 21 0 0\nv 20 1 0\nf -3 -2 -1\n");
  folder.write("m.mtl", "newmtl red\nnewmtl concrete\nnewmtl blue\nnewmtl glassy\nd 0.5\n");
  const World world = world_of(folder,
                               "[material.blue]\nreflectivity = 0.125\n[[solid]]\ntype = \"mesh\"\nname = \"m\"\nmaterial = \"brick\"\nfile = \"m.obj\"\nscale = 0.5\nsheet_thickness_m = 0.25\n"
                               "[solid.materials]\nred = \"wood\"\n");
  REQUIRE(world.solids.size() == 4);
  const auto material = [&](const char* name) -> std::string {
    for (std::size_t i = 0; i < world.solids.size(); ++i)
      if (world.solids[i].name == name) return world.materials[world.solids[i].material].name;
    return "no such solid";
  };
  CHECK(material("m/red") == "wood");
  CHECK(material("m/concrete") == "concrete");
  CHECK(material("m/blue") == "blue");
  CHECK(material("m/glassy/sheets") == "brick");
  const Solid* red = named(world, "m/red");
  CHECK(inside(*red, {0.1, 0.1, 0.1}));
  CHECK_FALSE(inside(*red, {0.45, 0.1, 0.1}));
  CHECK(inside(*named(world, "m/glassy/sheets"), {10.1, 0.1, 0.12}));
  CHECK_FALSE(inside(*named(world, "m/glassy/sheets"), {10.1, 0.1, 0.13}));
  CHECK(noticed(world, "open part"));
  CHECK(noticed(world, "'glassy' has a dissolve of 0.5"));
  const World upright = world_of(folder, "[[solid]]\ntype = \"mesh\"\nmaterial = \"brick\"\nfile = \"m.obj\"\nup = \"y\"\n");
  CHECK(upright.solids[0].name == "mesh 1/red");
  CHECK(extent(upright.solids[0]).high.z == doctest::Approx(1.0));
  CHECK(extent(upright.solids[0]).low.y == doctest::Approx(-2.0));
}

TEST_CASE("a tree and a hedge are wood and leaves, one mesh of each however often they stand") {
  for (const std::string type : {"tree", "hedge"}) {
    CAPTURE(type);
    const World world = world_of("[[solid]]\ntype = \"" + type + "\"\nname = \"oak\"\nmaterial = \"wood\"\nscale = 2\nleaf_thickness_m = 0.002\n" + (type == "tree" ? "leaves = 300\n" : "leaves_per_m3 = 100\n") +
                                 "[solid.repeat]\ncount = [5, 1, 1]\nspacing_m = [10, 0, 0]\n");
    REQUIRE(world.solids.size() == 10);
    for (std::size_t i = 0; i < 10; i += 2) {
      const Solid &wood = world.solids[i], &leaves = world.solids[i + 1];
      const std::string name = "oak " + std::to_string(i / 2 + 1);
      CHECK(wood.name == name);
      CHECK(leaves.name == name + "/leaves");
      CHECK(world.materials[wood.material].name == "wood");
      CHECK(world.materials[leaves.material].name == "leaf");
      CHECK(std::get<MeshSolid>(wood.shape).mesh == std::get<MeshSolid>(world.solids[0].shape).mesh);
      CHECK(std::get<MeshSolid>(leaves.shape).mesh == std::get<MeshSolid>(world.solids[1].shape).mesh);
      CHECK(std::get<MeshSolid>(wood.shape).mesh->closed);
      CHECK_FALSE(std::get<MeshSolid>(leaves.shape).mesh->closed);
      CHECK(std::get<MeshSolid>(leaves.shape).sheet_thickness == 0.002);
      CHECK(std::get<MeshSolid>(leaves.shape).scale == 2.0);
      CHECK(leaves.position == wood.position);
    }
    const auto scene = Scene::build(world);
    REQUIRE(static_cast<bool>(scene));
    CHECK(scene->figures().triangles < 2000);  // each mesh once
  }
  const World bare = world_of("[[solid]]\ntype = \"tree\"\nmaterial = \"wood\"\nleaves = 0\nleaf_material = \"brick\"\nheight_m = 8\n");
  REQUIRE(bare.solids.size() == 1);
  CHECK(inside(bare.solids[0], {0.0, 0.0, 0.5}));
  CHECK(extent(bare.solids[0]).high.z > 6.0);
}

TEST_CASE("a MovingAI map and an OBJ file are worlds of their own, and may be included") {
  const TemporaryFolder folder;
  const fs::path map = folder.write("yard.map", "type octile\nheight 2\nwidth 3\nmap\n..@\n...\n"), obj = folder.write("thing.obj", tetrahedron("wood", 0) + "usemtl other\nv 9 0 0\nv 9 1 0\nv 9 0 1\nf -3 -2 -1\n");
  MapOptions options;
  options.cell_size = 0.5;
  options.height = 1.0;
  const World yard = read_good(map, options), thing = read_good(obj);
  CHECK(yard.name == "yard");
  CHECK(in_matter(yard, {1.25, 0.75, 0.5}));
  CHECK_FALSE(in_matter(yard, {1.25, 0.75, 1.5}));
  CHECK_FALSE(in_matter(yard, {1.25, 0.25, 0.5}));
  CHECK(in_matter(read_good(map), {2.5, 1.5, 2.4}));  // cells of 1 m, 2.5 m high
  CHECK(thing.name == "thing");
  REQUIRE(thing.solids.size() == 2);
  CHECK(thing.material_of(0).name == "wood");
  CHECK(thing.material_of(1).name == "wall");
  CHECK(inside(thing.solids[0], {0.1, 0.1, 0.1}));
  CHECK_FALSE(thing.notices.empty());
  const World both = world_of(folder, "[[include]]\nfile = \"yard.map\"\nposition_m = [10, 0, 0]\n[[include]]\nfile = \"thing.obj\"\nname = \"it\"\n");
  REQUIRE(both.solids.size() == 3);
  CHECK(both.solids[0].name == "yard/map");
  CHECK(in_matter(both, {12.5, 1.5, 1.0}));
  CHECK(both.solids[1].name == "it/thing/wood");
  CHECK(both.notices == thing.notices);
}

TEST_CASE("faults without end are told a hundred at a time") {
  std::string text = "name = \"n\"\n";
  for (int i = 0; i < 250; ++i) text += "[[solid]]\ntype = \"ball\"\n";
  const TemporaryFolder folder;
  const auto world = read_world(folder.write("w.toml", text));
  REQUIRE_FALSE(static_cast<bool>(world));
  CHECK(std::count(world.error().message.begin(), world.error().message.end(), '\n') == 100);
  CHECK(world.error().message.ends_with("\nand 150 faults more"));
}
