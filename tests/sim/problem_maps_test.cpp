// Problems on maps that are files.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>

#include <glm/geometric.hpp>

#include "outside_data.hpp"
#include "temporary_folder.hpp"
#include "thicket/sim/problem.hpp"
#include "thicket/worlds/truth.hpp"

namespace thicket {
namespace {

Robot map_robot() {
  Robot robot;
  robot.vehicle.radius_m = 0.15;
  robot.clearance_m = 0.1;
  return robot;
}

// 6 x 4 cells; the top row of the file is the last of the grid.
constexpr const char* room =
    "type octile\nheight 4\nwidth 6\nmap\n"
    "@@@@@@\n"
    "@...@@\n"
    "@....@\n"
    "@@@@@@\n";

constexpr const char* scenarios =
    "version 1\n"
    "0\troom.map\t6\t4\t1\t1\t4\t2\t3.4\n"
    "0\tmaps/room.map\t6\t4\t3\t1\t1\t2\t2.4\n"
    "0\tother.map\t9\t9\t8\t8\t7\t7\t2.4\n"
    "0\troom.map\t6\t4\t0\t0\t1\t2\t2.4\n";

MapProblems some(std::size_t count, double cell = 1.0) {
  MapProblems how;
  how.problems_per_map = count;
  how.cell_size_m = cell;
  return how;
}

bool in_the_room(const glm::dvec2& p) { return (p.y > 1.0 && p.y < 2.0 && p.x > 1.0 && p.x < 5.0) || (p.y > 2.0 && p.y < 3.0 && p.x > 1.0 && p.x < 4.0); }

}  // namespace

TEST_CASE("problems of maps: scenarios count their rows from the top, and those that begin in matter are passed over and told") {
  const TemporaryFolder folder;
  const auto map = folder.write("room.map", room);
  folder.write("room.map.scen", scenarios);
  const auto read = read_problems(folder.path(), some(2), map_robot());
  REQUIRE_MESSAGE(read, read.error().message);
  REQUIRE(read->problems.size() == 2);
  const Problem& first = read->problems[0];
  CHECK(first.start.position == glm::dvec2(1.5, 2.5));
  CHECK(first.goal == glm::dvec2(4.5, 1.5));
  CHECK(first.family == "room");
  CHECK(first.number == 0);
  CHECK(first.world_file == map);
  CHECK(first.cell_size_m == 1.0);
  CHECK(first.world_image.empty());
  CHECK(read->problems[1].start.position == glm::dvec2(3.5, 2.5));
  CHECK(read->problems[1].goal == glm::dvec2(1.5, 1.5));
  CHECK(read->problems[1].number == 1);
  CHECK(read->problems[1].world == first.world);
  REQUIRE(read->notices.size() == 1);
  CHECK(read->notices[0].find("1 of 3 scenarios") != std::string::npos);

  const auto larger = read_problems(map, some(2, 2.0), map_robot());
  REQUIRE(larger);
  CHECK(larger->problems[0].start.position == glm::dvec2(3.0, 5.0));
  CHECK(larger->problems[0].cell_size_m == 2.0);
}

TEST_CASE("problems of maps: where scenarios are too few, places that are free follow at random, always the same of a seed") {
  const TemporaryFolder folder;
  folder.write("room.map", room);
  folder.write("room-even-1.scen", scenarios);
  const auto read = read_problems(folder.path(), some(30), map_robot());
  REQUIRE(read);
  REQUIRE(read->problems.size() == 30);
  CHECK(read->problems[0].start.position == glm::dvec2(1.5, 2.5));
  std::set<double> starts;
  for (const Problem& problem : read->problems) {
    CHECK(in_the_room(problem.start.position));
    CHECK(in_the_room(problem.goal));
    starts.insert(problem.start.position.x);
  }
  CHECK(starts.size() == 4);  // all columns
  const auto again = read_problems(folder.path() / "room.map", some(30), map_robot());
  REQUIRE(again);
  MapProblems other_seed = some(30);
  other_seed.seed = 2;
  const auto other = read_problems(folder.path(), other_seed, map_robot());
  REQUIRE(other);
  int differ = 0;
  for (std::size_t i = 0; i < 30; ++i) {
    CHECK(again->problems[i].start.position == read->problems[i].start.position);
    CHECK(again->problems[i].goal == read->problems[i].goal);
    differ += other->problems[i].goal != read->problems[i].goal;
  }
  CHECK(differ > 10);
}

TEST_CASE("problems of maps: scenarios are spread over their list") {
  const TemporaryFolder folder;
  folder.write("long.map", "type octile\nheight 1\nwidth 40\nmap\n" + std::string(40, '.') + "\n");
  std::string list = "version 1\n";
  for (int i = 0; i < 40; ++i) list += fmt::format("0 long.map 40 1 {} 0 0 0 1\n", i);
  folder.write("long.scen", list);
  const auto read = read_problems(folder.path(), some(4), map_robot());
  REQUIRE(read);
  for (std::size_t i = 0; i < 4; ++i) CHECK(read->problems[i].start.position.x == doctest::Approx(10.0 * static_cast<double>(i) + 0.5));
}

TEST_CASE("problems of maps: a map_server map, whose image may bear the map's name only, and a world file; in the order of their paths") {
  const TemporaryFolder folder;
  std::string image = "P5\n60 40\n255\n";
  for (int row = 0; row < 40; ++row)
    for (int column = 0; column < 60; ++column) image += row < 4 || column < 4 || row > 35 || column > 55 ? '\x00' : '\xfe';
  folder.write("b/hall.pgm", image);
  folder.write("b/hall.yaml", "image: missing.pgm\nresolution: 0.1\norigin: [-3, 1, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
  folder.write("a/box.toml", "name = \"box\"\nbounds_m = [0, 0, 10, 10]\n[material.wall]\n[[solid]]\ntype = \"box\"\nmaterial = \"wall\"\nposition_m = [5, 5, 0.5]\nsize_m = [8, 8, 1]\n");
  folder.write("a/moves.toml",
               "name = \"moves\"\n[material.wall]\n[[solid]]\ntype = \"box\"\nmaterial = \"wall\"\nsize_m = [1, 1, 1]\n[solid.motion]\nwaypoints_m = [[0, 0, 0], [1, 0, 0]]\n");
  folder.write("c/mission.toml", "[planner]\nname = \"bug2\"\n");
  const auto read = read_problems(folder.path(), some(20), map_robot());
  REQUIRE_MESSAGE(read, read.error().message);
  REQUIRE(read->problems.size() == 40);
  for (std::size_t i = 0; i < 40; ++i) {
    const Problem& problem = read->problems[i];
    CHECK(problem.number == i);
    CHECK(problem.family == (i < 20 ? "box" : "hall"));
    for (const glm::dvec2& p : {problem.start.position, problem.goal}) {
      const double far = problem.family == "box" ? std::max(std::abs(p.x - 5.0), std::abs(p.y - 5.0)) - 4.0 : std::min({p.x + 2.6, 2.6 - p.x, p.y - 1.4, 4.6 - p.y});
      CHECK(far >= 0.25 + problem_doubt(map_robot()) - 1e-9);
    }
  }
  CHECK(read->problems[30].world_image == folder.path() / "b/hall.pgm");
  REQUIRE(read->notices.size() == 2);
  CHECK(read->notices[0].find("moves.toml") != std::string::npos);
  CHECK(read->notices[1].find("'hall.pgm' beside it was taken") != std::string::npos);
}

TEST_CASE("problems of maps: what cannot be read is told with its name") {
  const TemporaryFolder folder;
  const auto message = [&] {
    const auto read = read_problems(folder.path(), some(5), map_robot());
    REQUIRE_FALSE(read);
    return read.error().message;
  };
  CHECK(message().find("holds no map") != std::string::npos);
  const auto map = folder.write("room.map", room);
  const auto list = [&](const char* row) { return folder.write("room.scen", fmt::format("version 1\n{}\n", row)).string() + ":2: "; };
  for (const char* row : {"0 room.map 5 4 1 1 2 1 1", "0 room.map 6 4 1 1 6 1 1", "0 room.map 6 4 1 -1 2 1 1", "0 room.map 6 4 1 x 2 1 1"}) {
    const std::string place = list(row);
    CHECK(message().starts_with(place));
  }
  folder.write("room.scen", "0 room.map 6 4 1 1 2 1 1\n");
  CHECK(message().find("room.scen:1: begins with '0'") != std::string::npos);
  folder.write("room.map", "type octile\n");
  CHECK(message().find(map.string()) != std::string::npos);
  CHECK_FALSE(read_problems(folder.path() / "nothing.yaml", some(5), map_robot()));
  const auto mission = folder.write("mission.toml", "[planner]\nname = \"bug2\"\n");
  CHECK(read_problems(mission, some(5), map_robot()).error().message.find("this is a mission") != std::string::npos);
}

TEST_CASE("problems of maps: a map with no room has none") {
  const TemporaryFolder folder;
  const auto map = folder.write("room.map", room);
  Robot large = map_robot();
  large.vehicle.radius_m = 3.0;
  const auto read = read_problems(map, some(5), large);
  REQUIRE(read);
  CHECK(read->problems.empty());
  REQUIRE(read->notices.size() == 1);
  CHECK(read->notices[0].find("has no room") != std::string::npos);
}

TEST_CASE("problems of maps: all outside maps give theirs") {
  std::map<std::string, int> counts;
  for (const char* name : {"movingai", "ros_maps"}) {
    const auto folder = outside_data(name);
    if (!folder) {
      MESSAGE("skipped: no outside data");
      return;
    }
    const auto read = read_problems(*folder, some(50), map_robot());
    REQUIRE_MESSAGE(read, read.error().message);
    for (const Problem& problem : read->problems) ++counts[problem.family];
    for (const std::string& notice : read->notices) MESSAGE(notice);
  }
  CHECK(counts.size() == 11);
  for (const auto& [family, count] : counts) {
    CAPTURE(family);
    CHECK(count == 50);
  }
}

}  // namespace thicket
