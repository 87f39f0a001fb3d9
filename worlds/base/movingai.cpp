#include "thicket/base/movingai.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "printable.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/image.hpp"

namespace thicket {
namespace {

namespace fs = std::filesystem;

std::optional<CellState> state_of(char letter) {
  switch (letter) {
    case '.':
    case 'G':
    case 'S':
      return CellState::free;
    case '@':
    case 'O':
    case 'T':
    case 'W':
      return CellState::occupied;
    default:
      return std::nullopt;
  }
}

class MovingAiReader {
 public:
  MovingAiReader(const fs::path& file, std::string_view content) : file_(file), rest_(content) {}

  Result<GridMap> read(double cell_size) {
    if (!next_line() || line_ != "type octile") return fault(1, fmt::format("'{}', expected 'type octile'", printable(line_)));
    if (auto wrong = read_sizes()) return *wrong;
    GridMap map;
    map.width = static_cast<int>(width_);
    map.height = static_cast<int>(height_);
    map.resolution = cell_size;
    // Each cell is a byte of the file: a short file with a large header is broken, and is found out before memory is taken.
    if (rest_.size() < static_cast<std::size_t>(width_ * height_))
      return fault(1, fmt::format("truncated: {} bytes follow 'map', expected {} rows of {} letters", rest_.size(), height_, width_));
    map.cells.resize(static_cast<std::size_t>(width_ * height_));
    for (std::int64_t row = height_; row-- > 0;) {
      if (auto wrong = read_row(map.cells.data() + row * width_, height_ - row)) return *wrong;
    }
    while (next_line())
      if (!line_.empty()) return fault(1, fmt::format("'{}' after the last row, expected {} rows (height)", printable(line_), height_));
    return map;
  }

 private:
  /// `height` and `width` in either order, up to the line `map`.
  std::optional<Error> read_sizes() {
    while (true) {
      if (!next_line()) return fault(1, fmt::format("the file ends, expected '{}'", missing()));
      if (line_ == "map") break;
      const auto gap = line_.find(' ');
      const std::string_view key = line_.substr(0, gap);
      if (key != "height" && key != "width") return fault(1, fmt::format("'{}', expected '{}'", printable(line_), missing()));
      std::int64_t& size = key == "height" ? height_ : width_;
      if (size > 0) return fault(1, fmt::format("'{}' is there twice, expected once", key));
      const std::string_view word = gap == line_.npos ? std::string_view{} : line_.substr(gap + 1);
      const auto [stop, failure] = std::from_chars(word.data(), word.data() + word.size(), size);
      if (failure != std::errc{} || stop != word.data() + word.size() || size < 1 || size > max_image_pixels)
        return fault(key.size() + 2, fmt::format("the {} is '{}', expected a whole number from 1 to {}", key, printable(word), max_image_pixels));
    }
    if (height_ == 0 || width_ == 0) return fault(1, fmt::format("'map', expected '{}' before it", missing()));
    if (width_ > max_image_pixels / height_) return fault(1, fmt::format("the size is {} x {}, expected at most {} cells", width_, height_, max_image_pixels));
    return std::nullopt;
  }
  const char* missing() const { return height_ == 0 ? "height N" : width_ == 0 ? "width N" : "map"; }

  std::optional<Error> read_row(CellState* cells, std::int64_t number) {
    if (!next_line()) return fault(1, fmt::format("the file ends before row {}, expected {} rows (height)", number, height_));
    for (std::size_t i = 0; i < line_.size() && i < static_cast<std::size_t>(width_); ++i) {
      const auto state = state_of(line_[i]);
      if (!state) return fault(i + 1, fmt::format("'{}' in row {}, expected one of . G S (passable), @ O T W (not)", printable(line_.substr(i, 1)), number));
      cells[i] = *state;
    }
    if (line_.size() != static_cast<std::size_t>(width_))
      return fault(std::min(line_.size(), static_cast<std::size_t>(width_)) + 1, fmt::format("row {} has {} letters, expected {} (width)", number, line_.size(), width_));
    return std::nullopt;
  }

  bool next_line() {
    ++number_;
    line_ = {};
    if (rest_.empty()) return false;
    const auto end = rest_.find('\n');
    line_ = rest_.substr(0, end);
    rest_.remove_prefix(end == rest_.npos ? rest_.size() : end + 1);
    while (!line_.empty() && (line_.back() == '\r' || line_.back() == ' ')) line_.remove_suffix(1);
    return true;
  }

  Error fault(std::size_t column, std::string_view what) const { return Error{fmt::format("{}:{}:{}: {}", file_.string(), number_, column, what)}; }

  const fs::path& file_;
  std::string_view rest_, line_;
  int number_ = 0;
  std::int64_t height_ = 0, width_ = 0;
};

}  // namespace

Result<GridMap> read_movingai_map(const fs::path& file, double cell_size) {
  if (!std::isgreaterequal(cell_size, least_cell_m) || !std::islessequal(cell_size, largest_cell_m))
    return Error{fmt::format("{}: the cell size is {} m, expected {} to {}", file.string(), cell_size, least_cell_m, largest_cell_m)};
  const auto content = read_text_file(file);
  if (!content) return content.error();
  return MovingAiReader(file, *content).read(cell_size);
}

Result<Done> write_movingai_map(const fs::path& file, const GridMap& map) {
  const auto count = static_cast<std::size_t>(std::max(map.width, 0)) * static_cast<std::size_t>(std::max(map.height, 0));
  if (count == 0 || map.cells.size() != count)
    return Error{fmt::format("{}: the map has {} cells, expected {} x {}, at least 1 x 1", file.string(), map.cells.size(), map.width, map.height)};
  std::string text = fmt::format("type octile\nheight {}\nwidth {}\nmap\n", map.height, map.width);
  text.reserve(text.size() + count + static_cast<std::size_t>(map.height));
  for (int row = map.height - 1; row >= 0; --row) {
    for (int column = 0; column < map.width; ++column) text += map.at(column, row) == CellState::free ? '.' : '@';
    text += '\n';
  }
  return write_file(file, text);
}

}  // namespace thicket
