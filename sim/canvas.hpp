// A sheet to draw pictures on: Cairo behind the few calls that the pictures of the program need. Private to the room.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "thicket/base/result.hpp"

struct _cairo;
struct _cairo_surface;

namespace thicket {

struct Colour {
  double red = 0.0, green = 0.0, blue = 0.0, alpha = 1.0;
};

/// Which point of a text stands where it is put.
enum class Align : std::uint8_t { left, middle, right };

/// Pixels, x right, y down.
class Canvas {
 public:
  enum class Format : std::uint8_t { png, svg };
  Canvas(int width, int height, const Colour& background, Format format = Format::png);

  void rectangle(const glm::dvec2& corner, const glm::dvec2& size, const Colour& fill);
  void frame(const glm::dvec2& corner, const glm::dvec2& size, const Colour& line, double width);
  void polyline(const std::vector<glm::dvec2>& points, const Colour& line, double width, bool dashed = false);
  void disc(const glm::dvec2& centre, double radius, const Colour& fill);
  void circle(const glm::dvec2& centre, double radius, const Colour& line, double width);
  void cross(const glm::dvec2& centre, double size, const Colour& line, double width);
  void polygon(const std::vector<glm::dvec2>& points, const Colour& fill);
  /// Baseline at `at`; to its right, unless it is aligned otherwise.
  void text(const std::string& words, const glm::dvec2& at, double size, const Colour& colour, Align align = Align::left);
  /// Read from below to above, the middle of its baseline at `at`.
  void upward_text(const std::string& words, const glm::dvec2& at, double size, const Colour& colour);
  double text_width(const std::string& words, double size);
  /// An image of packed 0xAARRGGBB pixels, opaque, scaled without smoothing.
  void image(const std::vector<std::uint32_t>& pixels, int columns, int rows, const glm::dvec2& corner, double scale);

  /// Until `unclip`, nothing is drawn outside of this rectangle.
  void clip(const glm::dvec2& corner, const glm::dvec2& size);
  void unclip();

  /// In the canvas' format, written whole or not at all. Of an SVG this is the last call.
  Result<Done> write(const std::filesystem::path& file) const;

 private:
  std::shared_ptr<std::string> svg_;  ///< what Cairo has written so far; null for PNG
  std::shared_ptr<_cairo_surface> surface_;
  std::shared_ptr<_cairo> context_;
};

}  // namespace thicket
