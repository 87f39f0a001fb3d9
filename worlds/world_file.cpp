// World files: TOML with materials, solids and other worlds; a grid map or an OBJ file is a world of its own.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/common.hpp>

#include "material_file.hpp"
#include "parts.hpp"
#include "solid_file.hpp"
#include "thicket/base/document.hpp"
#include "thicket/base/pose.hpp"
#include "thicket/base/text.hpp"
#include "thicket/worlds/world.hpp"
#include "world_keys.hpp"

namespace thicket {
namespace {

// Worlds may include one another: one that includes itself, or does so without end, is told.
constexpr std::size_t deepest_include = 8, most_includes = 10000;

/// The files that are being read, each included by the one before it, and how many have been read.
struct Includes {
  std::vector<std::filesystem::path> open;
  std::size_t count = 0;
};

struct ReadWorld {
  World world;
  std::optional<SlabKeys> floor, ceiling;  ///< which come last, when it is known how large they are
  std::uint32_t floor_material = 0, ceiling_material = 0;
};
Result<ReadWorld> read_world_at(const std::filesystem::path& file, const MapOptions& map, Includes& includes);

class WorldReader final : public MaterialFinder {
 public:
  WorldReader(ReadWorld& result, Includes& includes) : result_(result), world_(result.world), includes_(includes) {}

  void read(const Node& root) {
    HeaderKeys header;
    read_section(root, header_section(), &header, faults, {"material", "solid", "include", "floor", "ceiling"});
    world_.name = header.name;
    world_.source = header.source;
    world_.bounds = header.bounds;
    if (header.bounds && !(header.bounds->x < header.bounds->z && header.bounds->y < header.bounds->w))
      faults.add(root.find("bounds_m")->place, "'bounds_m' is empty, expected x_min < x_max and y_min < y_max");
    if (const Node* materials = root.find("material")) read_materials(*materials);
    if (const Node* solids = root.find("solid"))
      for (const Node& entry : entries(*solids, "solid")) read_solid(entry, world_.file.parent_path(), *this, world_, faults);
    if (const Node* floor = root.find("floor")) read_slab(*floor, false, result_.floor, result_.floor_material);
    if (const Node* ceiling = root.find("ceiling")) read_slab(*ceiling, true, result_.ceiling, result_.ceiling_material);
    if (const Node* includes = root.find("include"))
      for (const Node& entry : entries(*includes, "include")) read_include(entry);
    if (const Node* ceiling = root.find("ceiling"); ceiling && result_.floor && result_.ceiling->z <= result_.floor->z && faults.none())
      faults.add(ceiling->place, fmt::format("the ceiling is at z = {} m, expected above the floor, {} m", result_.ceiling->z, result_.floor->z));
  }

  /// A material of the world, or a shipped one, which the world then has too.
  std::uint32_t index_of(const std::string& name, const Place& place) override {
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

  bool knows(const std::string& name) override { return find_material(world_.materials, name) || find_material(presets(), name); }

  Faults faults;

 private:
  void read_materials(const Node& node) {
    const auto* table = node.table();
    if (!table) return faults.add(node.place, "'material' is not a table, expected tables [material.NAME]");
    for (const auto& [name, entry] : *table) world_.materials.push_back(read_material(name, entry, entry.find("preset") ? presets() : no_presets_, faults));
  }

  const Node::Array& entries(const Node& node, const char* name) {
    static const Node::Array none;
    if (const auto* array = node.array()) return *array;
    faults.add(node.place, fmt::format("'{}' is not an array of tables, expected entries [[{}]]", name, name));
    return none;
  }

  void read_slab(const Node& node, bool ceiling, std::optional<SlabKeys>& slab, std::uint32_t& material) {
    read_section(node, slab_section(ceiling), &slab.emplace(), faults);
    if (const Node* name = node.find("material"); name && std::holds_alternative<std::string>(name->content)) material = index_of(slab->material, name->place);
  }

  void read_include(const Node& entry) {
    IncludeKeys keys;
    read_section(entry, include_section(), &keys, faults);
    const auto file = file_of(entry, "file", world_.file.parent_path(), faults);
    if (!file) return;
    const Node* node = entry.find("file");
    std::error_code unknown;
    const auto same = [&](const std::filesystem::path& open) { return std::filesystem::equivalent(open, *file, unknown); };
    if (const auto found = std::find_if(includes_.open.begin(), includes_.open.end(), same); found != includes_.open.end()) {
      std::string way;
      for (auto f = found; f != includes_.open.end(); ++f) way += f->filename().string() + " includes ";
      return faults.add(node->place, fmt::format("'file' is '{}', which includes itself ({}{}), expected another world", keys.file, way, file->filename().string()));
    }
    if (includes_.open.size() > deepest_include) return faults.add(node->place, fmt::format("'file' is '{}', which is included {} deep, expected at most {}", keys.file, includes_.open.size(), deepest_include));
    if (++includes_.count > most_includes) {
      if (includes_.count == most_includes + 1) faults.add(node->place, fmt::format("the world includes more than {} files, expected at most that: use 'instances' or [solid.repeat]", most_includes));
      return;
    }
    auto read = read_world_at(*file, {}, includes_);
    if (!read) return faults.take(read.error());
    World& other = read->world;
    if (world_.solids.size() + other.solids.size() > most_solids)
      return faults.add(node->place, fmt::format("with '{}' the world has more than {} solids, expected at most that", keys.file, most_solids));
    // A material of this file counts instead of the other's of its name.
    std::vector<std::uint32_t> materials;
    for (const Material& material : other.materials) {
      const Material* ours = find_material(world_.materials, material.name);
      materials.push_back(static_cast<std::uint32_t>(ours ? ours - world_.materials.data() : static_cast<std::ptrdiff_t>(world_.materials.size())));
      if (!ours) world_.materials.push_back(material);
    }
    const std::string prefix = keys.name.empty() ? std::filesystem::path(keys.file).stem().string() : keys.name;
    const double yaw = radians(keys.yaw_deg);
    const glm::dmat3 turn = rotation_of(yaw, 0.0, 0.0);
    const auto placed = [&](const glm::dvec3& p) { return keys.position + turn * p; };
    for (Solid& solid : other.solids) {
      solid.name = prefix + "/" + solid.name;
      solid.material = materials[solid.material];
      move_solid(solid, placed);
      solid.yaw += yaw;
      world_.solids.push_back(std::move(solid));
    }
    for (std::string& notice : other.notices) world_.notices.push_back(std::move(notice));
    const auto adopt = [&](std::optional<SlabKeys>& ours, std::uint32_t& ours_material, const std::optional<SlabKeys>& theirs, std::uint32_t theirs_material) {
      if (ours || !theirs) return;
      ours = theirs;
      ours->z += keys.position.z;
      ours_material = materials[theirs_material];
    };
    adopt(result_.floor, result_.floor_material, read->floor, read->floor_material);
    adopt(result_.ceiling, result_.ceiling_material, read->ceiling, read->ceiling_material);
  }

  /// Read when the first is wanted: a world with materials of its own needs none.
  const std::vector<Material>& presets() {
    if (presets_) return *presets_;
    auto read = material_presets();
    if (!read) faults.take(read.error());
    return presets_.emplace(read ? std::move(*read) : no_presets_);
  }

  ReadWorld& result_;
  World& world_;
  Includes& includes_;
  std::optional<std::vector<Material>> presets_;
  const std::vector<Material> no_presets_;
};

/// A world of one material and what one file holds.
World world_of(const std::filesystem::path& file, const char* kind) {
  World world;
  world.name = file.stem().string();
  world.source = fmt::format("{} {}", kind, file.filename().string());
  world.file = file;
  world.materials.emplace_back().name = "wall";
  return world;
}

Result<World> world_of_map(const std::filesystem::path& file, const MapOptions& options) {
  auto grid = read_any_map(file, options);
  if (!grid) return grid.error();
  World world = world_of(file, file.extension() == ".map" ? "MovingAI map" : "map_server map");
  Solid solid;
  solid.name = "map";
  place_map(solid, std::move(*grid), options);
  // All of the map belongs to the world, also where its border is free.
  const MapSolid& map = std::get<MapSolid>(solid.shape);
  const glm::dvec2 size = glm::dvec2(map.grid.width, map.grid.height) * map.grid.resolution;
  const Pose2 frame{glm::dvec2(solid.position), solid.yaw};
  glm::dvec2 low(INFINITY), high(-INFINITY);
  for (const glm::dvec2& corner : {glm::dvec2(0.0), glm::dvec2(size.x, 0.0), size, glm::dvec2(0.0, size.y)}) {
    low = glm::min(low, frame.to_outer(corner));
    high = glm::max(high, frame.to_outer(corner));
  }
  world.bounds = glm::dvec4(low, high);
  world.solids.push_back(std::move(solid));
  return world;
}

Result<World> world_of_obj(const std::filesystem::path& file) {
  World world = world_of(file, "OBJ file");
  auto presets = material_presets();
  if (!presets) return presets.error();
  Solid solid;
  solid.name = file.stem().string();
  const auto material_of = [&](const std::string& mtl) -> std::uint32_t {
    const Material* found = find_material(world.materials, mtl);
    if (const Material* preset = found ? nullptr : find_material(*presets, mtl)) found = &world.materials.emplace_back(*preset);
    return found ? static_cast<std::uint32_t>(found - world.materials.data()) : 0;
  };
  auto solids = solids_of_obj(file, false, solid, MeshSolid{}, material_of, world);
  if (!solids) return solids.error();
  world.solids = std::move(*solids);
  return world;
}

/// Under or over all that there is.
Solid slab_solid(const SlabKeys& keys, std::uint32_t material, bool ceiling, const glm::dvec4& bounds) {
  const glm::dvec2 low = glm::dvec2(bounds.x, bounds.y) - keys.margin, high = glm::dvec2(bounds.z, bounds.w) + keys.margin;
  Solid solid;
  solid.name = ceiling ? "ceiling" : "floor";
  solid.material = material;
  solid.position = {0.5 * (low + high), keys.z + (ceiling ? 0.5 : -0.5) * keys.thickness};
  solid.shape = Box{{high - low, keys.thickness}};
  return solid;
}

Result<ReadWorld> read_world_at(const std::filesystem::path& file, const MapOptions& map, Includes& includes) {
  const std::string ending = file.extension().string();
  if (ending == ".yaml" || ending == ".yml" || ending == ".map") {
    auto world = world_of_map(file, map);
    if (!world) return world.error();
    return ReadWorld{std::move(*world), {}, {}};
  }
  if (!map.image.empty()) return Error{fmt::format("{}: a map image is given, but the world is not a map_server YAML file", file.string())};
  if (map.cell_size) return Error{fmt::format("{}: a cell size is given, but the world is not a .map file", file.string())};
  for (const char* image : {".pgm", ".png", ".mtl", ".jpg"})
    if (ending == image)
      return Error{fmt::format("{}: is no world, expected the file that names it: {}", file.string(), ending == ".mtl" ? "the .obj" : "the map's .yaml (map_server), or a world (.toml)")};
  if (ending == ".obj") {
    auto world = world_of_obj(file);
    if (!world) return world.error();
    return ReadWorld{std::move(*world), {}, {}};
  }
  const auto document = read_document(file);
  if (!document) return document.error();
  ReadWorld result;
  result.world.file = file;
  includes.open.push_back(file);
  WorldReader reader(result, includes);
  reader.read(*document);
  includes.open.pop_back();
  if (!reader.faults.none()) return reader.faults.error();
  return result;
}

}  // namespace

Result<World> read_world(const std::filesystem::path& file, const MapOptions& map) {
  Includes includes;
  auto read = read_world_at(file, map, includes);
  if (!read) return read.error();
  World& world = read->world;
  if (read->floor || read->ceiling) {
    // What a picture or a score is about is still the world without them.
    const auto box = whole_extent(world);
    const glm::dvec4 taken = box ? glm::dvec4(box->low.x, box->low.y, box->high.x, box->high.y) : glm::dvec4(-1.0, -1.0, 1.0, 1.0);
    const glm::dvec4 slab = world.bounds.value_or(taken);
    if (!world.bounds) world.bounds = taken + (box ? glm::dvec4(-1.0, -1.0, 1.0, 1.0) : glm::dvec4(0.0));  // as `thicket truth` has it without a floor
    if (read->floor) world.solids.push_back(slab_solid(*read->floor, read->floor_material, false, slab));
    if (read->ceiling) world.solids.push_back(slab_solid(*read->ceiling, read->ceiling_material, true, slab));
  }
  return std::move(world);
}

std::string describe_world_file(bool markdown) {
  std::string text;
  const auto describe = [&](const auto& section, const auto& defaults) {
    if (!text.empty()) text += "\n";
    text += markdown ? describe_section_in_markdown(section, &defaults) : describe_section(section, &defaults);
  };
  describe(header_section(), HeaderKeys{});
  text += "\n" + describe_material_table(markdown);
  describe(box_section(), BoxKeys{});
  describe(sphere_section(), SphereKeys{});
  describe(cylinder_section(), CylinderKeys{});
  describe(wall_section(), WallKeys{});
  describe(prism_section(), PrismKeys{});
  describe(hole_section(), HoleKeys{});
  describe(map_solid_section(), MapKeys{});
  describe(mesh_section(), MeshKeys{});
  describe(tree_section(), TreeKeys{});
  describe(hedge_section(), HedgeKeys{});
  describe(repeat_section(), RepeatKeys{});
  describe(motion_section(), MotionKeys{});
  describe(include_section(), IncludeKeys{});
  describe(slab_section(false), SlabKeys{});
  describe(slab_section(true), SlabKeys{});
  return text;
}

}  // namespace thicket
