// The map of a run in all its formats, `thicket convert` between them, and the picture of its probabilities.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "program_call.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/image.hpp"
#include "thicket/base/probability_file.hpp"
#include "thicket/sim/outputs.hpp"
#include "thicket/sim/probability_picture.hpp"

namespace thicket {
namespace {

constexpr float U = ProbabilityGrid::unknown;

/// How many cells of two grids differ by more than the tolerance, or by being known; a cell beyond the borders of `read` is unknown.
std::size_t different(const ProbabilityGrid& read, const ProbabilityGrid& expected, double tolerance) {
  const auto column = std::lround((read.origin.x - expected.origin.x) / expected.resolution), row = std::lround((read.origin.y - expected.origin.y) / expected.resolution);
  CHECK(read.resolution == expected.resolution);
  std::size_t count = 0;
  for (int y = 0; y < expected.height; ++y) {
    for (int x = 0; x < expected.width; ++x) {
      const long c = x - column, r = y - row;
      const bool inside = c >= 0 && r >= 0 && c < read.width && r < read.height;
      const float a = inside ? read.probability[read.index(static_cast<int>(c), static_cast<int>(r))] : U, b = expected.probability[expected.index(x, y)];
      count += std::isnan(a) || std::isnan(b) ? std::isnan(a) != std::isnan(b) : std::abs(a - b) > static_cast<float>(tolerance);
    }
  }
  return count;
}

/// A drive of 4 s along the foliage, some of which is sensed through.
Simulation drive(const std::string& formats) {
  const auto mission = read_mission(find_input("foliage_wall/bug2"), {{"limits.time_s", "4", "test"}, {"output.map_formats", formats, "test"}});
  if (!mission) FAIL(mission.error().message);
  auto simulation = Simulation::create(*mission);
  if (!simulation) FAIL(simulation.error().message);
  while (simulation->step()) {
  }
  return *simulation;
}

const std::vector<std::string> files = {"map_scale.yaml", "map_scale.png", "map_raw.yaml", "map_raw.pgm", "map.npy", "map.ot", "map.bt", "map_probability.png"};

}  // namespace

TEST_CASE("a run leaves its map in every format that is asked for, and all tell the same") {
  const TemporaryFolder folder;
  const Simulation simulation = drive("\"scale, raw, npy,ot ,bt,picture\"");
  const ProbabilityGrid grid = simulation.map().to_probabilities();
  REQUIRE(std::count(grid.through.begin(), grid.through.end(), 1) > 10);
  REQUIRE(write_outputs(folder.path(), simulation, {}, 0.0, 0.0));
  for (const std::string& name : files) CHECK_MESSAGE(std::filesystem::exists(folder.path() / name), name);

  const auto read = [&](const char* name, const ProbabilityReading& reading = {}) {
    const auto back = read_probabilities(folder.path() / name, reading);
    if (!back) FAIL(back.error().message);
    return *back;
  };
  CHECK(different(read("map_scale.yaml"), grid, 0.5 / 255.0 + 1e-7) == 0);
  CHECK(different(read("map_raw.yaml"), grid, 0.005 + 1e-7) == 0);
  CHECK(different(read("map.npy", {.cell_size = grid.resolution, .origin = grid.origin, .height = {}, .image = {}}), grid, 0.0) == 0);
  // The layer of voxels is at the sensor's height.
  const double height = simulation.mission().start.z_m + mounted(simulation.mission().sensors.front()).position_m.z;
  CHECK(different(read("map.ot", {.cell_size = {}, .origin = {}, .height = height, .image = {}}), grid, 1e-6) == 0);
  const ProbabilityGrid states = read("map.bt", {.cell_size = {}, .origin = {}, .height = height, .image = {}});
  ProbabilityGrid likely = grid;
  for (std::size_t i = 0; i < grid.probability.size(); ++i)
    if (grid.known(i)) likely.probability[i] = grid.probability[i] >= 0.5F ? sure_occupied : grid.sensed_through(i) ? U : sure_free;
  CHECK(different(states, likely, 0.0) == 0);
  // The map's own judgement is the same.
  CHECK(judged(grid).cells == simulation.map().to_grid().cells);
  CHECK(read_map_file(folder.path() / "map.yaml")->cells == judged(grid).cells);

  // Written again without them, nothing of the run before is left.
  REQUIRE(write_outputs(folder.path(), drive("\"npy\""), {}, 0.0, 0.0));
  for (const std::string& name : files) CHECK_MESSAGE(std::filesystem::exists(folder.path() / name) == (name == "map.npy"), name);
  CHECK(std::filesystem::exists(folder.path() / "map.yaml"));
  // A written mission says so, too.
  CHECK(has(*read_text_file(folder.path() / "mission.toml"), "map_formats = \"npy\""));
}

TEST_CASE("a format of the map that there is not is told so") {
  const auto mission = read_mission(find_input("foliage_wall/bug2"), {{"output.map_formats", "\"raw, octomap\"", "test"}});
  REQUIRE_FALSE(mission);
  CHECK_MESSAGE(has(mission.error().message, "'map_formats' names 'octomap', expected names separated by commas, of 'scale', 'raw', 'npy', 'ot', 'bt', 'picture'"), mission.error().message);
  OutputSpec output;
  CHECK(map_formats(output).empty());
  output.map_formats = "picture, bt,, raw, bt";
  CHECK(map_formats(output) == std::vector<std::string>{"raw", "bt", "picture"});
}

TEST_CASE("convert goes from every format of the map to every other") {
  const TemporaryFolder folder;
  ProbabilityGrid grid{3, 2, 0.1, {-0.4, 0.2}, {0.971F, 0.1192F, 0.7F, 0.3F, U, 0.971F}, {}};
  REQUIRE(write_npy(folder.path() / "a.npy", grid));
  REQUIRE(write_map_server(folder.path() / "raw", grid, MapMode::raw));
  const auto ok = [&](const std::string& arguments) {
    const Answer answer = call(folder, "convert " + arguments);
    CHECK_MESSAGE(answer.code == 0, answer.err);
    return answer.out;
  };
  const auto read = [&](const char* name, const ProbabilityReading& reading = {}) {
    const auto back = read_probabilities(folder.path() / name, reading);
    if (!back) FAIL(back.error().message);
    return *back;
  };
  CHECK(has(ok("a.npy b.ot --cell-size 0.1 --origin -0.4,0.2 --z 0.3"), "cells      3 x 2 of 0.1 m\nwritten    b.ot\n"));
  CHECK(different(read("b.ot", {.cell_size = {}, .origin = {}, .height = 0.35, .image = {}}), grid, 1e-6) == 0);
  CHECK(has(ok("b.ot c.yaml --mode scale"), "written    c.yaml\nwritten    c.png\n"));
  CHECK(different(read("c.yaml"), grid, 0.5 / 255.0 + 1e-6) == 0);
  CHECK(has(ok("c.yaml d.yaml --mode raw"), "written    d.pgm\n"));
  CHECK(different(read("d.yaml"), grid, 0.5 / 255.0 + 0.005) == 0);
  CHECK(has(ok("d.yaml e.npy"), "a .npy keeps neither resolution nor origin: 0.1 m a cell, origin -0.4, 0.2 m\n"));
  CHECK(different(read("e.npy", {.cell_size = 0.1, .origin = grid.origin, .height = {}, .image = {}}), grid, 0.5 / 255.0 + 0.005) == 0);
  CHECK(has(ok("raw.yaml f.bt"), "the layer of voxels is the one from 0 m up; --z gives another height"));
  const ProbabilityGrid likely{3, 2, 0.1, grid.origin, {0.971F, 0.1192F, 0.971F, 0.1192F, U, 0.971F}, {}};
  CHECK(different(read("f.bt"), likely, 0.0) == 0);
  // To states: 0.3 is neither.
  const ProbabilityGrid states{3, 2, 0.1, grid.origin, {0.971F, 0.1192F, 0.971F, U, U, 0.971F}, {}};
  for (const char* arguments : {"b.ot g.yaml", "b.ot g.yaml --mode trinary --z 0.3", "raw.yaml g.yaml", "a.npy g.yaml --cell-size 0.1 --origin -0.4,0.2"}) {
    CAPTURE(arguments);
    ok(arguments);
    CHECK(different(read("g.yaml"), states, 0.0) == 0);
  }
  ok("f.bt h.map");
  CHECK(has(*read_text_file(folder.path() / "h.map"), "map\n.@@\n@.@\n"));
  ok("h.map i.ot --cell-size 0.1");  // a world's or a benchmark's cells are as sure as may be
  CHECK(read("i.ot").known(1));
  ok("b.ot j.toml");
  CHECK(call(folder, "check j.toml").code == 0);
  ok("b.ot k.png");
  CHECK(read_image(folder.path() / "k.png"));
}

TEST_CASE("convert refuses flags and files that say nothing, with exit code 2") {
  const TemporaryFolder folder;
  REQUIRE(write_npy(folder.path() / "a.npy", {1, 1, 0.1, {}, {0.5F}, {}}));
  REQUIRE(write_map_server(folder.path() / "a", {1, 1, 0.1, {0.05, 0.0}, {0.5F}, {}}, MapMode::raw));
  folder.write("turned.yaml", "image: a.pgm\nresolution: 0.1\norigin: [0, 0, 1]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
  for (const auto& [arguments, words] :
       {std::pair{"a.npy b.yaml", "a .npy file does not say how large its cells are, expected a cell size"}, {"a.npy b.ot --cell-size 0.1 --origin 1", "--origin is '1', expected X,Y"}, {"a.yaml b.npy --origin 1,1", "--origin is '1,1', expected that only for a .npy"},
        {"a.yaml b.yaml --mode row", "--mode is 'row', expected trinary, scale, raw (did you mean 'raw'?)"}, {"a.yaml b.npy --mode raw", "--mode is 'raw', expected that only for a map_server map"}, {"a.yaml b.npy --z 1", "--z is 1, expected that only for an .ot or .bt"},
        {"a.yaml b.ot", "b.ot: the origin's x is 0.05 m, expected a multiple of the resolution"}, {"turned.yaml b.npy", "turned.yaml:3:9: the map is turned by 1 rad"}, {"a.npy b.npy --cell-size -1", "the resolution is -1"},
        {"a.yaml a.yaml --mode scale", "a.yaml: would be overwritten"}, {"a.npy ./a.npy --cell-size 1", "would be overwritten"}, {"none.ot b.bt", "there is no file 'none.ot'"}, {"a.yaml b.jpg", "expected a name ending in .yaml (map_server), .npy"}}) {
    CAPTURE(arguments);
    const Answer answer = call(folder, std::string("convert ") + arguments);
    CHECK(answer.code == 2);
    CHECK_MESSAGE(has(answer.err, words), answer.err);
  }
  for (const char* name : {"b.yaml", "b.ot", "b.npy"}) CHECK_FALSE(std::filesystem::exists(folder.path() / name));
  CHECK(has(call(folder, "truth foliage_wall/room_with_way_round --out b.ot").err, "--out is 'b.ot', expected a name ending in .yaml"));
}

TEST_CASE("the picture of the probabilities: white to black, blue unknown, green sensed through, with legend and scale bar") {
  const TemporaryFolder folder;
  const auto draw = [&](const ProbabilityGrid& grid) {
    REQUIRE(write_probability_picture(folder.path() / "p.png", grid, "a map"));
    const auto image = read_image(folder.path() / "p.png");
    REQUIRE(image);
    return *image;
  };
  // 22 cells of 48 pixels: the frame of the cells begins 16 pixels from the left and 50 from the top.
  ProbabilityGrid grid{22, 4, 0.1, {-3.0, 1.0}, std::vector<float>(88, 0.5F), {}};
  grid.probability[grid.index(0, 0)] = 0.0F;
  grid.probability[grid.index(1, 0)] = 1.0F;
  grid.probability[grid.index(2, 3)] = U;
  const auto mean = [](int r, int g, int b) { return (r + g + b + 1) / 3; };
  const auto cell = [&](const GreyImage& image, int column, int row) { return static_cast<int>(image.at(16 + 48 * column + 24, 50 + 48 * (3 - row) + 24)); };
  const GreyImage plain = draw(grid);
  CHECK(plain.width == 22 * 48 + 32);
  CHECK(cell(plain, 0, 0) == 255);
  CHECK(cell(plain, 1, 0) == 0);
  CHECK(cell(plain, 3, 2) == 128);
  CHECK(cell(plain, 2, 3) == mean(0x2f, 0x4b, 0x8f));
  grid.through.assign(88, 0);
  grid.through[grid.index(1, 0)] = 1;
  const GreyImage tinted = draw(grid);
  CHECK(cell(tinted, 1, 0) == mean(0x6e / 2, 0xc8 / 2, 0x5a / 2));
  CHECK(cell(tinted, 3, 2) == 128);
  // The scale bar below it is dark, over the length that its words say: 0.2 m are 96 pixels of 480 a metre.
  const int bar = 50 + 4 * 48 + 16 + 48;
  CHECK(tinted.at(16 + 48, bar) < 60);
  CHECK(tinted.at(16 + 90, bar) < 60);
  // The legend's ramps: from white to black, and the tinted one behind it.
  const int legend = 50 + 4 * 48 + 16 + 8;
  CHECK(plain.at(24, legend) > 235);
  CHECK(plain.at(144, legend) < 15);
  CHECK(draw(grid).pixels == tinted.pixels);
  const auto empty = write_probability_picture(folder.path() / "e.png", {}, "none");
  REQUIRE_FALSE(empty);
  CHECK(has(empty.error().message, "e.png: the map is 0 x 0 cells with 0 values"));
  // More cells than pixels.
  const GreyImage large = draw({5000, 3, 0.1, {}, std::vector<float>(15000, 1.0F), {}});
  CHECK(large.width <= 1200);
}

}  // namespace thicket
