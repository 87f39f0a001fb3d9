// Maps with probabilities in the formats of map_server and NumPy, and the choice of a format; OctoMap's trees are in octomap_file_test.cpp.
#include "thicket/base/probability_file.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "probability_grids.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/image.hpp"

using namespace thicket;

namespace {

constexpr float U = ProbabilityGrid::unknown;

std::string yaml_of(const std::string& mode, const std::string& extra = "negate: 0") {
  return fmt::format("image: m.pgm\nmode: {}\nresolution: 0.1\norigin: [1, 2, 0]\n{}\noccupied_thresh: 0.65\nfree_thresh: 0.196\n", mode, extra);
}

/// A .npy with this dictionary, which is padded as NumPy does, and these bytes after it.
std::string npy(std::string header, std::string_view data) {
  header.resize(117, ' ');
  return std::string("\x93NUMPY\x01\x00\x76\x00", 10) + header + "\n" + std::string(data);
}
const std::string good_header = "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2), }";
const std::string_view good_data("\x00\x00\x80\x3e\x00\x00\xc0\x7f", 8);  // 0.25, NaN

std::string npy_error(const std::string& content) {
  const TemporaryFolder folder;
  const auto grid = read_npy(folder.write("a.npy", content), 0.1, {0.0, 0.0});
  return error_of(grid, folder);
}

}  // namespace

TEST_CASE("trinary: what is judged is read back, and sensed through is unknown unless it is occupied") {
  const TemporaryFolder folder;
  ProbabilityGrid grid{4, 2, 0.1, {-0.7, 0.30000000000000004}, {0.66F, 0.64F, 0.19F, U, 0.19F, 0.9F, 0.971F, 0.1192F}, {0, 0, 0, 0, 1, 1, 0, 0}};
  REQUIRE(write_map_server(folder.path() / "m", grid, MapMode::trinary));
  const auto back = read_probabilities(folder.path() / "m.yaml");
  REQUIRE_MESSAGE(static_cast<bool>(back), error_of(back, folder));
  check_same(*back, {4, 2, 0.1, {-0.7, 0.30000000000000004}, {0.971F, U, 0.1192F, U, U, 0.971F, 0.971F, 0.1192F}, {}}, 0.0);
  CHECK(back->origin == grid.origin);  // every digit
  REQUIRE(write_map_server(folder.path() / "again", *back, MapMode::trinary));
  CHECK(*read_text_file(folder.path() / "again.pgm") == *read_text_file(folder.path() / "m.pgm"));
  CHECK(*read_text_file(folder.path() / "m.yaml") == "image: m.pgm\nmode: trinary\nresolution: 0.1\norigin: [-0.7, 0.30000000000000004, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
}

TEST_CASE("scale and raw: read back to within half a step, unknown to unknown, any resolution and origin to the same bits") {
  const TemporaryFolder folder;
  for (unsigned seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    ProbabilityGrid grid = random_grid(seed);
    grid.resolution = 0.1 + 1e-3 / (seed + 3.0);
    grid.origin = {-1.0 / (seed + 7.0), 1e6 / (seed + 9.0)};
    for (const auto& [mode, name, step] : {std::tuple{MapMode::scale, "scale", 1.0 / 255.0}, {MapMode::raw, "raw", 0.01}}) {
      CAPTURE(name);
      REQUIRE(write_map_server(folder.path() / name, grid, mode));
      const auto back = read_probabilities(folder.path() / (std::string(name) + ".yaml"));
      REQUIRE_MESSAGE(static_cast<bool>(back), error_of(back, folder));
      check_same(*back, grid, step / 2.0 + 1e-7);
      // A second time nothing is lost any more.
      REQUIRE(write_map_server(folder.path() / "again", *back, mode));
      const auto twice = read_probabilities(folder.path() / "again.yaml");
      REQUIRE(twice);
      check_same(*twice, *back, 0.0);
    }
  }
}

TEST_CASE("scale and raw as the bytes that map_server reads") {
  const TemporaryFolder folder;
  const ProbabilityGrid grid{3, 2, 0.05, {0.0, 0.0}, {0.0F, 0.196F, 1.0F, 0.66F, U, 0.5F}, {}};
  REQUIRE(write_map_server(folder.path() / "s.1", grid, MapMode::scale));  // a dot is part of the stem
  const auto image = read_image(folder.path() / "s.1.png");
  REQUIRE(image);
  // The image's first row is the map's last.
  CHECK(image->pixels == std::vector<std::uint8_t>{87, 128, 127, 255, 205, 0});
  CHECK(image->alpha == std::vector<std::uint8_t>{255, 0, 255, 255, 255, 255});
  CHECK(read_text_file(folder.path() / "s.1.yaml")->find("image: s.1.png\nmode: scale\n") == 0);
  REQUIRE(write_map_server(folder.path() / "r", grid, MapMode::raw));
  CHECK(*read_text_file(folder.path() / "r.pgm") == std::string("P5\n3 2\n255\n\x42\xff\x32\x00\x14\x64", 17));
  CHECK(read_text_file(folder.path() / "r.yaml")->find("mode: raw\n") != std::string::npos);
  // By states, as planners read them: occupied above 0.65 is so in both.
  for (const char* name : {"s.1.yaml", "r.yaml"}) {
    const auto states = read_map_file(folder.path() / name);
    REQUIRE(states);
    CHECK(states->at(0, 0) == CellState::free);
    CHECK(states->at(2, 0) == CellState::occupied);
    CHECK(states->at(0, 1) == CellState::occupied);
    CHECK(states->at(1, 1) == CellState::unknown);
    CHECK(states->at(2, 1) == CellState::unknown);
  }
}

TEST_CASE("foreign maps of every mode") {
  const TemporaryFolder folder;
  const auto cells = [&](const std::string& yaml, const std::string& image) {
    folder.write("m.pgm", image);
    const auto grid = read_probabilities(folder.write("m.yml", yaml));
    REQUIRE_MESSAGE(static_cast<bool>(grid), error_of(grid, folder));
    CHECK(grid->resolution == 0.1);
    CHECK(grid->origin == glm::dvec2(1.0, 2.0));
    return grid->probability;
  };
  const auto near = [](float value, double expected) { return std::abs(static_cast<double>(value) - expected) < 1e-6; };
  const auto scale = cells(yaml_of("scale"), "P2 4 1 255 0 51 204 255"), negated = cells(yaml_of("scale", "negate: 1"), "P2 4 1 255 0 51 204 255");
  // Nothing is certain: the ends stand for the half step next to them.
  CHECK(near(scale[0], 1.0 - 0.25 / 255.0));
  CHECK(near(scale[1], 0.8));
  CHECK(near(scale[2], 0.2));
  CHECK(near(scale[3], 0.25 / 255.0));
  for (std::size_t i = 0; i < 4; ++i) CHECK(near(negated[i], 1.0 - static_cast<double>(scale[i])));
  const auto raw = cells(yaml_of("raw", "negate: 1"), "P2 6 1 255 0 1 50 100 101 255");
  CHECK(near(raw[0], 0.0025));
  CHECK(near(raw[1], 0.01));
  CHECK(near(raw[2], 0.5));
  CHECK(near(raw[3], 0.9975));
  CHECK(std::isnan(raw[4]));
  CHECK(std::isnan(raw[5]));
  const auto trinary = cells(yaml_of("trinary", "negate: 1"), "P2 3 1 255 0 128 255");
  CHECK(trinary[0] == sure_free);
  CHECK(std::isnan(trinary[1]));
  CHECK(trinary[2] == sure_occupied);
  folder.write("other.pgm", "P2 1 1 255 50");
  const auto other = read_probabilities(folder.write("m.yaml", yaml_of("raw")), {.cell_size = {}, .origin = {}, .height = {}, .image = folder.path() / "other.pgm"});
  REQUIRE(other);
  CHECK(other->probability == std::vector<float>{0.5F});
}

TEST_CASE(".npy byte for byte, and back to the same bits") {
  const TemporaryFolder folder;
  REQUIRE(write_npy(folder.path() / "a.npy", {2, 1, 0.1, {0.0, 0.0}, {0.25F, U}, {}}));
  CHECK(*read_text_file(folder.path() / "a.npy") == npy(good_header, good_data));
  // Whatever NaN stands for unknown, the bytes are the same.
  REQUIRE(write_npy(folder.path() / "b.npy", {2, 1, 0.1, {0.0, 0.0}, {0.25F, -std::numeric_limits<float>::quiet_NaN()}, {}}));
  CHECK(*read_text_file(folder.path() / "b.npy") == npy(good_header, good_data));
  for (unsigned seed = 0; seed < 10; ++seed) {
    ProbabilityGrid grid = random_grid(seed);
    grid.origin = {-3.5, 7.0};
    REQUIRE(write_npy(folder.path() / "c.npy", grid));
    const auto back = read_probabilities(folder.path() / "c.npy", {.cell_size = grid.resolution, .origin = grid.origin, .height = {}, .image = {}});
    REQUIRE_MESSAGE(static_cast<bool>(back), error_of(back, folder));
    check_same(*back, grid, 0.0);
  }
}

TEST_CASE(".npy as NumPy's users may write it: float64, later formats, other spaces; 0 and 1 are not certain") {
  const TemporaryFolder folder;
  const std::string data("\x00\x00\x00\x00\x00\x00\xf0\x3f\x00\x00\x00\x00\x00\x00\x00\x00", 16);  // 1, 0
  const auto check = [&](const std::string& content) {
    const auto grid = read_npy(folder.write("a.npy", content), 0.5, {1.0, 2.0});
    REQUIRE_MESSAGE(static_cast<bool>(grid), error_of(grid, folder));
    CHECK(grid->width == 1);
    CHECK(grid->height == 2);
    CHECK(grid->resolution == 0.5);
    CHECK(grid->origin == glm::dvec2(1.0, 2.0));
    CHECK(static_cast<double>(grid->probability[0]) == 1.0 - least_probability);
    CHECK(static_cast<double>(grid->probability[1]) == least_probability);
  };
  check(npy("{'descr': '<f8', 'fortran_order': False, 'shape': (2, 1), }", data));
  check(npy("{'shape':(2,1),'fortran_order':False,'descr':'<f8'}", data));
  const std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 1), }\n";
  std::string second("\x93NUMPY\x02\x00", 8);
  second.push_back(static_cast<char>(header.size()));
  second.append(3, '\0');
  second += header;
  second += data;
  check(second);
}

TEST_CASE("a faulty .npy is told so") {
  const auto header = [](const std::string& type, const std::string& order, const std::string& shape) { return fmt::format("{{'descr': {}, 'fortran_order': {}, 'shape': {}, }}", type, order, shape); };
  const std::string eight(8, '\0');
  CHECK(npy_error("") == "a.npy: NPY: begins with '', expected a file that numpy.save wrote");
  CHECK(npy_error("P5\n1 1\n255\n0") == "a.npy: NPY: begins with 'P5.1 1', expected a file that numpy.save wrote");
  CHECK(npy_error("\x93NUMPY\x01") == "a.npy: NPY: truncated: the file ends before its header");
  CHECK(npy_error(std::string("\x93NUMPY\x01\x00\x76\x00{", 11)) == "a.npy: NPY: truncated: the file ends before its header does");
  CHECK(npy_error(std::string("\x93NUMPY\x02\x00\x76\x00\x00", 11)) == "a.npy: NPY: truncated: the file ends before its header does");
  CHECK(npy_error(std::string("\x93NUMPY\x02\x00\xff\xff\xff\xff{}", 14)) == "a.npy: NPY: truncated: the file ends before its header does");
  CHECK(npy_error(std::string("\x93NUMPY\x04\x00\x76\x00{", 11)) == "a.npy: NPY: the format is 4.0, expected 1.0, 2.0 or 3.0");
  CHECK(npy_error(npy(header("'|i1'", "False", "(1, 2)"), eight)) == "a.npy: NPY: the type of the numbers is '|i1', expected '<f4': numpy.save(file, array.astype('<f4'))");
  CHECK(npy_error(npy(header("[('a', '<f4')]", "False", "(1, 2)"), eight)).find("a.npy: NPY: the type of the numbers is [('a'") == 0);
  CHECK(npy_error(npy("{}", eight)).find("a.npy: NPY: the type of the numbers is ,") == 0);
  CHECK(npy_error(npy(header("'<f4'", "True", "(1, 2)"), eight)) == "a.npy: NPY: the array is in Fortran's order, expected C's: numpy.save(file, numpy.ascontiguousarray(array))");
  for (const char* shape : {"(2,)", "()", "(1, 1, 2)", "(0, 2)", "(-1, 2)", "(1, x)", "(1 2)", "1, 2", "(20000, 20000)", "(99999999999, 1)"}) {
    CAPTURE(shape);
    CHECK(npy_error(npy(header("'<f4'", "False", shape), eight)).find("a.npy: NPY: the shape is ") == 0);
  }
  CHECK(npy_error(npy(header("'<f4'", "False", "(2, 2)"), eight)) == "a.npy: NPY: 8 bytes of numbers after the header, expected 2 x 2 x 4: the file is truncated");
  CHECK(npy_error(npy(header("'<f4'", "False", "(1, 1)"), eight)) == "a.npy: NPY: 8 bytes of numbers after the header, expected 1 x 1 x 4");
  CHECK(npy_error(npy(good_header, std::string_view("\x00\x00\x80\x3e\x00\x00\x00\x40", 8))) == "a.npy: NPY: the number [0, 1] is 2, expected a probability, 0 to 1, or NaN for unknown");
  CHECK(npy_error(npy(good_header, std::string_view("\x00\x00\x80\x7f\x00\x00\x00\x00", 8))) == "a.npy: NPY: the number [0, 0] is inf, expected a probability, 0 to 1, or NaN for unknown");
  const TemporaryFolder folder;
  CHECK(error_of(read_npy(folder.write("a.npy", npy(good_header, good_data)), 0.0, {0.0, 0.0}), folder) == "a.npy: NPY: the resolution is 0, expected a finite number greater than 0");
}

TEST_CASE("what cannot be read says what to do") {
  const TemporaryFolder folder;
  folder.write("m.pgm", "P2 1 1 255 0");
  const auto error = [&](const char* name, const ProbabilityReading& reading = {}) { return error_of(read_probabilities(folder.path() / name, reading), folder); };
  folder.write("turned.yaml", "image: m.pgm\nresolution: 0.1\norigin: [1, 2, 0.5]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
  folder.write("good.yaml", yaml_of("raw"));
  folder.write("bad.yaml", yaml_of("row"));
  folder.write("a.npy", npy(good_header, good_data));
  CHECK(error("turned.yaml") == "turned.yaml:3:9: the map is turned by 0.5 rad (the third value of its origin), expected 0: turn the image in a picture editor and write 0 there");
  CHECK(error("bad.yaml") == "bad.yaml:2:7: mode is 'row', expected trinary, scale, raw (did you mean 'raw'?)");
  CHECK(error("none.yaml") == "none.yaml: does not exist");
  CHECK(error("none.npy", {.cell_size = 0.1, .origin = {}, .height = {}, .image = {}}) == "none.npy: does not exist");
  CHECK(error("none.ot") == "none.ot: does not exist");
  CHECK(error("m.pgm") == "m.pgm: cannot tell the format of the map, expected a name ending in .yaml (map_server), .npy (NumPy), .ot or .bt (OctoMap)");
  CHECK(error("a.npy") == "a.npy: a .npy file does not say how large its cells are, expected a cell size: thicket convert a.npy map.yaml --mode raw --cell-size 0.1");
  CHECK(error("good.yaml", {.cell_size = 0.1, .origin = {}, .height = {}, .image = {}}) == "good.yaml: a cell size is given, expected that only for a .npy: this file has its own");
  CHECK(error("good.yaml", {.cell_size = {}, .origin = glm::dvec2(0.0), .height = {}, .image = {}}) == "good.yaml: an origin is given, expected that only for a .npy: this file has its own");
  CHECK(error("good.yaml", {.cell_size = {}, .origin = {}, .height = 0.5, .image = {}}) == "good.yaml: the height of a layer is given, expected that only for an .ot or .bt");
  CHECK(error("a.npy", {.cell_size = 0.1, .origin = {}, .height = {}, .image = "m.pgm"}) == "a.npy: a map image is given, expected that only for a map_server YAML file");
}

TEST_CASE("what cannot be written leaves no file") {
  const TemporaryFolder folder;
  const auto check = [&](const ProbabilityGrid& grid, const std::string& expected) {
    for (const MapMode mode : {MapMode::trinary, MapMode::scale, MapMode::raw}) CHECK(error_of(write_map_server(folder.path() / "m", grid, mode), folder) == "m: " + expected);
    CHECK(error_of(write_npy(folder.path() / "m.npy", grid), folder) == "m.npy: " + expected);
    CHECK(error_of(write_octomap(folder.path() / "m.ot", grid, 0.0), folder) == "m.ot: " + expected);
  };
  check({0, 0, 0.1, {}, {}, {}}, "the map is 0 x 0 cells, expected at least 1 x 1");
  check({2, 2, 0.1, {}, {0.5F}, {}}, "the map has 1 cells, expected 2 x 2");
  check({1, 1, 0.0, {}, {0.5F}, {}}, "the resolution is 0, expected a finite number greater than 0");
  check({1, 1, 0.1, {INFINITY, 0.0}, {0.5F}, {}}, "the origin is [inf, 0, 0], expected finite numbers");
  check({1, 1, 0.1, {}, {0.5F}, {0, 1}}, "the map has 2 marks of cells sensed through, expected none or 1 x 1");
  check({2, 2, 0.1, {}, {0.5F, U, 0.5F, 1.5F}, {}}, "the probability in column 1, row 1 is 1.5, expected 0 to 1, or NaN for unknown");
  check({1, 1, 0.1, {}, {-0.1F}, {}}, "the probability in column 0, row 0 is -0.1, expected 0 to 1, or NaN for unknown");
  CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("the names of the modes") {
  CHECK(map_mode("trinary") == MapMode::trinary);
  CHECK(map_mode("scale") == MapMode::scale);
  CHECK(map_mode("raw") == MapMode::raw);
  CHECK_FALSE(map_mode("Raw"));
}
