// What clicks in the plan do.
#include <fmt/format.h>

#include <cmath>

#include <glm/geometric.hpp>

#include "plan.hpp"

namespace thicket::gui {
namespace {

float apart(const ImVec2& a, const ImVec2& b) { return std::hypot(a.x - b.x, a.y - b.y); }

/// Where the handle is that turns the robot: well off its hull, however small that is on the screen.
glm::dvec2 heading_handle(const PlanCamera& camera, const Pose2& pose, double radius) {
  return pose.position + (radius + std::max(0.4 * radius, 14.0 / camera.pixels_per_metre)) * direction(pose.yaw);
}

void draw_heading_handle(const Frame& frame, const PlanCamera& camera, const Pose2& pose, ImDrawList& draw) {
  const ImVec2 at = camera.to_screen(heading_handle(camera, pose, frame.now.simulation->mission().vehicle.radius_m));
  draw.AddLine(camera.to_screen(pose.position), at, frame.colours.selected, 1.5f);
  draw.AddCircleFilled(at, 5.0f, frame.colours.selected);
}

void draw_goal_at(const Frame& frame, const PlanCamera& camera, const glm::dvec2& goal, ImDrawList& draw) {
  const ImVec2 at = camera.to_screen(goal);
  for (const float side : {-1.0f, 1.0f}) draw.AddLine({at.x - 8.0f, at.y - 8.0f * side}, {at.x + 8.0f, at.y + 8.0f * side}, frame.colours.selected, 3.0f);
  draw.AddText({at.x + 11.0f, at.y - ImGui::GetFontSize()}, frame.colours.selected, fmt::format("{:.2f}, {:.2f}", goal.x, goal.y).c_str());
}

/// A box with words beside the cursor.
void say_at(const Frame& frame, const ImVec2& at, const std::string& words, ImDrawList& draw) {
  const ImVec2 size = ImGui::CalcTextSize(words.c_str()), low{at.x + 14.0f, at.y + 10.0f};
  draw.AddRectFilled({low.x - 5.0f, low.y - 3.0f}, {low.x + size.x + 5.0f, low.y + size.y + 3.0f}, with_alpha(frame.colours.background, 0.9), 3.0f);
  draw.AddText(low, frame.colours.text, words.c_str());
}

class GoalTool final : public PlanTool {
 public:
  const char* name() const override { return "goal"; }
  const char* help() const override { return "Click, or drag: the robot drives there."; }
  void use(const Frame& frame, const PlanCamera& camera, bool hovered, ImDrawList& draw) override {
    if (hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) pressed_ = true;
    const glm::dvec2 point = camera.to_world(ImGui::GetIO().MousePos);
    if (hovered || pressed_) draw_goal_at(frame, camera, point, draw);
    if (!pressed_ || ImGui::IsMouseDown(ImGuiMouseButton_Left)) return;
    pressed_ = false;
    frame.post(SetGoal{point});
  }

 private:
  bool pressed_ = false;
};

class RobotTool final : public PlanTool {
 public:
  const char* name() const override { return "robot"; }
  const char* help() const override { return "Drag the robot to move it, its handle to turn it; a press elsewhere puts it there, and dragging on turns it."; }
  void use(const Frame& frame, const PlanCamera& camera, bool hovered, ImDrawList& draw) override {
    draw_heading_handle(frame, camera, frame.now.simulation->vehicle().pose, draw);
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    if (placing_) return place(frame, camera, draw);
    if (handles_.use(frame, camera, hovered, draw) || handles_.busy()) return;
    if (!hovered || !ImGui::IsMouseClicked(ImGuiMouseButton_Left)) return;
    placing_ = true;
    pose_ = {camera.to_world(mouse), frame.now.simulation->vehicle().pose.yaw};
  }

 private:
  void place(const Frame& frame, const PlanCamera& camera, ImDrawList& draw) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    if (apart(mouse, camera.to_screen(pose_.position)) > 12.0f) pose_.yaw = bearing(camera.to_world(mouse) - pose_.position);
    draw_hull(camera, pose_, frame.now.simulation->mission().vehicle.radius_m, with_alpha(frame.colours.selected, 0.4), frame.colours.selected, draw);
    if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) return;
    placing_ = false;
    frame.post(MoveRobot{pose_});
  }
  Handles handles_;
  bool placing_ = false;
  Pose2 pose_;
};

class MeasureTool final : public PlanTool {
 public:
  const char* name() const override { return "measure"; }
  const char* help() const override { return "Drag, or click twice: distance and bearing. Escape forgets them."; }
  void use(const Frame& frame, const PlanCamera& camera, bool hovered, ImDrawList& draw) override {
    const glm::dvec2 point = camera.to_world(ImGui::GetIO().MousePos);
    if (hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
      if (!from_ || to_) {
        from_ = point;
        to_.reset();
      } else {
        to_ = point;
      }
    }
    if (from_ && !to_ && ImGui::IsMouseReleased(ImGuiMouseButton_Left) && apart(camera.to_screen(*from_), camera.to_screen(point)) > 6.0f) to_ = point;
    if (!from_) return;
    const glm::dvec2 end = to_.value_or(point), way = end - *from_;
    const ImVec2 a = camera.to_screen(*from_), b = camera.to_screen(end);
    draw.AddLine(a, b, frame.colours.selected, 2.0f);
    draw.AddCircleFilled(a, 3.5f, frame.colours.selected);
    draw.AddCircleFilled(b, 3.5f, frame.colours.selected);
    say_at(frame, b, fmt::format("{:.3f} m at {:.1f}°  (x {:+.3f}, y {:+.3f})", glm::length(way), degrees(bearing(way)), way.x, way.y), draw);
  }

 private:
  std::optional<glm::dvec2> from_, to_;
};

class InspectTool final : public PlanTool {
 public:
  explicit InspectTool(std::shared_ptr<PlanSolids> solids) : solids_(std::move(solids)) {}
  const char* name() const override { return "inspect"; }
  const char* help() const override { return "Click: the solid there, or what the map knows of that place."; }
  void use(const Frame& frame, const PlanCamera& camera, bool hovered, ImDrawList& draw) override {
    if (hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
      point_ = camera.to_world(ImGui::GetIO().MousePos);
      frame.desk.solid = solids_->at(frame.now, *point_);
    }
    if (!point_) return;
    const Simulation& simulation = *frame.now.simulation;
    std::string words;
    const World& world = simulation.scene().world();
    if (frame.desk.solid && *frame.desk.solid < world.solids.size()) {
      const Solid& solid = world.solids[*frame.desk.solid];
      const Material& material = world.material_of(*frame.desk.solid);
      const Bounds box = extent(solid);
      words = fmt::format("{} of {}\nz {:.2f} to {:.2f} m\nreflects {:.3g}, {} dB/m\n{}, {}\n", solid.name.empty() ? fmt::format("solid {}", *frame.desk.solid) : solid.name, material.name, box.low.z, box.high.z,
                          material.reflectivity, material.opaque() ? std::string("opaque: inf") : fmt::format("{:.3g}", material.attenuation_db_per_m), material.stops_light ? "stops light" : "lets light through",
                          material.stops_motion ? "stops a robot" : "lets a robot through");
    }
    words += describe_cell(simulation, *point_);
    const ImVec2 at = camera.to_screen(*point_);
    draw.AddCircle(at, 4.0f, frame.colours.selected, 0, 2.0f);
    say_at(frame, at, words, draw);
  }

 private:
  std::shared_ptr<PlanSolids> solids_;
  std::optional<glm::dvec2> point_;
};

}  // namespace

Handles::What Handles::at(const Frame& frame, const PlanCamera& camera, const ImVec2& point) {
  const Simulation& simulation = *frame.now.simulation;
  const Pose2& pose = simulation.vehicle().pose;
  const double radius = simulation.mission().vehicle.radius_m;
  if (has_goal(frame.now) && apart(camera.to_screen(*simulation.mission().planner.goal_m), point) < 11.0f) return What::goal;
  if (apart(camera.to_screen(heading_handle(camera, pose, radius)), point) < 8.0f) return What::heading;
  if (apart(camera.to_screen(pose.position), point) < std::max(9.0f, static_cast<float>(radius * camera.pixels_per_metre))) return What::robot;
  return What::nothing;
}

bool Handles::use(const Frame& frame, const PlanCamera& camera, bool hovered, ImDrawList& draw) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const Simulation& simulation = *frame.now.simulation;
  const double radius = simulation.mission().vehicle.radius_m;
  if (what_ == What::nothing) {
    const What under = hovered ? at(frame, camera, mouse) : What::nothing;
    if (under == What::nothing) return false;
    if (under != What::goal) draw_heading_handle(frame, camera, simulation.vehicle().pose, draw);
    ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    if (!ImGui::IsMouseClicked(ImGuiMouseButton_Left)) return false;
    what_ = under;
    pose_ = simulation.vehicle().pose;
    goal_ = simulation.mission().planner.goal_m.value_or(glm::dvec2(0.0));
    pressed_ = mouse;
    offset_ = (under == What::goal ? goal_ : pose_.position) - camera.to_world(mouse);
    moved_ = false;
    return true;
  }
  // A hand that trembles is no drag.
  moved_ = moved_ || apart(mouse, pressed_) > 3.0f;
  const glm::dvec2 point = camera.to_world(mouse);
  if (moved_) {
    if (what_ == What::goal) draw_goal_at(frame, camera, goal_ = point + offset_, draw);
    if (what_ == What::robot) pose_.position = point + offset_;
    if (what_ == What::heading) pose_.yaw = bearing(point - pose_.position);
    if (what_ != What::goal) draw_hull(camera, pose_, radius, with_alpha(frame.colours.selected, 0.4), frame.colours.selected, draw);
  }
  if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) return true;
  if (moved_) {
    if (what_ == What::goal) frame.post(SetGoal{goal_});
    else frame.post(MoveRobot{pose_});
  }
  what_ = What::nothing;
  return true;
}

std::unique_ptr<PlanTool> make_goal_tool() { return std::make_unique<GoalTool>(); }
std::unique_ptr<PlanTool> make_robot_tool() { return std::make_unique<RobotTool>(); }
std::unique_ptr<PlanTool> make_measure_tool() { return std::make_unique<MeasureTool>(); }
std::unique_ptr<PlanTool> make_inspect_tool(std::shared_ptr<PlanSolids> solids) { return std::make_unique<InspectTool>(std::move(solids)); }

std::string describe_cell(const Simulation& simulation, const glm::dvec2& point) {
  const OccupancyMap& map = simulation.map();
  const CellIndex cell = map.cell_at(point);
  const CellView view = map.view(cell);
  std::string words = fmt::format("x {:.2f}, y {:.2f} m   cell {}, {}   ", point.x, point.y, cell.column, cell.row);
  if (!view.known) return words + "never sensed";
  return words + fmt::format("p {:.2f}{}   last seen {:.1f} s ago", view.probability, view.sensed_through ? ", sensed through" : "", std::max(0.0, simulation.time() - view.last_seen));
}

}  // namespace thicket::gui
