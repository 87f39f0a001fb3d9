#include "plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "thicket/base/pose.hpp"

namespace thicket {
namespace {

constexpr Colour white{1.0, 1.0, 1.0}, ink{0.13, 0.14, 0.17}, pale_ink{0.36, 0.38, 0.42}, frame_ink{0.55, 0.57, 0.60}, grid_ink{0.88, 0.89, 0.90}, sensed_ink{0.925, 0.945, 0.965};
constexpr double title_size = 18.0, subtitle_size = 13.0, heading_size = 14.0, label_size = 13.0, tick_size = 12.0;
constexpr double sheet_margin = 22.0, panel_gap = 22.0, legend_row = 20.0;

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
  glm::dvec2 at(const glm::dvec2& p) const { return {box.corner.x + x.share(p.x) * box.size.x, box.bottom() - y.share(p.y) * box.size.y}; }
};

/// Ticks with their numbers and lines; returns how wide the numbers of the y axis are.
double draw_grid(Canvas& canvas, const Frame& frame, double tick, bool lines) {
  const auto ticks_x = tick > 0.0 ? even_ticks(frame.x.low, frame.x.high, tick) : nice_ticks(frame.x.low, frame.x.high, std::max(2, static_cast<int>(frame.box.size.x / 75.0)));
  const auto ticks_y = nice_ticks(frame.y.low, frame.y.high, std::max(2, static_cast<int>(frame.box.size.y / 38.0)));
  const auto labels_x = tick_labels(ticks_x), labels_y = tick_labels(ticks_y);
  double widest = 0.0;
  for (std::size_t i = 0; i < ticks_x.size(); ++i) {
    const double x = frame.at({ticks_x[i], 0.0}).x;
    if (lines) canvas.polyline({{x, frame.box.corner.y}, {x, frame.box.bottom()}}, grid_ink, 1.0);
    canvas.polyline({{x, frame.box.bottom()}, {x, frame.box.bottom() + 5.0}}, frame_ink, 1.0);
    canvas.text(labels_x[i], {x, frame.box.bottom() + 18.0}, tick_size, ink, Align::middle);
  }
  for (std::size_t i = 0; i < ticks_y.size(); ++i) {
    const double y = frame.at({0.0, ticks_y[i]}).y;
    if (lines) canvas.polyline({{frame.box.corner.x, y}, {frame.box.right(), y}}, grid_ink, 1.0);
    canvas.polyline({{frame.box.corner.x - 5.0, y}, {frame.box.corner.x, y}}, frame_ink, 1.0);
    canvas.text(labels_y[i], {frame.box.corner.x - 9.0, y + 4.3}, tick_size, ink, Align::right);
    widest = std::max(widest, canvas.text_width(labels_y[i], tick_size));
  }
  return widest;
}

void draw_labels(Canvas& canvas, const Frame& frame, const Axis& x, const Axis& y, double numbers) {
  canvas.frame(frame.box.corner, frame.box.size, frame_ink, 1.0);
  canvas.text(x.label, {frame.box.corner.x + 0.5 * frame.box.size.x, frame.box.bottom() + 39.0}, label_size, ink, Align::middle);
  canvas.upward_text(y.label, {frame.box.corner.x - std::max(54.0, numbers + 20.0), frame.box.corner.y + 0.5 * frame.box.size.y}, label_size, ink);
}

/// Words that fit into a width: what is too long ends in an ellipsis.
std::string fitting(Canvas& canvas, const std::string& words, double size, double width) {
  if (canvas.text_width(words, size) <= width) return words;
  std::string cut = words;
  while (!cut.empty() && canvas.text_width(cut + "…", size) > width) {
    while (!cut.empty() && (static_cast<unsigned char>(cut.back()) & 0xc0u) == 0x80u) cut.pop_back();  // the tail of a character of several bytes
    if (!cut.empty()) cut.pop_back();
  }
  return cut + "…";
}

// --- marks and curves

void draw_shape(Canvas& canvas, PolarPlot::Shape shape, const glm::dvec2& at, double radius, const Colour& colour) {
  using Shape = PolarPlot::Shape;
  const double wide = std::max(1.2, 0.45 * radius), r = radius;
  switch (shape) {
    case Shape::disc: return canvas.disc(at, r, colour);
    case Shape::ring: return canvas.circle(at, r, colour, wide);
    case Shape::diamond: return canvas.polygon({at + glm::dvec2(0.0, -1.4 * r), at + glm::dvec2(1.4 * r, 0.0), at + glm::dvec2(0.0, 1.4 * r), at + glm::dvec2(-1.4 * r, 0.0)}, colour);
    case Shape::square: return canvas.rectangle(at - glm::dvec2(0.9 * r), glm::dvec2(1.8 * r), colour);
    case Shape::cross: return canvas.cross(at, r, colour, wide);
  }
}

/// A curve, in pieces between its gaps.
void draw_curve(Canvas& canvas, const Frame& frame, const Series& series) {
  std::vector<glm::dvec2> piece;
  const auto finish = [&] {
    if (piece.size() == 1) canvas.disc(piece[0], 2.2, series.colour);
    canvas.polyline(piece, series.colour, series.kind == Series::Kind::dashed ? 1.5 : 1.8, series.kind == Series::Kind::dashed);
    piece.clear();
  };
  const auto& points = series.points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(points[i].x) || !std::isfinite(points[i].y)) {
      finish();
      continue;
    }
    const glm::dvec2 at = frame.at(points[i]);
    if (series.kind == Series::Kind::step && !piece.empty()) {
      const double middle = 0.5 * (piece.back().x + at.x), before = piece.back().y;
      piece.emplace_back(middle, before);
      piece.emplace_back(middle, at.y);
    }
    piece.push_back(at);
  }
  finish();
}

void draw_series(Canvas& canvas, const Frame& frame, const Series& series) {
  using Kind = Series::Kind;
  if (series.kind == Kind::line || series.kind == Kind::dashed || series.kind == Kind::step) return draw_curve(canvas, frame, series);
  const double radius = series.points.size() > 400 ? 2.0 : series.points.size() > 60 ? 2.8 : 3.6;
  for (const glm::dvec2& p : series.points) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) continue;
    const glm::dvec2 at = frame.at(p);
    if (series.kind == Kind::rings) {
      canvas.circle(at, 5.5, white, 4.0);
      canvas.circle(at, 5.5, series.colour, 2.0);
    } else {
      if (series.kind == Kind::stems) canvas.polyline({{at.x, frame.box.bottom()}, at}, series.colour, 1.4);
      canvas.disc(at, radius, series.colour);
    }
  }
}

// --- headings: a panel's title, and its legend below it

struct Entry {
  std::string words;
  const Series* series = nullptr;
  std::optional<PolarPlot::Shape> shape;  ///< neither: an area
};

/// Draws the legend in rows between two x, or only tells how high it is.
double legend(Canvas& canvas, const std::vector<Entry>& entries, const glm::dvec2& from, double right, bool draw) {
  if (entries.empty()) return 0.0;
  glm::dvec2 at = from;
  for (const Entry& entry : entries) {
    const std::string words = fitting(canvas, entry.words, tick_size, right - from.x - 32.0);
    const double width = 32.0 + canvas.text_width(words, tick_size);
    if (at.x > from.x && at.x + width > right) at = {from.x, at.y + legend_row};
    if (draw) {
      const double y = at.y + 10.0;
      if (entry.series) {
        // The same hand draws it, in a frame as large as the key.
        Series key = *entry.series;
        const Frame frame{{{at.x, y - 6.0}, {24.0, 12.0}}, {0.0, 1.0}, {0.0, 1.0}};
        const bool curve = key.kind == Series::Kind::line || key.kind == Series::Kind::dashed || key.kind == Series::Kind::step;
        key.points = curve ? std::vector<glm::dvec2>{{0.0, 0.5}, {1.0, 0.5}} : std::vector<glm::dvec2>{{0.5, key.kind == Series::Kind::stems ? 0.85 : 0.5}};
        draw_series(canvas, frame, key);
      } else if (entry.shape) {
        draw_shape(canvas, *entry.shape, {at.x + 14.0, y}, 3.6, ink);
      } else {
        canvas.rectangle({at.x + 4.0, y - 6.0}, {20.0, 12.0}, sensed_ink);
        canvas.frame({at.x + 4.0, y - 6.0}, {20.0, 12.0}, frame_ink, 0.8);
      }
      canvas.text(words, {at.x + 31.0, y + 4.3}, tick_size, ink);
    }
    at.x += width + 20.0;
  }
  return at.y - from.y + legend_row + 4.0;
}

std::vector<Entry> entries_of(const std::vector<Series>& list) {
  std::vector<Entry> entries;
  for (const Series& series : list)
    if (!series.name.empty()) entries.push_back({series.name, &series, {}});
  return entries;
}

/// Draws title and legend into the top of a box, and takes it off the box.
void take_heading(Canvas& canvas, Box& box, const std::string& title, const std::vector<Entry>& entries) {
  double height = 0.0;
  if (!title.empty()) {
    canvas.text(fitting(canvas, title, heading_size, box.size.x), box.corner + glm::dvec2(0.0, 13.0), heading_size, ink);
    height += 22.0;
  }
  const double keys = legend(canvas, entries, box.corner + glm::dvec2(0.0, height), box.right(), false);
  if (!entries.empty()) legend(canvas, entries, box.corner + glm::dvec2(0.0, height), box.right(), true);
  height += keys;
  box.corner.y += height;
  box.size.y -= height;
}

// --- colour bars

std::uint32_t pixel_of(const Colour& c) {
  const auto channel = [](double share) { return static_cast<std::uint32_t>(std::lround(255.0 * share)); };
  return 0xff000000u | channel(c.red) << 16 | channel(c.green) << 8 | channel(c.blue);
}

/// The colours of points on white: strong is dark, and the weakest is not so light that it is lost.
Colour point_colour(double share) { return heat_colour(0.90 * (1.0 - std::clamp(share, 0.0, 1.0))); }

void upright_bar(Canvas& canvas, const Box& box, const Limits& limits, const std::string& label) {
  const int height = static_cast<int>(box.size.y);
  std::vector<std::uint32_t> pixels;
  for (int row = 0; row < height; ++row) pixels.insert(pixels.end(), 16, pixel_of(heat_colour(1.0 - (row + 0.5) / height)));
  canvas.image(pixels, 16, height, box.corner, 1.0);
  canvas.frame(box.corner, {16.0, box.size.y}, frame_ink, 1.0);
  const auto ticks = nice_ticks(limits.low, limits.high, std::max(2, height / 38));
  const auto labels = tick_labels(ticks);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const double y = box.bottom() - limits.share(ticks[i]) * box.size.y;
    canvas.polyline({{box.corner.x + 16.0, y}, {box.corner.x + 20.0, y}}, frame_ink, 1.0);
    canvas.text(labels[i], {box.corner.x + 24.0, y + 4.3}, tick_size, ink);
  }
  canvas.upward_text(label, {box.corner.x + 74.0, box.corner.y + 0.5 * box.size.y}, label_size, ink);
}

void level_bar(Canvas& canvas, const Box& box, const Limits& limits, const std::string& label) {
  const int width = static_cast<int>(box.size.x);
  std::vector<std::uint32_t> pixels;
  for (int row = 0; row < 12; ++row)
    for (int column = 0; column < width; ++column) pixels.push_back(pixel_of(point_colour((column + 0.5) / width)));
  canvas.image(pixels, width, 12, box.corner, 1.0);
  canvas.frame(box.corner, {static_cast<double>(width), 12.0}, frame_ink, 1.0);
  const auto ticks = nice_ticks(limits.low, limits.high, std::max(2, width / 60));
  const auto labels = tick_labels(ticks);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const double x = box.corner.x + limits.share(ticks[i]) * width;
    canvas.polyline({{x, box.corner.y + 12.0}, {x, box.corner.y + 16.0}}, frame_ink, 1.0);
    canvas.text(labels[i], {x, box.corner.y + 28.0}, tick_size, ink, Align::middle);
  }
  canvas.text(label, {box.corner.x + 0.5 * width, box.corner.y + 46.0}, label_size, ink, Align::middle);
}

// --- the panels

constexpr double axis_left = 78.0, axis_bottom = 46.0, bar_room = 104.0, plain_room = 16.0;

double right_room(const Panel& panel) { return std::holds_alternative<ImagePlot>(panel) ? bar_room : plain_room; }

Box within_axes(const Box& box, double right) {
  return {{box.corner.x + axis_left, box.corner.y + 6.0}, {box.size.x - axis_left - right, box.size.y - axis_bottom - 6.0}};
}

void draw(Canvas& canvas, const Plot& plot, Box box, double right) {
  Box heading{{box.corner.x + axis_left, box.corner.y}, {box.size.x - axis_left - right, box.size.y}};
  take_heading(canvas, heading, plot.title, entries_of(plot.series));
  box.size.y -= heading.corner.y - box.corner.y;
  box.corner.y = heading.corner.y;
  const auto each = [&plot](bool x) {
    return [&plot, x](const auto& tell) {
      for (const Series& series : plot.series)
        for (const glm::dvec2& p : series.points)
          if (std::isfinite(p.x) && std::isfinite(p.y)) tell(x ? p.x : p.y);
    };
  };
  const Frame frame{within_axes(box, right), limits_of(plot.x, 0.0, each(true)), limits_of(plot.y, 0.06, each(false))};
  const double numbers = draw_grid(canvas, frame, plot.x.tick, true);
  canvas.clip(frame.box.corner - glm::dvec2(1.0), frame.box.size + glm::dvec2(2.0));
  for (const Series& series : plot.series) draw_series(canvas, frame, series);
  canvas.unclip();
  draw_labels(canvas, frame, plot.x, plot.y, numbers);
}

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

/// Where bearings and ranges are on the sheet.
struct Dial {
  glm::dvec2 centre{0.0};
  double scale = 1.0;  ///< pixels a metre
  glm::dvec2 at(double azimuth, double range) const { return centre - range * scale * glm::dvec2(std::sin(azimuth), std::cos(azimuth)); }
  std::vector<glm::dvec2> arc(double from, double to, double range) const {
    std::vector<glm::dvec2> points;
    const int pieces = 2 + static_cast<int>(std::abs(to - from) * 60.0);
    for (int i = 0; i <= pieces; ++i) points.push_back(at(from + (to - from) * i / pieces, range));
    return points;
  }
};

/// Ranges of the rings: round, and the outer one among them.
std::vector<double> rings_of(const PolarPlot& plot, const Dial& dial) {
  const int most = std::clamp(static_cast<int>(plot.range * dial.scale / 44.0), 2, 7);
  for (int more = most; more <= most + 6; ++more)
    if (auto rings = nice_ticks(0.0, plot.range, more); rings.back() > 0.999 * plot.range) return rings;
  return nice_ticks(0.0, plot.range, most);
}

void draw_dial(Canvas& canvas, const PolarPlot& plot, const Dial& dial, bool whole, double half) {
  const auto rings = rings_of(plot, dial);
  for (const double ring : rings)
    if (ring > 0.0 && ring < 0.999 * plot.range) canvas.polyline(dial.arc(-half, half, ring), {0.80, 0.82, 0.84}, 1.0);
  canvas.polyline(dial.arc(-half, half, plot.range), frame_ink, 1.2);
  const double step = radians(whole ? 30.0 : half > radians(50.0) ? 15.0 : half > radians(12.0) ? 10.0 : 2.0);
  const int ticks = static_cast<int>(std::floor(half / step + 1e-9));
  for (int i = whole ? -ticks + 1 : -ticks; i <= ticks; ++i) {
    const double azimuth = i * step;
    canvas.polyline({dial.centre, dial.at(azimuth, plot.range)}, grid_ink, 1.0);
    canvas.polyline({dial.at(azimuth, plot.range), dial.at(azimuth, plot.range + 5.0 / dial.scale)}, frame_ink, 1.0);
    const std::string words = i == 0 ? "0° ahead" : fmt::format("{}{:.0f}°", i < 0 ? "−" : "", std::abs(degrees(azimuth)));
    // Farther out where the text is wide along the bearing.
    const double away = 9.0 + std::abs(std::sin(azimuth)) * 0.5 * canvas.text_width(words, tick_size) + std::abs(std::cos(azimuth)) * 7.0;
    canvas.text(words, dial.at(azimuth, plot.range + away / dial.scale) + glm::dvec2(0.0, 4.3), tick_size, pale_ink, Align::middle);
  }
  if (!whole)
    for (const double side : {-half, half}) canvas.polyline({dial.centre, dial.at(side, plot.range)}, frame_ink, 1.2);
}

/// Ring labels come last, on a white ground, just inside of their rings; of the bearings between ticks along the one where they hide the fewest points.
void label_rings(Canvas& canvas, const PolarPlot& plot, const Dial& dial, bool whole, double half) {
  const auto rings = rings_of(plot, dial);
  const auto labels = tick_labels(rings);
  const double size = 11.5;
  const auto width = [&](std::size_t i) { return canvas.text_width(labels[i] + " m", size); };
  const auto place = [&](double azimuth, std::size_t i) { return dial.at(azimuth, rings[i] - (0.5 * width(i) + 4.0) / dial.scale); };
  double best = 0.0;
  std::size_t fewest = plot.points.size() + 1;
  for (const double candidate : {-75.0, -105.0, -45.0, -135.0, -15.0, -165.0, 75.0, 105.0, 45.0, 135.0, 15.0, 165.0}) {
    if (!whole || fewest == 0) break;
    std::size_t hidden = 0;
    for (std::size_t i = 1; i < rings.size(); ++i) {
      const glm::dvec2 at = place(radians(candidate), i), reach(0.5 * width(i) + 6.0, 12.0);
      for (const auto& p : plot.points) {
        const glm::dvec2 off = dial.at(p.azimuth, p.range) - at;
        hidden += std::abs(off.x) < reach.x && std::abs(off.y) < reach.y;
      }
    }
    if (hidden >= fewest) continue;
    fewest = hidden;
    best = radians(candidate);
  }
  for (std::size_t i = 0; i < rings.size(); ++i) {
    if (rings[i] <= 0.0) continue;
    const std::string words = labels[i] + " m";
    if (whole) {
      const glm::dvec2 at = place(best, i);
      canvas.rectangle({at.x - 0.5 * width(i) - 2.0, at.y - 7.5}, {width(i) + 4.0, 15.0}, {1.0, 1.0, 1.0, 0.75});
      canvas.text(words, {at.x, at.y + 4.2}, size, pale_ink, Align::middle);
    } else {
      canvas.text(words, dial.at(-half, rings[i]) + glm::dvec2(8.0 * std::cos(half) + 4.0, 4.2 + 10.0 * std::sin(half)), size, pale_ink);
    }
  }
}

void draw(Canvas& canvas, const PolarPlot& plot, Box box, double) {
  std::vector<Entry> entries;
  for (const auto& [shape, words] : plot.legend) entries.push_back({words, nullptr, shape});
  if (!plot.sensed.empty()) entries.push_back({"sensed", nullptr, {}});
  take_heading(canvas, box, plot.title, entries);
  const double bar = 56.0, rim = 32.0;
  const bool whole = plot.sector > pi + 1e-9;
  const double half = whole ? pi : 0.5 * plot.sector;
  const glm::dvec2 room = box.size - glm::dvec2(2.0 * rim, bar + 2.0 * rim);
  Dial dial;
  if (whole) {
    dial.scale = 0.5 * std::min(room.x, room.y) / plot.range;
    dial.centre = box.corner + glm::dvec2(0.5 * box.size.x, rim + 0.5 * room.y);
  } else {
    dial.scale = std::min((room.x - 30.0) / (2.0 * std::sin(half)), room.y) / plot.range;
    dial.centre = box.corner + glm::dvec2(0.5 * box.size.x, rim + 0.5 * (room.y + plot.range * dial.scale));
  }
  std::vector<glm::dvec2> area;
  for (const glm::dvec2& p : plot.sensed) area.push_back(dial.at(p.x, std::min(p.y, plot.range)));
  canvas.polygon(area, sensed_ink);
  draw_dial(canvas, plot, dial, whole, half);

  const Limits values = limits_of(plot.value, 0.0, [&](const auto& tell) {
    for (const auto& p : plot.points) tell(p.value);
  });
  // The strong ones on top.
  std::vector<PolarPlot::Point> points = plot.points;
  std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
  const double large = points.size() > 900 ? 0.75 : 1.0;
  for (const auto& p : points) {
    if (p.range > plot.range * (1.0 + 1e-9)) continue;
    const double share = std::clamp(values.share(p.value), 0.0, 1.0);
    draw_shape(canvas, p.shape, dial.at(p.azimuth, p.range), large * (1.7 + 2.0 * share), point_colour(share));
  }
  label_rings(canvas, plot, dial, whole, half);
  canvas.disc(dial.centre, 4.0, white);
  canvas.disc(dial.centre, 2.8, ink);
  const double length = std::min(360.0, 0.8 * box.size.x);
  if (points.empty()) return canvas.text("no echo", {box.corner.x + 0.5 * box.size.x, box.bottom() - 40.0}, label_size, pale_ink, Align::middle);
  level_bar(canvas, {{std::round(box.corner.x + 0.5 * (box.size.x - length)), std::round(box.bottom() - 50.0)}, {length, 12.0}}, values, plot.value.label);
}

}  // namespace

Colour plot_colour(std::size_t index) {
  constexpr std::array<Colour, 7> colours = {{{0.0, 0.447, 0.698}, {0.835, 0.369, 0.0}, {0.0, 0.620, 0.451}, {0.800, 0.475, 0.655}, {0.902, 0.624, 0.0}, {0.337, 0.706, 0.914}, {0.2, 0.2, 0.2}}};
  return colours[index % colours.size()];
}

Colour heat_colour(double share) {
  constexpr std::array<std::uint32_t, 10> viridis = {0x440154, 0x482878, 0x3e4a89, 0x31688e, 0x26828e, 0x1f9e89, 0x35b779, 0x6dcd59, 0xb4de2c, 0xfde725};
  const double place = std::clamp(std::isfinite(share) ? share : 0.0, 0.0, 1.0) * (viridis.size() - 1);
  const auto before = std::min(static_cast<std::size_t>(place), viridis.size() - 2);
  const double t = place - static_cast<double>(before);
  const auto channel = [&](int shift) { return ((1.0 - t) * (viridis[before] >> shift & 255u) + t * (viridis[before + 1] >> shift & 255u)) / 255.0; };
  return {channel(16), channel(8), channel(0)};
}

std::vector<double> nice_ticks(double low, double high, int most) {
  if (!(low < high) || !std::isfinite(high - low) || most < 1) return {};
  const double slack = 1e-9 * (high - low);
  for (double power = std::pow(10.0, std::floor(std::log10((high - low) / most)));; power *= 10.0) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double step = digit * power, first = std::ceil((low - slack) / step), last = std::floor((high + slack) / step);
      if (last - first + 1.0 > most) continue;
      return even_ticks(low, high, step);
    }
  }
}

std::vector<double> even_ticks(double low, double high, double step) {
  const double slack = 1e-9 * (high - low);
  std::vector<double> ticks;
  for (double i = std::ceil((low - slack) / step); i <= std::floor((high + slack) / step); ++i) ticks.push_back(i * step + 0.0);
  return ticks;
}

std::vector<std::string> tick_labels(const std::vector<double>& ticks) {
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : std::abs(ticks.empty() ? 1.0 : ticks[0]);
  const int decimals = step > 0.0 ? std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9) : 0;
  std::vector<std::string> labels;
  for (const double tick : ticks) labels.push_back(fmt::format("{}{:.{}f}", tick < 0.0 ? "−" : "", std::abs(tick), decimals));
  return labels;
}

Result<Done> Sheet::write(const std::filesystem::path& file) const {
  double height = sheet_margin + 14.0 + 20.0 * static_cast<double>(subtitles.size()) + 12.0;
  const double head = height;
  for (const Row& row : rows) height += row.height + panel_gap;
  Canvas canvas(width, static_cast<int>(std::ceil(height)), white);
  const double inside = width - 2.0 * sheet_margin;
  canvas.text(fitting(canvas, title, title_size, inside), {sheet_margin, sheet_margin + 12.0}, title_size, ink);
  for (std::size_t i = 0; i < subtitles.size(); ++i)
    canvas.text(fitting(canvas, subtitles[i], subtitle_size, inside), {sheet_margin, sheet_margin + 34.0 + 20.0 * static_cast<double>(i)}, subtitle_size, pale_ink);
  double top = head + 6.0;
  for (const Row& row : rows) {
    const double count = static_cast<double>(row.panels.size());
    const double wide = (width - 2.0 * sheet_margin - (count - 1.0) * panel_gap) / count;
    for (std::size_t i = 0; i < row.panels.size(); ++i) {
      double room = plain_room;
      for (const Row& other : rows)
        if (other.panels.size() == row.panels.size()) room = std::max(room, right_room(other.panels[i]));
      const Box box{{sheet_margin + static_cast<double>(i) * (wide + panel_gap), top}, {wide, row.height}};
      std::visit([&](const auto& panel) { draw(canvas, panel, box, room); }, row.panels[i]);
    }
    top += row.height + panel_gap;
  }
  return canvas.write(file);
}

}  // namespace thicket
