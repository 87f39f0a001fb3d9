// Lines and points in space over a picture of a world; what is behind the picture's surfaces is faint. Private to the room.
#pragma once

#include <optional>

#include "../view.hpp"
#include "world_render.hpp"

namespace thicket::gui {

class Overlay {
 public:
  /// `image`: whose distances hide what is behind; null: nothing is hidden.
  Overlay(ImDrawList& draw, ImVec2 low, ImVec2 high, const PictureView& view, const WorldImage* image) : draw_(draw), low_(low), high_(high), camera_(view), image_(image) {}

  void line(const glm::dvec3& from, const glm::dvec3& to, ImU32 colour, float width = 1.0f);
  void point(const glm::dvec3& at, ImU32 colour, float radius);
  /// Level, about its centre.
  void circle(const glm::dvec3& centre, double radius, ImU32 colour, float width = 1.0f);
  void text(const glm::dvec3& at, ImU32 colour, const char* words);

  /// On the screen; nothing for what is not ahead.
  std::optional<ImVec2> place(const glm::dvec3& point) const;
  bool hidden(const glm::dvec3& point) const;

 private:
  static ImU32 faint(ImU32 colour);
  ImVec2 on_screen(const glm::dvec3& seen) const;

  ImDrawList& draw_;
  ImVec2 low_, high_;
  PictureCamera camera_;
  const WorldImage* image_;
};

}  // namespace thicket::gui
