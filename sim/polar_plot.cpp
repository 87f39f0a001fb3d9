// What scanning sensors saw.
#include <fmt/format.h>

#include "plot_parts.hpp"
#include "thicket/base/pose.hpp"

namespace thicket {
namespace {

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

}  // namespace

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

}  // namespace thicket
