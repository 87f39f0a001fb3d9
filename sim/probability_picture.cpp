#include "thicket/sim/probability_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "canvas.hpp"
#include "picture_view.hpp"

namespace thicket {
namespace {

constexpr Colour paper{0.965, 0.965, 0.955}, ink{0.1, 0.1, 0.12};
constexpr std::uint32_t unknown_pixel = 0xff2f4b8f;  // as in map.png

/// The ramp; what was sensed through has the green of map.png in it, as much at any probability.
std::uint32_t pixel_of(double probability, bool through) {
  const double grey = 255.0 * (1.0 - probability);
  const auto mixed = [&](double tint) { return static_cast<std::uint32_t>(std::lround(through ? 0.5 * grey + 0.5 * tint : grey)); };
  return 0xff000000u | mixed(0x6e) << 16 | mixed(0xc8) << 8 | mixed(0x5a);
}

PictureFrame fit(const ProbabilityGrid& grid) {
  PictureFrame view;
  view.low = grid.origin;
  view.high = grid.origin + glm::dvec2(grid.width, grid.height) * grid.resolution;
  // Whole pixels a cell where there is room for it, so that cells are squares of one size; no cell is larger than a legend's swatch.
  const double pixels = 1100.0 / std::max(grid.width, grid.height);
  view.scale = (pixels >= 1.0 ? std::min(std::floor(pixels), 48.0) : pixels) / grid.resolution;
  return view;
}

void draw_cells(Canvas& canvas, const PictureFrame& view, const ProbabilityGrid& grid) {
  const int every = std::max(1, std::max(grid.width, grid.height) / 2200);
  std::vector<std::uint32_t> pixels;
  for (int row = grid.height - 1; row >= 0; row -= every)
    for (int column = 0; column < grid.width; column += every) {
      const std::size_t cell = grid.index(column, row);
      pixels.push_back(grid.known(cell) ? pixel_of(static_cast<double>(grid.probability[cell]), grid.sensed_through(cell)) : unknown_pixel);
    }
  canvas.image(pixels, (grid.width + every - 1) / every, (grid.height + every - 1) / every, view.at({view.low.x, view.high.y}), view.scale * grid.resolution * every);
}

/// A ramp with its numbers; returns where the next entry begins.
double draw_ramp(Canvas& canvas, double left, double top, bool through, const char* words) {
  constexpr int width = 128;
  std::vector<std::uint32_t> pixels(width);
  for (int i = 0; i < width; ++i) pixels[static_cast<std::size_t>(i)] = pixel_of(i / (width - 1.0), through);
  std::vector<std::uint32_t> block;
  for (int row = 0; row < 16; ++row) block.insert(block.end(), pixels.begin(), pixels.end());
  canvas.image(block, width, 16, {left, top}, 1.0);
  canvas.frame({left, top}, {width, 16.0}, ink, 1.0);
  for (const auto& [share, label] : {std::pair{0.0, "0"}, {0.5, "0.5"}, {1.0, "1"}}) canvas.text(label, {left + share * width, top + 30.0}, 11.0, ink, Align::middle);
  canvas.text(words, {left + width + 8.0, top + 13.0}, 13.0, ink);
  return left + width + 8.0 + canvas.text_width(words, 13.0) + 20.0;
}

void draw_legend(Canvas& canvas, const PictureFrame& view, double top, bool any_through) {
  double left = PictureFrame::margin + 4.0;
  left = draw_ramp(canvas, left, top, false, "probability of matter");
  if (any_through) left = draw_ramp(canvas, left, top, true, "sensed through");
  const auto part = [](std::uint32_t pixel, int shift) { return static_cast<double>(pixel >> shift & 255u) / 255.0; };
  canvas.rectangle({left, top}, {16.0, 16.0}, {part(unknown_pixel, 16), part(unknown_pixel, 8), part(unknown_pixel, 0)});
  canvas.frame({left, top}, {16.0, 16.0}, ink, 1.0);
  canvas.text("never sensed", {left + 22.0, top + 13.0}, 13.0, ink);
  const double length = scale_bar_length(view.high.x - view.low.x), end = PictureFrame::margin + length * view.scale;
  canvas.polyline({{PictureFrame::margin, top + 48.0}, {end, top + 48.0}}, ink, 4.0);
  canvas.text(fmt::format("{:.6g} m", length), {end + 8.0, top + 53.0}, 13.0, ink);
}

}  // namespace

Result<Done> write_probability_picture(const std::filesystem::path& file, const ProbabilityGrid& grid, const std::string& title) {
  if (grid.width < 1 || grid.height < 1 || grid.probability.size() != static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height))
    return Error{fmt::format("{}: the map is {} x {} cells with {} values, expected at least 1 x 1 and a value for each", file.string(), grid.width, grid.height, grid.probability.size())};
  const PictureFrame view = fit(grid);
  const glm::dvec2 size = (view.high - view.low) * view.scale;
  const bool any_through = std::any_of(grid.through.begin(), grid.through.end(), [](std::uint8_t t) { return t != 0; });
  const double width = std::max(size.x, any_through ? 680.0 : 420.0) + 2.0 * PictureFrame::margin, height = PictureFrame::header + size.y + 2.0 * PictureFrame::margin + 68.0;
  Canvas canvas(static_cast<int>(std::ceil(width)), static_cast<int>(std::ceil(height)), paper);
  canvas.text(title, {PictureFrame::margin, 28.0}, 16.0, ink);
  draw_cells(canvas, view, grid);
  canvas.frame(view.at({view.low.x, view.high.y}), size, ink, 1.0);
  draw_legend(canvas, view, PictureFrame::header + size.y + 2.0 * PictureFrame::margin, any_through);
  return canvas.write(file);
}

}  // namespace thicket
