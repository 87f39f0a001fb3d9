// A camera that goes around what it looks at. Private to the room.
#pragma once

#include "thicket/sim/world_picture.hpp"

namespace thicket::gui {

struct Orbit {
  glm::dvec3 at{0.0};       ///< what it looks at
  double distance = 10.0;   ///< from there, m
  double azimuth = 0.0, elevation = 0.7;  ///< of the camera seen from there, rad
  double fov_deg = 50.0;    ///< horizontal

  PictureView view(int width, int height) const;
  /// By so many radians; never quite to the poles.
  void turn(double sideways, double upward);
  /// What is `at` moves by so many pixels of a view so wide.
  void pan(double x, double y, int width);
  void zoom(double factor);
  /// All of a world, from the south-west, above.
  void fit(const World& world, int width, int height);
};

}  // namespace thicket::gui
