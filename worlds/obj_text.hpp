// The text of OBJ and MTL files: checked, and read by tinyobjloader. Not a public header.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "thicket/base/result.hpp"

namespace thicket {

struct ObjFace {
  std::uint32_t first = 0, count = 0;  ///< of `ObjText::corners`; three or more
  std::uint32_t material = 0;          ///< index into `ObjText::materials`
};

/// What an OBJ file says; nothing is mended yet.
struct ObjText {
  std::vector<glm::dvec3> vertices;         ///< finite
  std::vector<std::uint32_t> corners;       ///< of all faces, indices into `vertices`
  std::vector<ObjFace> faces;               ///< at least one
  std::vector<std::string> materials;       ///< used by faces, in the order of first use; empty for none
  std::vector<std::string> material_files;  ///< what follows each `mtllib`
  std::size_t left_out = 0;                 ///< lines, points, curves and surfaces
};

/// `name` stands in messages. Errors as `read_obj` has them.
Result<ObjText> parse_obj(std::string text, const std::string& name);

/// Adds the dissolve of each material that an MTL text defines, 0...1 (the first definition of a name counts), and a notice for each that
/// is not such a number.
void parse_mtl(std::string text, const std::string& name, std::map<std::string, double>& dissolve, std::vector<std::string>& notices);

}  // namespace thicket
