// Meshes from Wavefront OBJ files.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "thicket/base/result.hpp"
#include "thicket/worlds/mesh.hpp"

namespace thicket {

struct ObjOptions {
  bool y_up = false;  ///< the file's y axis points up: (x, y, z) becomes (x, -z, y)
};

/// A material that the faces of a file name.
struct ObjMaterial {
  std::string name;       ///< as in `usemtl`
  double dissolve = 1.0;  ///< of the MTL file: 0 clear ... 1 opaque
  bool defined = false;   ///< an MTL file has it
};

/// What can be traced as one solid: the closed parts of one material (a volume), or what is left of it (a thin sheet).
struct MeshPiece {
  std::shared_ptr<const Mesh> mesh;
  std::string material;  ///< empty for faces without one
};

struct ObjFile {
  std::vector<MeshPiece> pieces;       ///< by material, in the order of their first faces, the volume before the sheet
  std::vector<ObjMaterial> materials;  ///< those that faces use, in the same order
  std::vector<std::string> notices;    ///< what was mended, left out or assumed, a sentence each, with the file's name
};

/// Reads an OBJ file and the MTL files that it names (beside it), metres. Vertices at the same place are one.
///
/// A part (faces that hang together by edges, of one material) that is closed becomes a volume: made consistent where faces of a closed
/// part turn different ways, and turned outward unless it is a cavity (inside a part of the same material that faces the other way).
/// Everything else becomes thin sheets: what has holes or is closed only by several materials together, and what is closed but holds no
/// volume.
///
/// Errors: all faults of the file, up to 20, as `file:line:column: what, expected`: an index that is 0 or out of range (also of texture
/// coordinates and normals), a vertex without three finite numbers, or farther than 1e12 from 0, a face of fewer than three corners. Also a
/// file without faces, and one that has more than 1e8 vertices or faces for more than 2e7 triangles. An MTL file that cannot be read is a
/// notice.
Result<ObjFile> read_obj(const std::filesystem::path& file, const ObjOptions& options = {});

}  // namespace thicket
