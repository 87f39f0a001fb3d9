// Generated problems: what they are made of, and how many of them are reachable, judged by a flood fill of the grown free space.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cstdlib>
#include <map>
#include <set>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "problem_maker.hpp"
#include "temporary_folder.hpp"
#include "thicket/sim/problem.hpp"
#include "thicket/worlds/truth.hpp"
#include "thicket/worlds/world_text.hpp"

namespace thicket {
namespace {

Robot small_robot() {
  Robot robot;
  robot.vehicle.radius_m = 0.25;
  return robot;
}

bool joined(const Problem& problem, const Robot& robot, double grow) {
  const glm::dvec2 start = problem.start.position, margin(4.0 * robot.keep());
  glm::dvec2 low = glm::min(start, problem.goal), high = glm::max(start, problem.goal);
  if (const auto all = extent(*problem.world)) {
    low = glm::min(low, glm::dvec2(all->low));
    high = glm::max(high, glm::dvec2(all->high));
  }
  const auto grid = grown_obstacles(*problem.world, low - margin, high + margin, 0.05, grow, 0.0, robot.vehicle.height_m);
  REQUIRE(grid);
  return connected(*grid, start, problem.goal);
}

enum class Truth { reachable, unreachable, ambiguous };

Truth truth_of(const Problem& problem, const Robot& robot) {
  const double doubt = problem_doubt(robot);
  const bool thick = joined(problem, robot, robot.keep() + doubt);
  if (thick) return Truth::reachable;  // less growth opens what more of it leaves open
  return joined(problem, robot, robot.keep() - doubt) ? Truth::ambiguous : Truth::unreachable;
}

std::vector<Problem> problems_of(const std::string& family, std::uint64_t count, const Robot& robot) {
  std::vector<Problem> list;
  for (std::uint64_t number = 0; number < count; ++number) {
    auto problem = make_problem(family, number, robot);
    REQUIRE_MESSAGE(problem, problem.error().message);
    list.push_back(std::move(*problem));
  }
  return list;
}

double distance_to_matter(const Problem& problem, const glm::dvec2& point) {
  double least = INFINITY;
  for (const Solid& solid : problem.world->solids) least = std::min(least, plan_distance(solid, point));
  return least;
}

}  // namespace

TEST_CASE("families of problems: most are decided, and of all of them about a third has no way") {
  const Robot robot = small_robot();
  const char* wanted = std::getenv("THICKET_PROBLEMS");  // more than the standard number, for a study
  const auto count = static_cast<std::uint64_t>(wanted ? std::atoi(wanted) : 40);
  struct Shares {
    double unreachable_least, unreachable_most, ambiguous_most;
  };
  const std::map<std::string, Shares> expected = {
      {"convex", {0.0, 0.0, 0.02}},
      {"spiral", {0.15, 0.5, 0.02}},
      {"maze", {0.2, 0.5, 0.02}},
      {"comb", {0.1, 0.4, 0.02}},
      {"twins", {0.15, 0.6, 0.2}},
      {"enclosed", {0.45, 0.85, 0.15}},
      {"goal", {0.5, 0.95, 0.25}},
      {"m_line", {0.05, 0.5, 0.3}},
      {"thin", {0.25, 0.6, 0.02}},
      {"random", {0.15, 0.5, 0.2}},
  };
  std::map<Truth, double> all;
  for (const auto& [family, shares] : expected) {
    std::map<Truth, double> found;
    for (const Problem& problem : problems_of(family, count, robot)) {
      const Truth truth = truth_of(problem, robot);
      found[truth] += 1.0;
      if (wanted && truth == Truth::ambiguous) MESSAGE(fmt::format("ambiguous: {}", problem.world->name));
    }
    for (const auto& [truth, n] : found) all[truth] += n;
    const double n = static_cast<double>(count);
    CAPTURE(family);
    if (wanted) MESSAGE(fmt::format("{}: reachable {}, unreachable {}, ambiguous {}", family, found[Truth::reachable], found[Truth::unreachable], found[Truth::ambiguous]));
    CHECK(found[Truth::unreachable] >= shares.unreachable_least * n);
    CHECK(found[Truth::unreachable] <= shares.unreachable_most * n);
    CHECK(found[Truth::ambiguous] <= shares.ambiguous_most * n);
  }
  const double n = all[Truth::reachable] + all[Truth::unreachable] + all[Truth::ambiguous];
  CHECK(all[Truth::unreachable] >= 0.25 * n);
  CHECK(all[Truth::unreachable] <= 0.4 * n);
  CHECK(all[Truth::ambiguous] <= 0.15 * n);
}

TEST_CASE("families of problems: start and goal are free of matter grown by the clearance and what is in doubt, but where a family is about that") {
  const Robot robot = small_robot();
  const double free = robot.keep() + problem_doubt(robot);
  for (const std::string family : {"convex", "spiral", "maze", "comb", "enclosed", "thin", "random", "rooms2019"})
    for (const Problem& problem : problems_of(family, 40, robot)) {
      CAPTURE(problem.world->name);
      CHECK(distance_to_matter(problem, problem.start.position) >= free);
      CHECK(distance_to_matter(problem, problem.goal) >= free);
    }
  int goals_in_matter = 0, goals_too_near = 0, starts_too_near = 0;
  for (const Problem& problem : problems_of("goal", 60, robot)) {
    const double goal = distance_to_matter(problem, problem.goal), start = distance_to_matter(problem, problem.start.position);
    goals_in_matter += goal == 0.0;
    goals_too_near += goal > 0.0 && goal < robot.keep();
    starts_too_near += start < robot.keep();
    CHECK(start > robot.vehicle.radius_m);  // or it would collide where it stands
  }
  CHECK(goals_in_matter >= 10);
  CHECK(goals_too_near >= 20);
  CHECK(starts_too_near == 10);
}

TEST_CASE("families of problems: a number is one problem, whatever was made before; another is another") {
  const Robot robot = small_robot();
  for (const std::string& family : problem_families()) {
    const auto first = problems_of(family, 6, robot);
    for (std::uint64_t number = 6; number-- > 0;) {
      const auto again = make_problem(family, number, robot);
      REQUIRE(again);
      CHECK(again->family == family);
      CHECK(again->start.position == first[number].start.position);
      CHECK(again->start.yaw == first[number].start.yaw);
      CHECK(again->goal == first[number].goal);
      CHECK(*write_world(*again->world) == *write_world(*first[number].world));
      if (number > 0) CHECK(again->goal != first[number - 1].goal);
    }
    CHECK(family_in_words(family).size() > 20);
  }
  CHECK(family_in_words("rooms").empty());
}

TEST_CASE("families of problems: one that is unknown, and a robot without a size, are told") {
  const auto unknown = make_problem("spirals", 1, small_robot());
  REQUIRE_FALSE(unknown);
  CHECK(unknown.error().message.find("did you mean 'spiral'?") != std::string::npos);
  Robot nothing = small_robot();
  nothing.vehicle.radius_m = 0.0;
  CHECK_FALSE(make_problem("spiral", 1, nothing));
}

TEST_CASE("families of problems: widths follow the robot") {
  for (const double radius : {0.1, 0.356}) {
    Robot robot;
    robot.vehicle.radius_m = radius;
    robot.clearance_m = radius;
    for (const std::string family : {"spiral", "maze", "comb", "thin"})
      for (const Problem& problem : problems_of(family, 12, robot)) {
        CAPTURE(radius);
        CAPTURE(problem.world->name);
        CHECK(truth_of(problem, robot) != Truth::ambiguous);
      }
  }
}

TEST_CASE("families of problems: there is a problem of every number for robots of all sizes") {
  std::vector<std::string> families = problem_families();
  families.emplace_back("rooms2019");
  for (const auto& [radius, clearance] : {std::pair{0.02, 0.0}, {0.15, 0.1}, {0.25, 0.4}, {0.356, 0.8}, {2.0, 0.1}, {0.1, 3.0}}) {
    Robot robot;
    robot.vehicle.radius_m = radius;
    robot.clearance_m = clearance;
    CAPTURE(radius);
    for (const std::string& family : families)
      for (const std::uint64_t first : {std::uint64_t{0}, std::uint64_t{1} << 63})
        for (std::uint64_t number = first; number < first + 24; ++number) {
          const auto problem = make_problem(family, number, robot);
          REQUIRE_MESSAGE(problem, problem.error().message);
          CHECK(problem->world->solids.size() < 400);
        }
  }
}

TEST_CASE("families of problems: a world is written and read as it is, so that a run of it can be repeated to the bit") {
  const Robot robot = small_robot();
  const TemporaryFolder folder;
  for (const std::string& family : problem_families())
    for (const Problem& problem : problems_of(family, 8, robot)) {
      CAPTURE(problem.world->name);
      const auto text = write_world(*problem.world);
      REQUIRE(text);
      const auto read = read_world(folder.write("world.toml", *text));
      REQUIRE(read);
      REQUIRE(read->solids.size() == problem.world->solids.size());
      for (std::size_t i = 0; i < read->solids.size(); ++i) {
        CHECK(read->solids[i].position == problem.world->solids[i].position);
        CHECK(read->solids[i].yaw == problem.world->solids[i].yaw);
      }
      CHECK(*write_world(*read) == *text);
    }
}

TEST_CASE("families of problems: twins are the same problem mirrored, turned or moved, and have the same verdict") {
  const Robot robot = small_robot();
  std::map<TwinChange, int> changes;
  const auto list = problems_of("twins", 72, robot);
  for (std::size_t i = 0; i < list.size(); i += 2) {
    const Problem &one = list[i], &other = list[i + 1];
    CAPTURE(other.world->name);
    CHECK(twin_change(i) == TwinChange::none);
    const TwinChange change = twin_change(i + 1);
    ++changes[change];
    REQUIRE(one.world->solids.size() == other.world->solids.size());
    CHECK(glm::length(one.goal - one.start.position) == doctest::Approx(glm::length(other.goal - other.start.position)));
    const double nearest = distance_to_matter(one, one.goal);
    CHECK(distance_to_matter(other, other.goal) == doctest::Approx(nearest).epsilon(1e-6));
    const Truth truth = truth_of(one, robot), of_twin = truth_of(other, robot);
    if (truth != Truth::ambiguous && of_twin != Truth::ambiguous) CHECK(truth == of_twin);
    if (change == TwinChange::mirrored) {
      CHECK(other.goal == glm::dvec2(one.goal.x, -one.goal.y));
      CHECK(other.start.yaw == doctest::Approx(-one.start.yaw));
    } else if (change == TwinChange::moved) {
      CHECK(glm::length(other.start.position - one.start.position) > 10.0);
      CHECK(other.start.yaw == one.start.yaw);
    } else {
      CHECK(std::abs(wrap_angle(bearing(other.goal - other.start.position) - bearing(one.goal - one.start.position) - (other.start.yaw - one.start.yaw))) < 1e-6);
    }
  }
  CHECK(changes.size() == 3);
}

}  // namespace thicket
