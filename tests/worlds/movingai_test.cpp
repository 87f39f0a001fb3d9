#include "thicket/base/movingai.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "../outside_data.hpp"
#include "../temporary_folder.hpp"
#include "thicket/base/files.hpp"

using namespace thicket;

namespace {

constexpr CellState F = CellState::free, O = CellState::occupied, U = CellState::unknown;

Result<GridMap> read(const TemporaryFolder& folder, const std::string& text, double cell_size = 1.0) {
  return read_movingai_map(folder.write("m.map", text), cell_size);
}

/// The message, from the file's name on.
std::string error_of(const TemporaryFolder& folder, const std::string& text) {
  const auto map = read(folder, text);
  REQUIRE_FALSE(map);
  const std::string& message = map.error().message;
  return message.substr(message.find("m.map"));
}

}  // namespace

TEST_CASE("a MovingAI map is read, its top row last") {
  const TemporaryFolder folder;
  const auto map = read(folder, "type octile\nheight 2\nwidth 4\nmap\n.@OT\nWGS.\n", 0.25);
  REQUIRE(map);
  CHECK(map->width == 4);
  CHECK(map->height == 2);
  CHECK(map->resolution == 0.25);
  CHECK(map->origin == glm::dvec2(0.0));
  CHECK(map->cells == std::vector<CellState>{O, F, F, F, F, O, O, O});
}

TEST_CASE("a MovingAI map: width first, lines of Windows, no last line end, empty lines after it") {
  const TemporaryFolder folder;
  for (const char* text : {"type octile\nwidth 2\nheight 1\nmap\n.@", "type octile\r\nheight 1\r\nwidth 2\r\nmap\r\n.@\r\n", "type octile\nheight 1\nwidth 2\nmap\n.@\n\n\r\n"}) {
    CAPTURE(text);
    const auto map = read(folder, text);
    REQUIRE(map);
    CHECK(map->cells == std::vector<CellState>{F, O});
  }
}

TEST_CASE("faults of a MovingAI map, where they stand") {
  const TemporaryFolder folder;
  const std::string head = "type octile\nheight 2\nwidth 3\nmap\n";
  CHECK(error_of(folder, "") == "m.map:1:1: '', expected 'type octile'");
  CHECK(error_of(folder, "type tile\n") == "m.map:1:1: 'type tile', expected 'type octile'");
  CHECK(error_of(folder, "type octile\n") == "m.map:2:1: the file ends, expected 'height N'");
  CHECK(error_of(folder, "type octile\nheight 2\nmap\n") == "m.map:3:1: 'map', expected 'width N' before it");
  CHECK(error_of(folder, "type octile\nheight 2\nheight 2\n") == "m.map:3:1: 'height' is there twice, expected once");
  CHECK(error_of(folder, "type octile\nheight 2\nwitdh 3\n") == "m.map:3:1: 'witdh 3', expected 'width N'");
  CHECK(error_of(folder, "type octile\nheight 2\nwidth 3\n...\n") == "m.map:4:1: '...', expected 'map'");
  for (const char* wrong : {"0", "-1", "2.5", "x", "", "268435457", "99999999999999999999"}) {
    CAPTURE(wrong);
    CHECK(error_of(folder, std::string("type octile\nheight 2\nwidth ") + wrong + "x\n").find("m.map:3:7: the width is '") == 0);
    CHECK(error_of(folder, std::string("type octile\nwidth 2\nheight ") + wrong + "\nmap\n").find("m.map:3:8: the height is '") == 0);
  }
  CHECK(error_of(folder, "type octile\nheight 20000\nwidth 20000\nmap\n") == "m.map:4:1: the size is 20000 x 20000, expected at most 268435456 cells");
  CHECK(error_of(folder, "type octile\nheight 10000\nwidth 10000\nmap\n...\n") == "m.map:4:1: truncated: 4 bytes follow 'map', expected 10000 rows of 10000 letters");
  CHECK(error_of(folder, head + "...\n...\n...\n") == "m.map:7:1: '...' after the last row, expected 2 rows (height)");
  CHECK(error_of(folder, head + "......\n") == "m.map:5:4: row 1 has 6 letters, expected 3 (width)");
  CHECK(error_of(folder, head + "...\n..\n\n") == "m.map:6:3: row 2 has 2 letters, expected 3 (width)");
  CHECK(error_of(folder, head + "....\n...\n") == "m.map:5:4: row 1 has 4 letters, expected 3 (width)");
  CHECK(error_of(folder, head + "...@@@\n") == "m.map:5:4: row 1 has 6 letters, expected 3 (width)");
  CHECK(error_of(folder, head + "...\n.x.\n") == "m.map:6:2: 'x' in row 2, expected one of . G S (passable), @ O T W (not)");
  CHECK(error_of(folder, head + "...\n\x01..\n") == "m.map:6:1: '.' in row 2, expected one of . G S (passable), @ O T W (not)");
  for (const double size : {0.0, -1.0, 1e-7, 1e7, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) CHECK_FALSE(read(folder, head + "...\n...\n", size));
  CHECK_FALSE(read_movingai_map(folder.path() / "none.map", 1.0));
}

TEST_CASE("what is written as a MovingAI map is read again, unknown cells as walls") {
  const TemporaryFolder folder;
  const GridMap map{3, 2, 0.1, {4.0, 5.0}, 0.5, {F, O, U, F, F, O}};
  const auto file = folder.path() / "out.map";
  REQUIRE(write_movingai_map(file, map));
  CHECK(*read_text_file(file) == "type octile\nheight 2\nwidth 3\nmap\n..@\n.@@\n");
  const auto again = read_movingai_map(file, 0.1);
  REQUIRE(again);
  CHECK(again->cells == std::vector<CellState>{F, O, O, F, F, O});
  CHECK_FALSE(write_movingai_map(file, {2, 2, 1.0, {}, 0.0, {F}}));
  CHECK_FALSE(write_movingai_map(file, {0, 0, 1.0, {}, 0.0, {}}));
}

TEST_CASE("MovingAI maps from elsewhere") {
  struct Expected {
    const char* file;
    int width, height;
    long free;
  };
  for (const Expected& expected : {Expected{"movingai/64room_000.map", 512, 512, 246178}, {"movingai/Berlin_0_256.map", 256, 256, 48147}, {"movingai/maze-32-32-4.map", 32, 32, 790},
                                   {"movingai/random-32-32-20.map", 32, 32, 819}, {"movingai/room-64-64-16.map", 64, 64, 3646}, {"movingai/warehouse-10-20-10-2-1.map", 161, 63, 5699}}) {
    const auto file = outside_data(expected.file);
    if (!file) {
      MESSAGE("skipped: no outside data");
      return;
    }
    CAPTURE(expected.file);
    const auto map = read_movingai_map(*file, 1.0);
    REQUIRE_MESSAGE(static_cast<bool>(map), (map ? "" : map.error().message));
    CHECK(map->width == expected.width);
    CHECK(map->height == expected.height);
    CHECK(std::count(map->cells.begin(), map->cells.end(), F) == expected.free);
  }
}
