// Exact Euclidean distances of the cells of a raster from marked ones, row by row. Private to the room.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace thicket {

/// The distance of every cell from the nearest marked one, between their middles, in integers: no rounding. Meijster, Roerdink & Hesselink 2000 in the lower-envelope form of Felzenszwalb &
/// Huttenlocher 2012: columns first, then rows, in time proportional to the number of cells however far away the marked ones are. Holds 4 bytes a cell; rows are made when they are asked for.
class DistanceRows {
 public:
  static constexpr std::int64_t none = -1;

  /// `marked`: not 0 where a cell is, row by row, width * height of them.
  DistanceRows(std::span<const std::uint8_t> marked, int width, int height);

  /// Squared distances of the cells of a row, in cells; `none` everywhere if no cell of the raster is marked. Good until the next call.
  std::span<const std::int64_t> squares(int row);

 private:
  std::size_t width_, height_;
  std::vector<std::int32_t> along_column_;  ///< cells to the nearest marked one of the same column; -1: it has none
  std::vector<std::int64_t> squares_;
  struct Parabola {
    std::int64_t column, from;  ///< nearest for columns from here on
  };
  std::vector<Parabola> envelope_;
};

}  // namespace thicket
