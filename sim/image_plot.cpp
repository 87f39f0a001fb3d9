// Images over two axes.
#include <numeric>

#include "plot_parts.hpp"

namespace thicket {
namespace {

/// Limits in the middles of columns become those of their outer edges.
Limits column_limits(const ImagePlot& plot, const std::vector<double>& sorted) {
  Limits limits = limits_of(plot.x, 0.0, [&](const auto& tell) { std::for_each(sorted.begin(), sorted.end(), tell); });
  if (sorted.size() > 1 && !plot.x.low) limits.low -= 0.5 * (sorted[1] - sorted[0]);
  if (sorted.size() > 1 && !plot.x.high) limits.high += 0.5 * (sorted.back() - sorted[sorted.size() - 2]);
  return limits;
}

/// Pixel i covers the values first...last of it, or the one value nearest to it: of several the largest is shown, so that no echo is lost between pixels.
struct Covered {
  std::size_t first = 1, last = 0;  ///< none
};

std::vector<Covered> covered_rows(const ImagePlot& plot, const Limits& limits, int pixels) {
  std::vector<Covered> list;
  const double count = static_cast<double>(plot.rows);
  for (int i = 0; i < pixels; ++i) {
    const auto row_at = [&](double share) { return (limits.low + share * (limits.high - limits.low) - plot.first) / plot.step + 0.5; };
    const double low = row_at(static_cast<double>(i) / pixels), high = row_at(static_cast<double>(i + 1) / pixels);
    const double first = std::floor(low), last = std::max(first, std::ceil(high) - 1.0);
    if (last < 0.0 || first >= count) {
      list.emplace_back();
    } else {
      // Of two that a pixel touches where values are larger than pixels, the one at its middle.
      const bool coarse = high - low < 1.0;
      const double middle = std::clamp(std::floor(0.5 * (low + high)), 0.0, count - 1.0);
      list.push_back({static_cast<std::size_t>(coarse ? middle : std::max(0.0, first)), static_cast<std::size_t>(coarse ? middle : std::min(count - 1.0, last))});
    }
  }
  return list;
}

std::vector<Covered> covered_columns(const std::vector<double>& sorted, const Limits& limits, int pixels) {
  std::vector<Covered> list;
  for (int i = 0; i < pixels; ++i) {
    const double low = limits.low + (limits.high - limits.low) * i / pixels, high = limits.low + (limits.high - limits.low) * (i + 1) / pixels, middle = 0.5 * (low + high);
    const auto from = static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), low) - sorted.begin());
    const auto to = static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), high) - sorted.begin());
    if (to > from) {
      list.push_back({from, to - 1});
    } else {
      const bool back = from == sorted.size() || (from > 0 && middle - sorted[from - 1] < sorted[from] - middle);
      list.push_back({back ? from - 1 : from, back ? from - 1 : from});
    }
  }
  return list;
}

}  // namespace

void draw(Canvas& canvas, const ImagePlot& plot, Box box, double right) {
  Box heading{{box.corner.x + axis_left, box.corner.y}, {box.size.x - axis_left - right, box.size.y}};
  take_heading(canvas, heading, plot.title, entries_of(plot.series));
  box.size.y -= heading.corner.y - box.corner.y;
  box.corner.y = heading.corner.y;
  Box area = within_axes(box, right);
  area = {{std::round(area.corner.x), std::round(area.corner.y)}, {std::floor(area.size.x), std::floor(area.size.y)}};
  if (plot.columns.empty() || plot.rows == 0) return;

  std::vector<std::size_t> order(plot.columns.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return plot.columns[a] < plot.columns[b]; });
  std::vector<double> sorted;
  for (const std::size_t i : order) sorted.push_back(plot.columns[i]);
  const double bottom = plot.first - 0.5 * plot.step, top = bottom + plot.step * static_cast<double>(plot.rows);
  const Frame frame{area, column_limits(plot, sorted), {plot.y.low.value_or(bottom), plot.y.high.value_or(top)}};
  const Limits values = limits_of(plot.value, 0.0, [&](const auto& tell) { std::for_each(plot.values.begin(), plot.values.end(), tell); });

  const int width = static_cast<int>(area.size.x), height = static_cast<int>(area.size.y);
  const auto columns = covered_columns(sorted, frame.x, width);
  const auto rows = covered_rows(plot, frame.y, height);
  std::vector<std::uint32_t> pixels;
  for (int row = height - 1; row >= 0; --row) {
    const Covered& r = rows[static_cast<std::size_t>(row)];
    for (const Covered& c : columns) {
      double largest = -INFINITY;
      for (std::size_t i = c.first; i <= c.last; ++i)
        for (std::size_t j = r.first; j <= r.last; ++j) largest = std::max(largest, static_cast<double>(plot.values[order[i] * plot.rows + j]));
      pixels.push_back(r.first > r.last ? 0xffffffffu : pixel_of(heat_colour(values.share(std::max(largest, values.low)))));
    }
  }
  canvas.image(pixels, width, height, area.corner, 1.0);
  canvas.clip(area.corner, area.size);
  for (const Series& series : plot.series) draw_series(canvas, frame, series);
  canvas.unclip();
  const double numbers = draw_grid(canvas, frame, plot.x.tick, false);
  draw_labels(canvas, frame, plot.x, plot.y, numbers);
  upright_bar(canvas, {{area.right() + 16.0, area.corner.y}, {16.0, area.size.y}}, values, plot.value.label);
}

}  // namespace thicket
