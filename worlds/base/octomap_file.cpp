#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "octomap_tree.hpp"
#include "printable.hpp"
#include "probability_parts.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/image.hpp"

namespace thicket {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view full_title = "# Octomap OcTree file", binary_title = "# Octomap OcTree binary file";
/// In cells: what is nearer to a border than this lies on it. (0.3 / 0.1 is less than 3.)
constexpr double border = 1e-6, misfit = 1e-3;

struct TreeHeader {
  bool binary = false;
  std::size_t nodes = 0;
  double resolution = 0.0;  ///< m
  std::size_t data = 0;     ///< where the nodes begin
};

template <class Number>
std::optional<Number> number_of(std::string_view word) {
  Number number{};
  const auto [stop, failure] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (failure != std::errc{} || stop != word.data() + word.size()) return std::nullopt;
  return number;
}

/// Lines of a word and its value, up to the line `data`; comments begin with #.
Result<TreeHeader> read_header(const fs::path& file, std::string_view content) {
  TreeHeader header;
  header.binary = content.starts_with(binary_title);
  if (!header.binary && !content.starts_with(full_title))
    return Error{fmt::format("{}:1: begins with '{}', expected '{}' or '{}'", file.string(), printable(content.substr(0, std::min<std::size_t>(content.find('\n'), 30))), full_title, binary_title)};
  bool has_id = false, has_size = false;
  std::size_t at = 0;
  for (int line = 1;; ++line) {
    const std::size_t end = content.find('\n', at);
    const auto fault = [&](std::string_view what) { return Error{fmt::format("{}:{}: {}", file.string(), line, what)}; };
    if (end == std::string_view::npos) return fault("the file ends without a line 'data'");
    std::string_view text = content.substr(at, end - at);
    at = end + 1;
    if (text.ends_with('\r')) text.remove_suffix(1);
    if (text.empty() || text.starts_with('#')) continue;
    if (text == "data") {
      const char* missing = !has_id ? "id" : !has_size ? "size" : header.resolution == 0.0 ? "res" : nullptr;
      if (missing) return fault(fmt::format("'{}' is missing before the data", missing));
      header.data = at;
      return header;
    }
    const std::size_t space = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, space), value = text.substr(std::min(space + 1, text.size()));
    if (word == "id") {
      has_id = true;
      if (value != "OcTree") return fault(fmt::format("the id is '{}', expected OcTree: trees with colours or times are not read", printable(value)));
    } else if (word == "size") {
      const auto nodes = number_of<std::size_t>(value);
      if (!nodes) return fault(fmt::format("the size is '{}', expected the number of nodes", printable(value)));
      header.nodes = *nodes;
      has_size = true;
    } else if (word == "res") {
      const auto resolution = number_of<double>(value);
      if (!resolution || !std::isgreaterequal(*resolution, least_cell_m) || !std::islessequal(*resolution, largest_cell_m)) return fault(fmt::format("res is '{}', expected metres a cell, from {} to {}", printable(value), least_cell_m, largest_cell_m));
      header.resolution = *resolution;
    } else {
      return fault(fmt::format("'{}', expected id, size, res or data", printable(text)));
    }
  }
}

double low_of(int key, double resolution) { return (key - octree_middle) * resolution; }

/// The key of the layer that holds a height, or nothing if no tree reaches there.
std::optional<int> layer_at(double height, double resolution) {
  const double key = std::floor(height / resolution + border) + octree_middle;
  if (!std::isgreaterequal(key, 0.0) || !std::isless(key, 2.0 * octree_middle)) return std::nullopt;
  return static_cast<int>(key);
}

/// Keys from the first on, one past the last.
struct KeyRange {
  int first = 2 * octree_middle, end = 0;
  void hold(int low, int edge) {
    first = std::min(first, low);
    end = std::max(end, low + edge);
  }
};

std::string heights(const KeyRange& z, double resolution) { return fmt::format("{:.6g} to {:.6g} m", low_of(z.first, resolution), low_of(z.end, resolution)); }

/// The key of the origin along an axis.
Result<int> first_key(const fs::path& file, const char* axis, double origin, double resolution, int cells) {
  const double exact = origin / resolution, key = std::round(exact) + octree_middle;
  if (std::abs(exact - std::round(exact)) > misfit)
    return Error{fmt::format("{}: the origin's {} is {} m, expected a multiple of the resolution, {} m, for OctoMap's cells lie so: move the map's origin to {} {}", file.string(), axis, origin, resolution, axis, std::round(exact) * resolution)};
  if (!(key >= 0.0 && key + cells <= 2.0 * octree_middle))
    return Error{fmt::format("{}: the map reaches from {} {} to {} m, expected at most {} m on either side of 0: a tree of OctoMap has {} cells of {} m there; make the cells larger or the map smaller", file.string(), axis, origin,
                             origin + cells * resolution, octree_middle * resolution, octree_middle, resolution)};
  return static_cast<int>(key);
}

}  // namespace

Result<Done> write_octomap(const fs::path& file, const ProbabilityGrid& grid, double height) {
  if (auto wrong = unwritable(file, grid)) return *wrong;
  const auto x = first_key(file, "x", grid.origin.x, grid.resolution, grid.width), y = first_key(file, "y", grid.origin.y, grid.resolution, grid.height);
  if (!x) return x.error();
  if (!y) return y.error();
  const auto z = layer_at(height, grid.resolution);
  if (!z) return Error{fmt::format("{}: the height of the layer is {} m, expected {} to {} m, which is what a tree of OctoMap reaches", file.string(), height, -octree_middle * grid.resolution, octree_middle * grid.resolution)};
  const bool binary = file.extension() == ".bt";
  const EncodedTree tree = encode_layer(grid, *x, *y, *z, binary);
  if (tree.nodes == 0) return Error{file.string() + ": nothing is known of any cell, expected some: a tree of OctoMap holds what is known"};
  return write_file(file, fmt::format("{}\n# (one layer of voxels, from {:.6g} m up; written by Thicket)\nid OcTree\nsize {}\nres {}\ndata\n", binary ? binary_title : full_title, low_of(*z, grid.resolution), tree.nodes, grid.resolution) + tree.bytes);
}

Result<ProbabilityGrid> read_octomap(const fs::path& file, std::optional<double> height) {
  const Result<std::string> content = read_text_file(file);
  if (!content) return content.error();
  const auto header = read_header(file, *content);
  if (!header) return header.error();
  const auto fault = [&](std::string_view what) { return Error{fmt::format("{}: OctoMap: {}", file.string(), what)}; };
  if (header->nodes == 0) return fault("the tree is empty, expected known cells");
  const std::string_view bytes = std::string_view(*content).substr(header->data);

  KeyRange x, y, z;
  const auto counted = decode_tree(bytes, header->binary, [&](const OctreeLeaf& leaf) { z.hold(leaf.z, leaf.edge); });
  if (!counted) return fault(counted.error().message);
  if (*counted != header->nodes) return fault(fmt::format("the tree has {} nodes, expected {}, as its header says", *counted, header->nodes));
  if (z.end == 0) return fault("the tree has no leaves, expected known cells");
  if (!height && z.end - z.first > 1)
    return fault(fmt::format("the tree has {} layers of cells, at heights from {}, expected the height of one of them (--z {:.6g})", z.end - z.first, heights(z, header->resolution), low_of((z.first + z.end) / 2, header->resolution)));
  const auto wanted = height ? layer_at(*height, header->resolution) : std::optional(z.first);
  const auto in_layer = [&](const OctreeLeaf& leaf) { return wanted && *wanted >= leaf.z && *wanted < leaf.z + leaf.edge; };
  (void)decode_tree(bytes, header->binary, [&](const OctreeLeaf& leaf) {
    if (!in_layer(leaf)) return;
    x.hold(leaf.x, leaf.edge);
    y.hold(leaf.y, leaf.edge);
  });
  if (x.end == 0) return fault(fmt::format("nothing is known at a height of {} m, expected a height from {}", *height, heights(z, header->resolution)));
  const int width = x.end - x.first, rows = y.end - y.first;
  if (width > max_image_pixels / rows) return fault(fmt::format("the layer is {} x {} cells, expected at most {}", width, rows, max_image_pixels));

  ProbabilityGrid grid{width, rows, header->resolution, {low_of(x.first, header->resolution), low_of(y.first, header->resolution)}, {}, {}};
  grid.probability.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(rows), ProbabilityGrid::unknown);
  (void)decode_tree(bytes, header->binary, [&](const OctreeLeaf& leaf) {
    if (!in_layer(leaf)) return;
    for (int row = leaf.y - y.first; row < leaf.y - y.first + leaf.edge; ++row) {
      const auto first = grid.probability.begin() + static_cast<std::ptrdiff_t>(grid.index(leaf.x - x.first, row));
      std::fill(first, first + leaf.edge, leaf.probability);
    }
  });
  return grid;
}

}  // namespace thicket
