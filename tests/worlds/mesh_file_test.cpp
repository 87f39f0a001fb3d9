// OBJ files: what becomes of their faces, and what is said of broken ones.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "../outside_data.hpp"
#include "../temporary_folder.hpp"
#include "thicket/base/files.hpp"
#include "hand_made_mesh.hpp"
#include "thicket/worlds/mesh_file.hpp"

using namespace thicket;
namespace fs = std::filesystem;

namespace {

/// The lines of a cube with its lowest corner somewhere; its vertices follow `before` others. Faces: bottom, top, front, right, back, left.
struct Cube {
  glm::dvec3 low{0.0};
  double size = 1.0;
  int before = 0;
  bool flipped = false;

  static constexpr std::array<std::array<int, 4>, 6> faces = {
      {{1, 4, 3, 2}, {5, 6, 7, 8}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 4, 8, 7}, {4, 1, 5, 8}}};

  std::string vertices() const {
    const double s = size;
    const double x[] = {0, s, s, 0}, y[] = {0, 0, s, s};
    std::string text;
    for (int i = 0; i < 8; ++i) text += fmt::format("v {} {} {}\n", low.x + x[i % 4], low.y + y[i % 4], low.z + (i < 4 ? 0.0 : s));
    return text;
  }
  std::string face(std::size_t k, bool turned = false) const {
    std::array<int, 4> f = faces[k];
    if (turned != flipped) std::reverse(f.begin(), f.end());
    return fmt::format("f {} {} {} {}\n", f[0] + before, f[1] + before, f[2] + before, f[3] + before);
  }
  std::string all() const {
    std::string text = vertices();
    for (std::size_t k = 0; k < 6; ++k) text += face(k);
    return text;
  }
};

ObjFile read(const std::string& text, const ObjOptions& options = {}) {
  const TemporaryFolder folder;
  auto file = read_obj(folder.write("thing.obj", text), options);
  INFO((file ? "" : file.error().message));
  REQUIRE(static_cast<bool>(file));
  return *file;
}

std::string error_of(const std::string& text) {
  const TemporaryFolder folder;
  const auto file = read_obj(folder.write("thing.obj", text));
  REQUIRE_FALSE(static_cast<bool>(file));
  return file.error().message;
}

void check_volume(const MeshPiece& piece, double volume) {
  CHECK(piece.mesh->closed);
  CHECK(signed_volume(*piece.mesh) == doctest::Approx(volume).epsilon(1e-14));
}

bool noticed(const ObjFile& file, const std::string& part) {
  return std::any_of(file.notices.begin(), file.notices.end(),
                     [&](const std::string& notice) { return notice.find(part) != std::string::npos; });
}

}  // namespace

TEST_CASE("a cube is a volume, and there is nothing to say of it") {
  const ObjFile file = read(Cube{}.all());
  REQUIRE(file.pieces.size() == 1);
  CHECK(file.pieces[0].mesh->closed);
  CHECK(signed_volume(*file.pieces[0].mesh) == 1.0);
  CHECK(file.pieces[0].mesh->vertices.size() == 8);
  CHECK(file.pieces[0].mesh->triangles.size() == 12);
  CHECK(file.pieces[0].material.empty());
  CHECK(file.materials.empty());
  CHECK(file.notices.empty());
}

TEST_CASE("vertices that each face has for itself are welded") {
  std::string text;
  const double corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  for (const auto& face : Cube::faces) {
    // A zero may have a sign.
    for (const int i : face)
      text += fmt::format("v {}{} {} {}\n", corner[i - 1][0] == 0.0 && i % 2 == 0 ? "-" : "", corner[i - 1][0], corner[i - 1][1],
                          corner[i - 1][2]);
    text += "f -4 -3 -2 -1\n";
  }
  const ObjFile file = read(text);
  REQUIRE(file.pieces.size() == 1);
  CHECK(file.pieces[0].mesh->vertices.size() == 8);
  check_volume(file.pieces[0], 1.0);
  CHECK(file.notices.empty());
}

TEST_CASE("a cube that faces inward is turned") {
  const ObjFile file = read(Cube{.flipped = true}.all());
  REQUIRE(file.pieces.size() == 1);
  check_volume(file.pieces[0], 1.0);
  REQUIRE(file.notices.size() == 1);
  CHECK(file.notices[0] == "thing.obj: 1 closed part faced inward: turned outward");
}

TEST_CASE("a cube whose faces turn different ways is made consistent") {
  for (unsigned turned = 1; turned < 63; ++turned) {
    const Cube cube;
    std::string text = cube.vertices();
    for (std::size_t k = 0; k < 6; ++k) text += cube.face(k, ((turned >> k) & 1u) != 0);
    const ObjFile file = read(text);
    REQUIRE(file.pieces.size() == 1);
    check_volume(file.pieces[0], 1.0);
    CHECK(noticed(file, "1 closed part had faces that turned different ways"));
  }
}

TEST_CASE("a hollow cube keeps its cavity, whichever way the file faces") {
  for (const bool outer_flipped : {false, true}) {
    CAPTURE(outer_flipped);
    const Cube outer{{0, 0, 0}, 4.0, 0, outer_flipped}, cavity{{1, 1, 1}, 2.0, 8, !outer_flipped};
    const ObjFile file = read(outer.all() + cavity.all());
    REQUIRE(file.pieces.size() == 1);
    check_volume(file.pieces[0], 64.0 - 8.0);
    CHECK(file.notices.empty() != outer_flipped);
    if (outer_flipped) {
      CHECK(noticed(file, "1 closed part faced inward"));
      CHECK(noticed(file, "1 cavity faced into the matter"));
    }
  }
}

TEST_CASE("a cube in the cavity of a cube is matter again") {
  for (const bool flipped : {false, true}) {
    const ObjFile file =
        read(Cube{{0, 0, 0}, 6.0, 0, flipped}.all() + Cube{{1, 1, 1}, 4.0, 8, !flipped}.all() + Cube{{2, 2, 2}, 2.0, 16, flipped}.all());
    REQUIRE(file.pieces.size() == 1);
    check_volume(file.pieces[0], 216.0 - 64.0 + 8.0);
  }
}

TEST_CASE("a cavity whose face lies in the outer face is still one") {
  const ObjFile file = read(Cube{{0, 0, 0}, 4.0}.all() + Cube{{1, 1, 0}, 2.0, 8, true}.all());
  REQUIRE(file.pieces.size() == 1);
  check_volume(file.pieces[0], 56.0);
  CHECK(file.notices.empty());
}

TEST_CASE("what faces inward beside something is no cavity") {
  const ObjFile file = read(Cube{{0, 0, 0}, 4.0}.all() + Cube{{6, 0, 0}, 2.0, 8, true}.all() + Cube{{3, 3, 3}, 2.0, 16, true}.all());
  REQUIRE(file.pieces.size() == 1);
  check_volume(file.pieces[0], 64.0 + 8.0 + 8.0);
  CHECK(noticed(file, "2 closed parts faced inward"));
}

TEST_CASE("a cube within a cube, both facing outward, are two volumes") {
  const ObjFile file = read(Cube{{0, 0, 0}, 4.0}.all() + Cube{{1, 1, 1}, 2.0, 8}.all());
  REQUIRE(file.pieces.size() == 1);
  check_volume(file.pieces[0], 64.0 + 8.0);
  CHECK(file.notices.empty());
  // Of another material, one that faces inward is no cavity but is turned.
  const ObjFile other = read("usemtl a\n" + Cube{{0, 0, 0}, 4.0}.all() + "usemtl b\n" + Cube{{1, 1, 1}, 2.0, 8, true}.all());
  REQUIRE(other.pieces.size() == 2);
  check_volume(other.pieces[0], 64.0);
  check_volume(other.pieces[1], 8.0);
}

TEST_CASE("a cube without one face is a thin sheet") {
  const Cube cube;
  std::string text = cube.vertices();
  for (std::size_t k = 0; k < 5; ++k) text += cube.face(k);
  const ObjFile file = read(text);
  REQUIRE(file.pieces.size() == 1);
  CHECK_FALSE(file.pieces[0].mesh->closed);
  CHECK(area(*file.pieces[0].mesh) == 5.0);
  REQUIRE(file.notices.size() == 1);
  CHECK(file.notices[0] ==
        "thing.obj: 1 open part is a thin sheet (10 triangles, 4 boundary edges) instead of volumes, since they do not close");
}

TEST_CASE("hundreds of open parts are told of in one sentence") {
  std::string text;
  for (int i = 0; i < 300; ++i) text += fmt::format("v {} 0 0\nv {}.5 0 0\nv {} 1 0\nf -3 -2 -1\n", i, i, i);
  const ObjFile file = read(text + Cube{{0, 0, 5}, 1.0, 900}.all());
  REQUIRE(file.pieces.size() == 2);
  check_volume(file.pieces[0], 1.0);
  CHECK_FALSE(file.pieces[1].mesh->closed);
  REQUIRE(file.notices.size() == 1);
  CHECK(file.notices[0].find("300 open parts are thin sheets (300 triangles, 900 boundary edges)") != std::string::npos);
}

TEST_CASE("a cube that only two materials close together is sheets of both") {
  const Cube cube;
  std::string text = cube.vertices() + "usemtl side\n";
  for (std::size_t k = 2; k < 6; ++k) text += cube.face(k);
  text += "usemtl lid\n" + cube.face(0) + cube.face(1);
  const ObjFile file = read(text);
  REQUIRE(file.pieces.size() == 2);
  CHECK(file.pieces[0].material == "side");
  CHECK(area(*file.pieces[0].mesh) == 4.0);
  CHECK(file.pieces[1].material == "lid");
  CHECK(area(*file.pieces[1].mesh) == 2.0);
  for (const MeshPiece& piece : file.pieces) CHECK_FALSE(piece.mesh->closed);
  CHECK(noticed(
      file, "1 closed part is a thin sheet (12 triangles) instead of volumes, since faces of several materials close them only together"));
}

TEST_CASE("cubes that touch at a corner, an edge or a face stay volumes") {
  const glm::dvec3 offsets[] = {{1, 1, 1}, {1, 1, 0}, {1, 0, 0}};
  for (const glm::dvec3& offset : offsets)
    for (const bool second_flipped : {false, true}) {
      CAPTURE(offset.y + offset.z);
      CAPTURE(second_flipped);
      const std::string first = Cube{}.all(), second = Cube{offset, 1.0, 8, second_flipped}.all();
      const ObjFile two = read("usemtl a\n" + first + "usemtl b\n" + second);
      REQUIRE(two.pieces.size() == 2);
      for (const MeshPiece& piece : two.pieces) check_volume(piece, 1.0);
      if (offset.y == 0.0 && second_flipped) continue;  // of one material, the face between them cannot tell which is turned
      const ObjFile one = read(first + second);
      REQUIRE(one.pieces.size() == 1);
      check_volume(one.pieces[0], 2.0);
    }
}

TEST_CASE("a sheet that is modelled from both sides is one sheet") {
  const ObjFile file = read("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nf 3 2 1\n");
  REQUIRE(file.pieces.size() == 1);
  CHECK_FALSE(file.pieces[0].mesh->closed);
  CHECK(file.pieces[0].mesh->triangles.size() == 1);
  CHECK(noticed(file, "nothing lies between their faces"));
  CHECK(noticed(file, "1 triangle of thin sheets had the same corners as another"));
}

TEST_CASE("concave faces are cut within their outline, in any plane") {
  // A staple of area 5, once in each plane and once tilted; its corners are far more than tinyobjloader's own shapes can count if it is a
  // comb.
  const std::string flat[] = {"v 0 0 9\nv 3 0 9\nv 3 2 9\nv 2 2 9\nv 2 1 9\nv 1 1 9\nv 1 2 9\nv 0 2 9\n",
                              "v 9 0 0\nv 9 3 0\nv 9 3 2\nv 9 2 2\nv 9 2 1\nv 9 1 1\nv 9 1 2\nv 9 0 2\n",
                              "v 0 9 0\nv 3 9 0\nv 3 9 2\nv 2 9 2\nv 2 9 1\nv 1 9 1\nv 1 9 2\nv 0 9 2\n"};
  for (const std::string& vertices : flat)
    for (const char* face : {"f 1 2 3 4 5 6 7 8\n", "f 8 7 6 5 4 3 2 1\n", "f 6 7 8 1 2 3 4 5\n"}) {
      const ObjFile file = read(vertices + face);
      REQUIRE(file.pieces.size() == 1);
      CHECK(area(*file.pieces[0].mesh) == 5.0);
    }
  // A dart: fans from three of its four corners would leave it.
  for (const char* face : {"f 1 2 3 4\n", "f 2 3 4 1\n", "f 4 3 2 1\n"}) {
    const ObjFile dart = read(std::string("v 0 0 0\nv 2 1 2\nv 0 2 0\nv 0.5 1 0.5\n") + face);
    CHECK(area(*dart.pieces[0].mesh) == doctest::Approx(1.5 * std::sqrt(2.0)).epsilon(1e-14));
  }
  std::string comb, face = "f";
  for (int i = 0; i < 200; ++i) comb += fmt::format("v {} {} 0\n", i, i % 2 == 0 ? 1 : 3);
  comb += "v 199 0 0\nv 0 0 0\n";
  for (int i = 202; i >= 1; --i) face += fmt::format(" {}", i);
  for (int i = 0; i < 100; ++i) comb += fmt::format("v {} 0 -1\n", i);  // more than 255 corners
  for (int i = 0; i < 100; ++i) face += fmt::format("/1 {}", 203 + i);
  const ObjFile many = read("vt 0 0\n" + comb + face + "\n");
  CHECK(many.pieces[0].mesh->triangles.size() == 300);
}

TEST_CASE("a face with a hole that a cut joins to its outline") {
  const ObjFile file = read("v 0 0 0\nv 3 0 0\nv 3 3 0\nv 0 3 0\nv 1 1 0\nv 2 1 0\nv 2 2 0\nv 1 2 0\nf 1 2 3 4 1 5 8 7 6 5\n");
  REQUIRE(file.pieces.size() == 1);
  CHECK(area(*file.pieces[0].mesh) == 8.0);
  CHECK(file.pieces[0].mesh->triangles.size() == 8);
}

TEST_CASE("the y axis may point up") {
  const ObjFile file = read("v 1 2 3\nv 4 2 3\nv 1 7 3\nf 1 2 3\n", {.y_up = true});
  const Mesh& mesh = *file.pieces[0].mesh;
  CHECK(mesh.low == glm::dvec3(1, -3, 2));
  CHECK(mesh.high == glm::dvec3(4, -3, 7));
  check_volume(read(Cube{}.all(), {.y_up = true}).pieces[0], 1.0);
}

TEST_CASE("materials and their dissolve come from the MTL files") {
  const TemporaryFolder folder;
  folder.write("my glass.mtl",
               "newmtl glass\r\nKd 1 1 1\r\nd 0.25\r\n\r\nnewmtl tinted\nTr 0.75\nnewmtl odd\nd nan\nnewmtl halo\nd -halo 0.5\n");
  folder.write("more.mtl", "newmtl solid  \nKd 1 0 0\nnewmtl unused\nd 0.5\n");
  const auto file =
      read_obj(folder.write("a.obj",
                            "mtllib my glass.mtl\nmtllib none.mtl more.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl solid\nf 1 2 3\n"
                            "usemtl unused\nusemtl  tinted \nf 1 2 3\nusemtl glass\nf 1 2 3\nusemtl odd\nf 1 2 3\nusemtl unknown\nf 1 2 3\n"
                            "usemtl solid\nf 3 2 1\n"));
  REQUIRE(static_cast<bool>(file));
  REQUIRE(file->materials.size() == 5);
  const std::vector<ObjMaterial> expected = {
      {"solid", 1.0, true}, {"tinted", 0.25, true}, {"glass", 0.25, true}, {"odd", 1.0, true}, {"unknown", 1.0, false}};
  for (std::size_t i = 0; i < 5; ++i) {
    CHECK(file->materials[i].name == expected[i].name);
    CHECK(file->materials[i].dissolve == doctest::Approx(expected[i].dissolve).epsilon(1e-12));
    CHECK(file->materials[i].defined == expected[i].defined);
  }
  REQUIRE(file->pieces.size() == 6);
  CHECK(file->pieces[0].material.empty());
  CHECK(file->pieces[5].material == "unknown");
  CHECK(noticed(*file, "none.mtl: does not exist (an MTL file that a.obj names)"));
  CHECK(noticed(*file, "my glass.mtl:8:1: the dissolve 'nan' is left out, expected a number from 0 to 1"));
  CHECK(noticed(*file, "the dissolve '-halo' is left out"));
  CHECK(noticed(*file, "a.obj: no MTL file defines 'unknown'"));
}

TEST_CASE("line ends, joined lines, comments, groups and blanks are as files have them") {
  const ObjFile file = read(
      "\xef\xbb\xbfv 0 0 0 1.0 # first\r\n# C:\\models\\\r\nv +1 .0 0. 0.5 0.5 0.5\rv 1e0 1E+0 \\\r\n 0\ng\ng one two\no thing\ns off\n\n  "
      "\t f\t1/ 2// \\\n\\\n3 # last\n"
      "vp 0 0\nl 1 2\np 1\n\\");
  REQUIRE(file.pieces.size() == 1);
  CHECK(file.pieces[0].mesh->triangles.size() == 1);
  CHECK(area(*file.pieces[0].mesh) == 0.5);
  CHECK(noticed(file, "2 lines, points, curves or surfaces have been left out"));
}

TEST_CASE("vertices are where the file says, to the last bit, and however it says it") {
  const ObjFile file = read("v 0.75 552.8 1e-1\nv 1 0.3 0\nv 0 1.1 0.0\nv 75e-2 5528e-1 0.10\nv 7 7 7\nf 1 2 3\nf 4 5 2\n");
  REQUIRE(file.pieces.size() == 1);
  const Mesh& mesh = *file.pieces[0].mesh;
  REQUIRE(mesh.vertices.size() == 4);
  CHECK(mesh.vertices[0] == glm::dvec3(0.75, 552.8, 0.1));
  CHECK(mesh.vertices[1] == glm::dvec3(1, 0.3, 0));
  CHECK(mesh.vertices[2] == glm::dvec3(0, 1.1, 0));
}

TEST_CASE("degenerate triangles are dropped and told of") {
  const ObjFile file = read(Cube{}.all() + "v 0 0 0\nf 1 1 2\nf 1 9 3\nf 1 2 2 7\n");
  REQUIRE(file.pieces.size() == 2);
  check_volume(file.pieces[0], 1.0);
  CHECK(noticed(file, "3 triangles with two equal corners have been left out"));
}

TEST_CASE("all faults of a file are told, twenty at most") {
  std::string text = "v 0 0 0\nv x 0 0\nv 0 1\n";
  const std::string few = error_of(text + "f 1 2 7\n");
  CHECK(few.find("thing.obj:2:3: 'x'") != std::string::npos);
  CHECK(few.find("thing.obj:3:1: a vertex of 2") != std::string::npos);
  CHECK(few.find("thing.obj:4:7: there is no vertex 7") != std::string::npos);
  for (int i = 0; i < 30; ++i) text += "f 1 2 7\n";
  const std::string many = error_of(text);
  CHECK(std::count(many.begin(), many.end(), '\n') == 20);
  CHECK(many.find("thing.obj: and 12 more") != std::string::npos);
}

TEST_CASE("files that are too large are refused before they are read") {
  std::string face = "v 0 0 0\nf";
  for (int i = 0; i < 20'000'003; ++i) face += " 1";
  CHECK(error_of(face).find("has faces for 20000001 triangles, expected at most 20000000") != std::string::npos);
}

TEST_CASE("every broken OBJ file is told of at its place") {
  const fs::path folder = fs::path(THICKET_SOURCE_ROOT) / "tests" / "worlds" / "broken" / "obj";
  int count = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".obj") continue;
    ++count;
    const std::string name = entry.path().filename().string();
    CAPTURE(name);
    auto expected = read_text_file(fs::path(entry.path()).replace_extension(".expected"));
    REQUIRE(static_cast<bool>(expected));
    while (expected->ends_with('\n')) expected->pop_back();
    REQUIRE_FALSE(expected->empty());
    const auto file = read_obj(entry.path());
    REQUIRE_FALSE(static_cast<bool>(file));
    INFO(file.error().message);
    CHECK(file.error().message.find(*expected) != std::string::npos);
  }
  CHECK(count >= 14);
}

TEST_CASE("a file that is not there, and a folder, are errors") {
  const TemporaryFolder folder;
  const auto none = read_obj(folder.path() / "none.obj");
  REQUIRE_FALSE(static_cast<bool>(none));
  CHECK(none.error().message.find("none.obj: does not exist") != std::string::npos);
  CHECK_FALSE(static_cast<bool>(read_obj(folder.path())));
}

TEST_CASE("broken OBJ files of others have the outcome that is right") {
  const auto error = [](const char* name) -> std::string {
    const auto file = read_obj(*outside_data(name));
    REQUIRE_FALSE(static_cast<bool>(file));
    return file.error().message;
  };
  if (!outside_data("obj/invalid-face-definition.obj")) {
    MESSAGE("skipped: no outside data");
    return;
  }
  const std::string faces = error("obj/invalid-face-definition.obj");
  CHECK(faces.find(":15:1: a face of 1 corner") != std::string::npos);
  CHECK(faces.find(":18:1: a face of 2 corners") != std::string::npos);
  const std::string relative = error("obj/invalid-relative-vertex-index.obj");
  CHECK(relative.find(":1:3: there is no vertex -4") != std::string::npos);
  const std::string zero = error("obj/issue-140-zero-face-idx.obj");
  CHECK(zero.find(":16:3: there is no vertex 0, expected 1 to 4") != std::string::npos);
  const std::string nan = error("obj/test-nan.obj");
  CHECK(nan.find(":12:3: 'nan' is not a finite number") != std::string::npos);
  CHECK(nan.find(":14:3: '1.#IND'") != std::string::npos);
  const auto missing = read_obj(*outside_data("obj/missing_material_file.obj"));
  REQUIRE(static_cast<bool>(missing));
  CHECK(noticed(*missing, "no MTL file defines 'white'"));
  for (const ObjMaterial& material : missing->materials) CHECK_FALSE(material.defined);
}

TEST_CASE("OBJ files of others load") {
  if (!outside_data("obj/cornell_box.obj")) {
    MESSAGE("skipped: no outside data");
    return;
  }
  const auto load = [](const char* name) {
    const auto file = read_obj(*outside_data(name));
    REQUIRE(static_cast<bool>(file));
    return *file;
  };
  const ObjFile box = load("obj/cornell_box.obj");
  CHECK(box.materials.size() == 4);  // nothing is blue: its only face is a comment
  for (const ObjMaterial& material : box.materials) CHECK(material.defined);
  // The blocks stand on faces of the floor's list.
  const auto blocks = std::find_if(box.pieces.begin(), box.pieces.end(), [](const MeshPiece& piece) { return piece.mesh->closed; });
  REQUIRE(blocks != box.pieces.end());
  CHECK(blocks->mesh->triangles.size() == 24);
  const ObjFile floor = load("obj/floor_1.obj");
  REQUIRE(floor.pieces.size() == 1);
  CHECK(floor.pieces[0].material == "floor_1");
  CHECK(noticed(floor, "2 open parts are thin sheets (32 triangles"));
  const ObjFile wall = load("obj/wall_1.obj");  // boxes without a bottom
  REQUIRE(wall.pieces.size() == 1);
  CHECK(noticed(wall, "31 open parts are thin sheets (310 triangles, 124 boundary edges)"));
  const ObjFile stadium = load("obj/stadium.obj");
  CHECK(stadium.materials.size() == 3);
  CHECK(noticed(stadium, "11978 triangles"));
}
