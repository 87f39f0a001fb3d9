#include "plot_parts.hpp"

#include <fmt/format.h>

#include <array>
#include <numeric>

namespace thicket {

double draw_grid(Canvas& canvas, const Frame& frame, double tick, bool lines) {
  const int most_x = std::max(2, static_cast<int>(frame.box.size.x / 75.0)), most_y = std::max(2, static_cast<int>(frame.box.size.y / 38.0));
  // Over whole decades at their powers of ten; within one at round numbers.
  const auto in_decades = [](const Limits& limits) { return limits.high - limits.low >= 1.0; };
  const auto logarithms = [&](const Limits& limits, int most) { return in_decades(limits) ? decade_ticks(limits.low, limits.high) : log_ticks(limits.low, limits.high, most); };
  const auto ticks_x = frame.log_x ? logarithms(frame.x, most_x) : tick > 0.0 ? even_ticks(frame.x.low, frame.x.high, tick) : nice_ticks(frame.x.low, frame.x.high, most_x);
  const auto ticks_y = frame.log_y ? logarithms(frame.y, most_y) : nice_ticks(frame.y.low, frame.y.high, most_y);
  const auto words = [&](const std::vector<double>& ticks, const Limits& limits, bool logarithmic) {
    if (!logarithmic) return tick_labels(ticks);
    if (in_decades(limits)) return decade_labels(ticks);
    std::vector<std::string> labels;
    for (const double one : ticks) labels.push_back(fmt::format("{:.3g}", std::pow(10.0, one)));
    return labels;
  };
  const auto labels_x = words(ticks_x, frame.x, frame.log_x), labels_y = words(ticks_y, frame.y, frame.log_y);
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

namespace {

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

}  // namespace

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

void draw_point_labels(Canvas& canvas, const Frame& frame, const std::vector<Series>& list) {
  constexpr double size = 11.0, height = 12.0, away = 7.0;
  std::vector<Box> taken;
  for (const Series& series : list)
    if (series.kind == Series::Kind::points || series.kind == Series::Kind::rings)
      for (const glm::dvec2& p : series.points)
        if (std::isfinite(p.x) && std::isfinite(p.y)) taken.push_back({frame.at(p) - glm::dvec2(3.0), glm::dvec2(6.0)});
  const auto apart = [](const Box& a, const Box& b) { return a.right() <= b.corner.x || b.right() <= a.corner.x || a.bottom() <= b.corner.y || b.bottom() <= a.corner.y; };
  for (const Series& series : list)
    for (std::size_t i = 0; i < std::min(series.points.size(), series.labels.size()); ++i) {
      if (!std::isfinite(series.points[i].x) || !std::isfinite(series.points[i].y)) continue;
      const glm::dvec2 at = frame.at(series.points[i]);
      const double width = canvas.text_width(series.labels[i], size);
      const glm::dvec2 corners[] = {{away, -0.5 * height}, {-away - width, -0.5 * height}, {-0.5 * width, -away - height}, {-0.5 * width, away}, {away, -away - height}, {away, away}, {-away - width, -away - height}, {-away - width, away}};
      for (const glm::dvec2& corner : corners) {
        const Box box{at + corner, {width, height}};
        if (box.corner.x < frame.box.corner.x || box.right() > frame.box.right() || box.corner.y < frame.box.corner.y || box.bottom() > frame.box.bottom()) continue;
        if (!std::ranges::all_of(taken, [&](const Box& other) { return apart(box, other); })) continue;
        canvas.text(series.labels[i], {box.corner.x, box.bottom() - 2.5}, size, ink);
        taken.push_back(box);
        break;
      }
    }
}

// --- headings: a panel's title, and its legend below it

namespace {

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

}  // namespace

std::vector<Entry> entries_of(const std::vector<Series>& list) {
  std::vector<Entry> entries;
  for (const Series& series : list)
    if (!series.name.empty()) entries.push_back({series.name, &series, {}});
  return entries;
}

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

}  // namespace thicket
