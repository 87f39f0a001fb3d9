#include "space_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "axes.hpp"

namespace thicket::gui {

void SpaceView::choose(const Simulation& simulation, ImVec2 size) {
  if (ImGui::Button("fit (F)")) camera.fit(simulation.scene().world(), static_cast<int>(size.x), static_cast<int>(size.y));
  for (const auto& [text, flag] : {std::pair{"follow", &follow_}, {"rays", &rays_}, {"echoes", &echoes_}, {"trail", &trail_}, {"robot", &robot_}}) {
    ImGui::SameLine();
    ImGui::Checkbox(text, flag);
  }
  ImGui::SameLine();
  ImGui::TextDisabled("%s", image_ && !image_->finest ? "drawing..." : "");
}

void SpaceView::move_camera(const Simulation& simulation, ImVec2 size, bool hovered, bool active) {
  const ImGuiIO& io = ImGui::GetIO();
  if (active && ImGui::IsMouseDragging(0, 0.0f)) camera.turn(radians(-0.4 * static_cast<double>(io.MouseDelta.x)), radians(0.4 * static_cast<double>(io.MouseDelta.y)));
  else if (active && (ImGui::IsMouseDragging(1, 0.0f) || ImGui::IsMouseDragging(2, 0.0f))) camera.pan(static_cast<double>(io.MouseDelta.x), static_cast<double>(io.MouseDelta.y), static_cast<int>(size.x));
  if (hovered && io.MouseWheel != 0.0f) camera.zoom(std::pow(0.85, static_cast<double>(io.MouseWheel)));
  if (hovered && !io.WantTextInput && ImGui::IsKeyPressed('F', false)) camera.fit(simulation.scene().world(), static_cast<int>(size.x), static_cast<int>(size.y));
}

/// A click that did not turn the camera selects, and twice sets the goal: on what is there, or else at the robot's height.
void SpaceView::click(const Frame& frame, const PictureView& view, ImVec2 low, ImVec2 high) const {
  const ImGuiIO& io = ImGui::GetIO();
  const bool twice = ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left), once = ImGui::IsMouseReleased(ImGuiMouseButton_Left) && io.MouseDragMaxDistanceSqr[0] < 16.0f;
  if (!once && !twice) return;
  const double u = 2.0 * static_cast<double>((io.MousePos.x - low.x) / (high.x - low.x)) - 1.0, v = 1.0 - 2.0 * static_cast<double>((io.MousePos.y - low.y) / (high.y - low.y));
  const Simulation& s = *frame.now.simulation;
  const auto picked = pick_in_space(s.scene(), view, u, v);
  if (once && !twice) frame.desk.solid = picked ? std::optional(picked->solid) : std::nullopt;
  if (!twice) return;
  if (picked) return frame.post(SetGoal{glm::dvec2(picked->point)});
  const PictureCamera eye(view);
  const glm::dvec3 along = eye.direction(u, v);
  const double ahead = (s.vehicle_pose().position.z - eye.from.z) / along.z;
  if (std::isfinite(ahead) && ahead > 0.0) frame.post(SetGoal{glm::dvec2(eye.from + ahead * along)});
}

void SpaceView::draw(const Frame& frame) {
  if (!frame.now.simulation) return ImGui::TextUnformatted("Nothing is open.");
  const Simulation& s = *frame.now.simulation;
  const ImVec2 all = ImGui::GetContentRegionAvail();
  const float bar = ImGui::GetFrameHeightWithSpacing();
  const ImVec2 size{std::max(16.0f, std::floor(all.x)), std::max(16.0f, std::floor(all.y - (frame.still ? 0.0f : bar)))};
  if (!frame.still) choose(s, size);
  if (!fitted_ || file_ != frame.now.file) {
    camera.fit(s.scene().world(), static_cast<int>(size.x), static_cast<int>(size.y));
    file_ = frame.now.file;
    fitted_ = true;
  }
  const ImVec2 low = ImGui::GetCursorScreenPos(), high{low.x + size.x, low.y + size.y};
  ImGui::InvisibleButton("space", size, ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle);
  const bool hovered = ImGui::IsItemHovered() && !frame.still;
  if (!frame.still) move_camera(s, size, hovered, ImGui::IsItemActive());
  if (follow_) camera.at = s.vehicle_pose().position;

  const PictureView view = camera.view(static_cast<int>(size.x), static_cast<int>(size.y));
  if (frame.still) {
    image_ = render_.now(s.scene(), view);
  } else {
    render_.ask(s.scene(), view);
    image_ = render_.newest();
  }
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.PushClipRect(low, high, true);
  show_image(frame, low, high);
  // With the picture's own camera, which may be a moment late: lines and surfaces belong together.
  Overlay overlay(draw, low, high, image_ ? image_->view : view, image_.get());
  draw_run(frame, {rays_, echoes_, trail_, robot_}, overlay);
  const World& world = s.scene().world();
  if (frame.desk.solid && *frame.desk.solid < world.solids.size()) draw_outline(world.solids[*frame.desk.solid], s.time(), frame.colours.selected | IM_COL32_A_MASK, overlay);
  if (hovered) click(frame, image_ ? image_->view : view, low, high);
  if (hovered) read_out(frame, low, high);
  draw.PopClipRect();
}

void SpaceView::show_image(const Frame& frame, ImVec2 low, ImVec2 high) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(low, high, frame.colours.background);
  if (!image_) return;
  // A texture of each size that there is, so that none is made anew all the time.
  const std::string name = image_->width == image_->view.width ? "space" : "space, coarse";
  bool fresh = false;
  const ImTextureID texture = frame.textures.get(name, image_->width, image_->height, fresh);
  if (fresh || uploaded_ != image_->number) {
    frame.textures.update(name, 0, 0, image_->width, image_->height, image_->pixels.data());
    uploaded_ = image_->number;
  }
  if (texture) draw.AddImage(texture, low, high);
}

void SpaceView::read_out(const Frame& frame, ImVec2 low, ImVec2 high) const {
  if (!image_ || ImGui::IsMouseDown(0) || ImGui::IsMouseDown(1) || ImGui::IsMouseDown(2)) return;
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const double u = 2.0 * static_cast<double>((mouse.x - low.x) / (high.x - low.x)) - 1.0, v = 1.0 - 2.0 * static_cast<double>((mouse.y - low.y) / (high.y - low.y));
  const double depth = static_cast<double>(image_->depth_at(u, v));
  if (!std::isfinite(depth)) return;
  const PictureCamera eye(image_->view);
  const glm::dvec3 point = eye.from + depth * eye.direction(u, v);
  label(frame, {low.x + 6.0f, high.y - 1.5f * ImGui::GetTextLineHeight()}, fmt::format("({:.2f}, {:.2f}, {:.2f}) m, {:.2f} m from the camera", point.x, point.y, point.z, depth), frame.colours.text);
}

std::unique_ptr<View> make_space_view() { return std::make_unique<SpaceView>(); }

}  // namespace thicket::gui
