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
  const RunScore score = or_fail(score_run(run.simulation, Convention::any_overlap));
  const MapScore& s = score.map;
  const ClaimedCells claimed = claimed_cells(run.simulation);
  return {name, to_string(run.simulation.verdict()->kind), fixed(s.f1), fixed(s.precision), fixed(s.recall), std::to_string(claimed.all), std::to_string(claimed.wrong), fixed(s.edge_error_m), fixed(static_cast<double>(score.memory_bytes) / 1024.0, 0)};
}
const TableRow score_head = {"map", "verdict", "F1", "precision", "recall", "cells claimed", "of them wrong", "mean edge error, m", "map, KiB"};
const char* score_words = "F1, precision and recall are of surfaces within 0.2 m, judged by the world itself, a cell being matter if the two share any area, for plates and panes are thinner than a cell ([mapping.md](mapping.md#how-a-map-is-judged)). ";

std::vector<std::string> shortened(const ExperimentContext& context, std::vector<std::string> sets, const char* seconds = "8") {
  if (context.brief()) sets.push_back(std::string("limits.time_s=") + seconds);
  return sets;
}

/// What is freed of a lobe, what counts as a witness and how steel scatters, in cells of 0.1 m.
std::string room_by_other_keys(const ExperimentContext& context) {
  const PlacedThing plate{"plate", 3.0, 0.0, 0.5};
  std::vector<TableRow> rows;
  std::string pictures;
  for (const auto& [name, title, sets] : {std::tuple("", "the mission's: the middle 0.4 of a lobe is freed", std::vector<std::string>{}), std::tuple("", "0.2 of it", std::vector<std::string>{"map.lobe_share=0.2"}),
                                          std::tuple("", "0.7 of it, the default", std::vector<std::string>{"map.lobe_share=0.7"}), std::tuple("", "all of it, and every scan a witness", std::vector<std::string>{"map.lobe_share=1", "map.evidence=scans"}),
                                          std::tuple("diffuse", "0.4, and all surfaces diffuse, as in 2018", std::vector<std::string>{"sensor.scattering=lambert"}),
                                          std::tuple("", "all of it, every scan a witness, all surfaces diffuse", std::vector<std::string>{"map.lobe_share=1", "map.evidence=scans", "sensor.scattering=lambert"})}) {
    const FinishedRun run = context.run("ntnu_room/ntnu_room", shortened(context, sets));
    TableRow row = score_row(title, run);
    row.push_back(std::to_string(claimed_near(run.simulation, plate)));
    rows.push_back(std::move(row));
    if (*name != 0) pictures += context.map_picture(name, run, "The map in cells of 0.1 m if all surfaces were diffuse.");
  }
  TableRow head = score_head;
  head[0] = "in cells of 0.1 m";
  head.push_back("cells claimed about the plate");
  return pictures + table(head, rows);
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
  text += context.path_picture("way", runs.back(), "The way, which the robot keeps before the plate.") + pictures + table(score_head, rows) + score_words;
  text += "With 64-bit cells the source has 80 kB, 500 kB, 2 MB and 8 MB for 50 × 50 m; the last column is all that our map holds.\n\n" + room_by_other_keys(context);
  text += "**What differs.** In cells of 0.2 m and less the walls are lines in the right places; in cells of 0.5 m they are as thick as the gaps between things, as in the source. About half of the cells claimed are wrong, mostly the arcs that stick out of the "
          "corners: there no second look told where on its arc the echo was. The source has more false cells at 0.2 m than at 0.1 m; in ours their share rises as cells get smaller. Space behind walls stays unknown but for the arcs, and for corners that are freed where it turns, as in the source. Of the door there is a notch of 0.2 m at "
          "most, of the window nothing, as in the source: a lobe of 65° is wider than they are where it passes them, and the nearest thing in it is always a wall. A beam radar finds them ([mapping.md](mapping.md)).\n\nThe **plate** is the great difference: the source has it, and ours is "
          "one cell of it. Smooth steel answers squarely met and is silent from everywhere else, and silence frees cells. With diffuse surfaces, which is what the source's cosine means, the same flight has the plate and even what the source praises, unknown space behind it. "
          "How much of a lobe is freed matters as much: with the default of 0.7 the silence of lobes that pass along a wall wipes half of it out again, and the missions of 2018 therefore free 0.4.\n\n";
  std::vector<std::pair<TableRow, const FinishedRun*>> costs;
  for (std::size_t i = 0; i < runs.size(); ++i) costs.push_back({{rows[i][0]}, &runs[i]});
  return text + cost_table({"cells"}, costs);
}

std::string cluttered_room(ExperimentContext& context) {
  std::string text = context.world_picture("room", context.scene("cluttered_room/cluttered_room"), {.from = glm::dvec3(-1.0, -17.0, 15.0), .at = glm::dvec3(0.0, -0.6, 0.0), .width = 720, .height = 450, .hide = {"walls"}},
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
  text += "**What differs.** The source flies the same way twice; ours are two ways, so that it can be seen what comes from the way. Walls that were passed are there, and so are the dumpster, the side of the car that was passed (in run two a line along it, in run one "
          "an arc before it), the control panel in its wall, and the human where the robot came near. As in the source postbox and stop sign are the worst: of the postbox, in the top left corner, there is nothing, for the way leaves it 4 m aside; the stop sign is among the "
          "smeared arcs of its corner. The robot's model is lost too. About half of the cells claimed are wrong, nearly all of them arcs in corners that no second look has resolved. There the source blames a fixed grid of rays that now meets small things and now does "
          "not. Ours draws the directions anew for each scan, and it does not help a thing that a lobe sees from one side only.\n\n";
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
         "**What differs.** The source's map begins to claim cells to the left and right, along the lobe that meets the human. With every scan as a witness ours does the same, ahead, behind and to the right: 631 cells, arc behind arc, as the first echo jumps between "
         "things of like strength. Where looks from one place are one witness there are 76 in half a minute: not none, for where the first echo is now of the robot's model and now of the wall behind it, the median of the last 17 changes sides too, and each side has an arc. "
         "To the left, where the human is, nothing is added. Most cells that are wrong were so before it stood: a short straight way does not tell where on its arc an echo is.\n\n";
}

std::string cargo_hold(ExperimentContext& context) {
  std::string text = context.world_picture("hold", context.scene("cargo_hold/cargo_hold"), {.from = glm::dvec3(-22.0, -13.0, 14.0), .at = glm::dvec3(-3.0, 0.0, 0.0), .width = 720, .height = 450, .hide = {}}, "The hold, made by `thicket generate hold`: frames and stiffeners of steel plate, all of it traced.");
  const FinishedRun fine = context.run("cargo_hold/along_walls", shortened(context, {}));
  const FinishedRun freed = context.run("cargo_hold/along_walls", shortened(context, {"map.lobe_share=0.7"})), bounced = context.run("cargo_hold/along_walls", shortened(context, {"sensor.bounces_max=3"}));
  text += context.path_picture("way", fine, "The way along the walls.") + context.map_picture("map", fine, "The map, in cells of 0.1 m.");
  text += table(score_head, {score_row("0.1 m", fine), score_row("0.1 m, 0.7 of a lobe is freed, the default", freed), score_row("0.1 m, 3 bounces", bounced)}) + score_words;
  text += "\n\n**What differs.** The source could not trace its CAD model and flew between hand-made walls; ours flies in the mesh itself. Both long walls are lines, the bulkheads dashes; of the flanges, which are seen first for a few scans each, little is left. "
          "Arcs stick out of the corners, and behind walls space is freed where it turns, as the source has it in its rooms. The source says that almost nothing is detected. So it is here for the lobes ahead and behind, which are silent for most of the way; their silence wipes the walls out if 0.7 of it counts (second row). Corners of web "
          "and plate answer over two surfaces and break the silence: the third row has nearly all surfaces. Its mapping costs most when nothing is hit; ours has the share of the time below.\n\n";
  return text + cost_table({"flight"}, {{{"along the walls"}, &fine}});
}

}  // namespace

ClaimedCells claimed_cells(const Simulation& simulation) {
  const MapScore score = or_fail(score_run(simulation, Convention::any_overlap)).map;
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
