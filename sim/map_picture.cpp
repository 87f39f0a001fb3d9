#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "canvas.hpp"
#include "picture_view.hpp"
#include "thicket/sim/outputs.hpp"

namespace thicket {
namespace {

struct Ink {
  std::uint32_t pixel;
  const char* words;
};
// The legend of the 2012 map (its figure 15); "sensed through" is a shade of its grey.
constexpr Ink unknown_ink{0xff2f4b8f, "never sensed"}, sensed_ink{0xffffffff, "sensed"}, clear_ink{0xffc9ccd1, "clear, surely"},
    through_ink{0xff93b48c, "sensed through"}, obstacle_ink{0xff111111, "obstacle"};

constexpr Colour ink{0.1, 0.1, 0.12}, path_ink{0.85, 0.33, 0.0}, start_ink{0.0, 0.45, 0.70}, goal_ink{0.80, 0.0, 0.35}, line_ink{0.25, 0.25, 0.3, 0.8};

Colour colour_of(std::uint32_t pixel) {
  return {static_cast<double>(pixel >> 16 & 255u) / 255.0, static_cast<double>(pixel >> 8 & 255u) / 255.0, static_cast<double>(pixel & 255u) / 255.0};
}

std::uint32_t pixel_of(const OccupancyMap& map, const CellIndex& cell) {
  const CellView view = map.view(cell);
  if (!view.known) return unknown_ink.pixel;
  if (view.probability > 0.5) return obstacle_ink.pixel;
  if (view.sensed_through) return through_ink.pixel;
  return map.surely_free(cell) ? clear_ink.pixel : sensed_ink.pixel;
}

/// Shows the map, the path, the goal and the world's stated bounds.
PictureFrame fit(const Simulation& simulation, const Trajectory& trajectory) {
  PictureFrame view;
  const OccupancyMap& map = simulation.map();
  const double cell = map.resolution();
  if (const auto extent = map.extent()) {
    view.hold(glm::dvec2(static_cast<double>(extent->first.column), static_cast<double>(extent->first.row)) * cell);
    view.hold(glm::dvec2(static_cast<double>(extent->second.column), static_cast<double>(extent->second.row)) * cell);
  }
  for (const auto& p : trajectory.points()) view.hold(p.pose.position);
  if (const auto& goal = simulation.mission().planner.goal_m) view.hold(*goal);
  if (const auto& bounds = simulation.stage().scene.world().bounds) {
    view.hold({bounds->x, bounds->y});
    view.hold({bounds->z, bounds->w});
  }
  const double cells = 4.0 * cell;
  view.low -= glm::dvec2(cells);
  view.high += glm::dvec2(cells);
  // Whole pixels a cell where there is room for it, so that cells are squares of one size.
  const double longest = std::max(view.high.x - view.low.x, view.high.y - view.low.y);
  const double wanted = 1100.0 / longest;
  view.scale = wanted * cell >= 1.0 ? std::floor(wanted * cell) / cell : wanted;
  // Snapped to cells, so that the image of the map starts at a corner.
  view.low = {std::floor(view.low.x / cell) * cell, std::floor(view.low.y / cell) * cell};
  view.high = {std::ceil(view.high.x / cell) * cell, std::ceil(view.high.y / cell) * cell};
  return view;
}

void draw_map(Canvas& canvas, const PictureFrame& view, const OccupancyMap& map) {
  const double cell = map.resolution();
  const auto first_column = std::llround(view.low.x / cell), first_row = std::llround(view.low.y / cell);
  const auto columns = static_cast<int>(std::llround(view.high.x / cell) - first_column), rows = static_cast<int>(std::llround(view.high.y / cell) - first_row);
  // Of a map with more cells than the picture has pixels, every so-manieth is drawn.
  const int every = std::max(1, std::max(columns, rows) / 2200);
  std::vector<std::uint32_t> pixels;
  for (int r = rows - 1; r >= 0; r -= every)
    for (int c = 0; c < columns; c += every) pixels.push_back(pixel_of(map, {first_column + c, first_row + r}));
  canvas.image(pixels, (columns + every - 1) / every, (rows + every - 1) / every, view.at({view.low.x, view.high.y}), view.scale * cell * every);
}

void draw_run(Canvas& canvas, const PictureFrame& view, const Simulation& simulation, const Trajectory& trajectory) {
  for (const Mark& mark : simulation.marks())
    if (mark.kind == Mark::Kind::segment) canvas.polyline({view.at(mark.from), view.at(mark.to)}, line_ink, 1.2, true);
  std::vector<glm::dvec2> path;
  for (const auto& p : trajectory.points()) path.push_back(view.at(p.pose.position));
  canvas.polyline(path, {1.0, 1.0, 1.0, 0.7}, 5.0);
  canvas.polyline(path, path_ink, 2.4);
  for (const Mark& mark : simulation.marks()) {
    if (mark.kind != Mark::Kind::point) continue;
    const glm::dvec2 at = view.at(mark.from);
    canvas.disc(at, 4.0, {1.0, 1.0, 1.0});
    canvas.circle(at, 4.0, ink, 1.6);
    canvas.text(mark.label, at + glm::dvec2(7.0, -5.0), 12.0, ink);
  }
  const Pose2& pose = simulation.vehicle().pose;
  canvas.circle(view.at(pose.position), simulation.mission().vehicle.radius_m * view.scale, path_ink, 2.0);
  canvas.polyline({view.at(pose.position), view.at(pose.position + simulation.mission().vehicle.radius_m * direction(pose.yaw))}, path_ink, 2.0);
  const StartSpec& start = simulation.mission().start;
  canvas.disc(view.at({start.x_m, start.y_m}), 6.0, start_ink);
  canvas.text("start", view.at({start.x_m, start.y_m}) + glm::dvec2(9.0, 13.0), 12.0, start_ink);
  if (const auto& goal = simulation.mission().planner.goal_m; goal && planner_needs(simulation.mission().planner.name) == PlannerNeeds::goal) {
    canvas.cross(view.at(*goal), 6.0, goal_ink, 3.0);
    canvas.text("goal", view.at(*goal) + glm::dvec2(9.0, 13.0), 12.0, goal_ink);
  }
}

void draw_legend(Canvas& canvas, const PictureFrame& view, double top) {
  double x = PictureFrame::margin;
  for (const Ink& entry : {unknown_ink, sensed_ink, clear_ink, through_ink, obstacle_ink}) {
    canvas.rectangle({x, top}, {16.0, 16.0}, colour_of(entry.pixel));
    canvas.frame({x, top}, {16.0, 16.0}, ink, 1.0);
    canvas.text(entry.words, {x + 22.0, top + 13.0}, 13.0, ink);
    x += 22.0 + canvas.text_width(entry.words, 13.0) + 18.0;
  }
  const double length = scale_bar_length(view.high.x - view.low.x);
  canvas.polyline({{PictureFrame::margin, top + 36.0}, {PictureFrame::margin + length * view.scale, top + 36.0}}, ink, 4.0);
  canvas.text(fmt::format("{} m", length), {PictureFrame::margin + length * view.scale + 8.0, top + 41.0}, 13.0, ink);
}

}  // namespace

Result<Done> write_map_picture(const std::filesystem::path& file, const Simulation& simulation, const Trajectory& trajectory) {
  const PictureFrame view = fit(simulation, trajectory);
  const glm::dvec2 size = (view.high - view.low) * view.scale;
  const double width = std::max(size.x, 620.0) + 2.0 * PictureFrame::margin, height = PictureFrame::header + size.y + 2.0 * PictureFrame::margin + 56.0;
  Canvas canvas(static_cast<int>(std::ceil(width)), static_cast<int>(std::ceil(height)), {0.965, 0.965, 0.955});
  const auto& verdict = simulation.verdict();
  canvas.text(fmt::format("{}: {} after {:.1f} s and {:.1f} m", simulation.mission().name, verdict ? to_string(verdict->kind) : "running", simulation.time(),
                          simulation.totals().path_length),
              {PictureFrame::margin, 28.0}, 16.0, ink);
  draw_map(canvas, view, simulation.map());
  draw_run(canvas, view, simulation, trajectory);
  canvas.frame(view.at({view.low.x, view.high.y}), size, ink, 1.0);
  draw_legend(canvas, view, PictureFrame::header + size.y + 2.0 * PictureFrame::margin);
  return canvas.write(file);
}

}  // namespace thicket
