// A world as data: materials and solids. It is what files describe; `Scene` makes it traceable.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "thicket/base/map_file.hpp"
#include "thicket/base/result.hpp"
#include "thicket/base/schema.hpp"
#include "thicket/worlds/material.hpp"
#include "thicket/worlds/mesh.hpp"

namespace thicket {

// Shapes, each in the frame of its solid (origin at the solid's position, turned by its yaw). Metres.

struct Box {
  glm::dvec3 size{1.0, 1.0, 1.0};  ///< full edge lengths, centred on the position
};
struct Sphere {
  double radius = 0.5;  ///< centred on the position
};
struct Cylinder {
  double radius = 0.5;  ///< upright, centred on the position
  double height = 1.0;
};
/// A polyline of thickness and height; corners between its segments are rounded, its ends are square.
struct Wall {
  std::vector<glm::dvec2> points;  ///< at least two
  double thickness = 0.1;
  double height = 2.5;  ///< upward from the position's z
};
/// A block of cells of a `MapSolid`, in cells: [column, column + columns) x [row, row + rows).
struct CellBlock {
  int column = 0, row = 0, columns = 0, rows = 0;
};
/// The occupied (and, unless told otherwise, unknown) cells of a grid map, extruded.
struct MapSolid {
  GridMap grid;
  bool unknown_is_matter = true;
  double height = 2.5;            ///< upward from the position's z
  std::vector<CellBlock> blocks;  ///< the matter, merged into rectangles that share no cell

  bool matter(int column, int row) const {
    const CellState state = grid.at(column, row);
    return state == CellState::occupied || (state == CellState::unknown && unknown_is_matter);
  }
};

/// A polygon, possibly with holes, extruded upward from the position's z. The outline and the holes are simple polygons of three points or more, in either
/// direction, that do not meet one another; the first point is not repeated.
struct Prism {
  std::vector<glm::dvec2> outline;
  std::vector<std::vector<glm::dvec2>> holes;
  double height = 2.5;
};
/// A triangle mesh: a volume if it is closed, else a thin sheet of a thickness. `scale` is applied before the solid's pose.
struct MeshSolid {
  std::shared_ptr<const Mesh> mesh;
  double scale = 1.0;
  double sheet_thickness = 0.001;  ///< m, of an open mesh, whatever the scale
};

using Shape = std::variant<Box, Sphere, Cylinder, Wall, MapSolid, Prism, MeshSolid>;

/// How a solid moves: along way-points at a constant speed, without turning but for its spin. A pure function of time.
struct Motion {
  enum class Mode : std::uint8_t { once, loop, back_and_forth };  ///< loop: from the last point straight to the first
  std::vector<glm::dvec3> points;  ///< of the solid's position, one or more; at time start_s it is at the first
  double speed = 1.0;              ///< m/s
  double start_s = 0.0;            ///< before this it waits at the first point
  double spin = 0.0;               ///< rad/s about its vertical axis, from time 0 on
  Mode mode = Mode::once;
};

/// A shape with a material, somewhere. Where solids overlap, the highest attenuation counts, and motion stops if any of them stops it.
struct Solid {
  std::string name;
  std::uint32_t material = 0;  ///< index into World::materials
  glm::dvec3 position{0.0, 0.0, 0.0};
  double yaw = 0.0;  ///< rad
  Shape shape;
  double pitch = 0.0, roll = 0.0;  ///< rad, about the y and x axis; turned by roll first, then pitch, then yaw (REP 103). Not for walls and maps.
  std::shared_ptr<const Motion> motion = nullptr;  ///< nothing: it stands still

  bool upright() const { return pitch == 0.0 && roll == 0.0; }
};

/// From the solid's frame to the world's: the rotation without the position.
glm::dmat3 rotation_of(double yaw, double pitch, double roll);
inline glm::dmat3 rotation_of(const Solid& solid) { return rotation_of(solid.yaw, solid.pitch, solid.roll); }

/// Where a solid stands at a time, s, and how it moves there; always the same for one that does not move.
struct Standing {
  glm::dvec3 position{0.0};
  double yaw = 0.0;  ///< rad
  glm::dvec3 velocity{0.0};  ///< m/s, of its position; at a way-point, of the leg that begins there
  double turn_rate = 0.0;    ///< rad/s, about its vertical axis
};
Standing standing_at(const Solid& solid, double time);

struct Bounds {
  glm::dvec3 low{0.0}, high{0.0};
};
/// The union of two boxes.
Bounds join(const Bounds& a, const Bounds& b);

struct World {
  std::string name;
  std::string source;  ///< where its figures come from
  std::filesystem::path file;
  std::optional<glm::dvec4> bounds;  ///< x_min, y_min, x_max, y_max as the file states them; `extent` tells what the solids take
  std::vector<Material> materials;
  std::vector<Solid> solids;
  std::vector<std::string> notices;  ///< what a reader mended or assumed: open or flipped meshes and the like, a sentence each

  const Material& material_of(std::uint32_t solid) const { return materials[solids[solid].material]; }
};

/// The world as it stands at a time; nothing in it moves.
World world_at(const World& world, double time);

/// An axis-aligned box that holds a solid (as it stands at time 0), or all of them (nothing for an empty world). Exact, but
/// somewhat large for tilted meshes and past the square ends of a wall.
Bounds extent(const Solid& solid);
std::optional<Bounds> extent(const World& world);

/// At which heights the level cut through a world changes. Between two of them the world is a pure extrusion: the same at every height, at any time.
class LevelCuts {
 public:
  explicit LevelCuts(const World& world);

  /// The widest stretch of heights (low, high) about z without a change, infinite where nothing follows; nothing if the cut changes all the way there: a sphere, a mesh, a tilted solid, or one that moves up or down.
  std::optional<glm::dvec2> about(double z) const;

 private:
  std::vector<double> changes_;      ///< sorted
  std::vector<glm::dvec2> sloping_;  ///< sorted, apart: heights of what is no upright extrusion
};

/// The horizontal half-width of a sphere or cylinder about its own axis between two heights, the half diagonal of anything else there; 0 where it has no
/// matter between them. Tells whether a sensor's plane sees as much of a solid as the hull would meet.
double half_width_between(const Solid& solid, double z_low, double z_high);

/// Options for grid maps.
struct MapOptions {
  std::filesystem::path image;    ///< read instead of the image that the YAML names, if not empty
  bool unknown_is_matter = true;
  double height = 2.5;
  std::optional<double> cell_size = std::nullopt;  ///< m, of a MovingAI `.map`, which has none of its own; 1 if it is not given
};

/// Reads a world file (TOML), or a map_server YAML, a MovingAI `.map` or an OBJ file as a world of its own; the name's ending tells. Errors as in `Error`, all of a file's faults at once.
Result<World> read_world(const std::filesystem::path& file, const MapOptions& map = {});

/// Merges the matter of a map into rectangles: greedy, rows first, each cell in exactly one.
std::vector<CellBlock> merge_cells(const MapSolid& map);

/// The sections of a world file, for `thicket help world` and docs/worlds.md: title, and its keys with their defaults.
std::string describe_world_file(bool markdown = false);

}  // namespace thicket
