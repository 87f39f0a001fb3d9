// A run from above, in the world as it is: what a person wants to see of a planner.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include <glm/common.hpp>

#include "canvas.hpp"
#include "picture_view.hpp"
#include "thicket/sim/outputs.hpp"
#include "thicket/sim/travel.hpp"
#include "thicket/worlds/free_space.hpp"

namespace thicket {
namespace {

// Colours of the way as in Okabe and Ito's palette, which people who confuse colours can tell apart.
constexpr Colour ink{0.1, 0.1, 0.12}, matter_ink{0.24, 0.25, 0.27}, band_ink{0.91, 0.89, 0.82}, passable_ink{0.80, 0.84, 0.90}, free_ink{1.0, 1.0, 1.0}, start_ink{0.0, 0.0, 0.0},
    goal_ink{0.80, 0.0, 0.35}, line_ink{0.3, 0.3, 0.35, 0.9}, believed_ink{0.72, 0.30, 0.55};

/// What a robot does, told by its planner's words.
struct Doing {
  const char* words;  ///< of the legend
  Colour colour;
  double width;  ///< pixels; a way back is drawn inside of the way there
};
const std::array<Doing, 3> doings = {{{"straight on", {0.0, 0.45, 0.70}, 3.0}, {"along a boundary", {0.90, 0.50, 0.10}, 6.0}, {"returning", {0.0, 0.45, 0.33}, 2.4}}};

std::size_t doing_of(std::string_view state) {
  const auto says = [&](std::string_view word) { return state.find(word) != std::string_view::npos; };
  if (says("leaving")) return 0;
  if (says("returning")) return 2;
  return says("following") || says("walking around") || says("along the wall") || says("boxed in") ? 1 : 0;
}

/// The world's stated bounds, or what its solids take, as far as that is near the run.
PictureFrame fit(const Simulation& simulation, const Trajectory& trajectory) {
  const Mission& mission = simulation.mission();
  PictureFrame view;
  for (const auto& p : trajectory.points()) view.hold(p.pose.position);
  view.hold({mission.start.x_m, mission.start.y_m});
  if (const auto& goal = mission.planner.goal_m; goal && planner_needs(mission.planner.name) == PlannerNeeds::goal) view.hold(*goal);
  const double keep = mission.vehicle.radius_m + mission.planner.clearance_m, margin = 1.5 * keep;
  const glm::dvec2 near = glm::dvec2(4.0 * keep + 0.5 * std::max(view.high.x - view.low.x, view.high.y - view.low.y)), low = view.low - near, high = view.high + near;
  view.low -= margin;
  view.high += margin;
  const World& world = simulation.scene().world();
  if (world.bounds) {
    view.hold(glm::clamp(glm::dvec2(world.bounds->x, world.bounds->y), low, high));
    view.hold(glm::clamp(glm::dvec2(world.bounds->z, world.bounds->w), low, high));
  } else if (const auto box = extent(world)) {
    view.hold(glm::clamp(glm::dvec2(box->low) - margin, low, high));
    view.hold(glm::clamp(glm::dvec2(box->high) + margin, low, high));
  }
  view.scale = 900.0 / std::max(view.high.x - view.low.x, view.high.y - view.low.y);
  // Whole pixels.
  const glm::dvec2 size = glm::ceil((view.high - view.low) * view.scale);
  view.high = view.low + size / view.scale;
  return view;
}

Colour mix(const Colour& a, const Colour& b, double share) {
  return {a.red + (b.red - a.red) * share, a.green + (b.green - a.green) * share, a.blue + (b.blue - a.blue) * share};
}

std::uint32_t pixel_of(const Colour& colour) {
  const auto channel = [](double value) { return static_cast<std::uint32_t>(std::lround(255.0 * std::clamp(value, 0.0, 1.0))); };
  return 0xff000000u | channel(colour.red) << 16 | channel(colour.green) << 8 | channel(colour.blue);
}

/// Distances between the nodes of a grid.
double between(const DistanceGrid& grid, const glm::dvec2& place) {
  const glm::dvec2 at = glm::clamp((place - grid.low) / grid.resolution - 0.5, glm::dvec2(0.0), glm::dvec2(grid.width - 1, grid.height - 1));
  const auto column = static_cast<std::size_t>(at.x), row = static_cast<std::size_t>(at.y), width = static_cast<std::size_t>(grid.width);
  const std::size_t right = column + 1 < width ? 1 : 0, up = row + 1 < static_cast<std::size_t>(grid.height) ? width : 0, i = row * width + column;
  const glm::dvec2 share = at - glm::floor(at);
  const auto value = [&](std::size_t k) { return static_cast<double>(grid.distance[k]); };
  return (value(i) * (1.0 - share.x) + value(i + right) * share.x) * (1.0 - share.y) + (value(i + up) * (1.0 - share.x) + value(i + up + right) * share.x) * share.y;
}

/// Matter and the band around it, with soft edges; a node every other pixel, for leaves are many.
Result<Done> draw_world(Canvas& canvas, const PictureFrame& view, const Simulation& simulation) {
  const Mission& mission = simulation.mission();
  const World world = world_at(simulation.scene().world(), simulation.time());
  const double pixel = 1.0 / view.scale, keep = mission.vehicle.radius_m + mission.planner.clearance_m;
  const Hull hull = mission.vehicle.hull();
  const auto [lowest, highest] = travel_range(mission);
  const double z_low = lowest + hull.z_low, z_high = highest + hull.z_high;
  const auto grid = distance_to_matter(world, view.low, view.high, 2.0 * pixel, keep + 3.0 * pixel, z_low, z_high);
  if (!grid) return grid.error();
  const bool any_passable = std::any_of(world.solids.begin(), world.solids.end(), [&](const Solid& solid) { return !world.materials[solid.material].stops_motion; });
  const auto all = any_passable ? occupancy(world, view.low, view.high - 0.5 * pixel, pixel, z_low, z_high, Convention::cell_centre, false) : Result<TruthGrid>(TruthGrid{});
  if (!all) return all.error();
  const auto columns = static_cast<int>(std::lround((view.high.x - view.low.x) / pixel)), rows = static_cast<int>(std::lround((view.high.y - view.low.y) / pixel));
  std::vector<std::uint32_t> pixels;
  pixels.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (int row = rows - 1; row >= 0; --row)
    for (int column = 0; column < columns; ++column) {
      const glm::dvec2 place = view.low + (glm::dvec2(column, row) + 0.5) * pixel;
      const double distance = between(*grid, place);
      Colour colour = mix(free_ink, band_ink, std::clamp((keep - distance) / pixel + 0.5, 0.0, 1.0));
      if (any_passable && all->contains(place) && all->blocked[all->index_at(place)]) colour = mix(colour, passable_ink, 0.8);
      // Half a pixel more than there is, so that a sheet between two nodes is not lost.
      pixels.push_back(pixel_of(mix(colour, matter_ink, std::clamp(1.5 - distance / pixel, 0.0, 1.0))));
    }
  canvas.image(pixels, columns, rows, view.at({view.low.x, view.high.y}), 1.0);
  return Done{};
}

/// Puts words beside points, where they hide least.
class Labels {
 public:
  Labels(Canvas& canvas, const PictureFrame& view, const Trajectory& trajectory) : canvas_(canvas), low_(view.at({view.low.x, view.high.y})), high_(view.at({view.high.x, view.low.y})) {
    for (const auto& p : trajectory.points()) {
      const glm::dvec2 at = view.at(p.pose.position);
      if (way_.empty() || std::abs(at.x - way_.back().x) + std::abs(at.y - way_.back().y) > 3.0) way_.push_back(at);
    }
  }
  /// Nothing is to be written over this point.
  void keep_off(const glm::dvec2& at) { boxes_.push_back({at - 6.0, at + 6.0}); }

  void put(const std::string& words, const glm::dvec2& at, const Colour& colour) {
    const double width = canvas_.text_width(words, size);
    Box best;
    double least = INFINITY;
    for (const double away : {9.0, 16.0, 26.0})
      for (const auto& [x, y] : {std::pair(1.0, -0.7), {1.0, 0.7}, {-1.0, -0.7}, {-1.0, 0.7}, {0.0, -1.2}, {0.0, 1.2}, {1.0, 0.0}, {-1.0, 0.0}}) {
        const glm::dvec2 toward(x, y);
        const glm::dvec2 middle = at + toward * away + glm::dvec2(toward.x * 0.5 * width, toward.y * 0.3 * size);
        const Box box{middle - glm::dvec2(0.5 * width + 2.0, 0.6 * size), middle + glm::dvec2(0.5 * width + 2.0, 0.6 * size)};
        if (const double cost = cost_of(box) + 0.2 * away; cost < least) least = cost, best = box;
      }
    boxes_.push_back(best);
    canvas_.rectangle(best.low, best.high - best.low, {1.0, 1.0, 1.0, 0.75});
    canvas_.text(words, {best.low.x + 2.0, best.high.y - 0.25 * size}, size, colour);
  }

 private:
  static constexpr double size = 13.0;
  struct Box {
    glm::dvec2 low{0.0, 0.0}, high{0.0, 0.0};
  };
  double cost_of(const Box& box) const {
    double cost = 0.0;
    for (const Box& other : boxes_)
      if (box.low.x < other.high.x && other.low.x < box.high.x && box.low.y < other.high.y && other.low.y < box.high.y) cost += 40.0;
    for (const glm::dvec2& p : way_) cost += p.x > box.low.x - 2.0 && p.x < box.high.x + 2.0 && p.y > box.low.y - 2.0 && p.y < box.high.y + 2.0 ? 1.5 : 0.0;
    if (box.low.x < low_.x || box.low.y < low_.y || box.high.x > high_.x || box.high.y > high_.y) cost += 1000.0;
    return cost;
  }

  Canvas& canvas_;
  glm::dvec2 low_, high_;
  std::vector<glm::dvec2> way_;
  std::vector<Box> boxes_;
};

/// The way, in pieces of one doing.
void draw_way(Canvas& canvas, const PictureFrame& view, const Trajectory& trajectory) {
  struct Piece {
    std::size_t doing;
    std::vector<glm::dvec2> points;
  };
  std::vector<Piece> pieces;
  for (const auto& p : trajectory.points()) {
    const std::size_t doing = doing_of(p.state);
    const glm::dvec2 at = view.at(p.pose.position);
    if (pieces.empty()) pieces.push_back({doing, {}});
    if (pieces.back().doing != doing) {
      pieces.back().points.push_back(at);
      pieces.push_back({doing, {}});
    }
    pieces.back().points.push_back(at);
  }
  for (const Piece& piece : pieces)
    if (piece.points.size() > 1) canvas.polyline(piece.points, {1.0, 1.0, 1.0, 0.8}, doings[piece.doing].width + 2.0);
  // What is thin after what is wide, so that the way back shows on the way there.
  for (const std::size_t doing : {1u, 0u, 2u})
    for (const Piece& piece : pieces)
      if (piece.doing == doing && piece.points.size() > 1) canvas.polyline(piece.points, doings[doing].colour, doings[doing].width);
}

/// Point marks with their names, numbered where any name comes twice; of many of a name only the first and the last are named.
void draw_marks(Canvas& canvas, const PictureFrame& view, const Simulation& simulation, Labels& labels) {
  std::map<std::string, std::pair<std::size_t, std::size_t>> counts;  // of a name: all, and those drawn
  bool numbered = false;
  const auto marks = simulation.marks();
  for (const Mark& mark : marks)
    if (mark.kind == Mark::Kind::point) {
      numbered = ++counts[mark.label].first > 1 || numbered;
      labels.keep_off(view.at(mark.from));
      canvas.disc(view.at(mark.from), 4.5, free_ink);
      canvas.circle(view.at(mark.from), 4.5, ink, 1.8);
    }
  constexpr std::size_t most = 8;
  for (const Mark& mark : marks) {
    if (mark.kind != Mark::Kind::point) continue;
    auto& [all, number] = counts[mark.label];
    ++number;
    if (all <= most || number == 1 || number == all) labels.put(numbered ? fmt::format("{} {}", mark.label, number) : mark.label, view.at(mark.from), ink);
  }
}

void draw_run(Canvas& canvas, const PictureFrame& view, const Simulation& simulation, Labels& labels) {
  const Mission& mission = simulation.mission();
  const Pose2& pose = simulation.vehicle().pose;
  const double radius = std::max(3.0, mission.vehicle.radius_m * view.scale);
  const glm::dvec2 here = view.at(pose.position), start = view.at({mission.start.x_m, mission.start.y_m});
  canvas.disc(here, radius, {0.55, 0.75, 0.90, 0.55});
  canvas.circle(here, radius, ink, 1.6);
  canvas.polyline({here, here + radius * glm::dvec2(std::cos(pose.yaw), -std::sin(pose.yaw))}, ink, 2.0);
  canvas.disc(start, 5.5, start_ink);
  labels.keep_off(start);
  const auto& goal = mission.planner.goal_m;
  const bool to_goal = goal && planner_needs(mission.planner.name) == PlannerNeeds::goal;
  if (to_goal) {
    canvas.cross(view.at(*goal), 6.5, free_ink, 6.0);
    canvas.cross(view.at(*goal), 6.0, goal_ink, 3.2);
    labels.keep_off(view.at(*goal));
  }
  labels.put("start", start, start_ink);
  if (to_goal) labels.put("goal", view.at(*goal), goal_ink);
  draw_marks(canvas, view, simulation, labels);
}

struct Entry {
  std::string words;
  Colour colour;
  double width = 0.0;  ///< of a line, which may be dashed; 0: an area
  bool dashed = false;
};
/// In rows as wide as the picture; returns the height that they take. Nothing is drawn without a canvas.
double draw_legend(Canvas& measure, Canvas* canvas, const std::vector<Entry>& entries, double width, double top) {
  double x = PictureFrame::margin, y = top;
  for (const Entry& entry : entries) {
    const double wide = 32.0 + measure.text_width(entry.words, 13.0) + 20.0;
    if (x > PictureFrame::margin && x + wide > width) x = PictureFrame::margin, y += 24.0;
    if (canvas && entry.width > 0.0) canvas->polyline({{x, y + 8.0}, {x + 24.0, y + 8.0}}, entry.colour, entry.width, entry.dashed);
    if (canvas && entry.width == 0.0) {
      canvas->rectangle({x, y}, {24.0, 16.0}, entry.colour);
      canvas->frame({x, y}, {24.0, 16.0}, ink, 1.0);
    }
    if (canvas) canvas->text(entry.words, {x + 32.0, y + 13.0}, 13.0, ink);
    x += wide;
  }
  return y + 24.0 - top;
}

std::vector<Entry> legend_of(const Simulation& simulation, const Trajectory& trajectory) {
  const World& world = simulation.scene().world();
  std::vector<Entry> entries = {{"matter", matter_ink}, {fmt::format("nearer to it than hull + {:.4g} m", simulation.mission().planner.clearance_m), band_ink}};
  if (std::any_of(world.solids.begin(), world.solids.end(), [&](const Solid& solid) { return !world.materials[solid.material].stops_motion; }))
    entries.push_back({"lets robots pass", passable_ink});
  for (std::size_t i = 0; i < doings.size(); ++i)
    if (std::any_of(trajectory.points().begin(), trajectory.points().end(), [i](const TrajectoryPoint& p) { return doing_of(p.state) == i; }))
      entries.push_back({doings[i].words, doings[i].colour, doings[i].width});
  for (const Mark& mark : simulation.marks())
    if (mark.kind == Mark::Kind::segment && std::none_of(entries.begin(), entries.end(), [&](const Entry& e) { return e.words == mark.label; })) entries.push_back({mark.label, line_ink, 1.4, true});
  if (!simulation.mission().odometry.perfect()) entries.push_back({"where it believed to be", believed_ink, 1.6, true});
  return entries;
}

}  // namespace

Result<Done> write_path_picture(const std::filesystem::path& file, const Simulation& simulation, const Trajectory& trajectory) {
  const PictureFrame view = fit(simulation, trajectory);
  const glm::dvec2 size = (view.high - view.low) * view.scale, corner = view.at({view.low.x, view.high.y});
  const double width = std::max(size.x, 560.0) + 2.0 * PictureFrame::margin, below = corner.y + size.y + 14.0;
  const auto legend = legend_of(simulation, trajectory);
  Canvas sheet(1, 1, free_ink);
  const double height = below + draw_legend(sheet, nullptr, legend, width, 0.0) + 26.0;
  Canvas canvas(static_cast<int>(std::ceil(width)), static_cast<int>(std::ceil(height)), {0.965, 0.965, 0.955});
  const auto& verdict = simulation.verdict();
  const std::string &name = simulation.mission().name, &planner = simulation.mission().planner.name;
  const std::string title = name == planner ? name : fmt::format("{} ({})", name, planner);
  canvas.text(fmt::format("{}: {} after {:.1f} m in {:.0f} s", title, verdict ? to_string(verdict->kind) : "running", simulation.totals().path_length, simulation.time()),
              {PictureFrame::margin, 30.0}, 16.0, ink);
  if (const auto drawn = draw_world(canvas, view, simulation); !drawn) return drawn.error();
  canvas.clip(corner, size);
  for (const Mark& mark : simulation.marks())
    if (mark.kind == Mark::Kind::segment) canvas.polyline({view.at(mark.from), view.at(mark.to)}, line_ink, 1.4, true);
  Labels labels(canvas, view, trajectory);
  draw_way(canvas, view, trajectory);
  std::vector<glm::dvec2> believed;
  for (const auto& p : trajectory.points()) believed.push_back(view.at(p.estimate.position));
  if (!simulation.mission().odometry.perfect()) canvas.polyline(believed, believed_ink, 1.6, true);
  draw_run(canvas, view, simulation, labels);
  canvas.unclip();
  canvas.frame(corner, size, ink, 1.0);
  const double y = below + draw_legend(canvas, &canvas, legend, width, below) + 6.0, bar = scale_bar_length(view.high.x - view.low.x);
  canvas.polyline({{PictureFrame::margin, y}, {PictureFrame::margin + bar * view.scale, y}}, ink, 4.0);
  canvas.text(fmt::format("{} m", bar), {PictureFrame::margin + bar * view.scale + 8.0, y + 5.0}, 13.0, ink);
  return canvas.write(file);
}

}  // namespace thicket
