// The keys of a world file: structs that hold a section as it stands in the file, and the sections. Private to world_file.cpp and its tests of help.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "thicket/base/schema.hpp"
#include "thicket/worlds/generators.hpp"
#include "thicket/worlds/world.hpp"

namespace thicket {

inline constexpr double largest_m = 1e9;  ///< positions and sizes: keeps every square and sum of squares finite and exact enough
inline constexpr std::size_t most_solids = 1000000;  ///< of a world, with all repeats, instances and includes

struct HeaderKeys {
  std::string name, source;
  std::optional<glm::dvec4> bounds;
};

struct SolidKeys {
  std::string name, type, material, instances;
  glm::dvec3 position{0.0};
  double yaw_deg = 0.0;
};
struct TiltKeys : SolidKeys {
  double pitch_deg = 0.0, roll_deg = 0.0;
};
struct BoxKeys : TiltKeys {
  Box shape;
};
struct SphereKeys : SolidKeys {
  Sphere shape;
};
struct CylinderKeys : TiltKeys {
  Cylinder shape;
};
struct WallKeys : SolidKeys {
  Wall shape;
};
struct PrismKeys : TiltKeys {
  Prism shape;
};
struct MapKeys : SolidKeys {
  std::string file, image;
  double height = 2.5;
  bool unknown_is_matter = true;
  std::optional<double> cell_size;
};
struct MeshKeys : TiltKeys {
  std::string file, up = "z";
  double scale = 1.0, sheet_thickness = 0.001;
};
struct LeafKeys : TiltKeys {
  std::string leaf_material = "leaf";
  double leaf_thickness = 0.0003, scale = 1.0;
};
struct TreeKeys : LeafKeys {
  TreeSpec spec;
};
struct HedgeKeys : LeafKeys {
  HedgeSpec spec;
};

struct HoleKeys {
  std::vector<glm::dvec2> points;
};
struct RepeatKeys {
  glm::dvec3 count{1.0, 1.0, 1.0}, spacing{0.0};
};
struct MotionKeys {
  std::vector<glm::dvec3> waypoints;
  double speed = 1.0, start_s = 0.0, spin_deg_s = 0.0;
  std::string mode = "once";
};
struct IncludeKeys {
  std::string file, name;
  glm::dvec3 position{0.0};
  double yaw_deg = 0.0;
};
struct SlabKeys {
  std::string material;
  double z = 0.0, thickness = 0.5, margin = 50.0;
};

SectionOf<HeaderKeys> header_section();
SectionOf<BoxKeys> box_section();
SectionOf<SphereKeys> sphere_section();
SectionOf<CylinderKeys> cylinder_section();
SectionOf<WallKeys> wall_section();
SectionOf<PrismKeys> prism_section();
SectionOf<MapKeys> map_solid_section();
SectionOf<MeshKeys> mesh_section();
SectionOf<TreeKeys> tree_section();
SectionOf<HedgeKeys> hedge_section();
SectionOf<HoleKeys> hole_section();
SectionOf<RepeatKeys> repeat_section();
SectionOf<MotionKeys> motion_section();
SectionOf<IncludeKeys> include_section();
/// [floor] or [ceiling]
SectionOf<SlabKeys> slab_section(bool ceiling);

const std::vector<std::string>& shape_types();

}  // namespace thicket
