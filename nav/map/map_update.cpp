// Changed cells in few bytes. The format: "TMU1", the resolution (double, little-endian), then for each cell that changed, tile after tile and row after row: how far it is from the last one (rows and columns,
// variable-length), and what it is. Runs of cells side by side in a row with the same value are one entry.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string_view>

#include "cells.hpp"
#include "sensor_model.hpp"
#include "view_memory.hpp"

namespace thicket {
namespace {

constexpr std::string_view magic = "TMU1";
constexpr double per_nat = 32.0;

/// Seven bits a byte, the sign in the lowest bit.
void put_number(std::vector<std::uint8_t>& bytes, std::int64_t number) {
  auto left = static_cast<std::uint64_t>(number) << 1 ^ static_cast<std::uint64_t>(number >> 63);
  for (; left >= 0x80; left >>= 7) bytes.push_back(static_cast<std::uint8_t>(left | 0x80));
  bytes.push_back(static_cast<std::uint8_t>(left));
}

bool take_number(std::span<const std::uint8_t>& bytes, std::int64_t& number) {
  std::uint64_t whole = 0;
  for (int shift = 0; shift < 64; shift += 7) {
    if (bytes.empty()) return false;
    const std::uint8_t byte = bytes.front();
    bytes = bytes.subspan(1);
    whole |= std::uint64_t{byte & 0x7fu} << shift;
    if (byte < 0x80) {
      number = static_cast<std::int64_t>(whole >> 1) ^ -static_cast<std::int64_t>(whole & 1);
      return true;
    }
  }
  return false;
}

/// A cell in a number: log-odds and, in the lowest bit, sensed through.
std::int64_t number_of(const CellView& view) { return std::llround(per_nat * std::log(view.probability / (1.0 - view.probability))) * 2 + view.sensed_through; }

struct Run {
  CellIndex first;
  std::int64_t cells = 0, what = 0;
};

}  // namespace

std::vector<std::uint8_t> OccupancyMap::changes_since(const OccupancyMap& earlier) const {
  std::vector<std::uint8_t> bytes(magic.begin(), magic.end());
  bytes.resize(magic.size() + sizeof(double));
  std::memcpy(bytes.data() + magic.size(), &spec_.resolution_m, sizeof(double));
  CellIndex last;
  Run run;
  const auto end_run = [&] {
    if (run.cells == 0) return;
    put_number(bytes, run.first.row - last.row);
    put_number(bytes, run.first.column - last.column);
    put_number(bytes, run.cells);
    put_number(bytes, run.what);
    last = {run.first.column + run.cells, run.first.row};
    run.cells = 0;
  };
  const bool same_kind = spec_.store == earlier.spec_.store && spec_.cell_bits == earlier.spec_.cell_bits;
  cells_->each(same_kind ? earlier.cells_.get() : nullptr, [&](const CellIndex& cell, const CellView& view) {
    const std::int64_t what = number_of(view);
    const CellView before = earlier.view(cell);
    if (before.known && number_of(before) == what) return;
    if (run.cells > 0 && run.what == what && cell.row == run.first.row && cell.column == run.first.column + run.cells) {
      ++run.cells;
      return;
    }
    end_run();
    run = {cell, 1, what};
  });
  end_run();
  return bytes;
}

void OccupancyMap::changed_tiles(const OccupancyMap* other, const std::function<void(const CellIndex&, std::span<const CellLook>)>& use) const {
  static_assert(tile_cells_across == tile_size);
  const bool same_kind = other && spec_.store == other->spec_.store && spec_.cell_bits == other->spec_.cell_bits && spec_.resolution_m == other->spec_.resolution_m && spec_.clamp_low == other->spec_.clamp_low;
  cells_->changed_tiles(same_kind ? other->cells_.get() : nullptr, use);
}

Result<Done> OccupancyMap::apply_changes(std::span<const std::uint8_t> changes) {
  double resolution = 0.0;
  if (changes.size() < magic.size() + sizeof(double) || !std::equal(magic.begin(), magic.end(), changes.begin())) return Error{"these bytes are no update of a map, expected those of changes_since"};
  std::memcpy(&resolution, changes.data() + magic.size(), sizeof(double));
  if (resolution != spec_.resolution_m) return Error{fmt::format("the update is of a map with cells of {} m, expected {} m", resolution, spec_.resolution_m)};
  auto left = changes.subspan(magic.size() + sizeof(double));
  std::vector<Run> runs;
  CellIndex last;
  while (!left.empty()) {
    std::int64_t rows, columns;
    Run run;
    if (!take_number(left, rows) || !take_number(left, columns) || !take_number(left, run.cells) || !take_number(left, run.what) || run.cells < 1 || run.cells > tile_size || std::abs(run.what) > 2048)
      return Error{"the update of a map is cut off or damaged, expected the bytes of changes_since as they were"};
    run.first = {last.column + columns, last.row + rows};
    last = {run.first.column + run.cells, run.first.row};
    runs.push_back(run);
  }
  for (const Run& run : runs) {
    const bool through = (run.what & 1) != 0;
    const double probability = 1.0 / (1.0 + std::exp(-static_cast<double>((run.what - through) / 2) / per_nat));
    for (std::int64_t i = 0; i < run.cells; ++i) cells_->put({run.first.column + i, run.first.row}, probability, through, 0.0);
  }
  return Done{};
}

}  // namespace thicket
