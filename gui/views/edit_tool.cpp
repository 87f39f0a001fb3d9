#include "edit_tool.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "../core/editor_shapes.hpp"
#include "thicket/base/pose.hpp"
#include "thicket/sim/travel.hpp"
#include "thicket/worlds/shape_fault.hpp"

namespace thicket::gui {
namespace {

constexpr float grip_pixels = 6.0f, turn_pixels = 28.0f, still_pixels = 3.0f;

class EditTool final : public PlanTool {
 public:
  explicit EditTool(std::shared_ptr<Editing> editing) : editing_(std::move(editing)) {}
  const char* name() const override { return "edit"; }
  const char* help() const override;
  void use(const Frame& frame, const PlanCamera& camera, bool hovered, ImDrawList& draw) override;

 private:
  struct Drag {
    std::uint32_t solid;
    Solid before;
    Grip grip;
    ImVec2 from;
  };
  void escape();
  void press(const Frame& frame, const PlanCamera& camera, const glm::dvec2& at);
  void drag(const Frame& frame, const PlanCamera& camera, ImDrawList& draw);
  void draw_new(const Frame& frame, const PlanCamera& camera, bool hovered, ImDrawList& draw);
  void draw_points(const Frame& frame, const PlanCamera& camera, bool hovered, ImDrawList& draw);
  void show(const PlanCamera& camera, const Solid& solid, ImDrawList& draw, ImU32 colour) const;
  void show_selected(const Frame& frame, const PlanCamera& camera, ImDrawList& draw) const;
  std::optional<Grip> grip_under(const PlanCamera& camera, const Solid& solid, double time) const;
  /// Where the cursor is; with Ctrl on the grid.
  glm::dvec2 cursor(const PlanCamera& camera) const;
  Solid dragged_now(const PlanCamera& camera, double time) const;
  std::optional<Solid> drawn_now(const PlanCamera& camera, const std::vector<glm::dvec2>& points) const;
  void add(const Frame& frame, const std::optional<Solid>& solid);

  std::shared_ptr<Editing> editing_;
  std::optional<Drag> drag_;
  std::vector<glm::dvec2> points_;  ///< of what is being drawn
  double ground_ = 0.0, time_ = 0.0;  ///< of the run that is shown, m and s
};

const char* EditTool::help() const {
  switch (editing_->drawing) {
    case Drawing::nothing:
      return "Click selects, drag moves (Ctrl: to the grid), handles resize and turn, Del deletes, Ctrl+D copies, Ctrl+Z and Ctrl+Y undo and redo";
    case Drawing::box:
      return "Drag from corner to corner of the new box (Ctrl: to the grid)";
    case Drawing::sphere:
    case Drawing::cylinder:
      return "Drag from the middle to the rim (Ctrl: to the grid)";
    case Drawing::wall:
      return "Click the wall's points; Enter or a double click ends it, Escape drops it";
    case Drawing::prism:
      return "Click the outline's points; Enter or a double click closes it, Escape drops it";
  }
  return "";
}

glm::dvec2 EditTool::cursor(const PlanCamera& camera) const {
  const glm::dvec2 at = camera.to_world(ImGui::GetIO().MousePos);
  return ImGui::GetIO().KeyCtrl ? snapped(at, editing_->editor.grid) : at;
}

void EditTool::use(const Frame& frame, const PlanCamera& camera, bool hovered, ImDrawList& draw) {
  if (!frame.now.simulation) return;
  Editor& editor = editing_->editor;
  editor.follow(frame.now);
  ground_ = ground_height(frame.now.simulation->mission());
  time_ = frame.now.simulation->time();
  if (drag_ && drag_->solid >= editor.world().solids.size()) drag_.reset();
  if (!frame.still) {
    escape();
    if (!drag_) use_edit_keys(frame, *editing_);
    if (editing_->drawing == Drawing::wall || editing_->drawing == Drawing::prism) draw_points(frame, camera, hovered, draw);
    else if (editing_->drawing != Drawing::nothing) draw_new(frame, camera, hovered, draw);
    else if (drag_) drag(frame, camera, draw);
    else if (hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) press(frame, camera, camera.to_world(ImGui::GetIO().MousePos));
  }
  if (!drag_) show_selected(frame, camera, draw);
}

void EditTool::escape() {
  if (!ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false) || ImGui::GetIO().WantTextInput) return;
  if (!drag_ && points_.empty() && editing_->drawing == Drawing::nothing) return;
  // What is under way is dropped first, then what was to be drawn.
  if (!drag_ && points_.empty()) editing_->drawing = Drawing::nothing;
  drag_.reset();
  points_.clear();
  editing_->escape_frame = ImGui::GetFrameCount();
}

std::optional<Grip> EditTool::grip_under(const PlanCamera& camera, const Solid& solid, double time) const {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  for (const Grip& grip : grips(solid, time, static_cast<double>(turn_pixels) / camera.pixels_per_metre)) {
    const ImVec2 at = camera.to_screen(grip.at);
    if (std::hypot(at.x - mouse.x, at.y - mouse.y) <= grip_pixels + 2.0f) return grip;
  }
  return std::nullopt;
}

void EditTool::press(const Frame& frame, const PlanCamera& camera, const glm::dvec2& at) {
  const World& world = editing_->editor.world();
  const double time = frame.now.simulation->time();
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  auto& chosen = frame.desk.solid;
  if (chosen && *chosen < world.solids.size())
    if (const auto grip = grip_under(camera, world.solids[*chosen], time)) {
      drag_ = Drag{*chosen, world.solids[*chosen], *grip, mouse};
      return;
    }
  chosen = solid_at(world, at, time, ground_);
  if (chosen) drag_ = Drag{*chosen, world.solids[*chosen], {Grip::Kind::body, 0, at}, mouse};
}

Solid EditTool::dragged_now(const PlanCamera& camera, double time) const {
  const Solid& solid = drag_->before;
  const Grip& grip = drag_->grip;
  const glm::dvec2 mouse = camera.to_world(ImGui::GetIO().MousePos);
  const double grid = ImGui::GetIO().KeyCtrl ? editing_->editor.grid : 0.0;
  if (grip.kind == Grip::Kind::body) {
    // Its origin comes to lie on the grid, or on a whole millimetre.
    const glm::dvec2 place(standing_at(solid, time).position);
    return moved(solid, snapped(place + mouse - grip.at, grid > 0.0 ? grid : 0.001) - place);
  }
  if (grip.kind == Grip::Kind::turn && grid > 0.0) {
    const Standing standing = standing_at(solid, time);
    const double step = radians(15.0), wanted = std::round(bearing(mouse - glm::dvec2(standing.position)) / step) * step;
    return dragged(solid, grip, glm::dvec2(standing.position) + direction(wanted), time);
  }
  return dragged(solid, grip, snapped(mouse, grid), time);
}

void EditTool::drag(const Frame& frame, const PlanCamera& camera, ImDrawList& draw) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const bool moved_yet = std::hypot(mouse.x - drag_->from.x, mouse.y - drag_->from.y) > still_pixels;
  const double time = frame.now.simulation->time();
  if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    if (moved_yet) show(camera, dragged_now(camera, time), draw, frame.colours.selected);
    return;
  }
  if (moved_yet) {
    Solid after = dragged_now(camera, time);
    if (const auto fault = shape_fault(after.shape)) editing_->editor.message = *fault;
    else editing_->editor.replace(drag_->solid, std::move(after));
  }
  drag_.reset();
  post_edits(frame, *editing_);
}

std::optional<Solid> EditTool::drawn_now(const PlanCamera& camera, const std::vector<glm::dvec2>& points) const {
  const Editor& editor = editing_->editor;
  if (points.size() < 2) return std::nullopt;
  const double least = static_cast<double>(still_pixels) / camera.pixels_per_metre;
  switch (editing_->drawing) {
    case Drawing::nothing:
      return std::nullopt;
    case Drawing::box:
      if (std::min(std::abs(points[0].x - points[1].x), std::abs(points[0].y - points[1].y)) < least) return std::nullopt;
      return new_box(points[0], points[1], ground_, editor.new_height);
    case Drawing::sphere:
      if (glm::distance(points[0], points[1]) < least) return std::nullopt;
      return new_sphere(points[0], points[1], ground_);
    case Drawing::cylinder:
      if (glm::distance(points[0], points[1]) < least) return std::nullopt;
      return new_cylinder(points[0], points[1], ground_, editor.new_height);
    case Drawing::wall:
      return new_wall(points, ground_, editor.new_thickness, editor.new_height);
    case Drawing::prism:
      if (points.size() < 3) return std::nullopt;
      return new_prism(points, ground_, editor.new_height);
  }
  return std::nullopt;
}

void EditTool::add(const Frame& frame, const std::optional<Solid>& solid) {
  if (!solid) return;
  if (const auto fault = shape_fault(solid->shape)) {
    editing_->editor.message = *fault;
    return;
  }
  frame.desk.solid = editing_->editor.add(*solid);
  post_edits(frame, *editing_);
}

void EditTool::draw_new(const Frame& frame, const PlanCamera& camera, bool hovered, ImDrawList& draw) {
  if (hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) points_ = {cursor(camera)};
  if (points_.empty()) return;
  const auto solid = drawn_now(camera, {points_[0], cursor(camera)});
  if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    if (solid) show(camera, *solid, draw, frame.colours.selected);
    return;
  }
  points_.clear();
  add(frame, solid);
}

void EditTool::draw_points(const Frame& frame, const PlanCamera& camera, bool hovered, ImDrawList& draw) {
  const double least = static_cast<double>(still_pixels) / camera.pixels_per_metre;
  const glm::dvec2 at = cursor(camera);
  bool end = ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false) || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_KeyPadEnter), false);
  if (hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
    end = end || ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
    // The second click of a double click is where the first was.
    if (points_.empty() || glm::distance(points_.back(), at) > least) points_.push_back(at);
  }
  if (points_.empty()) return;
  if (end) {
    const auto solid = drawn_now(camera, points_);
    points_.clear();
    return add(frame, solid);
  }
  std::vector<glm::dvec2> next = points_;
  if (hovered && glm::distance(next.back(), at) > least) next.push_back(at);
  for (std::size_t i = 1; i < next.size(); ++i) draw.AddLine(camera.to_screen(next[i - 1]), camera.to_screen(next[i]), frame.colours.selected, 2.0f);
  if (editing_->drawing == Drawing::prism && next.size() > 2) draw.AddLine(camera.to_screen(next.back()), camera.to_screen(next.front()), frame.colours.faint, 1.0f);
  for (const glm::dvec2& p : points_) draw.AddCircleFilled(camera.to_screen(p), 3.5f, frame.colours.selected);
}

void EditTool::show(const PlanCamera& camera, const Solid& solid, ImDrawList& draw, ImU32 colour) const {
  for (const auto& ring : rings(solid, time_)) {
    std::vector<ImVec2> line;
    for (const glm::dvec2& p : ring) line.push_back(camera.to_screen(p));
    draw.AddPolyline(line.data(), static_cast<int>(line.size()), colour, ImDrawFlags_Closed, 2.0f);
  }
}

void EditTool::show_selected(const Frame& frame, const PlanCamera& camera, ImDrawList& draw) const {
  const World& world = editing_->editor.world();
  if (!frame.desk.solid || *frame.desk.solid >= world.solids.size()) return;
  const Solid& solid = world.solids[*frame.desk.solid];
  show(camera, solid, draw, frame.colours.selected);
  if (editing_->drawing != Drawing::nothing) return;
  const double reach = static_cast<double>(turn_pixels) / camera.pixels_per_metre;
  for (const Grip& grip : grips(solid, frame.now.simulation->time(), reach)) {
    const ImVec2 at = camera.to_screen(grip.at);
    if (grip.kind == Grip::Kind::turn) {
      draw.AddCircle(at, grip_pixels, frame.colours.selected, 16, 2.0f);
    } else {
      draw.AddRectFilled({at.x - 4.0f, at.y - 4.0f}, {at.x + 4.0f, at.y + 4.0f}, frame.colours.background);
      draw.AddRect({at.x - 4.0f, at.y - 4.0f}, {at.x + 4.0f, at.y + 4.0f}, frame.colours.selected, 0.0f, 0, 1.5f);
    }
  }
}

bool pressed(int key) { return ImGui::IsKeyPressed(key, false); }

}  // namespace

std::unique_ptr<PlanTool> make_edit_tool(std::shared_ptr<Editing> editing) { return std::make_unique<EditTool>(std::move(editing)); }

void use_edit_keys(const Frame& frame, Editing& editing) {
  const ImGuiIO& io = ImGui::GetIO();
  if (frame.still || io.WantTextInput || editing.keys_frame == ImGui::GetFrameCount()) return;
  editing.keys_frame = ImGui::GetFrameCount();
  Editor& editor = editing.editor;
  auto& chosen = frame.desk.solid;
  const bool have = chosen && *chosen < editor.world().solids.size();
  if (io.KeyCtrl && pressed(ImGui::GetKeyIndex(ImGuiKey_Z))) io.KeyShift ? editor.redo() : editor.undo();
  else if (io.KeyCtrl && pressed(ImGui::GetKeyIndex(ImGuiKey_Y))) editor.redo();
  else if (io.KeyCtrl && pressed('D') && have) chosen = editor.copy(*chosen, {0.5, -0.5});
  else if (pressed(ImGui::GetKeyIndex(ImGuiKey_Delete)) && have) {
    editor.erase(*chosen);
    chosen.reset();
  }
  post_edits(frame, editing);
}

void post_edits(const Frame& frame, Editing& editing) {
  if (auto world = editing.editor.take()) frame.post(ChangeWorld{std::move(*world)});
  if (frame.desk.solid && *frame.desk.solid >= editing.editor.world().solids.size()) frame.desk.solid.reset();
}

}  // namespace thicket::gui
