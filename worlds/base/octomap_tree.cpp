#include "octomap_tree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "probability_parts.hpp"

namespace thicket {
namespace {

enum Child : unsigned { none = 0, free_leaf = 1, occupied_leaf = 2, inner = 3 };

class LayerEncoder {
 public:
  LayerEncoder(const ProbabilityGrid& grid, int first_x, int first_y, int z) : grid_(grid), first_x_(first_x), first_y_(first_y), z_(z) {}

  /// Appends a node of `level` (0: a voxel) and all below it; returns its log-odds, or nothing, and appends nothing, if nothing is known there.
  std::optional<float> full(int level, int x, int y) {
    if (outside(level, x, y)) return std::nullopt;
    if (level == 0) {
      const std::size_t cell = grid_.index(x - first_x_, y - first_y_);
      if (!grid_.known(cell)) return std::nullopt;
      const auto p = static_cast<double>(inside(static_cast<double>(grid_.probability[cell])));
      const auto log_odds = static_cast<float>(std::log(p / (1.0 - p)));
      append_node(log_odds, 0);
      return log_odds;
    }
    // What it holds is known only after its children.
    const std::size_t at = out_.bytes.size(), nodes = out_.nodes;
    append_node(0.0F, 0);
    unsigned children = 0;
    std::optional<float> highest;
    each_child(level, x, y, [&](unsigned child, int child_x, int child_y) {
      const auto log_odds = full(level - 1, child_x, child_y);
      if (!log_odds) return;
      children |= 1U << child;
      highest = std::max(highest.value_or(*log_odds), *log_odds);
    });
    std::string node;
    if (highest) append_little(node, std::bit_cast<std::uint32_t>(*highest));
    if (highest) node += static_cast<char>(static_cast<std::uint8_t>(children));
    replace(at, nodes, node, 5);
    return highest;
  }

  /// The same for a .bt: what the parent says of this child. Leaves have no bytes of their own.
  Child binary(int level, int x, int y) {
    if (outside(level, x, y)) return none;
    if (level == 0) {
      const Child state = state_of(grid_.index(x - first_x_, y - first_y_));
      out_.nodes += state != none;
      return state;
    }
    const std::size_t at = out_.bytes.size(), nodes = out_.nodes;
    append_little(out_.bytes, std::uint16_t{0});
    ++out_.nodes;
    unsigned children = 0;
    each_child(level, x, y, [&](unsigned child, int child_x, int child_y) { children |= static_cast<unsigned>(binary(level - 1, child_x, child_y)) << (2 * child); });
    std::string node;
    if (children != 0) append_little(node, static_cast<std::uint16_t>(children));
    replace(at, nodes, node, 2);
    return children != 0 ? inner : none;
  }

  EncodedTree take() { return std::move(out_); }

 private:
  bool outside(int level, int x, int y) const {
    const int edge = 1 << level;
    return x + edge <= first_x_ || x >= first_x_ + grid_.width || y + edge <= first_y_ || y >= first_y_ + grid_.height;
  }

  Child state_of(std::size_t cell) const {
    if (!grid_.known(cell)) return none;
    if (grid_.probability[cell] >= 0.5F) return occupied_leaf;
    return grid_.sensed_through(cell) ? none : free_leaf;
  }

  template <class Call>
  void each_child(int level, int x, int y, const Call& call) {
    const int half = 1 << (level - 1);
    const unsigned above = (z_ & half) != 0 ? 4U : 0U;
    for (unsigned child = above; child < above + 4; ++child) call(child, x + ((child & 1U) != 0 ? half : 0), y + ((child & 2U) != 0 ? half : 0));
  }

  void append_node(float log_odds, std::uint8_t children) {
    append_little(out_.bytes, std::bit_cast<std::uint32_t>(log_odds));
    out_.bytes += static_cast<char>(children);
    ++out_.nodes;
  }

  /// Puts a node in its place; without one it was never there.
  void replace(std::size_t at, std::size_t nodes, const std::string& node, std::size_t size) {
    if (!node.empty()) return void(out_.bytes.replace(at, size, node));
    out_.bytes.resize(at);
    out_.nodes = nodes;
  }

  const ProbabilityGrid& grid_;
  int first_x_, first_y_, z_;
  EncodedTree out_;
};

class TreeDecoder {
 public:
  TreeDecoder(std::string_view bytes, const std::function<void(const OctreeLeaf&)>& visit) : rest_(bytes), visit_(visit) {}

  Result<std::size_t> decode(bool binary) {
    const OctreeLeaf root{0, 0, 0, 1 << octree_levels, 0.5F};
    if (binary) {
      take_binary(root);
    } else {
      take_full(root);
    }
    if (fault_.empty() && !rest_.empty()) fault_ = fmt::format("{} bytes follow the last node, expected none", rest_.size());
    if (!fault_.empty()) return Error{fault_};
    return nodes_;
  }

 private:
  static OctreeLeaf child_of(const OctreeLeaf& node, unsigned child) {
    const int half = node.edge / 2;
    return {node.x + ((child & 1U) != 0 ? half : 0), node.y + ((child & 2U) != 0 ? half : 0), node.z + ((child & 4U) != 0 ? half : 0), half, 0.5F};
  }

  /// The next bytes, or a fault.
  std::string_view next(std::size_t size) {
    if (rest_.size() < size) fault_ = fmt::format("truncated: the tree ends within its node {}", nodes_ + 1);
    const std::string_view bytes = rest_.substr(0, std::min(size, rest_.size()));
    rest_.remove_prefix(bytes.size());
    return bytes;
  }

  void too_deep() { fault_ = fmt::format("node {} has children below the {}th level, which is the last", nodes_, octree_levels); }

  void take_full(OctreeLeaf node) {
    const std::string_view bytes = next(5);
    if (!fault_.empty()) return;
    ++nodes_;
    const float log_odds = std::bit_cast<float>(little<std::uint32_t>(bytes));
    const unsigned children = static_cast<std::uint8_t>(bytes[4]);
    if (std::isnan(log_odds)) return void(fault_ = fmt::format("node {} is not a number, expected log-odds", nodes_));
    if (children == 0) {
      // (Not farther than exp reaches: at 700 it is as sure as can be.)
      node.probability = inside(1.0 / (1.0 + std::exp(std::min(-static_cast<double>(log_odds), 700.0))));
      return visit_(node);
    }
    if (node.edge == 1) return too_deep();
    for (unsigned child = 0; child < 8 && fault_.empty(); ++child)
      if ((children >> child & 1U) != 0) take_full(child_of(node, child));
  }

  void take_binary(const OctreeLeaf& node) {
    const std::string_view bytes = next(2);
    if (!fault_.empty()) return;
    ++nodes_;
    if (node.edge == 1) return too_deep();
    const unsigned children = little<std::uint16_t>(bytes);
    for (unsigned child = 0; child < 8 && fault_.empty(); ++child) {
      const unsigned state = children >> (2 * child) & 3U;
      if (state == none) continue;
      OctreeLeaf below = child_of(node, child);
      if (state == inner) {
        take_binary(below);
        continue;
      }
      ++nodes_;
      below.probability = state == occupied_leaf ? sure_occupied : sure_free;
      visit_(below);
    }
  }

  std::string_view rest_;
  const std::function<void(const OctreeLeaf&)>& visit_;
  std::size_t nodes_ = 0;
  std::string fault_;
};

}  // namespace

EncodedTree encode_layer(const ProbabilityGrid& grid, int first_x, int first_y, int z, bool binary) {
  LayerEncoder encoder(grid, first_x, first_y, z);
  if (binary) {
    encoder.binary(octree_levels, 0, 0);
  } else {
    encoder.full(octree_levels, 0, 0);
  }
  return encoder.take();
}

Result<std::size_t> decode_tree(std::string_view bytes, bool binary, const std::function<void(const OctreeLeaf&)>& visit) { return TreeDecoder(bytes, visit).decode(binary); }

}  // namespace thicket
