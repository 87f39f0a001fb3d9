// Where matter really is, as an outline over the plan.
#include <algorithm>
#include <cmath>

#include "plan.hpp"
#include "thicket/sim/travel.hpp"

namespace thicket::gui {
namespace {

/// The borders between blocked cells and others, as long lines.
template <class Use>
void borders(const TruthGrid& grid, Use use) {
  const auto blocked = [&](int column, int row) {
    return column >= 0 && row >= 0 && column < grid.width && row < grid.height && grid.blocked[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.width) + static_cast<std::size_t>(column)] != 0;
  };
  const auto corner = [&](int column, int row) { return grid.low + glm::dvec2(column, row) * grid.resolution; };
  for (int row = 0; row <= grid.height; ++row)
    for (int column = 0, from = -1; column <= grid.width; ++column) {
      const bool border = column < grid.width && blocked(column, row) != blocked(column, row - 1);
      if (border && from < 0) from = column;
      if (!border && from >= 0) use(corner(from, row), corner(column, row)), from = -1;
    }
  for (int column = 0; column <= grid.width; ++column)
    for (int row = 0, from = -1; row <= grid.height; ++row) {
      const bool border = row < grid.height && blocked(column, row) != blocked(column - 1, row);
      if (border && from < 0) from = row;
      if (!border && from >= 0) use(corner(column, from), corner(column, row)), from = -1;
    }
}

}  // namespace

void TruthOutline::draw(const Frame& frame, const PlanCamera& camera, ImDrawList& draw) {
  const bool other_time = frame.now.simulation->scene().moves() && time_ != frame.now.simulation->time();
  if ((revision_ != frame.now.world_revision || other_time) && !work_.busy()) {
    revision_ = frame.now.world_revision;
    time_ = frame.now.simulation->time();
    PlanExtent all = extent_of(frame.now);
    const Mission& mission = frame.now.simulation->mission();
    const double cell = mission.map.resolution_m, height = travel_heights(mission).front() + mounted(mission.sensors.front()).position_m.z;
    // Cells of the map itself; of a very large world, coarser ones.
    double step = cell;
    while ((all.high.x - all.low.x) * (all.high.y - all.low.y) > 4e6 * step * step) step *= 2.0;
    const glm::dvec2 low{std::floor(all.low.x / step) * step - step, std::floor(all.low.y / step) * step - step}, high = all.high + step;
    work_.start([run = frame.now.simulation, low, high, step, height] {
      Made made;
      const auto grid = occupancy(world_at(run->stage().scene.world(), run->time()), low, high, step, height, height, Convention::cell_centre, false);
      if (!grid) made.error = grid.error().message;
      else borders(*grid, [&](const glm::dvec2& from, const glm::dvec2& to) { made.lines.push_back({from, to}); });
      return made;
    });
  }
  work_.poll(frame.still, made_);
  const ImVec2 low = camera.low, high{camera.low.x + camera.size.x, camera.low.y + camera.size.y};
  for (const Line& line : made_.lines) {
    const ImVec2 a = camera.to_screen(line.from), b = camera.to_screen(line.to);
    if (std::max(a.x, b.x) < low.x || std::min(a.x, b.x) > high.x || std::max(a.y, b.y) < low.y || std::min(a.y, b.y) > high.y) continue;
    draw.AddLine(a, b, frame.colours.warning, 1.5f);
  }
  if (!made_.error.empty()) draw.AddText({low.x + 8.0f, low.y + 8.0f}, frame.colours.warning, made_.error.c_str());
}

}  // namespace thicket::gui
