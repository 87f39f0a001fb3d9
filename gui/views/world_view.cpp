#include <cstring>

#include "plan.hpp"

namespace thicket::gui {
namespace {

struct ToolKey {
  const char* name;
  char key;
  std::unique_ptr<PlanTool> (*make)(std::shared_ptr<PlanSolids>);
};
constexpr ToolKey tool_keys[] = {
    {"goal", 'G', [](std::shared_ptr<PlanSolids>) { return make_goal_tool(); }},
    {"robot", 'J', [](std::shared_ptr<PlanSolids>) { return make_robot_tool(); }},
    {"measure", 'M', [](std::shared_ptr<PlanSolids>) { return make_measure_tool(); }},
    {"inspect", 'I', [](std::shared_ptr<PlanSolids> solids) { return make_inspect_tool(std::move(solids)); }},
};

class WorldView final : public View {
 public:
  const char* name() const override { return "World"; }
  void draw(const Frame& frame) override;
  std::span<const ViewKey> own_keys() const override {
    static constexpr ViewKey list[] = {
        {"F", "fit"},
        {"T", "follow the robot"},
        {"N", "north up, or the robot's heading"},
        {"P G J M I", "tools: pan, goal, robot, measure, inspect"},
        {"1", "rays"},
        {"Y", "rays by amplitude, by depth in matter, by side"},
        {"2", "echoes"},
        {"3", "bumpers"},
        {"4", "clearance"},
        {"5", "lidar"},
        {"6", "lobes"},
        {"7", "map: off, under, over"},
        {"8", "truth"},
        {"9", "contact"},
        {"0", "trail"},
        {"K", "the planner's marks"},
        {"B", "solids"}};
    return list;
  }

 private:
  void toolbar(const Frame& frame);
  void keys(const Frame& frame);
  void draw_plan(const Frame& frame, ImDrawList& draw);
  void use_mouse(const Frame& frame, ImDrawList& draw);

  PlanControls controls_;
  /// Tools of the desk may outlive this view, and look at the solids.
  std::shared_ptr<PlanSolids> solids_ = std::make_shared<PlanSolids>();
  MapPicture map_{"world map", 0};
  TruthOutline truth_;
  Layers layers_;
  Handles handles_;
};

bool is_chosen(const Frame& frame, const char* name) { return frame.desk.tool && std::strcmp(frame.desk.tool->name(), name) == 0; }

void WorldView::toolbar(const Frame& frame) {
  const auto button = [&](const char* words, bool chosen) {
    if (chosen) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    const bool pressed = ImGui::SmallButton(words);
    if (chosen) ImGui::PopStyleColor();
    return pressed;
  };
  if (button("pan (P)", !frame.desk.tool)) frame.desk.tool.reset();
  for (const ToolKey& tool : tool_keys) {
    const std::string words = std::string(tool.name) + " (" + tool.key + ")";
    beside_if_room(words.c_str());
    if (button(words.c_str(), is_chosen(frame, tool.name))) frame.desk.tool = tool.make(solids_);
  }
  beside_if_room("Layers");
  if (button("Layers", false)) ImGui::OpenPopup("layers");
  if (ImGui::BeginPopup("layers")) {
    layers_.menu();
    ImGui::EndPopup();
  }
  controls_.buttons();
}

void WorldView::keys(const Frame& frame) {
  if (!controls_.hovered()) return;
  layers_.keys();
  if (key_pressed('P')) frame.desk.tool.reset();
  for (const ToolKey& tool : tool_keys)
    if (key_pressed(tool.key)) frame.desk.tool = is_chosen(frame, tool.name) ? nullptr : tool.make(solids_);
}

void WorldView::draw_plan(const Frame& frame, ImDrawList& draw) {
  const PlanCamera& camera = controls_.camera;
  controls_.draw_grid(frame, draw);
  if (layers_.map == Layers::MapPlace::under) map_.draw(frame, camera, false, 0.8, draw);
  if (layers_.solids) solids_->draw(frame, camera, draw);
  if (layers_.map == Layers::MapPlace::over) map_.draw(frame, camera, false, 0.6, draw);
  if (layers_.truth) truth_.draw(frame, camera, draw);
  if (layers_.clearance) draw_clearance(frame, camera, draw);
  if (layers_.bumpers) draw_bumpers(frame, camera, draw);
  draw_scans(frame, camera, layers_, draw);
  if (layers_.trail) draw_trail(frame, camera, draw);
  if (layers_.marks) draw_marks(frame, camera, draw);
  draw_places(frame, camera, draw);
  draw_robot(frame, camera, draw);
  if (layers_.contact) draw_contact(frame, camera, draw);
}

void WorldView::use_mouse(const Frame& frame, ImDrawList& draw) {
  const bool hovered = controls_.hovered();
  if (frame.desk.tool) {
    controls_.pan(frame, false);
    frame.desk.tool->use(frame, controls_.camera, hovered, draw);
    return;
  }
  if (handles_.use(frame, controls_.camera, hovered, draw)) return;
  controls_.pan(frame, true);
  if (hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) frame.post(SetGoal{controls_.camera.to_world(ImGui::GetIO().MousePos)});
}

void WorldView::draw(const Frame& frame) {
  if (!frame.now.simulation) return ImGui::TextUnformatted("Nothing is open.");
  if (!frame.still) toolbar(frame);
  controls_.begin(frame, "plan");
  keys(frame);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const PlanCamera& camera = controls_.camera;
  const ImVec2 high{camera.low.x + camera.size.x, camera.low.y + camera.size.y};
  draw.PushClipRect(camera.low, high, true);
  draw_plan(frame, draw);
  if (!frame.still) use_mouse(frame, draw);
  controls_.draw_scale_bar(frame, draw);
  if (frame.desk.tool && !frame.still) draw.AddText({camera.low.x + 8.0f, camera.low.y + 6.0f}, frame.colours.text, frame.desk.tool->help());
  draw.PopClipRect();
}

}  // namespace

std::unique_ptr<View> make_world_view() { return std::make_unique<WorldView>(); }

}  // namespace thicket::gui
