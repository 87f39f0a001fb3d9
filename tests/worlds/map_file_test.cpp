#include "thicket/base/map_file.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <string_view>

#include "../outside_data.hpp"
#include "../temporary_folder.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/image.hpp"

using namespace thicket;
namespace fs = std::filesystem;

namespace {

constexpr auto U = CellState::unknown;
constexpr auto F = CellState::free;
constexpr auto O = CellState::occupied;
using Cells = std::vector<CellState>;

/// The lines of a good file; a test replaces one of them, or adds one.
std::string yaml(const std::string& key = "", const std::string& line = "") {
  std::string text;
  bool replaced = false;
  for (const std::string part :
       {"image: m.pgm", "resolution: 0.05", "origin: [1, 2, 0]", "negate: 0", "occupied_thresh: 0.65", "free_thresh: 0.196"}) {
    const bool is_it = part.substr(0, part.find(':')) == key;
    replaced |= is_it;
    text += (is_it ? line : part) + "\n";
  }
  return replaced ? text : text + line + "\n";
}

struct Reading {
  GridMap map;
  std::string error;  ///< without the folder's name
};

Reading read(std::string_view text, std::string_view image = "P2 3 1 255 0 205 254") {
  const TemporaryFolder folder;
  folder.write("m.pgm", image);
  const auto map = read_map_file(folder.write("m.yaml", text));
  if (map) return {*map, ""};
  std::string message = map.error().message;
  const std::string prefix = folder.path().string() + "/";
  for (auto at = message.find(prefix); at != std::string::npos; at = message.find(prefix)) message.erase(at, prefix.size());
  return {{}, message};
}

std::string error_of(std::string_view text) {
  return read(text).error;
}

Cells cells(std::string_view text, std::string_view image = "P2 3 1 255 0 205 254") {
  const Reading reading = read(text, image);
  CHECK(reading.error == "");
  return reading.map.cells;
}

}  // namespace

TEST_CASE("a map is read") {
  const auto [map, error] = read(yaml());
  REQUIRE(error == "");
  CHECK(map.width == 3);
  CHECK(map.height == 1);
  CHECK(map.resolution == 0.05);
  CHECK(map.origin == glm::dvec2(1.0, 2.0));
  CHECK(map.origin_yaw == 0.0);
  CHECK(map.cells == Cells{O, U, F});
}

TEST_CASE("the image's last row is the map's first") {
  const auto [map, error] = read(yaml(), "P2 2 3 255  0 254  205 0  254 205");
  REQUIRE(error == "");
  CHECK(map.cells == Cells{F, U, U, O, O, F});
  CHECK(map.at(0, 0) == F);
  CHECK(map.at(1, 2) == F);
  CHECK(map.at(0, 2) == O);
}

TEST_CASE("numbers in every spelling") {
  const auto [map, error] =
      read("image: m.pgm\nresolution: 5e-2\norigin: [-1.5e1, +2, .5]\nnegate: 0\noccupied_thresh: 1\nfree_thresh: 0\n");
  REQUIRE(error == "");
  CHECK(map.resolution == 0.05);
  CHECK(map.origin == glm::dvec2(-15.0, 2.0));
  CHECK(map.origin_yaw == 0.5);
  CHECK(read(yaml("resolution", "resolution: 1")).map.resolution == 1.0);
  CHECK(read(yaml("resolution", "resolution: \"0.1\"")).map.resolution == 0.1);
  CHECK(read(yaml("origin", "origin:\n- 3\n- 4.\n- -1")).map.origin == glm::dvec2(3.0, 4.0));
}

TEST_CASE("thresholds are strict") {
  // 51/255 and 204/255 are the doubles 0.2 and 0.8 themselves.
  const std::string text = "image: m.pgm\nresolution: 1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.8\nfree_thresh: 0.2\n";
  CHECK(cells(text, "P2 4 1 255 50 51 204 205") == Cells{O, U, U, F});
  CHECK(cells(yaml("free_thresh", "free_thresh: 0.25"), "P2 1 1 255 205") == Cells{F});  // what MAPPING warns of
}

TEST_CASE("negate turns black and white round") {
  for (const char* spelt : {"1", "true", "True", "yes"}) CHECK(cells(yaml("negate", "negate: " + std::string(spelt))) == Cells{F, O, O});
  for (const char* spelt : {"0", "false", "False"}) CHECK(cells(yaml("negate", "negate: " + std::string(spelt))) == Cells{O, U, F});
}

TEST_CASE("modes") {
  CHECK(cells(yaml("mode", "mode: trinary")) == Cells{O, U, F});
  CHECK(cells(yaml("mode", "mode: scale")) == Cells{O, U, F});
  const std::string greys = "P2 7 1 255 0 19 20 65 66 100 101";
  CHECK(cells(yaml("mode", "mode: raw"), greys) == Cells{F, F, U, U, O, O, U});
  // Raw does not care for negate.
  CHECK(cells("image: m.pgm\nmode: raw\nresolution: 1\norigin: [0, 0, 0]\nnegate: 1\noccupied_thresh: 0.65\nfree_thresh: 0.196\n", greys) ==
        Cells{F, F, U, U, O, O, U});
}

TEST_CASE("a fully transparent pixel is unknown in every mode") {
  for (const char* mode : {"trinary", "scale", "raw"}) {
    const TemporaryFolder folder;
    REQUIRE(write_png(folder.path() / "m.png", {3, 1, {0, 0, 0}, {0, 1, 255}}));
    const std::string text = yaml("image", "image: m.png") + "mode: " + mode + "\n";
    const auto map = read_map_file(folder.write("m.yaml", text));
    REQUIRE(map);
    const CellState black = std::string_view(mode) == "raw" ? F : O;
    CHECK(map->cells == Cells{U, black, black});
  }
}

TEST_CASE("an unknown key is an error with the nearest one") {
  CHECK(error_of(yaml("resolution", "resoltion: 0.05")) == "m.yaml:2:1: unknown key 'resoltion' (did you mean 'resolution'?)");
  CHECK(error_of(yaml("", "  # fine")) == "");
  CHECK(error_of(yaml("", "height: 3")) ==
        "m.yaml:7:1: unknown key 'height', expected one of image, mode, resolution, origin, negate, occupied_thresh, free_thresh");
  CHECK(error_of(yaml("", "[a]: 3")) == "m.yaml:7:1: a key is a list, expected a word");
}

TEST_CASE("a key that is missing or there twice is an error") {
  for (const char* key : {"image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh"}) {
    CHECK(error_of(yaml(key, "")) == "m.yaml: key '" + std::string(key) + "' is missing");
  }
  CHECK(error_of(yaml("", "negate: 1")) == "m.yaml:7:1: key 'negate' is there twice, expected once");
}

TEST_CASE("every value is checked, where it stands") {
  const auto wrong = [](const std::string& key, const std::string& value) { return error_of(yaml(key, key + ": " + value)); };
  const std::string metres = ", expected metres a cell, a finite number greater than 0";
  CHECK(wrong("resolution", "0") == "m.yaml:2:13: resolution is '0'" + metres);
  CHECK(wrong("resolution", "-0.05") == "m.yaml:2:13: resolution is '-0.05'" + metres);
  CHECK(wrong("resolution", "0,05") == "m.yaml:2:13: resolution is '0,05'" + metres);
  CHECK(wrong("resolution", "0.05m") == "m.yaml:2:13: resolution is '0.05m'" + metres);
  CHECK(wrong("resolution", ".inf") == "m.yaml:2:13: resolution is '.inf'" + metres);
  CHECK(wrong("resolution", "inf") == "m.yaml:2:13: resolution is 'inf'" + metres);
  CHECK(wrong("resolution", "nan") == "m.yaml:2:13: resolution is 'nan'" + metres);
  CHECK(wrong("resolution", "1e999") == "m.yaml:2:13: resolution is '1e999'" + metres);
  CHECK(wrong("resolution", "0x10") == "m.yaml:2:13: resolution is '0x10'" + metres);
  CHECK(wrong("resolution", "+-1") == "m.yaml:2:13: resolution is '+-1'" + metres);
  CHECK(wrong("resolution", "\"\"") == "m.yaml:2:13: resolution is ''" + metres);
  CHECK(wrong("resolution", "[0.05]") == "m.yaml:2:13: resolution is a list" + metres);
  CHECK(wrong("resolution", "{m: 0.05}") == "m.yaml:2:13: resolution is a map" + metres);
  CHECK(wrong("resolution", "") == "m.yaml:2:1: resolution is empty" + metres);
  CHECK(wrong("resolution", "\"\\e[2J\\n\"") == "m.yaml:2:13: resolution is '.[2J.'" + metres);

  CHECK(wrong("resolution", "9e-7") == "m.yaml:2:13: resolution is '9e-7', expected metres a cell, from 1e-06 to 1000000");
  CHECK(wrong("resolution", "1000001") == "m.yaml:2:13: resolution is '1000001', expected metres a cell, from 1e-06 to 1000000");
  CHECK(wrong("origin", "[1.1e9, -2e9, 0]") == "m.yaml:3:10: origin's x is '1.1e9', expected metres, from -1000000000 to 1000000000\n"
                                               "m.yaml:3:17: origin's y is '-2e9', expected metres, from -1000000000 to 1000000000");
  CHECK(wrong("origin", "[1, 2]") == "m.yaml:3:9: origin has 2 values, expected 3: [x, y, yaw] in metres and radians");
  CHECK(wrong("origin", "[]") == "m.yaml:3:9: origin has 0 values, expected 3: [x, y, yaw] in metres and radians");
  CHECK(wrong("origin", "[1, 2, 3, 4]") == "m.yaml:3:9: origin has 4 values, expected 3: [x, y, yaw] in metres and radians");
  CHECK(wrong("origin", "1") == "m.yaml:3:9: origin is '1', expected [x, y, yaw] in metres and radians");
  CHECK(wrong("origin", "[1, two, 0]") == "m.yaml:3:13: origin's y is 'two', expected a finite number");
  CHECK(wrong("origin", "[nan, 2, .inf]") ==
        "m.yaml:3:10: origin's x is 'nan', expected a finite number\nm.yaml:3:18: origin's yaw is '.inf', expected a finite number");
  CHECK(wrong("origin", "[1, [2], 0]") == "m.yaml:3:13: origin's y is a list, expected a finite number");

  CHECK(wrong("negate", "2") == "m.yaml:4:9: negate is '2', expected 0, 1, true or false");
  CHECK(wrong("negate", "") == "m.yaml:4:1: negate is empty, expected 0, 1, true or false");
  CHECK(wrong("negate", "[0]") == "m.yaml:4:9: negate is a list, expected 0, 1, true or false");
  CHECK(wrong("occupied_thresh", "1.01") == "m.yaml:5:18: occupied_thresh is '1.01', expected a number from 0 to 1");
  CHECK(wrong("occupied_thresh", "nan") == "m.yaml:5:18: occupied_thresh is 'nan', expected a number from 0 to 1");
  CHECK(wrong("free_thresh", "-0.1") == "m.yaml:6:14: free_thresh is '-0.1', expected a number from 0 to 1");
  CHECK(wrong("free_thresh", "65") == "m.yaml:6:14: free_thresh is '65', expected a number from 0 to 1");
  CHECK(wrong("free_thresh", "0.7") == "m.yaml:6:14: free_thresh is '0.7', expected at most occupied_thresh, 0.65");
  CHECK(wrong("free_thresh", "0.65") == "");
  CHECK(wrong("mode", "trinry") == "m.yaml:7:7: mode is 'trinry', expected trinary, scale, raw (did you mean 'trinary'?)");
  CHECK(wrong("mode", "Fast") == "m.yaml:7:7: mode is 'Fast', expected trinary, scale, raw");
  CHECK(wrong("mode", "[raw]") == "m.yaml:7:7: mode is a list, expected trinary, scale, raw");
  CHECK(wrong("image", "") == "m.yaml:1:1: image is empty, expected the name of a PGM or PNG file");
  CHECK(wrong("image", "[m.pgm]") == "m.yaml:1:8: image is a list, expected the name of a PGM or PNG file");
}

TEST_CASE("all faults of a file stand in one message, one per line") {
  CHECK(error_of("image: m.pgm\nresolution: x\norigin: [0, 0]\nnegat: 0\noccupied_thresh: 0.65\n") ==
        "m.yaml:4:1: unknown key 'negat' (did you mean 'negate'?)\n"
        "m.yaml:2:13: resolution is 'x', expected metres a cell, a finite number greater than 0\n"
        "m.yaml:3:9: origin has 2 values, expected 3: [x, y, yaw] in metres and radians\n"
        "m.yaml: key 'free_thresh' is missing");
}

TEST_CASE("what is no map at all") {
  const std::string keys = ", expected the keys image, mode, resolution, origin, negate, occupied_thresh, free_thresh";
  CHECK(error_of("") == "m.yaml: not a map" + keys);
  CHECK(error_of("\n# nothing\n") == "m.yaml: not a map" + keys);
  CHECK(error_of("just words") == "m.yaml:1:1: not a map" + keys);
  CHECK(error_of("- image: m.pgm") == "m.yaml:1:1: not a map" + keys);
  CHECK(error_of(std::string("P5\n2 2\n255\n\0\0\0\0", 15)) != "");
}

TEST_CASE("broken YAML is an error with its place, and nothing is thrown") {
  CHECK(error_of("image: m.pgm\norigin: [0, 0\n") == "m.yaml:3:1: end of sequence flow not found, expected the YAML of a map");
  CHECK(error_of("image: m.pgm\n\tnegate: 0\n") == "m.yaml:2:1: illegal tab when looking for indentation, expected the YAML of a map");
  CHECK(error_of("image: *nobody\n") == "m.yaml:1:8: the referenced anchor is not defined, expected the YAML of a map");
  for (const std::string& text :
       {std::string(100'000, '['), std::string(100'000, '{'), std::string("\xff\xfe\0\x01", 4), std::string("\"\\x\""),
        std::string(1000, '\0'), std::string("? ? ? "), std::string("&a [*a]"), std::string("%YAML 9.9\n---\n")}) {
    CHECK_NOTHROW(CHECK(error_of(text) != ""));
  }
}

TEST_CASE("every file cut short is an error or a map, never a throw") {
  const std::string whole = yaml("mode", "mode: raw");
  for (std::size_t size = 0; size < whole.size(); ++size) CHECK_NOTHROW(read(whole.substr(0, size)));
}

TEST_CASE("an image that is not there: its neighbour is named") {
  const TemporaryFolder folder;
  const std::string path = folder.path().string();
  const fs::path file = folder.write("nav2_depot.yaml", yaml("image", "image: depot.pgm"));
  CHECK(read_map_file(file).error().message ==
        path + "/nav2_depot.yaml:1:8: image 'depot.pgm' does not exist, expected a PGM or PNG file, relative to the YAML file");
  folder.write("nav2_depot.png", "");
  CHECK(read_map_file(file).error().message ==
        path +
            "/nav2_depot.yaml:1:8: image 'depot.pgm' does not exist; 'nav2_depot.png' is beside it: correct the "
            "line, or add --map-image " +
            path + "/nav2_depot.png");
  const fs::path image = folder.write("nav2_depot.pgm", "P2 1 1 255 0");
  CHECK(read_map_file(file).error().message ==
        path +
            "/nav2_depot.yaml:1:8: image 'depot.pgm' does not exist; 'nav2_depot.pgm' is beside it: correct the "
            "line, or add --map-image " +
            path + "/nav2_depot.pgm");
  CHECK(read_map_file(file, image)->cells == Cells{O});
  CHECK(read_map_file(file, folder.path() / "none.pgm").error().message == path + "/none.pgm: does not exist");
}

TEST_CASE("the image's name") {
  const TemporaryFolder folder;
  const fs::path image = folder.write("images/a map.pgm", "P2 1 1 255 254");
  const auto cells_with = [&](const std::string& name) {
    return read_map_file(folder.write("maps/x.yaml", yaml("image", "image: " + name)))->cells;
  };
  CHECK(cells_with("../images/a map.pgm") == Cells{F});
  CHECK(cells_with(image.string()) == Cells{F});
  // With another image given, the YAML need not name one; what it names must still be a name.
  CHECK(read_map_file(folder.write("y.yaml", yaml("image", "")), image)->cells == Cells{F});
  CHECK_FALSE(read_map_file(folder.write("z.yaml", yaml("image", "image: []")), image));
}

TEST_CASE("a broken image, a folder, a YAML that is not there") {
  const TemporaryFolder folder;
  const std::string path = folder.path().string();
  folder.write("m.pgm", "P5 2 2 255\n123");
  CHECK(read_map_file(folder.write("m.yaml", yaml())).error().message ==
        path + "/m.pgm: PGM: truncated: expected 4 bytes of pixels after the header, found 3");
  CHECK(read_map_file(folder.write("m.yaml", yaml("image", "image: ."))).error().message == path + "/.: is a folder, expected a file");
  CHECK(read_map_file(folder.path() / "none.yaml").error().message == path + "/none.yaml: does not exist");
}

TEST_CASE("what is written is read again, digit by digit") {
  const TemporaryFolder folder;
  GridMap map;
  map.width = 2;
  map.height = 3;
  map.resolution = 0.1 + 0.2;
  map.origin = {-7.0 / 3.0, 1e-7};
  map.origin_yaw = -1.2345678901234567;
  map.cells = {O, F, U, U, F, O};
  const fs::path stem = folder.path() / "maps" / "floor.2";  // the dot belongs to the name
  REQUIRE(write_map_file(stem, map));
  CHECK(*read_text_file(stem.string() + ".yaml") ==
        "image: floor.2.pgm\nmode: trinary\nresolution: 0.30000000000000004\norigin: [-2.3333333333333335, 1.e-07, -1.2345678901234567]\n"
        "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
  CHECK(read_image(stem.string() + ".pgm")->pixels == std::vector<std::uint8_t>{254, 0, 205, 205, 0, 254});
  const auto again = read_map_file(stem.string() + ".yaml");
  REQUIRE(again);
  CHECK(again->width == 2);
  CHECK(again->height == 3);
  CHECK(again->resolution == map.resolution);
  CHECK(again->origin == map.origin);
  CHECK(again->origin_yaw == map.origin_yaw);
  CHECK(again->cells == map.cells);
}

TEST_CASE("a name that YAML would misread is quoted") {
  const TemporaryFolder folder;
  const GridMap map{1, 1, 1.0, {0.0, 0.0}, 0.0, {F}};
  for (const char* name : {"a: b #c", "- dash", "'quoted'", "[list]", "~", "über", "two\nlines"}) {
    CAPTURE(name);
    REQUIRE(write_map_file(folder.path() / name, map));
    const auto again = read_map_file(folder.path() / (std::string(name) + ".yaml"));
    CHECK(again);
  }
}

TEST_CASE("a map that could not be read again is not written") {
  const TemporaryFolder folder;
  const fs::path stem = folder.path() / "m";
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  const auto refused = [&](const GridMap& map) {
    const auto written = write_map_file(stem, map);
    return written ? std::string("written") : written.error().message.substr(stem.string().size());
  };
  CHECK(refused({0, 1, 1.0, {}, 0.0, {}}) == ": the map is 0 x 1 cells, expected at least 1 x 1");
  CHECK(refused({2, 1, 1.0, {}, 0.0, {F}}) == ": the map has 1 cells, expected 2 x 1");
  CHECK(refused({1, 1, 0.0, {}, 0.0, {F}}) == ": the resolution is 0, expected a finite number greater than 0");
  CHECK(refused({1, 1, nan, {}, 0.0, {F}}) == ": the resolution is nan, expected a finite number greater than 0");
  CHECK(refused({1, 1, 1.0, {0.0, infinite}, 0.0, {F}}) == ": the origin is [0, inf, 0], expected finite numbers");
  CHECK(refused({1, 1, 1e-7, {}, 0.0, {F}}) == ": the resolution is 1e-07 m, expected 1e-06 to 1000000");
  CHECK(refused({1, 1, 1.0, {0.0, 1e10}, 0.0, {F}}) == ": the origin is [0, 10000000000, 0], expected metres from -1000000000 to 1000000000");
  CHECK(refused({1, 1, 1.0, {}, nan, {F}}) == ": the origin is [0, 0, nan], expected finite numbers");
  CHECK(fs::is_empty(folder.path()));
}

TEST_CASE("maps from elsewhere") {
  const auto folder = outside_data("ros_maps");
  if (!folder) {
    MESSAGE("skipped: no outside data");
    return;
  }
  // Their YAML files name images by other names.
  const auto depot = *folder / "nav2_depot.yaml";
  CHECK(read_map_file(depot).error().message == depot.string() + ":1:8: image 'depot.pgm' does not exist; 'nav2_depot.pgm' is beside it: " +
                                                    "correct the line, or add --map-image " + (*folder / "nav2_depot.pgm").string());
  struct Expected {
    const char* name;
    int width, height;
    double resolution;
    glm::dvec2 origin;
  };
  for (const Expected& expected :
       {Expected{"nav2_depot", 604, 307, 0.05, {-7.14, -7.83}}, Expected{"turtlebot3_world", 384, 384, 0.05, {-10, -10}},
        Expected{"aws_small_house", 500, 500, 0.05, {-12.5, -12.5}}, Expected{"nav2_TenByTen", 10, 10, 1, {0, 0}},
        Expected{"tuw_test04", 500, 500, 0.032, {-8, -8}}}) {
    CAPTURE(expected.name);
    const fs::path stem = *folder / expected.name;
    const auto map = read_map_file(stem.string() + ".yaml", stem.string() + ".pgm");
    REQUIRE(map);
    CHECK(map->width == expected.width);
    CHECK(map->height == expected.height);
    CHECK(map->resolution == expected.resolution);
    CHECK(map->origin == expected.origin);
    CHECK(map->origin_yaw == 0.0);
  }
}
