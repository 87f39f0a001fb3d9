// `thicket truth` and `thicket convert` as a person or a script meets them.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <utility>

#include "outside_data.hpp"
#include "program_call.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/image.hpp"
#include "thicket/base/map_file.hpp"
#include "thicket/base/movingai.hpp"
#include "thicket/worlds/world.hpp"

namespace thicket {
namespace {

/// A wall with a gap of 1 m from x = 3 to 3.2, in a room of 6 x 4 m; smoke in the gap; a lintel over it.
constexpr const char* gap_world = R"(name = "gap"
bounds_m = [0.0, 0.0, 6.0, 4.0]
[material.stone]
[material.smoke]
stops_motion = false
[[solid]]
type = "box"
material = "stone"
position_m = [3.1, 0.75, 1.0]
size_m = [0.2, 1.5, 2.0]
[[solid]]
type = "box"
material = "stone"
position_m = [3.1, 3.25, 1.0]
size_m = [0.2, 1.5, 2.0]
[[solid]]
type = "box"
material = "smoke"
position_m = [3.1, 2.0, 0.5]
size_m = [0.2, 1.0, 1.0]
[[solid]]
type = "box"
material = "stone"
position_m = [3.1, 2.0, 1.9]
size_m = [0.2, 1.0, 0.2]
)";

long occupied(const GridMap& map) { return std::count(map.cells.begin(), map.cells.end(), CellState::occupied); }

}  // namespace

TEST_CASE("truth writes what is there, at the heights and the resolution that are asked for") {
  const TemporaryFolder folder;
  folder.write("gap.toml", gap_world);
  const Answer answer = call(folder, "truth gap.toml --out low.yaml --resolution 0.1");
  CHECK(answer.err == "");
  CHECK(answer.code == 0);
  CHECK(has(answer.out, "cells      60 x 40 of 0.1 m"));
  CHECK(has(answer.out, "occupied   2.500 %"));
  const auto low = read_map_file(folder.path() / "low.yaml");
  REQUIRE(low);
  CHECK(low->width == 60);
  CHECK(low->height == 40);
  CHECK(low->resolution == 0.1);
  CHECK(low->origin == glm::dvec2(0.0));
  CHECK(occupied(*low) == 60);
  CHECK(low->at(30, 14) == CellState::occupied);
  CHECK(low->at(31, 14) == CellState::occupied);
  CHECK(low->at(30, 15) == CellState::free);
  CHECK(low->at(29, 14) == CellState::free);
  const auto count = [&](const std::string& flags) {
    const Answer one = call(folder, "truth gap.toml --resolution 0.1 --out m " + flags);
    CHECK(one.code == 0);
    return occupied(*read_map_file(folder.path() / "m.yaml"));
  };
  CHECK(count("--z-high 1.9") == 80);
  CHECK(count("--all-matter") == 80);
  CHECK(count("--z-low 2 --z-high 3") == 0);
  CHECK(count("--bounds 3,0,4,1") == 20);
  CHECK(count("--bounds -0.05,0,6,4") == 90);
  CHECK(count("--bounds -0.05,0,6,4 --convention centre") == 90);  // centres on the faces count
  CHECK(count("--bounds -0.04,0,6,4 --convention centre") == 60);
  // Each wall of 2 x 15 cells gets a column on either side (0.05 m from it), and four cells at its end (0.05 m and, at the corners, 0.071 m).
  CHECK(count("--grow 0.101") == 128);
}

TEST_CASE("truth tells whether there is a way, and how long") {
  const TemporaryFolder folder;
  folder.write("gap.toml", gap_world);
  const std::string way = " --from 0.55,2.05 --to 5.55,2.05 --resolution 0.1 --out m.png";
  const Answer wide = call(folder, "truth gap.toml --grow 0.4" + way), narrow = call(folder, "truth gap.toml --grow 0.6" + way);
  CHECK(wide.code == 0);
  CHECK(has(wide.out, "connected  yes, the shortest path is 5.000 m"));
  CHECK(narrow.code == 3);
  CHECK(has(narrow.out, "connected  no\n"));
  CHECK(call(folder, "truth gap.toml --all-matter" + way).code == 3);
  const Answer inside = call(folder, "truth gap.toml --from 3.1,1 --to 5,2 --out m.png");
  CHECK(inside.code == 3);
  CHECK(has(inside.out, "--from lies in a blocked cell"));
  REQUIRE(call(folder, "truth gap.toml" + way).code == 0);
  const auto picture = read_image(folder.path() / "m.png");
  REQUIRE(picture);
  CHECK(picture->width == 60);
  CHECK(picture->at(30, 39) == 0);
  CHECK(picture->at(0, 0) == 255);
  CHECK(picture->at(30, 19) == 128);
}

TEST_CASE("truth of a MovingAI map") {
  const TemporaryFolder folder;
  folder.write("m.map", "type octile\nheight 2\nwidth 3\nmap\n.@.\n...\n");
  const Answer answer = call(folder, "truth m.map --cell-size 0.5 --resolution 0.5 --bounds 0,0,1.5,1 --from 0.2,0.8 --to 1.2,0.8 --out t");
  CHECK(answer.code == 0);
  CHECK(has(answer.out, "the shortest path is 2.000 m"));
  CHECK(occupied(*read_map_file(folder.path() / "t.yaml")) == 1);
}

TEST_CASE("truth and convert refuse what makes no sense, with exit code 2") {
  const TemporaryFolder folder;
  folder.write("gap.toml", gap_world);
  folder.write("empty.toml", "name = \"empty\"\n");
  folder.write("m.map", "type octile\nheight 1\nwidth 2\nmap\n.@\n");
  REQUIRE(call(folder, "convert m.map kept.yaml").code == 0);
  REQUIRE(call(folder, "convert m.map kept.toml").code == 0);
  for (const auto& [arguments, words] :
       {std::pair{"truth gap.toml", "--out is required"}, {"truth nowhere --out m", "there is no file 'nowhere'"}, {"truth gap.toml --out m --resolution 0", "the resolution is 0 m"},
        {"truth gap.toml --out m --resolution nan", "the resolution is nan m"}, {"truth gap.toml --out m --resolution 1e-6", "expected at most 268435456"}, {"truth gap.toml --out m --grow -1", "--grow"},
        {"truth gap.toml --out m --grow 1 --convention centre", "--convention"}, {"truth gap.toml --out m --grow 1 --all-matter", "--all-matter does not go with --grow"},
        {"truth gap.toml --out m --convention middle", "expected centre or overlap"}, {"truth gap.toml --out m --bounds 0,0,1", "expected X0,Y0,X1,Y1"}, {"truth gap.toml --out m --bounds 0,0,1,1,1", "expected X0,Y0,X1,Y1"},
        {"truth gap.toml --out m --bounds 0,0,-1,1", "the bounds are 0, 0 to -1, 1 m"}, {"truth gap.toml --out m --from 1,1", "--to is missing"}, {"truth gap.toml --out m --to 1,1", "--from is missing"},
        {"truth gap.toml --out m --from 1 --to 1,1", "--from is '1', expected X,Y"}, {"truth gap.toml --out m --from 1,1 --to 1,x", "--to is '1,x', expected X,Y"},
        {"truth gap.toml --out m --from 1,1 --to 7,1", "--to lies outside the grid"}, {"truth gap.toml --out m --z-low 1", "the heights are 1 to 0.5 m"}, {"truth gap.toml --out m.map", "expected a name ending in .yaml"},
        {"truth gap.toml --out m --map-image x.pgm", "a map image is given"}, {"truth empty.toml --out m", "expected --bounds"}, {"truth kept.yaml --out kept", "kept.yaml: would be overwritten"},
        {"truth kept.toml --out kept", "kept.yaml: would be overwritten"}, {"convert m.map m.map", "m.map: would be overwritten"}, {"convert kept.yaml ./kept.yaml", "would be overwritten"},
        {"convert kept.yaml kept.toml", "kept.yaml: would be overwritten"}, {"convert kept.toml kept.yaml", "would be overwritten"}, {"convert m.map m.txt", "'m.txt': cannot tell the format"}, {"convert m.map m", "cannot tell the format"},
        {"convert nowhere.map m.yaml", "there is no file"}, {"convert m.map m.yaml --cell-size 0", "the cell size is 0 m"}, {"convert m.map m.toml --height 0", "--height is 0"},
        {"convert m.map m.yaml --map-image kept.pgm", "a map image is given"}, {"convert m.map", "out is required"}}) {
    CAPTURE(arguments);
    const Answer answer = call(folder, arguments);
    CHECK(answer.code == 2);
    CHECK_MESSAGE(has(answer.err, words), answer.err);
  }
  CHECK_FALSE(std::filesystem::exists(folder.path() / "m.yaml"));
}

TEST_CASE("convert keeps the cells, there and back again") {
  const TemporaryFolder folder;
  const std::string text = "type octile\nheight 3\nwidth 4\nmap\n..@.\n@...\n.@@.\n";
  folder.write("a.map", text);
  REQUIRE(call(folder, "convert a.map b.yaml --cell-size 0.25").code == 0);
  const auto there = read_map_file(folder.path() / "b.yaml"), original = read_movingai_map(folder.path() / "a.map", 0.25);
  REQUIRE(there);
  CHECK(there->cells == original->cells);
  CHECK(there->resolution == 0.25);
  const Answer back = call(folder, "convert b.yaml c.map");
  CHECK(back.code == 0);
  CHECK(has(back.out, "a .map keeps neither resolution nor origin: 0.25 m a cell"));
  CHECK_FALSE(has(back.out, "unknown"));
  CHECK(*read_text_file(folder.path() / "c.map") == text);

  // As a world: the same matter, which is mapped to the same cells.
  REQUIRE(call(folder, "convert b.yaml d.toml --height 1.5").code == 0);
  const auto world = read_world(folder.path() / "d.toml");
  REQUIRE_MESSAGE(static_cast<bool>(world), (world ? "" : world.error().message));
  REQUIRE(world->solids.size() == 1);
  CHECK(std::get<MapSolid>(world->solids[0].shape).grid.cells == original->cells);
  CHECK(std::get<MapSolid>(world->solids[0].shape).height == 1.5);
  REQUIRE(call(folder, "truth d.toml --bounds 0,0,1,0.75 --resolution 0.25 --z-low 1 --z-high 1.2 --out e").code == 0);
  CHECK(read_map_file(folder.path() / "e.yaml")->cells == original->cells);
  // The world states the map's bounds: nothing of a free border is lost.
  REQUIRE(call(folder, "convert d.toml f.map --resolution 0.25").code == 0);
  const auto again = read_movingai_map(folder.path() / "f.map", 0.25);
  REQUIRE(again);
  CHECK(again->width == original->width);
  CHECK(again->height == original->height);
  CHECK(occupied(*again) == 4);
}

TEST_CASE("convert of a map with unknown cells notes that they become walls") {
  const TemporaryFolder folder;
  const GridMap map{3, 1, 0.1, {2.0, 3.0}, 0.0, {CellState::free, CellState::unknown, CellState::occupied}};
  REQUIRE(write_map_file(folder.path() / "u", map));
  const Answer answer = call(folder, "convert u.yaml u.map");
  CHECK(answer.code == 0);
  CHECK(has(answer.out, "1 unknown cells became '@'"));
  CHECK(has(answer.out, "origin 2, 3 m"));
  CHECK(has(*read_text_file(folder.path() / "u.map"), "map\n.@@\n"));
}

TEST_CASE("outside maps go from MovingAI to map_server and back without a change") {
  for (const char* name : {"movingai/Berlin_0_256.map", "movingai/64room_000.map"}) {
    const auto file = outside_data(name);
    if (!file) {
      MESSAGE("skipped: no outside data");
      return;
    }
    const TemporaryFolder folder;
    REQUIRE(call(folder, "convert '" + file->string() + "' a.yaml").code == 0);
    REQUIRE(call(folder, "convert a.yaml b.map").code == 0);
    const auto before = read_movingai_map(*file, 1.0), after = read_movingai_map(folder.path() / "b.map", 1.0);
    REQUIRE(after);
    CHECK(before->cells == after->cells);
  }
}

}  // namespace thicket
