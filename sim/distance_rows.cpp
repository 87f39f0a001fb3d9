#include "distance_rows.hpp"

#include <algorithm>

namespace thicket {

DistanceRows::DistanceRows(std::span<const std::uint8_t> marked, int width, int height)
    : width_(static_cast<std::size_t>(width)), height_(static_cast<std::size_t>(height)), along_column_(width_ * height_, -1), squares_(width_) {
  // All columns at once, a row at a time, so that memory is read in its order: up from marked cells, then down.
  const auto take = [&](std::size_t row, const std::int32_t* before) {
    std::int32_t* const here = along_column_.data() + row * width_;
    for (std::size_t x = 0; x < width_; ++x) {
      const std::int32_t next = before[x] < 0 ? -1 : before[x] + 1;
      if (next >= 0 && (here[x] < 0 || next < here[x])) here[x] = next;
    }
  };
  for (std::size_t i = 0; i < along_column_.size(); ++i) along_column_[i] = marked[i] ? 0 : -1;
  for (std::size_t row = 1; row < height_; ++row) take(row, along_column_.data() + (row - 1) * width_);
  for (std::size_t row = height_; row-- > 1;) take(row - 1, along_column_.data() + row * width_);
  envelope_.reserve(width_);
}

std::span<const std::int64_t> DistanceRows::squares(int row) {
  const std::int32_t* const up = along_column_.data() + static_cast<std::size_t>(row) * width_;
  const auto height = [up](std::int64_t column) { return std::int64_t{up[column]} * up[column]; };
  envelope_.clear();
  for (std::int64_t column = 0; column < static_cast<std::int64_t>(width_); ++column) {
    if (up[column] < 0) continue;
    // From which column on this one is at least as near as the last of the envelope: what that makes of no use falls out.
    std::int64_t from = 0;
    while (!envelope_.empty()) {
      const std::int64_t other = envelope_.back().column;
      const std::int64_t rise = height(column) + column * column - height(other) - other * other, run = 2 * (column - other);
      from = rise <= 0 ? 0 : (rise + run - 1) / run;
      if (from > envelope_.back().from) break;
      envelope_.pop_back();
      from = 0;
    }
    if (from < static_cast<std::int64_t>(width_)) envelope_.push_back({column, from});
  }
  if (envelope_.empty()) {
    std::fill(squares_.begin(), squares_.end(), none);
    return squares_;
  }
  std::size_t at = 0;
  for (std::int64_t x = 0; x < static_cast<std::int64_t>(width_); ++x) {
    while (at + 1 < envelope_.size() && envelope_[at + 1].from <= x) ++at;
    const std::int64_t across = x - envelope_[at].column;
    squares_[static_cast<std::size_t>(x)] = across * across + height(envelope_[at].column);
  }
  return squares_;
}

}  // namespace thicket
