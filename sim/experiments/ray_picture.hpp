// What a scanning sensor looked at and what it read, over the plan of the world, from above. Private to sim/experiments.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "thicket/base/result.hpp"
#include "thicket/scan/scan.hpp"
#include "thicket/worlds/scene.hpp"

namespace thicket {

struct RayPanel {
  std::string title;
  const Scene* scene = nullptr;
  glm::dvec2 position{0.0};  ///< of the sensor, m
  double yaw = 0.0;          ///< of the sensor, rad
  std::vector<Scan> scans;   ///< drawn over each other
  bool rays = false;         ///< each beam as a line to where it sensed last, red the left side rays and blue the right ones; else the area that was sensed
  double side_angle = 0.0, side_shift = 0.0;  ///< how far a side ray turns away from its beam, rad, or stands beside it, m
};

struct RayPicture {
  glm::dvec2 low{0.0}, high{0.0};  ///< what is shown, m
  double height = 0.4;             ///< at which the world is cut, m
  double scale = 20.0;             ///< pixels per metre
  int columns = 2;                 ///< panels a row
  double hull_radius = 0.0;        ///< of a robot about each sensor, m; 0: none
  std::vector<RayPanel> panels;
};

/// PNG. The same picture gives the same bytes. Errors: of the file, and of a plan that is too large.
Result<Done> write_ray_picture(const std::filesystem::path& file, const RayPicture& picture);

}  // namespace thicket
