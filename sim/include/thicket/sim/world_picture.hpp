// A shaded picture of a world, made with the simulator's own rays: what a radar meets is what is drawn.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
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

/// What a picture is about: the stated bounds, or the solids, without floor and ceiling.
Bounds picture_subject(const World& world);

/// The camera that `view` asks for, with both points given. Floor and ceiling do not count for the fit.
PictureView fitted(const World& world, const PictureView& view);

/// A pinhole: where the points of a world are in its picture.
struct PictureCamera {
  glm::dvec3 from, forward, right, up;
  double half_width = 1.0, half_height = 1.0;  ///< of the picture, at distance 1

  /// Of a view with both points given.
  explicit PictureCamera(const PictureView& view);
  /// u and v in -1...1, from the left and the bottom.
  glm::dvec3 direction(double u, double v) const;
  /// (u, v, how far ahead, m); what is not ahead is not in the picture.
  glm::dvec3 seen(const glm::dvec3& point) const;
};

/// Which solids `view`, with both points given, leaves out. Errors: a name that no solid has.
Result<std::vector<bool>> hidden_solids(const World& world, const PictureView& view);
/// The scene without some of its solids; a copy if that is none.
Result<Scene> without(const Scene& scene, const std::vector<bool>& hidden);

/// Paints row after row, for a window that wants a picture bit by bit. Rows do not depend on each other and may be painted by many threads at once.
class WorldPainter {
 public:
  /// All of `scene` is painted; `view` has both points given.
  WorldPainter(Scene scene, const PictureView& view, const Bounds& subject);
  const PictureView& view() const;
  /// `samples`: rays a pixel, 1 or 4. Pixels are 0xAARRGGBB.
  void paint_row(int row, int samples, std::uint32_t* pixels) const;
  /// The distance from the camera, along the ray through the middle of each pixel, of the surface that hides what is behind, m; +inf: none.
  void measure_row(int row, float* depth) const;

 private:
  class Painter;
  std::shared_ptr<const Painter> painter_;
};

/// The world as it stands at the scene's time, row by row from the top, as `WorldPainter` has it, with its distances if `depth` is given. Neither depends on the number of threads.
/// Errors: a view out of its ranges, a name in `hide` that no solid has, other samples than 1 and 4.
Result<Done> draw_world_pixels(const Scene& scene, const PictureView& view, int samples, std::vector<std::uint32_t>& pixels, std::vector<float>* depth = nullptr);

/// Draws the world as it stands at the scene's time and writes a PNG. Four rays a pixel and four to the sun; colours by the names of materials (a material "red_paint" is red) and
/// else by a hash of the name; what light or robots pass is translucent. The bytes do not depend on the number of threads.
/// Errors: a view out of its ranges, a name in `hide` that no solid has, a file that cannot be written.
Result<Done> draw_world(const Scene& scene, const PictureView& view, const std::filesystem::path& file);

}  // namespace thicket
