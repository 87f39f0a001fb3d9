// The nodes of OctoMap's trees as bytes. Not a public header.
//
// A tree has 16 levels below its root; a voxel's key along an axis is floor(coordinate / resolution) + 32768. Child i lies high in x if bit 0 of i is set, in y for bit 1, in z for bit 2. Nodes come in preorder.
// Full (.ot): log-odds (float32), then a byte with a bit for each child. Binary (.bt): no leaves; two bytes a node with inner children, two bits a child, from the lowest on: 1 free, 2 occupied, 3 inner, 0 unknown.
// (Hornung et al., "OctoMap", Autonomous Robots 2013, section 3.4, and the files that OctoMap 1.9 writes.)
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "thicket/base/probability_grid.hpp"
#include "thicket/base/result.hpp"

namespace thicket {

inline constexpr int octree_levels = 16, octree_middle = 1 << (octree_levels - 1);

struct EncodedTree {
  std::string bytes;
  std::size_t nodes = 0;  ///< with the leaves, as OctoMap counts them; 0: nothing is known
};

/// A layer of voxels; `first_x` ... are keys, of the grid's cell (0, 0) and of the layer. All keys must be in 0...65535.
/// Nothing is pruned: that takes eight equal children, and a node of one layer has no more than four.
EncodedTree encode_layer(const ProbabilityGrid& grid, int first_x, int first_y, int z, bool binary);

/// A leaf: a cube of `edge` voxels whose lowest has these keys.
struct OctreeLeaf {
  int x = 0, y = 0, z = 0;
  int edge = 1;
  float probability = 0.5F;
};

/// Calls `visit` for each leaf; returns how many nodes there are. An error says what is wrong, without the file.
Result<std::size_t> decode_tree(std::string_view bytes, bool binary, const std::function<void(const OctreeLeaf&)>& visit);

}  // namespace thicket
