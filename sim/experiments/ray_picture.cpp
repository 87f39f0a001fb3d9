#include "ray_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "../canvas.hpp"
#include "../picture_view.hpp"
#include "thicket/worlds/truth.hpp"

namespace thicket {
namespace {

constexpr Colour paper{0.965, 0.965, 0.955}, ink{0.1, 0.1, 0.12}, sensed_ink{0.86, 0.91, 0.96}, left_ink{0.80, 0.10, 0.10}, right_ink{0.05, 0.30, 0.80}, middle_ink{0.45, 0.45, 0.48}, echo_ink{0.75, 0.25, 0.0},
    robot_ink{0.0, 0.0, 0.0};
constexpr std::uint32_t open_pixel = 0xffffffffu, medium_pixel = 0xffe9dcc0u;
constexpr double margin = 16.0, heading = 26.0;

/// A panel's part of the sheet.
struct Area {
  const RayPicture* picture;
  glm::dvec2 corner;
  glm::dvec2 size() const { return (picture->high - picture->low) * picture->scale; }
  glm::dvec2 at(const glm::dvec2& p) const { return {corner.x + (p.x - picture->low.x) * picture->scale, corner.y + (picture->high.y - p.y) * picture->scale}; }
};

glm::dvec2 toward(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// Where matter is, and what robots pass (dust, smoke) in another colour. What is sensed is drawn below, so open cells are left out.
Result<Done> draw_plan(Canvas& canvas, const Area& area, const RayPanel& panel) {
  const RayPicture& p = *area.picture;
  const double cell = 1.0 / p.scale;
  const auto solid = occupancy(panel.scene->world(), p.low, p.high, cell, p.height, p.height, Convention::any_overlap, true);
  if (!solid) return solid.error();
  for (int row = 0; row < solid->height; ++row)
    for (int column = 0; column < solid->width;) {
      const auto blocked = [&](int c) { return solid->blocked[static_cast<std::size_t>(row) * static_cast<std::size_t>(solid->width) + static_cast<std::size_t>(c)] != 0; };
      int end = column + 1;
      while (end < solid->width && blocked(end) == blocked(column)) ++end;
      if (blocked(column)) canvas.rectangle({area.corner.x + column, area.corner.y + solid->height - 1 - row}, {static_cast<double>(end - column), 1.0}, {0.60, 0.62, 0.65});
      column = end;
    }
  return Done{};
}

Result<Done> draw_media(Canvas& canvas, const Area& area, const RayPanel& panel) {
  const RayPicture& p = *area.picture;
  const auto all = occupancy(panel.scene->world(), p.low, p.high, 1.0 / p.scale, p.height, p.height, Convention::cell_centre, false);
  if (!all) return all.error();
  std::vector<std::uint32_t> pixels;
  for (int row = all->height - 1; row >= 0; --row)
    for (int column = 0; column < all->width; ++column) pixels.push_back(all->blocked[static_cast<std::size_t>(row) * static_cast<std::size_t>(all->width) + static_cast<std::size_t>(column)] ? medium_pixel : open_pixel);
  canvas.image(pixels, all->width, all->height, area.corner, 1.0);
  return Done{};
}

/// The area that a scan sensed: each beam is as wide as the step between two.
void draw_sensed(Canvas& canvas, const Area& area, const RayPanel& panel, const Scan& scan) {
  if (scan.beams.size() < 2) return;
  const double half = 0.5 * (scan.beams[1].azimuth - scan.beams[0].azimuth);
  std::vector<glm::dvec2> outline = {area.at(panel.position)};
  for (const Beam& beam : scan.beams)
    for (const double side : {-half, half}) outline.push_back(area.at(panel.position + beam.sensed_range * toward(panel.yaw + beam.azimuth + side)));
  canvas.polygon(outline, {0.45, 0.65, 0.88, 0.28});
}

/// Where a beam begins, and its direction.
std::pair<glm::dvec2, glm::dvec2> ray_of(const RayPanel& panel, const Beam& beam) {
  const double angle = panel.yaw + beam.azimuth + beam.side * panel.side_angle;
  const glm::dvec2 ahead = toward(angle);
  return {panel.position + beam.side * panel.side_shift * glm::dvec2(-ahead.y, ahead.x), ahead};
}

void draw_rays(Canvas& canvas, const Area& area, const RayPanel& panel) {
  // Scans that took the same side of a beam drew the same line.
  std::set<std::pair<int, double>> drawn;
  for (const int side : {0, -1, 1})
    for (const Scan& scan : panel.scans)
      for (const Beam& beam : scan.beams) {
        if (beam.side != side || !drawn.insert({side, beam.azimuth}).second) continue;
        const auto [from, ahead] = ray_of(panel, beam);
        canvas.polyline({area.at(from), area.at(from + beam.sensed_range * ahead)}, side == 0 ? middle_ink : side > 0 ? left_ink : right_ink, side == 0 ? 0.7 : 1.0);
      }
}

/// Echoes where the sensor believes them: along the middle of their beam.
void draw_echoes(Canvas& canvas, const Area& area, const RayPanel& panel) {
  for (const Scan& scan : panel.scans)
    for (const Beam& beam : scan.beams)
      for (const Echo& echo : scan.echoes_of(beam)) {
        const glm::dvec2 at = area.at(panel.position + echo.range * toward(panel.yaw + beam.azimuth));
        if (echo.edge == Edge::back) canvas.circle(at, 2.0, echo_ink, 1.0);
        else canvas.disc(at, 2.1, echo_ink);
      }
}

Result<Done> draw_panel(Canvas& canvas, const Area& area, const RayPanel& panel) {
  const RayPicture& p = *area.picture;
  canvas.text(panel.title, area.corner + glm::dvec2(0.0, -8.0), 14.0, ink);
  if (const auto drawn = draw_media(canvas, area, panel); !drawn) return drawn;
  canvas.clip(area.corner, area.size());
  if (!panel.rays)
    for (const Scan& scan : panel.scans) draw_sensed(canvas, area, panel, scan);
  if (const auto drawn = draw_plan(canvas, area, panel); !drawn) return drawn;
  if (panel.rays) draw_rays(canvas, area, panel);
  else draw_echoes(canvas, area, panel);
  const glm::dvec2 here = area.at(panel.position);
  if (p.hull_radius > 0.0) canvas.circle(here, p.hull_radius * p.scale, robot_ink, 1.6);
  canvas.disc(here, 3.0, robot_ink);
  canvas.polyline({here, area.at(panel.position + std::max(p.hull_radius, 9.0 / p.scale) * toward(panel.yaw))}, robot_ink, 1.6);
  canvas.unclip();
  canvas.frame(area.corner, area.size(), ink, 1.0);
  return Done{};
}

/// What the colours mean, of what is drawn; then a scale bar.
void draw_legend(Canvas& canvas, const RayPicture& p, double top) {
  const bool rays = std::any_of(p.panels.begin(), p.panels.end(), [](const RayPanel& panel) { return panel.rays; });
  double x = margin;
  const auto words = [&](const char* text) {
    canvas.text(text, {x + 26.0, top + 12.0}, 13.0, ink);
    x += 26.0 + canvas.text_width(text, 13.0) + 16.0;
  };
  const auto area = [&](const Colour& colour, const char* text) {
    canvas.rectangle({x, top + 1.0}, {20.0, 13.0}, colour);
    canvas.frame({x, top + 1.0}, {20.0, 13.0}, ink, 0.8);
    words(text);
  };
  area({0.60, 0.62, 0.65}, "matter");
  const auto in_medium = [](const RayPanel& panel) { return std::any_of(panel.scene->world().solids.begin(), panel.scene->world().solids.end(), [&](const Solid& s) { return !panel.scene->world().materials[s.material].stops_motion; }); };
  if (std::any_of(p.panels.begin(), p.panels.end(), in_medium)) area({0.914, 0.863, 0.753}, "dust, smoke");
  if (rays) {
    for (const auto& [colour, text] : {std::pair{left_ink, "left side rays"}, {right_ink, "right side rays"}, {middle_ink, "middle rays"}}) {
      canvas.polyline({{x, top + 8.0}, {x + 20.0, top + 8.0}}, colour, 2.0);
      words(text);
    }
  } else {
    area(sensed_ink, "sensed");
    canvas.disc({x + 12.0, top + 7.5}, 3.0, echo_ink);
    words("echo");
    canvas.circle({x + 12.0, top + 7.5}, 3.0, echo_ink, 1.2);
    words("back of matter");
  }
  const double length = scale_bar_length((p.high.x - p.low.x) * 2.0);
  canvas.polyline({{margin, top + 30.0}, {margin + length * p.scale, top + 30.0}}, ink, 4.0);
  canvas.text(fmt::format("{} m", length), {margin + length * p.scale + 8.0, top + 35.0}, 13.0, ink);
}

}  // namespace

Result<Done> write_ray_picture(const std::filesystem::path& file, const RayPicture& picture) {
  const glm::dvec2 size = (picture.high - picture.low) * picture.scale;
  const int columns = std::max(1, std::min<int>(picture.columns, static_cast<int>(picture.panels.size())));
  const int rows = (static_cast<int>(picture.panels.size()) + columns - 1) / columns;
  const double width = std::max(560.0, margin + columns * (size.x + margin)), below = rows * (size.y + heading + 10.0) + 10.0;
  Canvas canvas(static_cast<int>(std::ceil(width)), static_cast<int>(std::ceil(below + 48.0)), paper);
  for (std::size_t i = 0; i < picture.panels.size(); ++i) {
    const int column = static_cast<int>(i) % columns, row = static_cast<int>(i) / columns;
    const Area area{&picture, {margin + std::round(column * (size.x + margin)), heading + std::round(row * (size.y + heading + 10.0))}};
    if (const auto drawn = draw_panel(canvas, area, picture.panels[i]); !drawn) return drawn;
  }
  draw_legend(canvas, picture, below);
  return canvas.write(file);
}

}  // namespace thicket
