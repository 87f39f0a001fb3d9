// A shaded picture of a world, made with the simulator's own rays: what a radar meets is what is drawn.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "thicket/base/result.hpp"
#include "thicket/worlds/scene.hpp"

namespace thicket {

/// Where the camera is and what it shows. Metres; what is not given is chosen so that the whole world is seen from the south-west, above.
struct PictureView {
  std::optional<glm::dvec3> from, at;  ///< the camera, and the point in the middle of the picture; not the same
  double fov_deg = 50.0;               ///< the horizontal opening, 1 to 150
  int width = 960, height = 600;       ///< pixels, 1 to `largest_picture_side`
  std::vector<std::string> hide;       ///< solids that are left out, by name; "oak" also means "oak 3" and "oak/leaves". A ceiling is, too, if the camera is above it.
};

inline constexpr int largest_picture_side = 8192;

/// The camera that `view` asks for, with both points given. Floor and ceiling do not count for the fit.
PictureView fitted(const World& world, const PictureView& view);

/// Draws the world as it stands at the scene's time and writes a PNG. Four rays a pixel and four to the sun; colours by the names of materials (a material "red_paint" is red) and
/// else by a hash of the name; what light or robots pass is translucent. The bytes do not depend on the number of threads.
/// Errors: a view out of its ranges, a name in `hide` that no solid has, a file that cannot be written.
Result<Done> draw_world(const Scene& scene, const PictureView& view, const std::filesystem::path& file);

}  // namespace thicket
