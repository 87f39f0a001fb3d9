// OctoMap's .ot and .bt: by hand, there and back, and against OctoMap itself where Debian's octomap-tools are installed.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

#include "probability_grids.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/probability_file.hpp"

using namespace thicket;

namespace {

constexpr float U = ProbabilityGrid::unknown;
using Bytes = std::string;

Bytes times(int count, const Bytes& bytes) {
  Bytes all;
  for (int i = 0; i < count; ++i) all += bytes;
  return all;
}

/// Log-odds of 0.75, which are log 3, with a byte of children.
Bytes node(char children) { return Bytes("\x54\x9f\x8c\x3f", 4) + children; }

// Two voxels at x = 0 and 1, y = z = 0: behind the root's last child (all coordinates are not negative), then always in the lowest.
const Bytes two_full = node('\x80') + times(14, node('\x01')) + node('\x03') + node('\0') + Bytes("\x54\x9f\x8c\xbf\x00", 5);
const Bytes two_binary = Bytes("\x00\xc0", 2) + times(14, Bytes("\x03\x00", 2)) + Bytes("\x06\x00", 2);

Bytes full(const Bytes& data, const std::string& lines = "id OcTree\nsize 18\nres 0.5\n") { return "# Octomap OcTree file\n" + lines + "data\n" + data; }
Bytes binary(const Bytes& data, int size = 18) { return fmt::format("# Octomap OcTree binary file\n# a comment\n\nid OcTree\nsize {}\nres 0.5\ndata\n", size) + data; }

/// What comes after the line `data`.
Bytes data_of(const std::filesystem::path& file) {
  const auto content = read_text_file(file);
  REQUIRE(content);
  return content->substr(content->find("data\n") + 5);
}

std::string read_error(const Bytes& content, std::optional<double> height = std::nullopt) {
  const TemporaryFolder folder;
  return error_of(read_octomap(folder.write("t.ot", content), height), folder);
}

/// What a .bt keeps of a grid.
ProbabilityGrid most_likely(ProbabilityGrid grid) {
  for (std::size_t i = 0; i < grid.probability.size(); ++i)
    if (grid.known(i)) grid.probability[i] = grid.probability[i] >= 0.5F ? sure_occupied : grid.sensed_through(i) ? U : sure_free;
  grid.through.clear();
  return grid;
}

}  // namespace

TEST_CASE("two voxels as OctoMap's bytes") {
  const TemporaryFolder folder;
  const ProbabilityGrid grid{2, 1, 0.5, {0.0, 0.0}, {0.75F, 0.25F}, {}};
  REQUIRE(write_octomap(folder.path() / "a.ot", grid, 0.2));
  CHECK(*read_text_file(folder.path() / "a.ot") == "# Octomap OcTree file\n# (one layer of voxels, from 0 m up; written by Thicket)\nid OcTree\nsize 18\nres 0.5\ndata\n" + two_full);
  REQUIRE(write_octomap(folder.path() / "a.bt", grid, 0.2));
  CHECK(*read_text_file(folder.path() / "a.bt") == "# Octomap OcTree binary file\n# (one layer of voxels, from 0 m up; written by Thicket)\nid OcTree\nsize 18\nres 0.5\ndata\n" + two_binary);
  check_same(*read_probabilities(folder.path() / "a.ot"), grid, 1e-7);
  check_same(*read_probabilities(folder.path() / "a.bt"), most_likely(grid), 0.0);
  // The first line tells the format, not the name.
  check_same(*read_octomap(folder.write("b.ot", binary(two_binary)), 0.0), most_likely(grid), 0.0);
  // On the other side of 0: child 0 of the root, then always child 6: low in x, high in y and z.
  REQUIRE(write_octomap(folder.path() / "c.bt", {1, 1, 0.5, {0.0, -0.5}, {0.25F}, {}}, -0.01));
  CHECK(data_of(folder.path() / "c.bt") == Bytes("\x0c\x00", 2) + times(14, Bytes("\x00\x30", 2)) + Bytes("\x00\x10", 2));
}

TEST_CASE("layers are read back as they were written, wherever they lie") {
  const TemporaryFolder folder;
  for (unsigned seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    ProbabilityGrid grid = random_grid(seed);
    grid.resolution = seed % 2 == 0 ? 0.1 : 0.05;
    grid.origin = glm::dvec2(static_cast<int>(seed * 7919 % 3000) - 1500, static_cast<int>(seed * 104729 % 3000) - 1500) * grid.resolution;
    if (seed == 3) grid.origin = glm::dvec2(-32768.0 * grid.resolution);
    if (seed == 5) grid.origin = glm::dvec2(32768 - grid.width, 32768 - grid.height) * grid.resolution;
    const double height = grid.resolution * (static_cast<double>(seed % 5) - 2.0);
    REQUIRE(write_octomap(folder.path() / "g.ot", grid, height));
    REQUIRE(write_octomap(folder.path() / "g.bt", grid, height));
    for (const auto& layer : {std::optional<double>{}, std::optional(height), std::optional(height + 0.99 * grid.resolution)}) {
      const auto back = read_octomap(folder.path() / "g.ot", layer), states = read_octomap(folder.path() / "g.bt", layer);
      REQUIRE_MESSAGE(static_cast<bool>(back), error_of(back, folder));
      REQUIRE_MESSAGE(static_cast<bool>(states), error_of(states, folder));
      check_same(*back, grid, 2e-7);
      check_same(*states, most_likely(grid), 0.0);
    }
    CHECK_FALSE(read_octomap(folder.path() / "g.ot", height + 1.01 * grid.resolution));
    CHECK_FALSE(read_octomap(folder.path() / "g.ot", height - 0.01 * grid.resolution));
  }
}

TEST_CASE("the borders that nothing is known of are lost, and in a .bt what was sensed through; nothing is certain in an .ot") {
  const TemporaryFolder folder;
  const ProbabilityGrid grid{4, 3, 0.5, {-1.0, 2.0}, {U, U, U, U, U, 0.4F, 0.6F, U, U, U, U, 0.2F}, {0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
  REQUIRE(write_octomap(folder.path() / "g.ot", grid, 1.0));
  REQUIRE(write_octomap(folder.path() / "g.bt", grid, 1.0));
  check_same(*read_octomap(folder.path() / "g.ot", {}), {3, 2, 0.5, {-0.5, 2.5}, {0.4F, 0.6F, U, U, U, 0.2F}, {}}, 1e-7);
  check_same(*read_octomap(folder.path() / "g.bt", {}), {2, 1, 0.5, {-0.5, 2.5}, {sure_free, sure_occupied}, {}}, 0.0);
  REQUIRE(write_octomap(folder.path() / "sure.ot", {2, 1, 0.5, {}, {0.0F, 1.0F}, {}}, 0.0));
  const auto sure = read_octomap(folder.path() / "sure.ot", {});
  REQUIRE(sure);
  CHECK(static_cast<double>(sure->probability[0]) == doctest::Approx(least_probability));
  CHECK(static_cast<double>(sure->probability[1]) == doctest::Approx(1.0 - least_probability));
}

TEST_CASE("a pruned tree of several layers, of which one is read") {
  const TemporaryFolder folder;
  // The lowest 4 x 4 x 4 voxels from 0 on: a leaf of 2 x 2 x 2 at (0, 0, 0), a voxel at (2, 2, 2), a leaf of 2 x 2 x 2 at (0, 2, 2).
  const Bytes tree = Bytes("\x00\xc0", 2) + times(13, Bytes("\x03\x00", 2)) + Bytes("\x02\xd0", 2) + Bytes("\x01\x00", 2);
  const auto file = folder.write("p.bt", binary(tree, 19));
  CHECK(error_of(read_octomap(file, {}), folder) == "p.bt: OctoMap: the tree has 4 layers of cells, at heights from 0 to 2 m, expected the height of one of them (--z 1)");
  for (const double height : {0.0, 0.75}) check_same(*read_octomap(file, height), {2, 2, 0.5, {0.0, 0.0}, {sure_occupied, sure_occupied, sure_occupied, sure_occupied}, {}}, 0.0);
  check_same(*read_octomap(file, 1.2), {3, 2, 0.5, {0.0, 1.0}, {sure_free, sure_free, sure_free, sure_free, sure_free, U}, {}}, 0.0);
  check_same(*read_octomap(file, 1.5), {2, 2, 0.5, {0.0, 1.0}, {sure_free, sure_free, sure_free, sure_free}, {}}, 0.0);
  CHECK(error_of(read_octomap(file, 2.0), folder) == "p.bt: OctoMap: nothing is known at a height of 2 m, expected a height from 0 to 2 m");
  CHECK(error_of(read_octomap(file, -1e9), folder) == "p.bt: OctoMap: nothing is known at a height of -1000000000 m, expected a height from 0 to 2 m");
  // All the space there is, free: too much of it.
  CHECK(read_error(full(Bytes("\x00\x00\x00\xbf\x00", 5), "id OcTree\nsize 1\nres 0.5\n"), 0.0) == "t.ot: OctoMap: the layer is 65536 x 65536 cells, expected at most 268435456");
}

TEST_CASE("a faulty tree is told so") {
  CHECK(read_error("") == "t.ot:1: begins with '', expected '# Octomap OcTree file' or '# Octomap OcTree binary file'");
  CHECK(read_error("P5\n1 1") == "t.ot:1: begins with 'P5', expected '# Octomap OcTree file' or '# Octomap OcTree binary file'");
  CHECK(read_error("# Octomap OcTree file\nid OcTree\n") == "t.ot:3: the file ends without a line 'data'");
  CHECK(read_error(full(two_full, "id ColorOcTree\nsize 18\nres 0.5\n")) == "t.ot:2: the id is 'ColorOcTree', expected OcTree: trees with colours or times are not read");
  CHECK(read_error(full(two_full, "size 18\nres 0.5\n")) == "t.ot:4: 'id' is missing before the data");
  CHECK(read_error(full(two_full, "id OcTree\nres 0.5\n")) == "t.ot:4: 'size' is missing before the data");
  CHECK(read_error(full(two_full, "id OcTree\nsize 18\n")) == "t.ot:4: 'res' is missing before the data");
  CHECK(read_error(full(two_full, "id OcTree\nsize x\n")) == "t.ot:3: the size is 'x', expected the number of nodes");
  for (const char* res : {"0", "-1", "nan", "1e-9", "inf", "a"}) CHECK(read_error(full(two_full, fmt::format("id OcTree\nsize 18\nres {}\n", res))) == fmt::format("t.ot:4: res is '{}', expected metres a cell, from 1e-06 to 1000000", res));
  CHECK(read_error(full(two_full, "id OcTree\ncolour red\n")) == "t.ot:3: 'colour red', expected id, size, res or data");
  CHECK(read_error(full("", "id OcTree\nsize 0\nres 0.5\n")) == "t.ot: OctoMap: the tree is empty, expected known cells");
  CHECK(read_error(full(two_full, "id OcTree\nsize 17\nres 0.5\n")) == "t.ot: OctoMap: the tree has 18 nodes, expected 17, as its header says");
  for (const Bytes& content : {full(two_full), binary(two_binary)})
    CHECK(read_error(content + "x") == "t.ot: OctoMap: 1 bytes follow the last node, expected none");
  for (std::size_t cut = 1; cut <= two_full.size(); ++cut) CHECK(read_error(full(two_full.substr(0, two_full.size() - cut))).find("t.ot: OctoMap: truncated: the tree ends within its node") == 0);
  for (std::size_t cut = 1; cut <= two_binary.size(); ++cut) CHECK(read_error(binary(two_binary.substr(0, two_binary.size() - cut))).find("t.ot: OctoMap: truncated: the tree ends within its node") == 0);
  CHECK(read_error(full(times(30, node('\x01')))) == "t.ot: OctoMap: node 17 has children below the 16th level, which is the last");
  CHECK(read_error(binary(times(30, Bytes("\x03\x00", 2)))) == "t.ot: OctoMap: node 17 has children below the 16th level, which is the last");
  CHECK(read_error(full(Bytes("\x00\x00\xc0\x7f\x00", 5))) == "t.ot: OctoMap: node 1 is not a number, expected log-odds");
  CHECK(read_error(binary(Bytes("\x00\x00", 2), 1)) == "t.ot: OctoMap: the tree has no leaves, expected known cells");
}

TEST_CASE("a tree with a changed byte is refused, or read as another map, and no more") {
  const TemporaryFolder folder;
  ProbabilityGrid grid = random_grid(0);
  for (unsigned seed = 1; grid.probability.size() < 500; ++seed) grid = random_grid(seed);
  std::mt19937 random(1);
  std::size_t refused = 0;
  for (const char* name : {"g.ot", "g.bt"}) {
    REQUIRE(write_octomap(folder.path() / name, grid, 0.0));
    const Bytes content = *read_text_file(folder.path() / name);
    // Behind the upper levels, for a leaf there is a map of gigabytes.
    const std::size_t first = content.find("data\n") + 5 + 11 * (name == std::string("g.ot") ? 5 : 2);
    REQUIRE(content.size() > first + 100);
    for (int i = 0; i < 300; ++i) {
      Bytes changed = content;
      changed[first + random() % (content.size() - first)] = static_cast<char>(random() % 256);
      const auto read = read_octomap(folder.write("changed", changed), 0.0);
      refused += !read;
      if (read) CHECK(read->probability.size() == static_cast<std::size_t>(read->width) * static_cast<std::size_t>(read->height));
    }
  }
  CHECK(refused > 50);
}

TEST_CASE("what no tree can hold is not written") {
  const TemporaryFolder folder;
  const auto error = [&](const ProbabilityGrid& grid, double height = 0.0) { return error_of(write_octomap(folder.path() / "m.bt", grid, height), folder); };
  CHECK(error({1, 1, 0.5, {0.2, 0.0}, {0.5F}, {}}) == "m.bt: the origin's x is 0.2 m, expected a multiple of the resolution, 0.5 m, for OctoMap's cells lie so: move the map's origin to x 0");
  CHECK(error({1, 1, 0.5, {0.0, 1.3}, {0.5F}, {}}) == "m.bt: the origin's y is 1.3 m, expected a multiple of the resolution, 0.5 m, for OctoMap's cells lie so: move the map's origin to y 1.5");
  CHECK(error({1, 1, 0.5, {16384.0, 0.0}, {0.5F}, {}}).find("m.bt: the map reaches from x 16384 to 16384.5 m, expected at most 16384 m on either side of 0") == 0);
  CHECK(error({1, 1, 0.5, {0.0, -16384.5}, {0.5F}, {}}).find("m.bt: the map reaches from y -16384.5 to -16384 m, expected at most 16384 m on either side of 0") == 0);
  CHECK(error({65537, 1, 0.5, {-16384.0, 0.0}, std::vector<float>(65537, 0.5F), {}}).find("m.bt: the map reaches from x -16384 to 16384.5 m") == 0);
  for (const double height : {16384.0, -16384.1, static_cast<double>(NAN)}) CHECK(error({1, 1, 0.5, {}, {0.5F}, {}}, height).find("m.bt: the height of the layer is ") == 0);
  CHECK(error({2, 1, 0.5, {}, {U, U}, {}}) == "m.bt: nothing is known of any cell, expected some: a tree of OctoMap holds what is known");
  CHECK(error({1, 1, 0.5, {}, {0.2F}, {1}}) == "m.bt: nothing is known of any cell, expected some: a tree of OctoMap holds what is known");
  CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("OctoMap itself reads what we write, and we read what it writes (octomap-tools)") {
  if (std::system("command -v convert_octree > /dev/null 2>&1") != 0) {
    MESSAGE("skipped: convert_octree is not installed (apt install octomap-tools)");
    return;
  }
  const TemporaryFolder folder;
  const auto convert = [&](const char* from, const char* to) {
    const std::string log = folder.path() / "log";
    const int code = std::system(fmt::format("cd '{}' && convert_octree {} {} > log 2>&1", folder.path().string(), from, to).c_str());
    const std::string said = *read_text_file(log);
    CAPTURE(said);
    CHECK(code == 0);
    // It only warns of a wrong number of nodes.
    CHECK(said.find("ERROR") == std::string::npos);
    CHECK(said.find("WARNING") == std::string::npos);
  };
  for (unsigned seed = 0; seed < 12; ++seed) {
    CAPTURE(seed);
    ProbabilityGrid grid = random_grid(seed);
    grid.resolution = seed % 2 == 0 ? 0.1 : 0.25;
    grid.origin = glm::dvec2(static_cast<int>(seed * 7919 % 300) - 150, static_cast<int>(seed * 104729 % 300) - 150) * grid.resolution;
    const double height = grid.resolution * static_cast<double>(seed % 3);
    REQUIRE(write_octomap(folder.path() / "ours.ot", grid, height));
    REQUIRE(write_octomap(folder.path() / "ours.bt", grid, height));
    convert("ours.ot", "theirs.ot");
    CHECK(data_of(folder.path() / "theirs.ot") == data_of(folder.path() / "ours.ot"));  // inner nodes and all
    check_same(*read_octomap(folder.path() / "theirs.ot", height), grid, 2e-7);
    convert("ours.ot", "theirs.bt");
    CHECK(data_of(folder.path() / "theirs.bt") == data_of(folder.path() / "ours.bt"));
    convert("ours.bt", "theirs.ot");
    const auto states = read_octomap(folder.path() / "theirs.ot", {});
    REQUIRE_MESSAGE(static_cast<bool>(states), error_of(states, folder));
    check_same(*states, most_likely(grid), 1e-6);
    convert("ours.bt", "again.bt");
    CHECK(data_of(folder.path() / "again.bt") == data_of(folder.path() / "ours.bt"));
  }
}
