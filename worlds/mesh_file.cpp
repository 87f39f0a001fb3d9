#include "thicket/worlds/mesh_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <utility>

#include <glm/geometric.hpp>

#include "edges.hpp"
#include "mesh_parts.hpp"
#include "obj_text.hpp"
#include "polygon.hpp"
#include "thicket/base/files.hpp"

namespace thicket {
namespace {

namespace fs = std::filesystem;

/// Cuts a face into triangles, as it looks along the axis that it faces most: leaving out a coordinate is exact, where turning it into its
/// plane is not.
class FaceCutter {
 public:
  explicit FaceCutter(const std::vector<glm::dvec3>& vertices) : vertices_(vertices) {}

  /// `corners`: three or more, no neighbours equal. Adds corners - 2 triangles that run the same way.
  void cut(const std::vector<std::uint32_t>& corners, std::vector<glm::uvec3>& triangles) {
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) { triangles.emplace_back(corners[a], corners[b], corners[c]); };
    if (corners.size() == 3) return add(0, 1, 2);
    flatten(corners);
    if (corners.size() == 4) {
      const auto turns = [&](std::size_t a, std::size_t b, std::size_t c) { return orientation(ring_[a], ring_[b], ring_[c]) > 0.0; };
      const bool by_02 = turns(0, 1, 2) && turns(0, 2, 3), by_13 = turns(1, 2, 3) && turns(1, 3, 0);
      const auto length = [&](std::size_t a, std::size_t b) { return glm::distance(vertices_[corners[a]], vertices_[corners[b]]); };
      if (by_13 && !(by_02 && length(0, 2) <= length(1, 3))) {
        add(1, 2, 3);
        add(1, 3, 0);
      } else {
        add(0, 1, 2);
        add(0, 2, 3);
      }
      return;
    }
    for (const glm::uvec3& t : triangulate_counter_clockwise(ring_)) add(t.x, t.y, t.z);
  }

 private:
  /// Newell's normal chooses the axis (Sutherland, Sproull & Schumacker 1974): right also for faces that are concave or not quite flat.
  void flatten(const std::vector<std::uint32_t>& corners) {
    const glm::dvec3 origin = vertices_[corners.front()];
    glm::dvec3 normal(0.0);
    for (std::size_t i = 0; i < corners.size(); ++i)
      normal += glm::cross(vertices_[corners[i]] - origin, vertices_[corners[(i + 1) % corners.size()]] - origin);
    const glm::dvec3 size = glm::abs(normal);
    const int axis = size.z >= size.x && size.z >= size.y ? 2 : size.x >= size.y ? 0 : 1;
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (normal[axis] < 0.0) std::swap(u, v);
    ring_.clear();
    for (const std::uint32_t corner : corners) ring_.emplace_back(vertices_[corner][u], vertices_[corner][v]);
  }

  const std::vector<glm::dvec3>& vertices_;
  Ring ring_;
};

/// The triangles of all faces; how many corners or triangles were nothing but a line.
std::size_t cut_faces(const ObjText& text, const std::vector<std::uint32_t>& index, TriangleSoup& soup) {
  FaceCutter cutter(soup.vertices);
  std::vector<std::uint32_t> corners;
  std::vector<glm::uvec3> cut;
  std::size_t degenerate = 0;
  for (const ObjFace& face : text.faces) {
    corners.clear();
    for (std::uint32_t i = 0; i < face.count; ++i) {
      const std::uint32_t corner = index[text.corners[face.first + i]];
      if (corners.empty() || corners.back() != corner) corners.push_back(corner);
    }
    while (corners.size() > 1 && corners.back() == corners.front()) corners.pop_back();
    degenerate += std::min<std::size_t>(face.count - corners.size(), face.count - 2);
    if (corners.size() < 3) continue;
    cut.clear();
    cutter.cut(corners, cut);
    for (const glm::uvec3& t : cut) {
      if (t.x == t.y || t.y == t.z || t.z == t.x) {  // where the face touches itself
        ++degenerate;
        continue;
      }
      soup.triangles.push_back(t);
      soup.materials.push_back(face.material);
    }
  }
  return degenerate;
}

/// The MTL files that a line names: all of it if there is such a file, since names may have blanks, else its words.
std::vector<fs::path> files_of(const std::string& line, const fs::path& folder) {
  std::error_code none;
  if (fs::exists(folder / line, none)) return {folder / line};
  std::vector<fs::path> files;
  std::istringstream words(line);
  for (std::string word; words >> word;) files.push_back(folder / word);
  return files;
}

std::vector<ObjMaterial> read_materials(const ObjText& text, const fs::path& file, std::vector<std::string>& notices) {
  std::map<std::string, double> dissolve;
  std::set<fs::path> read;
  for (const std::string& line : text.material_files)
    for (const fs::path& mtl : files_of(line, file.parent_path())) {
      if (!read.insert(mtl).second) continue;
      if (auto content = read_text_file(mtl)) {
        parse_mtl(std::move(*content), mtl.string(), dissolve, notices);
      } else {
        notices.push_back(fmt::format("{} (an MTL file that {} names)", content.error().message, file.filename().string()));
      }
    }
  std::vector<ObjMaterial> materials;
  std::string undefined;
  for (const std::string& name : text.materials) {
    if (name.empty()) continue;
    const auto found = dissolve.find(name);
    if (found == dissolve.end()) {
      materials.push_back({name, 1.0, false});
      undefined += (undefined.empty() ? "'" : ", '") + name + "'";
    } else {
      materials.push_back({name, found->second, true});
    }
  }
  if (!undefined.empty()) notices.push_back(fmt::format("{}: no MTL file defines {}", file.filename().string(), undefined));
  return materials;
}

}  // namespace

Result<ObjFile> read_obj(const fs::path& file, const ObjOptions& options) {
  auto content = read_text_file(file);
  if (!content) return content.error();
  auto text = parse_obj(std::move(*content), file.string());
  if (!text) return text.error();

  const std::string name = file.filename().string();
  ObjFile result;
  result.materials = read_materials(*text, file, result.notices);
  if (text->left_out > 0)
    result.notices.push_back(
        fmt::format("{}: {} lines, points, curves or surfaces have been left out: only faces are matter", name, text->left_out));

  if (options.y_up)
    for (glm::dvec3& v : text->vertices) v = {v.x, -v.z, v.y};
  Welded welded = weld(text->vertices);
  text->vertices = {};
  TriangleSoup soup;
  soup.vertices = std::move(welded.vertices);
  soup.names = text->materials;
  if (const std::size_t degenerate = cut_faces(*text, welded.index, soup); degenerate > 0)
    result.notices.push_back(fmt::format("{}: {} triangle{} with two equal corners {} been left out", name, degenerate,
                                         degenerate == 1 ? "" : "s", degenerate == 1 ? "has" : "have"));
  if (soup.triangles.empty()) return Error{file.string() + ": has no faces but such with two equal corners, expected one that has an area"};
  text = ObjText{};  // no longer needed, and large
  result.pieces = take_apart(soup, name, result.notices);
  return result;
}

}  // namespace thicket
