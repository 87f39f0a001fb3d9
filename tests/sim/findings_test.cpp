// What the maps of 2018 missed: doors, windows, a postbox and a stop sign. The rules are those of found_things.hpp.
#include <doctest/doctest.h>

#include <string>
#include <tuple>

#include "finished.hpp"
#include "experiments/found_things.hpp"
#include "thicket/base/files.hpp"
#include "thicket/sim/map_score.hpp"
#include "thicket/sim/outputs.hpp"

namespace thicket {
namespace {

using finds::Found;

Simulation mapped(const char* name, const char* resolution, const char* evidence = "views") {
  const auto mission = read_mission(find_input(name), {{"map.resolution_m", resolution, "--set"}, {"map.evidence", evidence, "--set"}});
  if (!mission) FAIL(mission.error().message);
  Simulation simulation = finished(*mission);
  REQUIRE(simulation.verdict());
  CHECK(simulation.verdict()->kind == Verdict::Kind::reached);
  return simulation;
}

Found found(const Simulation& simulation) { return finds::found(simulation.map(), simulation.scene().world()); }

void check_whole_walls(const char* evidence) {
  for (const char* resolution : {"0.2", "0.1"}) {
    CAPTURE(std::string(resolution));
    const Simulation simulation = mapped("findings/beams", resolution, evidence);
    const World& world = simulation.scene().world();
    const finds::Look look(simulation.map());
    CHECK_FALSE(look.doorway(finds::plan_of(world, "window pane")));
    CHECK_FALSE(look.thing(finds::plan_of(world, "pole of the stop sign").moved(0.4, 1.0)));
  }
}

}  // namespace

TEST_CASE("a beam radar finds doorway, window, postbox and stop sign in cells of 0.2 m and less, and where there are none it finds none") {
  for (const char* resolution : {"0.2", "0.1", "0.05"}) {
    CAPTURE(std::string(resolution));
    const Simulation simulation = mapped("findings/beams", resolution);
    CHECK(found(simulation) == Found{true, true, true, true});
    const World& world = simulation.scene().world();
    const finds::Look look(simulation.map());
    for (const double aside : {3.0, 4.5}) CHECK_FALSE(look.doorway(finds::plan_of(world, "wall above the doorway").moved(aside, 0.0)));
    for (const double aside : {-2.2, 2.2}) CHECK_FALSE(look.window(finds::plan_of(world, "window pane").moved(aside, 0.0), 1));
    CHECK_FALSE(look.window(finds::plan_of(world, "wall above the doorway"), -1));  // an opening without a pane
    CHECK_FALSE(look.thing(finds::plan_of(world, "postbox").moved(2.0, -2.0)));
    CHECK_FALSE(look.thing(finds::plan_of(world, "pole of the stop sign").moved(-2.0, 2.0)));
  }
}

// Postbox and pole are half a metre and less from walls and run together with them; free cells behind a wall are too large to tell a window from it.
TEST_CASE("a beam radar finds no window, no postbox and no stop sign in cells of half a metre") {
  Found coarse = found(mapped("findings/beams", "0.5"));
  coarse.doorway = false;  // see below
  CHECK(coarse == Found{});
}

TEST_CASE("a beam radar finds the doorway in cells of half a metre") { CHECK(found(mapped("findings/beams", "0.5")).doorway); }

TEST_CASE("where every look counts no way leads through a window pane, and no piece of a wall stands alone") { check_whole_walls("scans"); }

TEST_CASE("where repeated looks are one witness no way leads through a window pane, and no piece of a wall stands alone") { check_whole_walls("views"); }

// A lobe of 65 degrees is 1.7 m wide at the distance at which it passes the doorway: the nearest thing in it is always a wall.
TEST_CASE("four lobes find no doorway and no stop sign, whatever the cells") {
  for (const char* resolution : {"0.5", "0.2", "0.1", "0.05"}) {
    CAPTURE(std::string(resolution));
    const Found by_lobes = found(mapped("findings/lobes", resolution));
    CHECK_FALSE(by_lobes.doorway);
    CHECK_FALSE(by_lobes.sign);
    MESSAGE("in cells of ", std::string(resolution), " m postbox found: ", by_lobes.postbox, ", window: ", by_lobes.window);
  }
}

TEST_CASE("from one side of the foliage all echoes map the room behind it, the first echoes nothing of it") {
  const auto behind = [](const char* name) {
    const auto mission = read_mission(find_input(name), {});
    REQUIRE(mission);
    const Simulation simulation = finished(*mission);
    const glm::dvec4 region = *mission->output.observed_region_m;
    // What the map has of the hidden room alone.
    ProbabilityGrid grid = simulation.map().to_probabilities();
    std::size_t free = 0;
    for (int row = 0; row < grid.height; ++row)
      for (int column = 0; column < grid.width; ++column) {
        const glm::dvec2 centre = grid.origin + (glm::dvec2(column, row) + 0.5) * grid.resolution;
        float& p = grid.probability[grid.index(column, row)];
        if (centre.x < region.x || centre.x > region.z + 0.1 || centre.y < region.y - 0.1 || centre.y > region.w + 0.1) p = ProbabilityGrid::unknown;  // with its walls, which begin there
        else free += grid.known(grid.index(column, row)) && p < 0.5f;
      }
    const auto truth = map_truth(simulation, grid, Convention::cell_centre);
    REQUIRE(truth);
    const auto score = score_map(grid, *truth);
    REQUIRE(score);
    const auto share = observed_share(simulation, region);
    REQUIRE(share);
    MESSAGE(std::string(name), ": ", free, " cells behind the foliage known free, ", *share, " of its free area observed, F1 ", score->f1, ", ", score->claimed, " cells claimed");
    return std::tuple(free, *share, *score);
  };
  const auto [all_free, all_share, all] = behind("foliage_wall/map_radar");
  CHECK(all_free > 10000);  // of 16,000 cells
  CHECK(all_share > 0.65);
  CHECK(all.f1 > 0.95);
  const auto [first_free, first_share, first] = behind("foliage_wall/map_first_echo");
  CHECK(first_free == 0);
  CHECK(first_share == 0.0);
  CHECK(first.claimed == 0);
}

}  // namespace thicket
