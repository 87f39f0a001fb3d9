// The occupancy map as pictures.
#include <algorithm>
#include <cmath>

#include "plan.hpp"

namespace thicket::gui {
namespace {

constexpr int tile = OccupancyMap::tile_cells_across;

/// The legend of the 2012 map, as map.png has it.
std::uint32_t legend_pixel(const CellLook& look) {
  if (look.probability > 127) return IM_COL32(0x11, 0x11, 0x11, 255);
  if (look.sensed_through) return IM_COL32(0x93, 0xb4, 0x8c, 255);
  return look.surely_free ? IM_COL32(0xc9, 0xcc, 0xd1, 255) : IM_COL32(255, 255, 255, 255);
}

/// From white to black, with green in it where it was sensed through, as `thicket` writes probabilities.
std::uint32_t probability_pixel(const CellLook& look) {
  const int grey = 255 - look.probability;
  const auto mixed = [&](int tint) { return look.sensed_through ? (grey + tint) / 2 : grey; };
  return IM_COL32(mixed(0x6e), mixed(0xc8), mixed(0x5a), 255);
}

std::int64_t floored(std::int64_t a, std::int64_t b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

}  // namespace

MapPicture::Chunk& MapPicture::chunk_at(std::int64_t column, std::int64_t row) {
  const auto chunk = std::find_if(chunks_.begin(), chunks_.end(), [&](const Chunk& c) { return c.column == column && c.row == row; });
  if (chunk != chunks_.end()) return *chunk;
  chunks_.push_back({column, row, std::vector<std::uint32_t>(static_cast<std::size_t>(across) * across, unknown_), std::vector<bool>(static_cast<std::size_t>(across / tile) * (across / tile), false), true});
  return chunks_.back();
}

void MapPicture::take(const Frame& frame, bool probability) {
  const auto& now = frame.now.simulation;
  const MapSpec& spec = now->mission().map;
  const bool other_kind = last_ && (last_->mission().map.store != spec.store || last_->mission().map.cell_bits != spec.cell_bits || last_->mission().map.resolution_m != spec.resolution_m || last_->mission().map.clamp_low != spec.clamp_low);
  const bool anew = !last_ || other_kind || probability != probability_;
  if (!anew && last_ == now) return;
  probability_ = probability;
  if (anew)
    for (Chunk& chunk : chunks_) {
      std::fill(chunk.pixels.begin(), chunk.pixels.end(), unknown_);
      chunk.all_dirty = true;
    }
  now->map().changed_tiles(anew ? nullptr : &last_->map(), [&](const CellIndex& corner, std::span<const CellLook> looks) {
    const std::int64_t column = floored(corner.column, across), row = floored(corner.row, across);
    Chunk& chunk = chunk_at(column, row);
    const auto x = static_cast<std::size_t>(corner.column - column * across), y = static_cast<std::size_t>(corner.row - row * across);
    for (std::size_t r = 0; r < tile; ++r) {
      std::uint32_t* to = chunk.pixels.data() + (y + r) * across + x;
      for (std::size_t c = 0; c < tile; ++c) {
        const CellLook& look = looks[r * tile + c];
        to[c] = !look.known ? unknown_ : probability ? probability_pixel(look) : legend_pixel(look);
      }
    }
    chunk.dirty[y / tile * (across / tile) + x / tile] = true;
  });
  last_ = now;
}

void MapPicture::send(const Frame& frame, Chunk& chunk, ImTextureID& texture) {
  const std::string name = name_ + " " + std::to_string(chunk.column) + " " + std::to_string(chunk.row);
  bool fresh = false;
  texture = frame.textures.get(name, across, across, fresh);
  if (fresh || chunk.all_dirty) {
    frame.textures.update(name, 0, 0, across, across, chunk.pixels.data());
    sent_ += static_cast<std::size_t>(std::count(chunk.dirty.begin(), chunk.dirty.end(), true));
  } else {
    std::vector<std::uint32_t> square(static_cast<std::size_t>(tile) * tile);
    for (std::size_t i = 0; i < chunk.dirty.size(); ++i) {
      if (!chunk.dirty[i]) continue;
      const std::size_t x = i % (across / tile) * tile, y = i / (across / tile) * tile;
      for (std::size_t r = 0; r < tile; ++r) std::copy_n(chunk.pixels.data() + (y + r) * across + x, tile, square.data() + r * tile);
      frame.textures.update(name, static_cast<int>(x), static_cast<int>(y), tile, tile, square.data());
      ++sent_;
    }
  }
  std::fill(chunk.dirty.begin(), chunk.dirty.end(), false);
  chunk.all_dirty = false;
}

/// What no picture covers. Not all of the view under the pictures: each time over the screen costs a software renderer much.
void MapPicture::fill_around(const PlanCamera& camera, double size, ImDrawList& draw) const {
  const PlanExtent seen = seen_by(camera);
  const auto index = [&](double metres) { return static_cast<std::int64_t>(std::floor(metres / size)); };
  if ((seen.high.x - seen.low.x) * (seen.high.y - seen.low.y) > 256.0 * size * size) return draw.AddRectFilled(camera.low, {camera.low.x + camera.size.x, camera.low.y + camera.size.y}, unknown_);
  const ImDrawListFlags flags = draw.Flags;
  draw.Flags &= ~ImDrawListFlags_AntiAliasedFill;
  for (std::int64_t row = index(seen.low.y); row <= index(seen.high.y); ++row)
    for (std::int64_t column = index(seen.low.x); column <= index(seen.high.x); ++column) {
      if (std::any_of(chunks_.begin(), chunks_.end(), [&](const Chunk& c) { return c.column == column && c.row == row; })) continue;
      const glm::dvec2 low = glm::dvec2(static_cast<double>(column), static_cast<double>(row)) * size;
      draw.AddQuadFilled(camera.to_screen(low), camera.to_screen(low + glm::dvec2(size, 0.0)), camera.to_screen(low + size), camera.to_screen(low + glm::dvec2(0.0, size)), unknown_);
    }
  draw.Flags = flags;
}

void MapPicture::draw(const Frame& frame, const PlanCamera& camera, bool probability, double alpha, ImDrawList& draw) {
  take(frame, probability);
  const double size = across * frame.now.simulation->map().resolution();
  if (unknown_ != 0) fill_around(camera, size, draw);
  for (Chunk& chunk : chunks_) {
    const glm::dvec2 low = glm::dvec2(static_cast<double>(chunk.column), static_cast<double>(chunk.row)) * size;
    PlanExtent box;
    ImVec2 corners[4];
    for (int i = 0; i < 4; ++i) {
      corners[i] = camera.to_screen(low + glm::dvec2(i == 1 || i == 2 ? size : 0.0, i >= 2 ? size : 0.0));
      box.hold({corners[i].x, corners[i].y});
    }
    // What is out of sight is sent when it comes into sight.
    if (box.high.x < static_cast<double>(camera.low.x) || box.high.y < static_cast<double>(camera.low.y) || box.low.x > static_cast<double>(camera.low.x + camera.size.x) || box.low.y > static_cast<double>(camera.low.y + camera.size.y)) continue;
    ImTextureID texture = nullptr;
    send(frame, chunk, texture);
    draw.AddImageQuad(texture, corners[0], corners[1], corners[2], corners[3], {0, 0}, {1, 0}, {1, 1}, {0, 1}, with_alpha(IM_COL32_WHITE, alpha));
  }
}

}  // namespace thicket::gui
