#include "orbit.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "thicket/base/pose.hpp"

namespace thicket::gui {

PictureView Orbit::view(int width, int height) const {
  PictureView view;
  view.at = at;
  view.from = at + distance * glm::dvec3(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
  view.fov_deg = fov_deg;
  view.width = std::clamp(width, 1, largest_picture_side);
  view.height = std::clamp(height, 1, largest_picture_side);
  return view;
}

void Orbit::turn(double sideways, double upward) {
  azimuth = wrap_angle(azimuth + sideways);
  elevation = std::clamp(elevation + upward, radians(-89.0), radians(89.0));
}

void Orbit::pan(double x, double y, int width) {
  const PictureCamera camera(view(width, width));
  const double metres = 2.0 * camera.half_width * distance / width;
  at += metres * (-x * camera.right + y * camera.up);
}

void Orbit::zoom(double factor) { distance = std::clamp(distance * factor, 0.05, 1e6); }

void Orbit::fit(const World& world, int width, int height) {
  PictureView wanted;
  wanted.fov_deg = fov_deg;
  wanted.width = std::clamp(width, 1, largest_picture_side);
  wanted.height = std::clamp(height, 1, largest_picture_side);
  const PictureView full = fitted(world, wanted);
  const glm::dvec3 back = *full.from - *full.at;
  at = *full.at;
  distance = glm::length(back);
  azimuth = std::atan2(back.y, back.x);
  elevation = std::asin(std::clamp(back.z / distance, -1.0, 1.0));
}

}  // namespace thicket::gui
