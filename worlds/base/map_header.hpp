// The YAML of a map_server map, as read and as written. Not a public header.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include <glm/vec2.hpp>

#include "thicket/base/image.hpp"
#include "thicket/base/result.hpp"

namespace thicket {

/// What map_saver writes: 0, 254 and 205 come back as the states they were. (With a free_thresh of 0.25 the unknown 205 would be free.)
inline constexpr double saved_occupied_thresh = 0.65, saved_free_thresh = 0.196;

struct MapHeader {
  std::string image;
  std::string image_place, origin_place;  ///< `file:line:column`, for messages
  std::string mode = "trinary";           ///< or scale, raw
  double resolution = 1.0;                ///< m
  std::array<double, 3> origin{};         ///< x, y, yaw: m, rad
  bool negate = false;
  double occupied_thresh = saved_occupied_thresh;
  double free_thresh = saved_free_thresh;
};

/// All faults of the file in one error, a line each.
Result<MapHeader> read_map_header(const std::filesystem::path& yaml, bool image_needed);

/// The image that the header names, or the other one where that is not empty.
Result<GreyImage> read_map_image(const std::filesystem::path& yaml, const MapHeader& header, const std::filesystem::path& image_override);

/// Where a map lies, and how many cells it holds.
struct MapFrame {
  int width = 0, height = 0;
  std::size_t cells = 0;
  double resolution = 0.0;  ///< m
  glm::dvec2 origin{0.0};   ///< m
  double yaw = 0.0;         ///< rad
};

/// Why a map cannot be written, or nothing: what would not be read again is not written.
std::optional<std::string> unwritable(const MapFrame& map);

/// Writes `stem`.yaml that names the image, which lies beside it: thresholds 0.65 and 0.196, resolution and origin with all their digits.
Result<Done> write_map_header(const std::filesystem::path& stem, const std::filesystem::path& image, std::string_view mode, const MapFrame& map);

}  // namespace thicket
