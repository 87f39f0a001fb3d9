// Grey images as maps need them, and the three formats they come in.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "thicket/base/result.hpp"

namespace thicket {

/// A grey image with 8 bits a pixel. `pixels[row * width + column]`, row 0 at the top, 0 black, 255 white.
/// `alpha` is empty (opaque), or has one value a pixel (0 transparent).
struct GreyImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;
  std::vector<std::uint8_t> alpha;

  std::uint8_t at(int column, int row) const {
    return pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)];
  }
};

/// The largest image that is read: 2^28 pixels. A larger header is refused before memory is taken.
inline constexpr std::int64_t max_image_pixels = std::int64_t{1} << 28;

/// Reads PGM (P5 or P2, 8 or 16 bits, comments allowed; other maxima are scaled to 255) or PNG (any colour type;
/// colours become the mean of red, green and blue, as map_server does it). The format is told by the file's first bytes, not by its name.
/// Errors name the file and say what was expected; a truncated file is an error.
Result<GreyImage> read_image(const std::filesystem::path& file);

/// Writes binary PGM (P5, maximum 255); alpha is not written. Written to a temporary name and renamed.
Result<Done> write_pgm(const std::filesystem::path& file, const GreyImage& image);

/// Writes an 8-bit grey PNG (grey + alpha where there is alpha). Written to a temporary name and renamed.
Result<Done> write_png(const std::filesystem::path& file, const GreyImage& image);

}  // namespace thicket
