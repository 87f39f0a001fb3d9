#include "../view.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

namespace thicket::gui {

Palette palette(bool dark) {
  Palette p{};
  p.dark = dark;
  const auto rgb = [](int r, int g, int b, int a = 255) { return IM_COL32(r, g, b, a); };
  // Okabe & Ito: orange 230 159 0, sky 86 180 233, green 0 158 115, yellow 240 228 66, blue 0 114 178, vermilion 213 94 0, purple 204 121 167.
  p.background = dark ? rgb(22, 24, 28) : rgb(250, 250, 248);
  p.grid = dark ? rgb(255, 255, 255, 22) : rgb(0, 0, 0, 24);
  p.grid_text = dark ? rgb(255, 255, 255, 110) : rgb(0, 0, 0, 120);
  p.text = dark ? rgb(235, 235, 230) : rgb(25, 25, 25);
  p.faint = dark ? rgb(235, 235, 230, 120) : rgb(25, 25, 25, 120);
  p.robot = rgb(86, 180, 233);
  p.robot_edge = dark ? rgb(255, 255, 255) : rgb(0, 0, 0);
  p.estimate = rgb(204, 121, 167);
  p.trail = rgb(86, 180, 233, 200);
  p.start = rgb(0, 114, 178);
  p.goal = rgb(0, 158, 115);
  p.mark = dark ? rgb(204, 121, 167) : rgb(150, 60, 110);
  p.contact = rgb(213, 94, 0);
  p.ray = rgb(230, 159, 0, 70);
  p.ray_through = rgb(0, 158, 115, 120);
  p.side_left = rgb(213, 94, 0, 120);
  p.side_right = rgb(0, 114, 178, 140);
  p.echo = dark ? rgb(240, 228, 66) : rgb(150, 110, 0);
  p.lobe = rgb(230, 159, 0, 40);
  p.lidar = rgb(204, 121, 167, 110);
  p.pressed = rgb(213, 94, 0, 130);
  p.released = rgb(0, 158, 115, 60);
  p.unseen = rgb(128, 128, 128, 90);
  p.clearance = rgb(230, 159, 0, 160);
  p.selected = rgb(240, 228, 66);
  p.warning = rgb(213, 94, 0);
  return p;
}

ImVec2 PlanCamera::to_screen(const glm::dvec2& point) const {
  const double c = std::cos(up), s = std::sin(up);
  const glm::dvec2 d = (point - centre) * pixels_per_metre;
  return {low.x + 0.5f * size.x + static_cast<float>(c * d.x + s * d.y), low.y + 0.5f * size.y - static_cast<float>(-s * d.x + c * d.y)};
}

glm::dvec2 PlanCamera::to_world(const ImVec2& point) const {
  const double c = std::cos(up), s = std::sin(up);
  const double x = static_cast<double>(point.x - low.x - 0.5f * size.x) / pixels_per_metre, y = static_cast<double>(low.y + 0.5f * size.y - point.y) / pixels_per_metre;
  return centre + glm::dvec2(c * x - s * y, s * x + c * y);
}

void PlanCamera::fit(const glm::dvec2& lower, const glm::dvec2& upper) {
  centre = 0.5 * (lower + upper);
  const glm::dvec2 wide = glm::max(upper - lower, glm::dvec2(0.5));
  pixels_per_metre = 0.9 * std::min(static_cast<double>(size.x) / wide.x, static_cast<double>(size.y) / wide.y);
}

void PlanCamera::zoom(double factor, const ImVec2& cursor) {
  const glm::dvec2 before = to_world(cursor);
  pixels_per_metre = std::clamp(pixels_per_metre * factor, 1e-4, 1e5);
  centre += before - to_world(cursor);
}

}  // namespace thicket::gui
