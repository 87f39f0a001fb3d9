#include "overlay.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace thicket::gui {
namespace {

constexpr double nearest = 0.02;  // m ahead of the camera

}  // namespace

ImU32 Overlay::faint(ImU32 colour) {
  const ImU32 alpha = (colour >> IM_COL32_A_SHIFT & 0xffu) / 4;
  return (colour & ~IM_COL32_A_MASK) | alpha << IM_COL32_A_SHIFT;
}

ImVec2 Overlay::on_screen(const glm::dvec3& seen) const {
  const auto within = [](double x) { return static_cast<float>(std::clamp(x, -1e4, 1e4)); };
  return {low_.x + 0.5f * (1.0f + within(seen.x)) * (high_.x - low_.x), low_.y + 0.5f * (1.0f - within(seen.y)) * (high_.y - low_.y)};
}

std::optional<ImVec2> Overlay::place(const glm::dvec3& point) const {
  const glm::dvec3 seen = camera_.seen(point);
  if (!(seen.z > nearest)) return std::nullopt;
  return on_screen(seen);
}

bool Overlay::hidden(const glm::dvec3& point) const {
  if (!image_) return false;
  const glm::dvec3 seen = camera_.seen(point);
  if (std::abs(seen.x) > 1.0 || std::abs(seen.y) > 1.0) return false;
  // What lies on a surface is not behind it: pixels have a size.
  return glm::distance(point, camera_.from) > 1.01 * static_cast<double>(image_->depth_at(seen.x, seen.y)) + 0.03;
}

void Overlay::line(const glm::dvec3& from, const glm::dvec3& to, ImU32 colour, float width) {
  glm::dvec3 a = from, b = to;
  const double ahead_a = glm::dot(a - camera_.from, camera_.forward), ahead_b = glm::dot(b - camera_.from, camera_.forward), enough = 2.0 * nearest;
  if (ahead_a < enough && ahead_b < enough) return;
  if (ahead_a < enough) a = glm::mix(a, b, (enough - ahead_a) / (ahead_b - ahead_a));
  if (ahead_b < enough) b = glm::mix(b, a, (enough - ahead_b) / (ahead_a - ahead_b));
  const auto first = place(a), last = place(b);
  if (!first || !last) return;
  if (std::max(first->x, last->x) < low_.x || std::min(first->x, last->x) > high_.x || std::max(first->y, last->y) < low_.y || std::min(first->y, last->y) > high_.y) return;

  // In pieces of a few pixels, of which neighbours that look the same are drawn as one.
  const float length = std::hypot(last->x - first->x, last->y - first->y);
  const int pieces = std::clamp(static_cast<int>(length / 8.0f), 1, 200);
  ImVec2 begun = *first;
  bool begun_hidden = hidden(glm::mix(a, b, 0.5 / pieces));
  for (int i = 1; i < pieces; ++i) {
    const bool now = hidden(glm::mix(a, b, (i + 0.5) / pieces));
    if (now == begun_hidden) continue;
    const ImVec2 here = place(glm::mix(a, b, static_cast<double>(i) / pieces)).value_or(begun);
    draw_.AddLine(begun, here, begun_hidden ? faint(colour) : colour, width);
    begun = here;
    begun_hidden = now;
  }
  draw_.AddLine(begun, *last, begun_hidden ? faint(colour) : colour, width);
}

void Overlay::point(const glm::dvec3& at, ImU32 colour, float radius) {
  if (const auto there = place(at)) draw_.AddCircleFilled(*there, radius, hidden(at) ? faint(colour) : colour, 8);
}

void Overlay::circle(const glm::dvec3& centre, double radius, ImU32 colour, float width) {
  constexpr int sides = 40;
  const auto at = [&](int i) { return centre + glm::dvec3(radius * direction(2.0 * pi * i / sides), 0.0); };
  for (int i = 0; i < sides; ++i) line(at(i), at(i + 1), colour, width);
}

void Overlay::text(const glm::dvec3& at, ImU32 colour, const char* words) {
  if (const auto there = place(at)) draw_.AddText({there->x + 4.0f, there->y - 0.5f * ImGui::GetTextLineHeight()}, colour, words);
}

}  // namespace thicket::gui
