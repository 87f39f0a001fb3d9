// World files: TOML with [material.NAME] tables and [[solid]] entries, or a map_server YAML as a world of its own.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include <glm/geometric.hpp>

#include "material_file.hpp"
#include "thicket/base/document.hpp"
#include "thicket/base/pose.hpp"
#include "thicket/base/schema.hpp"
#include "thicket/base/text.hpp"
#include "thicket/worlds/world.hpp"

namespace thicket {
namespace {

constexpr double largest_m = 1e9;  // positions and sizes: keeps every square and sum of squares finite and exact enough

struct Header {
  std::string name, source;
  std::optional<glm::dvec4> bounds;
};

struct CommonKeys {
  std::string name, type, material;
  glm::dvec3 position{0.0};
  double yaw_deg = 0.0;
};
template <class S>
struct SolidKeys : CommonKeys {
  S shape;
};
struct MapKeys : CommonKeys {
  std::string file, image;
  double height = 2.5;
  bool unknown_is_matter = true;
};

SectionOf<Header> header_section() {
  SectionOf<Header> section("world file", "what the world is called and where its figures come from; at the top of the file, without a table header");
  section.key("name", &Header::name, "name of the world")
      .required()
      .key("source", &Header::source, "where its figures come from")
      .key("bounds_m", &Header::bounds, "m", between(-largest_m, largest_m), "x_min, y_min, x_max, y_max of what belongs to the world, for pictures and scores");
  return section;
}

template <class S>
SectionOf<S> solid_section(const char* type, const char* help) {
  SectionOf<S> section(fmt::format("[[solid]] of type \"{}\"", type), help);
  section.key("type", &S::type, "the shape").required();
  section.key("name", &S::name, "name of the solid, for messages")
      .key("material", &S::material, "name of its material: a table [material.NAME], or one of `thicket materials`")
      .required()
      .key("position_m", &S::position, "m", between(-largest_m, largest_m), "x, y, z of the shape's origin")
      .key("yaw_deg", &S::yaw_deg, "deg", between(-36000.0, 36000.0), "turn about its own vertical axis, counter-clockwise");
  return section;
}

const Range size = above_up_to(0.0, largest_m);

SectionOf<SolidKeys<Box>> box_section() {
  using K = SolidKeys<Box>;
  auto section = solid_section<K>("box", "a box, centred on its position");
  section.add("size_m", [](K& k) -> glm::dvec3& { return k.shape.size; }, "m", size, "edge lengths along x, y, z").required();
  return section;
}
SectionOf<SolidKeys<Sphere>> sphere_section() {
  using K = SolidKeys<Sphere>;
  auto section = solid_section<K>("sphere", "a sphere, centred on its position");
  section.add("radius_m", [](K& k) -> double& { return k.shape.radius; }, "m", size, "radius").required();
  return section;
}
SectionOf<SolidKeys<Cylinder>> cylinder_section() {
  using K = SolidKeys<Cylinder>;
  auto section = solid_section<K>("cylinder", "an upright cylinder, centred on its position");
  section.add("radius_m", [](K& k) -> double& { return k.shape.radius; }, "m", size, "radius").required();
  section.add("height_m", [](K& k) -> double& { return k.shape.height; }, "m", size, "height").required();
  return section;
}
SectionOf<SolidKeys<Wall>> wall_section() {
  using K = SolidKeys<Wall>;
  auto section = solid_section<K>("wall", "a polyline of thickness and height, upward from its position's z; its corners are rounded");
  section.add("points_m", [](K& k) -> std::vector<glm::dvec2>& { return k.shape.points; }, "m", between(-largest_m, largest_m), "the middle line, two points or more")
      .required();
  section.add("thickness_m", [](K& k) -> double& { return k.shape.thickness; }, "m", size, "thickness");
  section.add("height_m", [](K& k) -> double& { return k.shape.height; }, "m", size, "height");
  return section;
}
SectionOf<MapKeys> map_section() {
  auto section = solid_section<MapKeys>("map", "a map_server map, its matter extruded upward from its position's z; position and yaw come on top of the map's own origin");
  section.key("file", &MapKeys::file, "the map's YAML file, relative to this one")
      .required()
      .key("image", &MapKeys::image, "an image to read instead of the one that the YAML names, relative to this file")
      .key("height_m", &MapKeys::height, "m", size, "height")
      .key("unknown_is_matter", &MapKeys::unknown_is_matter, "whether unknown cells are matter");
  return section;
}

const std::vector<std::string>& shape_types() {
  static const std::vector<std::string> types = {"box", "sphere", "cylinder", "wall", "map"};
  return types;
}

/// A grid map as a solid: its frame is the map's own, placed by the solid's pose.
void place_map(Solid& solid, GridMap grid, const MapOptions& options) {
  const Pose2 outer{glm::dvec2(solid.position), solid.yaw};
  const glm::dvec2 corner = outer.to_outer(grid.origin);
  solid.position = {corner.x, corner.y, solid.position.z};
  solid.yaw += grid.origin_yaw;
  MapSolid shape{std::move(grid), options.unknown_is_matter, options.height, {}};
  shape.blocks = merge_cells(shape);
  solid.shape = std::move(shape);
}

class WorldReader {
 public:
  explicit WorldReader(World& world) : world_(world) {}

  void read(const Node& root) {
    Header header;
    read_section(root, header_section(), &header, faults, {"material", "solid"});
    world_.name = header.name;
    world_.source = header.source;
    world_.bounds = header.bounds;
    if (header.bounds && !(header.bounds->x < header.bounds->z && header.bounds->y < header.bounds->w))
      faults.add(root.find("bounds_m")->place, "'bounds_m' is empty, expected x_min < x_max and y_min < y_max");
    if (const Node* materials = root.find("material")) read_materials(*materials);
    if (const Node* solids = root.find("solid")) read_solids(*solids);
  }

  Faults faults;

 private:
  void read_materials(const Node& node) {
    const auto* table = node.table();
    if (!table) return faults.add(node.place, "'material' is not a table, expected tables [material.NAME]");
    for (const auto& [name, entry] : *table) world_.materials.push_back(read_material(name, entry, entry.find("preset") ? presets() : no_presets_, faults));
  }

  void read_solids(const Node& node) {
    const auto* array = node.array();
    if (!array) return faults.add(node.place, "'solid' is not an array of tables, expected entries [[solid]]");
    for (const Node& entry : *array) read_solid(entry);
  }

  void read_solid(const Node& entry) {
    const Node* type = entry.find("type");
    const auto* word = type ? std::get_if<std::string>(&type->content) : nullptr;
    const std::string expected = fmt::format("expected one of '{}'", fmt::join(shape_types(), "', '"));
    if (!type) return faults.add(entry.place, fmt::format("[[solid]] lacks a 'type', {}", expected));
    if (!word) return faults.add(type->place, fmt::format("'type' is {}, {}", type->kind_in_words(), expected));
    if (*word == "box") return add(entry, box_section(), SolidKeys<Box>{});
    if (*word == "sphere") return add(entry, sphere_section(), SolidKeys<Sphere>{});
    if (*word == "cylinder") return add(entry, cylinder_section(), SolidKeys<Cylinder>{});
    if (*word == "wall") return add(entry, wall_section(), SolidKeys<Wall>{});
    if (*word == "map") return add(entry, map_section(), MapKeys{});
    faults.add(type->place, fmt::format("'type' is '{}', {}{}", *word, expected, did_you_mean(*word, shape_types())));
  }

  template <class K>
  void add(const Node& entry, const Section& section, K keys) {
    read_section(entry, section, &keys, faults);
    Solid solid;
    solid.name = keys.name.empty() ? fmt::format("{} {}", keys.type, world_.solids.size() + 1) : keys.name;
    solid.position = keys.position;
    solid.yaw = radians(keys.yaw_deg);
    if (const Node* material = entry.find("material"); material && std::holds_alternative<std::string>(material->content))
      solid.material = material_index(keys.material, material->place);
    finish(entry, keys, solid);
    world_.solids.push_back(std::move(solid));
  }

  template <class S>
  void finish(const Node&, SolidKeys<S>& keys, Solid& solid) {
    solid.shape = std::move(keys.shape);
  }
  void finish(const Node& entry, SolidKeys<Wall>& keys, Solid& solid) {
    const auto& points = keys.shape.points;
    const Node* node = entry.find("points_m");
    if (node && node->array() && node->array()->size() < 2)
      faults.add(node->place, fmt::format("'points_m' has {} points, expected two or more", node->array()->size()));
    for (std::size_t i = 1; i < points.size(); ++i)
      if (points[i] == points[i - 1]) faults.add(node->place, fmt::format("points {} and {} of 'points_m' are the same, expected different ones", i, i + 1));
    solid.shape = std::move(keys.shape);
  }
  void finish(const Node&, MapKeys& keys, Solid& solid) {
    if (keys.file.empty()) return;  // told already
    const auto folder = world_.file.parent_path();
    auto grid = read_map_file(folder / keys.file, keys.image.empty() ? std::filesystem::path{} : folder / keys.image);
    if (!grid) return faults.take(grid.error());
    place_map(solid, std::move(*grid), {{}, keys.unknown_is_matter, keys.height});
  }

  /// A material of the world, or a shipped one, which the world then has too.
  std::uint32_t material_index(const std::string& name, const Place& place) {
    const Material* found = find_material(world_.materials, name);
    if (!found) {
      const Material* preset = find_material(presets(), name);
      if (!preset) {
        std::vector<std::string> known = names_of(world_.materials);
        for (std::string& shipped : names_of(presets())) known.push_back(std::move(shipped));
        faults.add(place, fmt::format("there is no material '{}', expected a table [material.{}] or one of `thicket materials`{}", name, name, did_you_mean(name, known)));
        return 0;
      }
      found = &world_.materials.emplace_back(*preset);
    }
    return static_cast<std::uint32_t>(found - world_.materials.data());
  }

  /// Read when the first is wanted: a world with materials of its own needs none.
  const std::vector<Material>& presets() {
    if (presets_) return *presets_;
    auto read = material_presets();
    if (!read) faults.take(read.error());
    return presets_.emplace(read ? std::move(*read) : no_presets_);
  }

  World& world_;
  std::optional<std::vector<Material>> presets_;
  const std::vector<Material> no_presets_;
};

Result<World> world_of_map(const std::filesystem::path& file, const MapOptions& options) {
  auto grid = read_map_file(file, options.image);
  if (!grid) return grid.error();
  World world;
  world.name = file.stem().string();
  world.source = fmt::format("map_server map {}", file.filename().string());
  world.file = file;
  Material wall;
  wall.name = "wall";
  world.materials.push_back(wall);
  Solid solid;
  solid.name = "map";
  place_map(solid, std::move(*grid), options);
  world.solids.push_back(std::move(solid));
  return world;
}

}  // namespace

Result<World> read_world(const std::filesystem::path& file, const MapOptions& map) {
  const std::string ending = file.extension().string();
  if (ending == ".yaml" || ending == ".yml") return world_of_map(file, map);
  if (!map.image.empty()) return Error{fmt::format("{}: a map image is given, but the world is not a map_server YAML file", file.string())};
  const auto document = read_document(file);
  if (!document) return document.error();
  World world;
  world.file = file;
  WorldReader reader(world);
  reader.read(*document);
  if (!reader.faults.none()) return reader.faults.error();
  return world;
}

std::string describe_world_file() {
  const Header header;
  std::string text = describe_section(header_section(), &header) + "\n" + describe_material_table();
  const auto describe = [&text](const auto& section, const auto& defaults) { text += "\n" + describe_section(section, &defaults); };
  describe(box_section(), SolidKeys<Box>{});
  describe(sphere_section(), SolidKeys<Sphere>{});
  describe(cylinder_section(), SolidKeys<Cylinder>{});
  describe(wall_section(), SolidKeys<Wall>{});
  describe(map_section(), MapKeys{});
  return text;
}

}  // namespace thicket
