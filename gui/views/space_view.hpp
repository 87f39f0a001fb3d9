// The 3D view's class, for its maker and its tests. Private to the room.
#pragma once

#include "orbit.hpp"
#include "overlay.hpp"

namespace thicket::gui {

class SpaceView final : public View {
 public:
  const char* name() const override { return "3D"; }
  void draw(const Frame& frame) override;
  std::span<const ViewKey> own_keys() const override {
    static constexpr ViewKey list[] = {{"F", "fit"}, {"click", "select a solid (and edit it under Edit)"}, {"double click", "the goal is there"}};
    return list;
  }

  Orbit camera;
  const WorldImage* image() const { return image_.get(); }  ///< what was drawn last

 private:
  void choose(const Simulation& simulation, ImVec2 size);
  void move_camera(const Simulation& simulation, ImVec2 size, bool hovered, bool active);
  void show_image(const Frame& frame, ImVec2 low, ImVec2 high);
  void click(const Frame& frame, const PictureView& view, ImVec2 low, ImVec2 high) const;
  void read_out(const Frame& frame, ImVec2 low, ImVec2 high) const;

  WorldRender render_;
  std::shared_ptr<const WorldImage> image_;
  std::uint64_t uploaded_ = 0;
  std::filesystem::path file_;
  bool fitted_ = false, follow_ = false;
  bool rays_ = true, echoes_ = true, trail_ = true, robot_ = true;
};

/// What the camera's ray meets first of what the view shows.
struct Picked {
  std::uint32_t solid = 0;
  glm::dvec3 point{0.0};
};
/// u and v in -1...1, from the left and the bottom; nothing: sky.
std::optional<Picked> pick_in_space(const Scene& scene, const PictureView& view, double u, double v);
/// The edges of a solid at a time, s; of a mesh those of the box around it.
void draw_outline(const Solid& solid, double time, ImU32 colour, Overlay& overlay);

/// What is known of a run, drawn in space.
struct SpaceLayers {
  bool rays = true, echoes = true, trail = true, robot = true;
};
void draw_run(const Frame& frame, const SpaceLayers& layers, Overlay& overlay);

}  // namespace thicket::gui
