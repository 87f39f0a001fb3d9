// A picture in colours, and its PNG.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "thicket/base/result.hpp"

namespace thicket::gui {

/// Red, green, blue; row by row from the top.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;

  const std::uint8_t* at(int x, int y) const { return &rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x))]; }
};

/// Written whole or not at all. The same picture gives the same bytes.
Result<Done> write_picture(const std::filesystem::path& file, const Picture& picture);

}  // namespace thicket::gui
