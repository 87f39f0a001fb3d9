// What is drawn over the solids, but for the sensors' beams.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "plan.hpp"

namespace thicket::gui {
namespace {

/// A sector of a ring about a point.
void band(const PlanCamera& camera, const glm::dvec2& centre, double low, double high, double inner, double outer, ImU32 colour, ImDrawList& draw) {
  const ImDrawListFlags flags = draw.Flags;
  draw.Flags &= ~ImDrawListFlags_AntiAliasedFill;
  const int count = std::clamp(static_cast<int>((high - low) / radians(3.0)) + 1, 1, 120);
  for (int i = 0; i < count; ++i) {
    const double a = low + (high - low) * i / count, b = low + (high - low) * (i + 1) / count;
    draw.AddQuadFilled(camera.to_screen(centre + inner * direction(a)), camera.to_screen(centre + outer * direction(a)), camera.to_screen(centre + outer * direction(b)), camera.to_screen(centre + inner * direction(b)), colour);
  }
  draw.Flags = flags;
}

void arc(const PlanCamera& camera, const glm::dvec2& centre, double low, double high, double radius, ImU32 colour, float thick, ImDrawList& draw) {
  std::vector<ImVec2> points;
  for (int i = 0; i <= 24; ++i) points.push_back(camera.to_screen(centre + radius * direction(low + (high - low) * i / 24)));
  draw.AddPolyline(points.data(), static_cast<int>(points.size()), colour, 0, thick);
}

void dashes(const PlanCamera& camera, const glm::dvec2& from, const glm::dvec2& to, ImU32 colour, ImDrawList& draw) {
  const ImVec2 a = camera.to_screen(from), b = camera.to_screen(to);
  const float length = std::hypot(b.x - a.x, b.y - a.y);
  // Of a line that leaves the screen by far a plain one is seen as well.
  if (length > 4000.0f) return draw.AddLine(a, b, colour, 1.5f);
  for (float at = 0.0f; at < length; at += 10.0f) {
    const float end = std::min(length, at + 6.0f);
    draw.AddLine({a.x + (b.x - a.x) * at / length, a.y + (b.y - a.y) * at / length}, {a.x + (b.x - a.x) * end / length, a.y + (b.y - a.y) * end / length}, colour, 1.5f);
  }
}

}  // namespace

void label(const Frame& frame, const ImVec2& at, ImU32 colour, const char* words, ImDrawList& draw) {
  const ImU32 behind = with_alpha(frame.colours.background, 0.6);
  for (const ImVec2 shift : {ImVec2(-1.0f, 0.0f), ImVec2(1.0f, 0.0f), ImVec2(0.0f, -1.0f), ImVec2(0.0f, 1.0f)}) draw.AddText({at.x + shift.x, at.y + shift.y}, behind, words);
  draw.AddText(at, colour, words);
}

Pose2 pose_at(const Snapshot& now, double time) {
  const Simulation& simulation = *now.simulation;
  const auto step = static_cast<std::uint64_t>(std::llround(time / simulation.mission().step_s));
  if (step >= simulation.steps()) return simulation.vehicle().pose;
  const std::size_t count = now.samples.count_until(step);
  if (count == 0 || now.samples[count - 1].step != step) return simulation.vehicle().pose;
  return now.samples[count - 1].pose;
}

bool has_goal(const Snapshot& now) {
  const PlannerSpec& planner = now.simulation->mission().planner;
  return planner.goal_m && planner_needs(planner.name) == PlannerNeeds::goal;
}

void draw_bumpers(const Frame& frame, const PlanCamera& camera, ImDrawList& draw) {
  const Simulation& simulation = *frame.now.simulation;
  const auto& bumpers = simulation.bumpers().bumpers();
  if (bumpers.empty()) return;
  const Pose2& pose = simulation.vehicle().pose;
  const double hull = simulation.mission().vehicle.radius_m, press = simulation.bumpers().press_distance(), half = pi / static_cast<double>(bumpers.size());
  for (const Bumper& b : bumpers) {
    const double middle = pose.yaw + b.centre, low = middle - half, high = middle + half, gap = 0.03 * half;
    // Each reaches to where it is pressed; what it measures is a line across it, nearer or farther.
    band(camera, pose.position, low + gap, high - gap, hull, hull + press, b.pressed ? frame.colours.pressed : frame.colours.released, draw);
    if (b.unseen > 0.0) band(camera, pose.position, middle - 0.5 * b.unseen, middle + 0.5 * b.unseen, hull, hull + press, frame.colours.unseen, draw);
    if (!std::isfinite(b.distance)) continue;
    const ImU32 line = with_alpha(b.pressed ? frame.colours.pressed : frame.colours.released, 4.0);
    arc(camera, pose.position, low + gap, high - gap, hull + b.distance, line, 2.0f, draw);
    if (b.bearing_high > b.bearing_low) arc(camera, pose.position, pose.yaw + b.bearing_low, pose.yaw + b.bearing_high, hull + b.distance, line, 4.0f, draw);
    if (press * camera.pixels_per_metre < 40.0) continue;
    const std::string words = fmt::format("{:.2f}", b.distance);
    const ImVec2 at = camera.to_screen(pose.position + (hull + 0.6 * press) * direction(middle)), size = ImGui::CalcTextSize(words.c_str());
    label(frame, {at.x - 0.5f * size.x, at.y - 0.5f * size.y}, frame.colours.text, words.c_str(), draw);
  }
}

void draw_clearance(const Frame& frame, const PlanCamera& camera, ImDrawList& draw) {
  const Simulation& simulation = *frame.now.simulation;
  const ImVec2 at = camera.to_screen(simulation.vehicle().pose.position);
  const double hull = simulation.mission().vehicle.radius_m, wanted = hull + simulation.mission().planner.clearance_m;
  draw.AddCircle(at, static_cast<float>(wanted * camera.pixels_per_metre), with_alpha(frame.colours.clearance, 0.5), 0, 1.0f);
  if (!std::isfinite(simulation.clearance().distance)) return;
  const auto radius = static_cast<float>(std::max(0.0, hull + simulation.clearance().distance) * camera.pixels_per_metre);
  draw.AddCircleFilled(at, radius, with_alpha(frame.colours.clearance, 0.2));
  draw.AddCircle(at, radius, frame.colours.clearance, 0, 2.0f);
}

void draw_contact(const Frame& frame, const PlanCamera& camera, ImDrawList& draw) {
  const Simulation& simulation = *frame.now.simulation;
  const bool hits = simulation.clearance().distance <= 0.0 || (simulation.verdict() && simulation.verdict()->kind == Verdict::Kind::collided);
  if (!hits) return;
  const ImVec2 at = camera.to_screen(simulation.vehicle().pose.position);
  const auto radius = static_cast<float>(simulation.mission().vehicle.radius_m * camera.pixels_per_metre);
  draw.AddCircleFilled(at, radius + 4.0f, with_alpha(frame.colours.contact, 0.4));
  draw.AddCircle(at, radius + 4.0f, frame.colours.contact, 0, 4.0f);
  const std::uint32_t solid = simulation.clearance().solid;
  const auto& solids = simulation.scene().world().solids;
  const std::string words = solid < solids.size() ? "touches " + (solids[solid].name.empty() ? "solid " + std::to_string(solid) : solids[solid].name) : "touches something";
  label(frame, {at.x + radius + 8.0f, at.y - 0.5f * ImGui::GetFontSize()}, frame.colours.contact, words.c_str(), draw);
}

void draw_trail(const Frame& frame, const PlanCamera& camera, ImDrawList& draw) {
  const Snapshot& now = frame.now;
  const std::size_t count = now.samples.count_until(now.simulation->steps());
  if (count < 2) return;
  const auto trail = [&](auto pose_of, ImU32 colour, float thick) {
    // Points that the screen cannot tell apart are one; of very long runs every so-manieth is looked at.
    const std::size_t every = 1 + count / 20000;
    std::vector<ImVec2> points;
    for (std::size_t i = 0; i < count; i += every) {
      const ImVec2 p = camera.to_screen(pose_of(now.samples[i]).position);
      if (points.empty() || std::abs(p.x - points.back().x) + std::abs(p.y - points.back().y) >= 2.0f) points.push_back(p);
    }
    points.push_back(camera.to_screen(pose_of(now.samples[count - 1]).position));
    draw.AddPolyline(points.data(), static_cast<int>(points.size()), colour, 0, thick);
  };
  if (!now.simulation->mission().odometry.perfect())
    trail([](const Sample& s) { return s.estimate; }, with_alpha(frame.colours.estimate, 0.6), 1.0f);
  trail([](const Sample& s) { return s.pose; }, frame.colours.trail, static_cast<float>(2.0 * frame.scale));
}

void draw_marks(const Frame& frame, const PlanCamera& camera, ImDrawList& draw) {
  const auto marks = frame.now.simulation->marks();
  for (const Mark& mark : marks)
    if (mark.kind == Mark::Kind::segment) {
      dashes(camera, mark.from, mark.to, frame.colours.mark, draw);
      const ImVec2 middle = camera.to_screen(0.5 * (mark.from + mark.to));
      label(frame, {middle.x + 4.0f, middle.y + 2.0f}, with_alpha(frame.colours.mark, 0.8), mark.label.c_str(), draw);
    }
  for (const Mark& mark : marks) {
    if (mark.kind != Mark::Kind::point) continue;
    const ImVec2 at = camera.to_screen(mark.from);
    draw.AddCircleFilled(at, 4.0f, frame.colours.mark);
    draw.AddCircle(at, 4.5f, frame.colours.robot_edge);
    label(frame, {at.x + 7.0f, at.y - ImGui::GetFontSize()}, frame.colours.text, mark.label.c_str(), draw);
  }
}

void draw_places(const Frame& frame, const PlanCamera& camera, ImDrawList& draw) {
  const Mission& mission = frame.now.simulation->mission();
  const ImVec2 start = camera.to_screen({mission.start.x_m, mission.start.y_m});
  draw.AddRect({start.x - 5.0f, start.y - 5.0f}, {start.x + 5.0f, start.y + 5.0f}, frame.colours.start, 0.0f, 0, 2.5f);
  label(frame, {start.x + 9.0f, start.y}, frame.colours.text, "start", draw);
  for (std::size_t i = 0; i < mission.planner.waypoints_m.size() && planner_needs(mission.planner.name) == PlannerNeeds::waypoints; ++i) {
    const ImVec2 at = camera.to_screen(mission.planner.waypoints_m[i]);
    if (i > 0) draw.AddLine(camera.to_screen(mission.planner.waypoints_m[i - 1]), at, with_alpha(frame.colours.goal, 0.4));
    draw.AddCircle(at, 5.0f, frame.colours.goal, 0, 2.0f);
  }
  if (!has_goal(frame.now)) return;
  const ImVec2 goal = camera.to_screen(*mission.planner.goal_m);
  const auto tolerance = static_cast<float>(mission.planner.goal_tolerance_m * camera.pixels_per_metre);
  draw.AddCircle(goal, std::max(3.0f, tolerance), frame.colours.goal, 0, 1.5f);
  for (const float side : {-1.0f, 1.0f}) draw.AddLine({goal.x - 8.0f, goal.y - 8.0f * side}, {goal.x + 8.0f, goal.y + 8.0f * side}, frame.colours.goal, 3.0f);
  label(frame, {goal.x + 11.0f, goal.y}, frame.colours.text, "goal", draw);
}

void draw_hull(const PlanCamera& camera, const Pose2& pose, double radius, ImU32 fill, ImU32 edge, ImDrawList& draw) {
  const ImVec2 at = camera.to_screen(pose.position);
  const auto r = static_cast<float>(std::max(3.0, radius * camera.pixels_per_metre));
  draw.AddCircleFilled(at, r, fill);
  draw.AddCircle(at, r, edge, 0, 1.5f);
  draw.AddLine(at, camera.to_screen(pose.position + 1.25 * std::max(radius, 3.0 / camera.pixels_per_metre) * direction(pose.yaw)), edge, 2.0f);
}

void draw_robot(const Frame& frame, const PlanCamera& camera, ImDrawList& draw) {
  const Simulation& simulation = *frame.now.simulation;
  const double radius = simulation.mission().vehicle.radius_m;
  const Pose2 &truth = simulation.vehicle().pose, &estimate = simulation.estimate();
  draw_hull(camera, truth, radius, with_alpha(frame.colours.robot, 0.85), frame.colours.robot_edge, draw);
  if (glm::distance(truth.position, estimate.position) > 1e-3 || std::abs(wrap_angle(truth.yaw - estimate.yaw)) > 1e-3) draw_hull(camera, estimate, radius, 0, frame.colours.estimate, draw);
}

void Layers::keys() {
  struct Switch {
    char key;
    bool* layer;
  };
  for (const Switch& s : {Switch{'1', &rays}, {'2', &echoes}, {'3', &bumpers}, {'4', &clearance}, {'5', &lidar}, {'6', &lobes}, {'8', &truth}, {'9', &contact}, {'0', &trail}, {'K', &marks}, {'B', &solids}})
    if (key_pressed(s.key)) *s.layer = !*s.layer;
  if (key_pressed('7')) map = static_cast<MapPlace>((static_cast<int>(map) + 1) % 3);
  if (key_pressed('Y')) ray_mode = static_cast<Rays>((static_cast<int>(ray_mode) + 1) % 3);
}

void Layers::menu() {
  ImGui::Checkbox("1  rays", &rays);
  int mode = static_cast<int>(ray_mode), place = static_cast<int>(map);
  ImGui::Indent();
  ImGui::TextUnformatted("Y  coloured by");
  ImGui::RadioButton("amplitude", &mode, 0);
  ImGui::RadioButton("depth in matter", &mode, 1);
  ImGui::RadioButton("side (left red, right blue)", &mode, 2);
  ray_mode = static_cast<Rays>(mode);
  ImGui::Unindent();
  ImGui::Checkbox("2  echoes", &echoes);
  ImGui::Checkbox("3  bumpers", &bumpers);
  ImGui::Checkbox("4  clearance", &clearance);
  ImGui::Checkbox("5  lidar", &lidar);
  ImGui::Checkbox("6  lobes", &lobes);
  ImGui::TextUnformatted("7  map");
  ImGui::SameLine();
  ImGui::RadioButton("off", &place, 0);
  ImGui::SameLine();
  ImGui::RadioButton("under", &place, 1);
  ImGui::SameLine();
  ImGui::RadioButton("over", &place, 2);
  map = static_cast<MapPlace>(place);
  ImGui::Checkbox("8  truth", &truth);
  ImGui::Checkbox("9  contact", &contact);
  ImGui::Checkbox("0  trail", &trail);
  ImGui::Checkbox("K  planner's marks", &marks);
  ImGui::Checkbox("B  solids", &solids);
}

}  // namespace thicket::gui
