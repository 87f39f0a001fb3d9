// What all views share. Private to the room.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <glm/vec2.hpp>
#include <imgui.h>

#include "thicket/gui/runner.hpp"

namespace thicket::gui {

/// Colours, safe for colour-blind eyes (after Okabe & Ito 2008), for dark or light.
struct Palette {
  bool dark = true;
  ImU32 background, grid, grid_text, text, faint;
  ImU32 robot, robot_edge, estimate, trail, start, goal, mark, contact;
  ImU32 ray, ray_through, side_left, side_right, echo, lobe, lidar;
  ImU32 pressed, released, unseen, clearance;
  ImU32 selected, warning;
};
Palette palette(bool dark);

/// Pictures on the graphics card, by name; without a card they do nothing, and views do not know.
class Textures {
 public:
  virtual ~Textures() = default;
  /// The texture of that name and size; another size makes it anew, with undefined contents. `fresh` tells so.
  virtual ImTextureID get(const std::string& name, int width, int height, bool& fresh) = 0;
  /// Pixels are 0xAABBGGRR, row by row from the top.
  virtual void update(const std::string& name, int x, int y, int width, int height, const std::uint32_t* pixels) = 0;
};

struct Frame;

/// A key of a view's own, for who asks what keys there are.
struct ViewKey {
  const char* key;
  const char* help;
};

/// One view: draws itself into the current ImGui window (or child), all of its content region.
class View {
 public:
  virtual ~View() = default;
  virtual const char* name() const = 0;  ///< "World"; also the name for `thicket render --view`, in small letters
  virtual void draw(const Frame& frame) = 0;
  /// What it does with keys while the mouse is over it.
  virtual std::span<const ViewKey> own_keys() const { return {}; }
};

/// A plan seen from above: where points of the world are on the screen.
struct PlanCamera {
  glm::dvec2 centre{0.0, 0.0};     ///< of the view, m
  double pixels_per_metre = 40.0;
  double up = 0.0;                 ///< rad: the bearing of the world that is right on the screen; 0: north is up
  ImVec2 low{0.0f, 0.0f}, size{1.0f, 1.0f};  ///< of the view on the screen

  ImVec2 to_screen(const glm::dvec2& point) const;
  glm::dvec2 to_world(const ImVec2& point) const;
  /// Shows a rectangle of the world with a margin.
  void fit(const glm::dvec2& lower, const glm::dvec2& upper);
  /// By a factor, the point under the cursor stays where it is.
  void zoom(double factor, const ImVec2& cursor);
};

/// What clicks in the plan do. The world view has one tool at a time, and asks it after its own panning and zooming.
class PlanTool {
 public:
  virtual ~PlanTool() = default;
  virtual const char* name() const = 0;
  virtual const char* help() const = 0;  ///< a sentence for the status line
  /// Called every frame while the tool is chosen, `hovered` if the cursor is over the plan and no button of the view; it may draw over the plan.
  virtual void use(const Frame& frame, const PlanCamera& camera, bool hovered, ImDrawList& draw) = 0;
};

/// What views know of each other.
struct Desk {
  std::optional<std::uint32_t> solid;  ///< that is selected, of the snapshot's world
  std::unique_ptr<PlanTool> tool;      ///< of the world view; null: it pans
};

/// What a view may ask for while it is drawn.
struct Frame {
  const Snapshot& now;
  const Palette& colours;
  Textures& textures;
  Desk& desk;
  std::function<void(Action)> post;
  double scale = 1.0;  ///< of HiDPI screens
  bool still = false;  ///< a picture without a person: everything must be there at once, nothing follows the mouse
};

std::unique_ptr<View> make_world_view();
std::unique_ptr<View> make_map_view();
std::unique_ptr<View> make_radar_view();
std::unique_ptr<View> make_sar_view();
std::unique_ptr<View> make_space_view();
std::unique_ptr<View> make_planner_view();
std::unique_ptr<View> make_plots_view();
std::unique_ptr<View> make_profiler_view();
/// The mission's keys as a form, and saving it.
std::unique_ptr<View> make_mission_view();
/// The world's solids as a list, and their keys; adding, copying, deleting, undo, saving.
std::unique_ptr<View> make_edit_view();

}  // namespace thicket::gui
