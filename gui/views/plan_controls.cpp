// Moving about in a plan, its grid and its scale.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plan.hpp"

namespace thicket::gui {
namespace {

/// 1, 2 or 5 times a power of ten, at or above.
double round_up(double length) {
  const double power = std::pow(10.0, std::floor(std::log10(length)));
  for (const double digit : {1.0, 2.0, 5.0})
    if (digit * power >= length * (1.0 - 1e-9)) return digit * power;
  return 10.0 * power;
}

}  // namespace

ImU32 with_alpha(ImU32 colour, double share) {
  const auto alpha = static_cast<ImU32>(std::lround(std::clamp(share * static_cast<double>(colour >> IM_COL32_A_SHIFT & 255u), 0.0, 255.0)));
  return (colour & ~IM_COL32_A_MASK) | alpha << IM_COL32_A_SHIFT;
}

ImU32 colour_of(const glm::dvec3& display, double alpha) {
  const auto part = [](double x) { return static_cast<int>(std::lround(255.0 * std::clamp(x, 0.0, 1.0))); };
  return IM_COL32(part(display.x), part(display.y), part(display.z), part(alpha));
}

ImU32 ramp(double share, double alpha) {
  static constexpr std::array<glm::dvec3, 4> stops = {{{0.94, 0.89, 0.26}, {0.90, 0.48, 0.10}, {0.62, 0.20, 0.50}, {0.13, 0.20, 0.60}}};
  const double at = std::clamp(share, 0.0, 1.0) * 3.0;
  const auto low = std::min<std::size_t>(2, static_cast<std::size_t>(at));
  const double part = at - static_cast<double>(low);
  return colour_of(stops[low] * (1.0 - part) + stops[low + 1] * part, alpha);
}

bool key_pressed(char key) {
  const ImGuiIO& io = ImGui::GetIO();
  return !io.WantTextInput && !io.KeyCtrl && !io.KeyAlt && !io.KeySuper && ImGui::IsKeyPressed(static_cast<unsigned char>(key), false);
}

void beside_if_room(const char* words, bool box) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const float width = ImGui::CalcTextSize(words).x + 2.0f * style.FramePadding.x + (box ? ImGui::GetFrameHeight() + style.ItemInnerSpacing.x : 0.0f);
  if (ImGui::GetItemRectMax().x + style.ItemSpacing.x + width < ImGui::GetWindowPos().x + ImGui::GetContentRegionMax().x) ImGui::SameLine();
}

PlanExtent extent_of(const Snapshot& now) {
  PlanExtent all;
  const Simulation& simulation = *now.simulation;
  const World& world = simulation.scene().world();
  if (world.bounds) {
    all.hold({world.bounds->x, world.bounds->y});
    all.hold({world.bounds->z, world.bounds->w});
  } else if (const auto solids = extent(world)) {
    all.hold(glm::dvec2(solids->low));
    all.hold(glm::dvec2(solids->high));
  }
  const Mission& mission = simulation.mission();
  const glm::dvec2 room(mission.vehicle.radius_m);
  for (const glm::dvec2& p : {simulation.vehicle().pose.position, glm::dvec2(mission.start.x_m, mission.start.y_m)}) {
    all.hold(p - room);
    all.hold(p + room);
  }
  if (has_goal(now)) all.hold(*mission.planner.goal_m);
  for (const glm::dvec2& p : mission.planner.waypoints_m) all.hold(p);
  return all;
}

PlanExtent seen_by(const PlanCamera& camera) {
  PlanExtent all;
  for (const float x : {0.0f, camera.size.x})
    for (const float y : {0.0f, camera.size.y}) all.hold(camera.to_world({camera.low.x + x, camera.low.y + y}));
  return all;
}

void PlanControls::fit(const Frame& frame) {
  const PlanExtent all = extent_of(frame.now);
  camera.fit(all.low, all.high);
  follow = touched_ = false;
  fitted_size_ = camera.size;
}

void PlanControls::buttons() {
  beside_if_room("Fit (F)");
  if (ImGui::SmallButton("Fit (F)")) wants_fit_ = true;
  beside_if_room("follow (T)", true);
  ImGui::Checkbox("follow (T)", &follow);
  beside_if_room("robot up (N)", true);
  if (ImGui::Checkbox("robot up (N)", &robot_up) && !robot_up) camera.up = 0.0;
}

void PlanControls::begin(const Frame& frame, const char* id) {
  camera.low = ImGui::GetCursorScreenPos();
  const ImVec2 left = ImGui::GetContentRegionAvail();
  camera.size = {std::max(left.x, 16.0f), std::max(left.y, 16.0f)};
  ImGui::InvisibleButton(id, camera.size, ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle | ImGuiButtonFlags_MouseButtonRight);
  hovered_ = !frame.still && ImGui::IsItemHovered();
  // Until somebody moves it, the plan fits its window, whatever becomes of that.
  if (file_ != frame.now.file) touched_ = false;
  const bool other_size = fitted_size_.x != camera.size.x || fitted_size_.y != camera.size.y;
  if (wants_fit_ || (!touched_ && (other_size || file_ != frame.now.file))) fit(frame);
  wants_fit_ = false;
  file_ = frame.now.file;
  if (hovered_) {
    if (key_pressed('F')) fit(frame);
    if (key_pressed('T')) follow = !follow;
    if (key_pressed('N')) robot_up = !robot_up;
    if (const float wheel = ImGui::GetIO().MouseWheel; wheel != 0.0f) {
      camera.zoom(std::pow(1.2, static_cast<double>(wheel)), ImGui::GetIO().MousePos);
      touched_ = true;
    }
  }
  const Pose2& pose = frame.now.simulation->vehicle().pose;
  camera.up = robot_up ? pose.yaw - 0.5 * pi : 0.0;
  if (follow) {
    camera.centre = pose.position;
    touched_ = true;
  }
}

void PlanControls::pan(const Frame& frame, bool left) {
  if (frame.still || !ImGui::IsItemActive()) return;
  const ImGuiIO& io = ImGui::GetIO();
  const bool drags = (left && ImGui::IsMouseDragging(ImGuiMouseButton_Left)) || ImGui::IsMouseDragging(ImGuiMouseButton_Middle) || ImGui::IsMouseDragging(ImGuiMouseButton_Right);
  if (!drags || (io.MouseDelta.x == 0.0f && io.MouseDelta.y == 0.0f)) return;
  camera.centre += camera.to_world({0.0f, 0.0f}) - camera.to_world(io.MouseDelta);
  follow = false;
  touched_ = true;
}

void PlanControls::draw_grid(const Frame& frame, ImDrawList& draw) const {
  const double step = round_up(70.0 * frame.scale / camera.pixels_per_metre);
  const PlanExtent seen = seen_by(camera);
  const float line = ImGui::GetFontSize();
  const float bottom = camera.low.y + camera.size.y - line - 2.0f, left = camera.low.x + 3.0f;
  const auto number = [&](double value) { return fmt::format("{:g}", std::abs(value) < 1e-9 * step ? 0.0 : value); };
  for (double x = std::ceil(seen.low.x / step) * step; x <= seen.high.x; x += step) {
    const ImVec2 a = camera.to_screen({x, seen.low.y}), b = camera.to_screen({x, seen.high.y});
    draw.AddLine(a, b, frame.colours.grid);
    if (std::abs(b.y - a.y) < 1.0f) continue;
    const float at = a.x + (b.x - a.x) * (bottom - a.y) / (b.y - a.y);
    label(frame, {at + 2.0f, bottom}, frame.colours.grid_text, number(x).c_str(), draw);
  }
  for (double y = std::ceil(seen.low.y / step) * step; y <= seen.high.y; y += step) {
    const ImVec2 a = camera.to_screen({seen.low.x, y}), b = camera.to_screen({seen.high.x, y});
    draw.AddLine(a, b, frame.colours.grid);
    if (std::abs(b.x - a.x) < 1.0f) continue;
    const float at = a.y + (b.y - a.y) * (left - a.x) / (b.x - a.x);
    if (at < bottom - line) label(frame, {left, at + 1.0f}, frame.colours.grid_text, number(y).c_str(), draw);
  }
}

void PlanControls::draw_scale_bar(const Frame& frame, ImDrawList& draw) const {
  const double metres = round_up(0.5 * std::min(240.0 * frame.scale, 0.4 * static_cast<double>(camera.size.x)) / camera.pixels_per_metre);
  const auto length = static_cast<float>(metres * camera.pixels_per_metre);
  const std::string words = metres >= 1000.0 ? fmt::format("{:g} km", 0.001 * metres) : metres >= 0.999 ? fmt::format("{:g} m", metres) : fmt::format("{:g} cm", 100.0 * metres);
  const ImVec2 end{camera.low.x + camera.size.x - 14.0f, camera.low.y + camera.size.y - ImGui::GetFontSize() - 12.0f}, start{end.x - length, end.y};
  draw.AddLine(start, end, frame.colours.text, 2.0f);
  for (const ImVec2& p : {start, end}) draw.AddLine({p.x, p.y - 5.0f}, {p.x, p.y + 1.0f}, frame.colours.text, 2.0f);
  label(frame, {start.x + 0.5f * (length - ImGui::CalcTextSize(words.c_str()).x), end.y - ImGui::GetFontSize() - 6.0f}, frame.colours.text, words.c_str(), draw);
}

}  // namespace thicket::gui
