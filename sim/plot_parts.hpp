// What panels of plots are drawn with: frames, grids, marks, legends, colour bars. Private to plot*.cpp and *_plot.cpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "plot.hpp"

namespace thicket {

inline constexpr Colour white{1.0, 1.0, 1.0}, ink{0.13, 0.14, 0.17}, pale_ink{0.36, 0.38, 0.42}, frame_ink{0.55, 0.57, 0.60}, grid_ink{0.88, 0.89, 0.90}, sensed_ink{0.925, 0.945, 0.965};
inline constexpr double title_size = 18.0, subtitle_size = 13.0, heading_size = 14.0, label_size = 13.0, tick_size = 12.0;
inline constexpr double sheet_margin = 22.0, panel_gap = 22.0, legend_row = 20.0;

/// A rectangle of the sheet.
struct Box {
  glm::dvec2 corner{0.0}, size{0.0};
  double right() const { return corner.x + size.x; }
  double bottom() const { return corner.y + size.y; }
};

struct Limits {
  double low = 0.0, high = 1.0;
  double share(double value) const { return (value - low) / (high - low); }
};

/// Limits of an axis: as given, else those of the numbers, and never empty.
template <class Numbers>
Limits limits_of(const Axis& axis, double margin, const Numbers& each_number) {
  Limits limits{INFINITY, -INFINITY};
  each_number([&limits](double number) {
    if (!std::isfinite(number)) return;
    limits.low = std::min(limits.low, number);
    limits.high = std::max(limits.high, number);
  });
  if (!(limits.low <= limits.high)) limits = {axis.low.value_or(axis.high.value_or(1.0) - 1.0), axis.high.value_or(axis.low.value_or(0.0) + 1.0)};
  const double room = margin * (limits.high - limits.low);
  limits = {axis.low.value_or(limits.low - room), axis.high.value_or(limits.high + room)};
  if (!(limits.high - limits.low > 1e-9 * std::max(1.0, std::abs(limits.low)))) {
    const double half = std::max(0.5, 0.02 * std::abs(limits.low));
    limits = {limits.low - half, limits.low + half};
  }
  return limits;
}

/// Where an axis' numbers are on the sheet.
struct Frame {
  Box box;
  Limits x, y;
  bool log_x = false, log_y = false;  ///< the numbers are decimal logarithms
  glm::dvec2 at(const glm::dvec2& p) const { return {box.corner.x + x.share(p.x) * box.size.x, box.bottom() - y.share(p.y) * box.size.y}; }
};

/// Ticks with their numbers and lines; returns how wide the numbers of the y axis are.
double draw_grid(Canvas& canvas, const Frame& frame, double tick, bool lines);
void draw_labels(Canvas& canvas, const Frame& frame, const Axis& x, const Axis& y, double numbers);
/// Words that fit into a width: what is too long ends in an ellipsis.
std::string fitting(Canvas& canvas, const std::string& words, double size, double width);

void draw_shape(Canvas& canvas, PolarPlot::Shape shape, const glm::dvec2& at, double radius, const Colour& colour);
void draw_series(Canvas& canvas, const Frame& frame, const Series& series);
/// Writes the points' labels where they cover neither a point nor each other; those for which there is no such place are left out, the last ones first.
void draw_point_labels(Canvas& canvas, const Frame& frame, const std::vector<Series>& list);

/// What a legend tells of.
struct Entry {
  std::string words;
  const Series* series = nullptr;
  std::optional<PolarPlot::Shape> shape;  ///< neither: an area
};
std::vector<Entry> entries_of(const std::vector<Series>& list);
/// Draws title and legend into the top of a box, and takes it off the box.
void take_heading(Canvas& canvas, Box& box, const std::string& title, const std::vector<Entry>& entries);

std::uint32_t pixel_of(const Colour& c);
/// The colours of points on white: strong is dark, and the weakest is not so light that it is lost.
Colour point_colour(double share);
void upright_bar(Canvas& canvas, const Box& box, const Limits& limits, const std::string& label);
void level_bar(Canvas& canvas, const Box& box, const Limits& limits, const std::string& label);

/// Room about the axes, in pixels.
inline constexpr double axis_left = 78.0, axis_bottom = 46.0, bar_room = 104.0, plain_room = 16.0;
inline Box within_axes(const Box& box, double right) {
  return {{box.corner.x + axis_left, box.corner.y + 6.0}, {box.size.x - axis_left - right, box.size.y - axis_bottom - 6.0}};
}

/// The panels; `right` is the room that the panels of a column leave to the right of their axes.
void draw(Canvas& canvas, const Plot& plot, Box box, double right);
void draw(Canvas& canvas, const ImagePlot& plot, Box box, double right);
void draw(Canvas& canvas, const PolarPlot& plot, Box box, double right);

}  // namespace thicket
