#include "world_keys.hpp"

#include <fmt/format.h>

#include "material_file.hpp"

namespace thicket {
namespace {

const Range place = between(-largest_m, largest_m);
const Range size = above_up_to(0.0, largest_m);
const Range angle = between(-36000.0, 36000.0);

template <class S>
SectionOf<S> solid_section(const char* type, const char* help) {
  SectionOf<S> section(fmt::format("[[solid]] of type \"{}\"", type), help);
  section.key("type", &S::type, "the shape").required();
  section.key("name", &S::name, "name of the solid, for messages")
      .key("material", &S::material, "name of its material: a table [material.NAME], or one of `thicket materials`")
      .required()
      .key("position_m", &S::position, "m", place, "x, y, z of the shape's origin")
      .key("yaw_deg", &S::yaw_deg, "deg", angle, "turn about its own vertical axis, counter-clockwise")
      .key("instances", &S::instances, "a table (CSV, relative to this file) with a pose a line: the solid stands at each of them");
  return section;
}

template <class S>
SectionOf<S> tilted_section(const char* type, const char* help) {
  auto section = solid_section<S>(type, help);
  section.key("pitch_deg", &S::pitch_deg, "deg", angle, "turn about its y axis, before the yaw: forward end down")
      .key("roll_deg", &S::roll_deg, "deg", angle, "turn about its x axis, before the pitch: left side up");
  return section;
}

template <class S>
void add_leaf_keys(SectionOf<S>& section) {
  section.key("leaf_material", &S::leaf_material, "material of the leaves; `material` is the wood")
      .key("leaf_thickness_m", &S::leaf_thickness, "m", size, "thickness of a leaf")
      .key("scale", &S::scale, "", between(1e-6, 1e6), "factor of all its lengths but the leaves' thickness")
      .add("leaf_size_m", [](S& k) -> double& { return k.spec.leaf_size; }, "m", between(1e-4, 1e3), "length of a leaf; its width is 0.6 of it")
      .add("seed", [](S& k) -> std::int64_t& { return k.spec.seed; }, "", Range{}, "another seed, another plant");
}

}  // namespace

const std::vector<std::string>& shape_types() {
  static const std::vector<std::string> types = {"box", "sphere", "cylinder", "wall", "prism", "map", "mesh", "tree", "hedge"};
  return types;
}

SectionOf<HeaderKeys> header_section() {
  SectionOf<HeaderKeys> section("world file", "what the world is called and where its figures come from; at the top of the file, without a table header");
  section.key("name", &HeaderKeys::name, "name of the world")
      .required()
      .key("source", &HeaderKeys::source, "where its figures come from")
      .key("bounds_m", &HeaderKeys::bounds, "m", place, "x_min, y_min, x_max, y_max of what belongs to the world, for pictures and scores");
  return section;
}

SectionOf<BoxKeys> box_section() {
  auto section = tilted_section<BoxKeys>("box", "a box, centred on its position");
  section.add("size_m", [](BoxKeys& k) -> glm::dvec3& { return k.shape.size; }, "m", size, "edge lengths along x, y, z").required();
  return section;
}

SectionOf<SphereKeys> sphere_section() {
  auto section = solid_section<SphereKeys>("sphere", "a sphere, centred on its position");
  section.add("radius_m", [](SphereKeys& k) -> double& { return k.shape.radius; }, "m", size, "radius").required();
  return section;
}

SectionOf<CylinderKeys> cylinder_section() {
  auto section = tilted_section<CylinderKeys>("cylinder", "a cylinder, centred on its position; upright unless it is tilted");
  section.add("radius_m", [](CylinderKeys& k) -> double& { return k.shape.radius; }, "m", size, "radius").required();
  section.add("height_m", [](CylinderKeys& k) -> double& { return k.shape.height; }, "m", size, "height").required();
  return section;
}

SectionOf<WallKeys> wall_section() {
  auto section = solid_section<WallKeys>("wall", "a polyline of thickness and height, upward from its position's z; its corners are rounded");
  section.add("points_m", [](WallKeys& k) -> std::vector<glm::dvec2>& { return k.shape.points; }, "m", place, "the middle line, two points or more").required();
  section.add("thickness_m", [](WallKeys& k) -> double& { return k.shape.thickness; }, "m", size, "thickness");
  section.add("height_m", [](WallKeys& k) -> double& { return k.shape.height; }, "m", size, "height");
  return section;
}

SectionOf<PrismKeys> prism_section() {
  auto section = tilted_section<PrismKeys>("prism", "a polygon extruded upward from its position's z; holes are entries [[solid.hole]] after it");
  section.add("points_m", [](PrismKeys& k) -> std::vector<glm::dvec2>& { return k.shape.outline; }, "m", place, "the outline: three points or more, the first not repeated at the end").required();
  section.add("height_m", [](PrismKeys& k) -> double& { return k.shape.height; }, "m", size, "height");
  return section;
}

SectionOf<HoleKeys> hole_section() {
  SectionOf<HoleKeys> section("[[solid.hole]]", "a hole of the prism before it, through its whole height");
  section.key("points_m", &HoleKeys::points, "m", place, "its outline, inside that of the prism").required();
  return section;
}

SectionOf<MapKeys> map_solid_section() {
  auto section = solid_section<MapKeys>("map", "a grid map, its matter extruded upward from its position's z; position and yaw come on top of the map's own origin");
  section.key("file", &MapKeys::file, "the map's YAML file (map_server) or .map file (MovingAI), relative to this one")
      .required()
      .key("image", &MapKeys::image, "an image to read instead of the one that the YAML names, relative to this file")
      .key("cell_size_m", &MapKeys::cell_size, "m", between(least_cell_m, largest_cell_m), "size of a cell of a .map file, which does not tell; 1 if it is not given")
      .key("height_m", &MapKeys::height, "m", size, "height")
      .key("unknown_is_matter", &MapKeys::unknown_is_matter, "whether unknown cells are matter");
  return section;
}

SectionOf<MeshKeys> mesh_section() {
  auto section = tilted_section<MeshKeys>("mesh", "an OBJ file: closed parts are volumes, open ones thin sheets. An MTL material becomes the one that [solid.materials] gives for it, else the "
                                                   "one of its own name, else `material`");
  section.key("file", &MeshKeys::file, "the OBJ file, relative to this one")
      .required()
      .choice("up", &MeshKeys::up, {"z", "y"}, "the file's axis that points up")
      .key("scale", &MeshKeys::scale, "", between(1e-6, 1e6), "metres in a unit of the file")
      .key("sheet_thickness_m", &MeshKeys::sheet_thickness, "m", size, "thickness of the parts that are open");
  return section;
}

SectionOf<TreeKeys> tree_section() {
  using K = TreeKeys;
  auto section = tilted_section<K>("tree", "a grown tree: trunk and branches of `material`, real leaves; it stands on its position");
  section.add("height_m", [](K& k) -> double& { return k.spec.height; }, "m", between(0.01, 1000.0), "height")
      .add("trunk_radius_m", [](K& k) -> double& { return k.spec.trunk_radius; }, "m", between(1e-4, 100.0), "radius of the trunk at the ground")
      .add("crown_radius_m", [](K& k) -> double& { return k.spec.crown_radius; }, "m", between(0.01, 1000.0), "half of the crown's width")
      .add("crown_base_m", [](K& k) -> double& { return k.spec.crown_base; }, "m", between(0.0, 1000.0), "where the crown begins above the ground; less than height_m")
      .add("branches", [](K& k) -> int& { return k.spec.branches; }, "", between(0.0, 1e5), "number of branches")
      .add("leaves", [](K& k) -> int& { return k.spec.leaves; }, "", between(0.0, 1e6), "number of leaves, two triangles each");
  add_leaf_keys(section);
  return section;
}

SectionOf<HedgeKeys> hedge_section() {
  using K = HedgeKeys;
  auto section = tilted_section<K>("hedge", "a box full of leaves, with stems of `material` along its x axis; centred on its position in x and y, upward from its z");
  section.add("size_m", [](K& k) -> glm::dvec3& { return k.spec.size; }, "m", between(0.01, 1000.0), "length, width and height")
      .add("leaves_per_m3", [](K& k) -> double& { return k.spec.leaves_per_m3; }, "1/m^3", between(0.0, 1e6), "leaves in a cubic metre; at most 10^6 in all")
      .add("stems", [](K& k) -> int& { return k.spec.stems; }, "", between(0.0, 1e5), "number of stems")
      .add("stem_radius_m", [](K& k) -> double& { return k.spec.stem_radius; }, "m", between(1e-4, 100.0), "radius of a stem");
  add_leaf_keys(section);
  return section;
}

SectionOf<RepeatKeys> repeat_section() {
  SectionOf<RepeatKeys> section("[solid.repeat]", "an array of the solid before it, along the axes of its frame");
  section.key("count", &RepeatKeys::count, "", between(1.0, 1e6), "how often along x, y and z: whole numbers")
      .required()
      .key("spacing_m", &RepeatKeys::spacing, "m", place, "from one to the next along x, y and z")
      .required();
  return section;
}

SectionOf<MotionKeys> motion_section() {
  SectionOf<MotionKeys> section("[solid.motion]", "the solid before it moves: its position goes from way-point to way-point, instead of `position_m`");
  section.key("waypoints_m", &MotionKeys::waypoints, "m", place, "positions, one or more; at time start_s it is at the first")
      .required()
      .key("speed_m_s", &MotionKeys::speed, "m/s", between(0.0, 1e4), "speed along the way")
      .choice("mode", &MotionKeys::mode, {"once", "loop", "back_and_forth"}, "at the last point it stays, goes straight to the first, or turns back")
      .key("start_s", &MotionKeys::start_s, "s", between(0.0, 1e9), "when it sets out")
      .key("spin_deg_s", &MotionKeys::spin_deg_s, "deg/s", between(-1e5, 1e5), "how fast it turns about its vertical axis, from time 0 on; it does not turn otherwise");
  return section;
}

SectionOf<IncludeKeys> include_section() {
  SectionOf<IncludeKeys> section("[[include]]", "the solids of another world file. Its materials come with it; where both have one of a name, this file's counts. A floor or ceiling of it counts where this file has none");
  section.key("file", &IncludeKeys::file, "a world file, map or OBJ, relative to this file")
      .required()
      .key("name", &IncludeKeys::name, "its solids are called NAME/...; not given: after the file")
      .key("position_m", &IncludeKeys::position, "m", place, "where its origin comes to lie")
      .key("yaw_deg", &IncludeKeys::yaw_deg, "deg", angle, "how it is turned about that");
  return section;
}

SectionOf<SlabKeys> slab_section(bool ceiling) {
  using K = SlabKeys;
  SectionOf<K> section(ceiling ? "[ceiling]" : "[floor]", ceiling ? "a slab above the whole world" : "a slab under the whole world. Without it there is no ground: rays go on for ever");
  section.key("material", &K::material, "name of its material").required();
  section.key("z_m", &K::z, "m", place, ceiling ? "height of its lower face; give it" : "height of its upper face")
      .key("thickness_m", &K::thickness, "m", size, "thickness")
      .key("margin_m", &K::margin, "m", between(0.0, 1e6), "how far it goes beyond bounds_m, or beyond all solids");
  if (ceiling) section.keys[1].required = true;
  return section;
}

}  // namespace thicket
