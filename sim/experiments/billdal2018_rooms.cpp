// The experiments of Billdal 2018: maps of the test room, the cluttered room and the cargo hold (figures 6.10 to 6.18).
#include <fmt/format.h>

#include <cmath>
#include <set>

#include <glm/geometric.hpp>

#include "billdal2018.hpp"
#include "thicket/sim/map_score.hpp"

namespace thicket {
namespace {

/// What a reader needs of a score.
TableRow score_row(const std::string& name, const FinishedRun& run) {
  const RunScore score = or_fail(score_run(run.simulation));
  const MapScore& s = score.map;
  const ClaimedCells claimed = claimed_cells(run.simulation);
  return {name, to_string(run.simulation.verdict()->kind), fixed(s.f1), fixed(s.precision), fixed(s.recall), std::to_string(claimed.all), std::to_string(claimed.wrong), fixed(s.edge_error_m), fixed(static_cast<double>(score.memory_bytes) / 1024.0, 0)};
}
const TableRow score_head = {"map", "verdict", "F1", "precision", "recall", "cells claimed", "of them wrong", "mean edge error, m", "map, KiB"};
const char* score_words = "F1, precision and recall are of surfaces within 0.2 m, judged by the world itself ([mapping.md](mapping.md#how-a-map-is-judged)). ";

std::vector<std::string> shortened(const ExperimentContext& context, std::vector<std::string> sets, const char* seconds = "8") {
  if (context.brief()) sets.push_back(std::string("limits.time_s=") + seconds);
  return sets;
}

std::string ntnu_room(ExperimentContext& context) {
  std::string text = context.world_picture("room", context.scene("test_room/test_room"), {.from = glm::dvec3(-4.5, -11.0, 9.0), .at = glm::dvec3(0.0, 0.0, 0.5), .width = 640, .height = 400, .hide = {}}, "The room as it is, without its ceiling: an open door in the south, a window in the north, the plate in the east.");
  std::vector<TableRow> rows;
  std::vector<FinishedRun> runs;
  std::string pictures;
  for (const char* cell : {"0.5", "0.2", "0.1", "0.05"}) {
    runs.push_back(context.run("ntnu_room/ntnu_room", shortened(context, {std::string("map.resolution_m=") + cell})));
    rows.push_back(score_row(std::string(cell) + " m", runs.back()));
    pictures += context.map_picture(std::string("map_") + std::string(cell).substr(2), runs.back(), std::string("The map in cells of ") + cell + " m.");
  }
  FinishedRun literal = context.run("ntnu_room/ntnu_room", shortened(context, {"map.resolution_m=0.2", "map.evidence=scans", "map.lobe_share=1"}));
  rows.push_back(score_row("0.2 m, every scan a witness, all of the lobe freed", literal));
  text += context.path_picture("way", runs.back(), "The way, which the robot keeps before the plate.") + pictures + table(score_head, rows) + score_words;
  text += "A lobe tells how far and not where: walls are a band whose near edge is right. With 64-bit cells the source has 80 kB, 500 kB, 2 MB and 8 MB for 50 m²; the last column is all that our map holds.\n\n";
  text += "**What differs.** The plate and the walls are there in all four; cells of 0.5 m are too coarse for both. Space behind the walls stays unknown, and so do door and window: a lobe of 65° is wider than they are where it passes "
          "them, and the nearest thing in it is always a wall. A beam radar finds them ([mapping.md](mapping.md)).\n\n";
  std::vector<std::pair<TableRow, const FinishedRun*>> costs;
  for (std::size_t i = 0; i < runs.size(); ++i) costs.push_back({{rows[i][0]}, &runs[i]});
  return text + cost_table({"cells"}, costs);
}

std::string cluttered_room(ExperimentContext& context) {
  std::string text = context.world_picture("room", context.scene("cluttered_room/cluttered_room"), {.from = glm::dvec3(-2.0, -14.0, 12.0), .at = glm::dvec3(0.0, -0.3, 0.0), .width = 720, .height = 450, .hide = {"walls"}},
                                           "The room without walls and ceiling: dumpster, robot and stop sign in front, control panel on the left, postbox, human and car behind.");
  std::vector<TableRow> rows, things;
  std::vector<FinishedRun> runs;
  for (const char* name : {"one", "two"}) {
    runs.push_back(context.run(std::string("cluttered_room/cluttered_") + name, shortened(context, {})));
    rows.push_back(score_row(std::string("run ") + name, runs.back()));
    text += context.map_picture(std::string("map_") + name, runs.back(), std::string("The map of run ") + name + ".");
  }
  for (const PlacedThing& thing : cluttered_things()) things.push_back({thing.name, std::to_string(claimed_near(runs[0].simulation, thing)), std::to_string(claimed_near(runs[1].simulation, thing))});
  text += table(score_head, rows) + score_words + "Cells that the maps claim where the seven things stand, and within 0.2 m of them:\n\n" + table({"thing", "run one", "run two"}, things);
  text += "**What differs.** The source flies the same way twice; ours are two ways, so that it can be seen what comes from the way. A thing near a wall, such as postbox and stop sign, runs together with it in cells of a lobe: as in the source they "
          "are the worst. That they flicker and smear comes there from a fixed grid of rays that now meets them and now does not; here the directions are drawn anew for each scan, and repeated looks from one place are one witness.\n\n";
  return text + cost_table({"run"}, {{{"one"}, &runs[0]}, {{"two"}, &runs[1]}});
}

/// Claimed cells by place, so that maps that have grown can be compared.
std::set<std::pair<std::int64_t, std::int64_t>> places(const Simulation& simulation) {
  std::set<std::pair<std::int64_t, std::int64_t>> list;
  const ProbabilityGrid grid = simulation.map().to_probabilities();
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column)
      if (const auto i = grid.index(column, row); grid.known(i) && grid.probability[i] > 0.5f) list.emplace(std::llround(grid.origin.x / grid.resolution) + column, std::llround(grid.origin.y / grid.resolution) + row);
  return list;
}

std::string standing_still(ExperimentContext& context) {
  std::vector<TableRow> rows;
  std::string pictures;
  for (const auto& [name, title, sets] : {std::tuple("views", "ours: looks from one place are one witness", std::vector<std::string>{}), std::tuple("scans", "every scan is a witness", std::vector<std::string>{"map.evidence=scans"}),
                                          std::tuple("literal", "and all of the lobe is freed", std::vector<std::string>{"map.evidence=scans", "map.lobe_share=1"})}) {
    Simulation simulation = context.prepare("cluttered_room/standing_still", shortened(context, sets, "9"));
    drive_until_standing(simulation);
    const auto before = places(simulation);
    const ClaimedCells then = claimed_cells(simulation);
    const double began = simulation.time();
    FinishedRun run{std::move(simulation), {}, {}};
    while (run.simulation.step()) {
    }
    const auto after = places(run.simulation);
    std::size_t more = 0, fewer = 0;
    for (const auto& place : after) more += !before.contains(place);
    for (const auto& place : before) fewer += !after.contains(place);
    const ClaimedCells now = claimed_cells(run.simulation);
    rows.push_back({title, fixed(run.simulation.time() - began, 1), std::to_string(then.all), std::to_string(then.wrong), std::to_string(more), std::to_string(fewer), std::to_string(now.wrong)});
    if (std::string(name) != "literal") pictures += context.map_picture(name, run, std::string("At the end: ") + title + ".");
  }
  return "The last two metres of the first run, and then half a minute on the spot; counted from one second after it has come to rest.\n\n" + pictures +
         table({"map", "stands for, s", "cells claimed", "of them wrong", "claimed while it stands", "given up meanwhile", "wrong at the end"}, rows) +
         "**What differs.** The source's map begins to claim cells to the left and right, along the lobe that meets the human. Ours takes the median of looks from one place and counts it once: nothing that is wrong is added by standing.\n\n";
}

std::string cargo_hold(ExperimentContext& context) {
  std::string text = context.world_picture("hold", context.scene("cargo_hold/cargo_hold"), {.from = glm::dvec3(-22.0, -13.0, 14.0), .at = glm::dvec3(-3.0, 0.0, 0.0), .width = 720, .height = 450, .hide = {}}, "The hold, made by `thicket generate hold`: frames and stiffeners of steel plate, all of it traced.");
  const FinishedRun fine = context.run("cargo_hold/along_walls", shortened(context, {}));
  text += context.path_picture("way", fine, "The way along the walls.") + context.map_picture("map", fine, "The map, in cells of 0.1 m.");
  text += table(score_head, {score_row("0.1 m", fine)}) + score_words;
  text += "\n\n**What differs.** The source could not trace its CAD model and flew between hand-made walls; ours flies in the mesh itself, and the flanges of the frames are what is seen first. It says that almost nothing is detected, and that its mapping costs most then; "
          "ours takes no longer where nothing is hit.\n\n";
  return text + cost_table({"flight"}, {{{"along the walls"}, &fine}});
}

}  // namespace

ClaimedCells claimed_cells(const Simulation& simulation) {
  const MapScore score = or_fail(score_run(simulation)).map;
  return {score.claimed, std::isfinite(score.precision) ? static_cast<std::size_t>(std::lround(static_cast<double>(score.claimed) * (1.0 - score.precision))) : 0};
}

bool drive_until_standing(Simulation& simulation) {
  double since = 0.0;
  while (simulation.step()) {
    const bool moves = simulation.totals().path_length < 1.0 || glm::length(simulation.platform().velocity) > 0.01;
    if (moves) since = simulation.time();
    if (!moves && simulation.time() - since >= 1.0) return true;
  }
  return false;
}

const std::vector<PlacedThing>& cluttered_things() {
  static const std::vector<PlacedThing> things = {{"car", 4.2, 4.2, 1.6}, {"postbox", -7.0, 5.0, 0.2}, {"stop sign", 7.0, -5.0, 0.3}, {"human", -0.5, 3.8, 0.3}, {"robot", 1.5, -5.0, 0.35}, {"control panel", -7.6, -1.0, 0.5}, {"dumpster", -4.5, -5.2, 0.8}};
  return things;
}

std::size_t claimed_near(const Simulation& simulation, const PlacedThing& thing) {
  const ProbabilityGrid grid = simulation.map().to_probabilities();
  std::size_t count = 0;
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const auto i = grid.index(column, row);
      const glm::dvec2 centre = grid.origin + (glm::dvec2(column, row) + 0.5) * grid.resolution;
      count += grid.known(i) && grid.probability[i] > 0.5f && glm::distance(centre, glm::dvec2(thing.x, thing.y)) <= thing.radius + 0.2;
    }
  return count;
}

std::vector<Experiment> room_experiments2018() {
  return {{"billdal2018/ntnu_room", "The test room in four resolutions", "Billdal 2018, figures 6.10, 6.12a and 6.13",
           "A room with a plate, flown round by a quadrotor with four lobes. In cells of 0.5 m most features are gone, 0.2 m has walls and plate and some cells that are not there, 0.1 and 0.05 m have few of those. Space behind the walls is mapped "
           "when it turns; doors and windows are missed.",
           ntnu_room},
          {"billdal2018/cluttered_room", "The cluttered room", "Billdal 2018, figures 6.11, 6.12b and 6.14",
           "Car, postbox, stop sign, human, robot, control panel and dumpster in a larger room, run twice, in cells of 0.1 m. Most is mapped; the stop sign is smeared, the postbox is in several places.", cluttered_room},
          {"billdal2018/standing_still", "Standing still", "Billdal 2018, figure 6.14, where the way ends", "The quadrotor waits at the end of its way, and its map begins to claim cells to its left and right that are free.", standing_still},
          {"billdal2018/cargo_hold", "The cargo hold", "Billdal 2018, figures 6.15 to 6.18", "A ship's hold, of hand-made walls since its mesh could not be traced, flown along the walls; the map in cells of 0.1 m. Almost nothing is detected.", cargo_hold}};
}

}  // namespace thicket
