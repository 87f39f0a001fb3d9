#include "solid_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

#include "parts.hpp"
#include "polygon.hpp"
#include "pose_table.hpp"
#include "thicket/base/movingai.hpp"
#include "thicket/base/pose.hpp"
#include "thicket/base/text.hpp"
#include "thicket/worlds/mesh_file.hpp"
#include "world_keys.hpp"

namespace thicket {
namespace {

constexpr std::size_t most_points = 10000;  // of a prism: what is checked and triangulated takes time by its square

constexpr double most_copied_bytes = 2147483648.0;  // of maps, walls and prisms by one repeat or table: meshes are shared, these are not

/// What a copy of a solid takes, roughly.
double bytes_of(const Solid& solid) {
  double bytes = sizeof(Solid);
  if (const auto* map = std::get_if<MapSolid>(&solid.shape)) bytes += static_cast<double>(map->grid.cells.size() * sizeof(CellState) + map->blocks.size() * sizeof(CellBlock));
  if (const auto* wall = std::get_if<Wall>(&solid.shape)) bytes += static_cast<double>(wall->points.size() * sizeof(glm::dvec2));
  if (const auto* prism = std::get_if<Prism>(&solid.shape)) {
    bytes += static_cast<double>(prism->outline.size() * sizeof(glm::dvec2));
    for (const auto& hole : prism->holes) bytes += static_cast<double>(hole.size() * sizeof(glm::dvec2));
  }
  return bytes;
}

/// The sections that an entry may have inside, beside its keys.
const std::vector<std::string> inner_sections = {"repeat", "motion", "hole", "materials"};

class SolidReader {
 public:
  SolidReader(const Node& entry, const std::filesystem::path& folder, MaterialFinder& materials, World& world, Faults& faults)
      : entry_(entry), folder_(folder), materials_(materials), world_(world), faults_(faults) {}

  void read() {
    const Node* type = entry_.find("type");
    const auto* word = type ? std::get_if<std::string>(&type->content) : nullptr;
    const std::string expected = fmt::format("expected one of '{}'", fmt::join(shape_types(), "', '"));
    if (!type) return faults_.add(entry_.place, fmt::format("[[solid]] lacks a 'type', {}", expected));
    if (!word) return faults_.add(type->place, fmt::format("'type' is {}, {}", type->kind_in_words(), expected));
    if (*word == "box") return add(box_section(), BoxKeys{});
    if (*word == "sphere") return add(sphere_section(), SphereKeys{});
    if (*word == "cylinder") return add(cylinder_section(), CylinderKeys{});
    if (*word == "wall") return add(wall_section(), WallKeys{});
    if (*word == "prism") return add(prism_section(), PrismKeys{});
    if (*word == "map") return add(map_solid_section(), MapKeys{});
    if (*word == "mesh") return add(mesh_section(), MeshKeys{});
    if (*word == "tree") return add(tree_section(), TreeKeys{});
    if (*word == "hedge") return add(hedge_section(), HedgeKeys{});
    faults_.add(type->place, fmt::format("'type' is '{}', {}{}", *word, expected, did_you_mean(*word, shape_types())));
  }

 private:
  template <class K>
  void add(const Section& section, K keys) {
    for (const auto& [inner, type] : {std::pair{"hole", "prism"}, std::pair{"materials", "mesh"}})
      if (const Node* node = entry_.find(inner); node && !section.name.ends_with(fmt::format("\"{}\"", type)))
        faults_.add(node->key_place, fmt::format("'{}' belongs to solids of type '{}', not to {}", inner, type, section.name));
    std::vector<std::string> inner = inner_sections;
    if constexpr (!std::is_base_of_v<TiltKeys, K>)
      for (const char* tilt : {"pitch_deg", "roll_deg"})
        if (const Node* node = entry_.find(tilt)) {
          faults_.add(node->key_place, fmt::format("'{}' is not for {}, expected a box, cylinder, prism, mesh, tree or hedge: only they can be tilted", tilt, section.name));
          inner.push_back(tilt);
        }
    read_section(entry_, section, &keys, faults_, inner);
    Solid solid;
    solid.name = keys.name.empty() ? fmt::format("{} {}", keys.type, world_.solids.size() + 1) : keys.name;
    solid.position = keys.position;
    solid.yaw = radians(keys.yaw_deg);
    if constexpr (std::is_base_of_v<TiltKeys, K>) {
      solid.pitch = radians(keys.pitch_deg);
      solid.roll = radians(keys.roll_deg);
    }
    if (const Node* material = entry_.find("material"); material && std::holds_alternative<std::string>(material->content))
      solid.material = materials_.index_of(keys.material, material->place);
    std::vector<Solid> body = body_of(keys, solid);
    if (const Node* motion = entry_.find("motion")) add_motion(*motion, body);
    if (const Node* repeat = entry_.find("repeat")) body = repeated(*repeat, std::move(body));
    if (entry_.find("instances")) body = instances(std::move(body));
    if (!body.empty() && (too_many(entry_.place, body, 1.0) || too_far(body))) return;
    for (Solid& part : body) world_.solids.push_back(std::move(part));
  }

  /// Keys are in range each, but a repeat, a table or a scale comes on top of them.
  bool too_far(const std::vector<Solid>& body) {
    for (const Solid& solid : body) {
      for (const glm::dvec3& p : solid.motion ? solid.motion->points : std::vector{solid.position}) {
        if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= largest_m) continue;
        faults_.add(entry_.place, fmt::format("'{}' comes to lie at [{}, {}, {}], expected at most {} m from 0 along each axis", solid.name, p.x, p.y, p.z, largest_m));
        return true;
      }
      const auto* mesh = std::get_if<MeshSolid>(&solid.shape);
      if (!mesh) continue;
      double reach = 0.0;
      for (int i = 0; i < 3; ++i) reach = std::max({reach, std::abs(mesh->mesh->low[i]), std::abs(mesh->mesh->high[i])});
      if (reach * mesh->scale > largest_m) {
        faults_.add(entry_.place, fmt::format("'{}' reaches {} m from its origin, expected at most {}: make 'scale' smaller", solid.name, reach * mesh->scale, largest_m));
        return true;
      }
    }
    return false;
  }

  // --- the solids of one entry, at their own pose

  template <class K>
  std::vector<Solid> body_of(K& keys, Solid solid) {
    solid.shape = std::move(keys.shape);
    return {std::move(solid)};
  }
  std::vector<Solid> body_of(WallKeys& keys, Solid solid) {
    const auto& points = keys.shape.points;
    const Node* node = entry_.find("points_m");
    if (node && node->array() && node->array()->size() < 2)
      faults_.add(node->place, fmt::format("'points_m' has {} points, expected two or more", node->array()->size()));
    for (std::size_t i = 1; i < points.size(); ++i)
      if (points[i] == points[i - 1]) faults_.add(node->place, fmt::format("points {} and {} of 'points_m' are the same, expected different ones", i, i + 1));
    solid.shape = std::move(keys.shape);
    return {std::move(solid)};
  }
  std::vector<Solid> body_of(PrismKeys& keys, Solid solid) {
    const Node* node = entry_.find("points_m");
    const bool read = node && (keys.shape.outline.size() > 0 || (node->array() && node->array()->empty()));
    bool holes_read = true;
    std::vector<Place> hole_places;
    std::size_t points = keys.shape.outline.size();
    if (const Node* holes = entry_.find("hole")) {
      if (!holes->array()) faults_.add(holes->place, "'hole' is not an array of tables, expected entries [[solid.hole]]");
      else
        for (const Node& hole : *holes->array()) {
          HoleKeys hole_keys;
          read_section(hole, hole_section(), &hole_keys, faults_);
          points += hole_keys.points.size();
          const Node* hole_points = hole.find("points_m");
          hole_places.push_back(hole_points ? hole_points->place : hole.place);
          holes_read = holes_read && hole_points && hole_points->array() && hole_points->array()->size() == hole_keys.points.size();
          keys.shape.holes.push_back(std::move(hole_keys.points));
        }
    }
    if (points > most_points) faults_.add(node ? node->place : entry_.place, fmt::format("the prism has {} points with its holes, expected at most {}: give it as a mesh", points, most_points));
    else if (read && holes_read)
      if (const auto fault = polygon_fault(keys.shape.outline, keys.shape.holes))
        faults_.add(place_in(*fault, hole_places, node->place), fmt::format("the prism is not a simple polygon: {}{}", *fault, repeats_its_first(keys.shape) ? ", leave out the last" : ""));
    solid.shape = std::move(keys.shape);
    return {std::move(solid)};
  }
  /// Where the points are that a fault of a polygon is about: those of the first hole that it names, else the outline.
  static Place place_in(const std::string& fault, const std::vector<Place>& holes, const Place& outline) {
    const std::size_t at = fault.find("hole ");
    const std::size_t number = at == fault.npos ? 0 : std::strtoul(fault.c_str() + at + 5, nullptr, 10);
    return number >= 1 && number <= holes.size() ? holes[number - 1] : outline;
  }
  static bool repeats_its_first(const Prism& prism) { return prism.outline.size() > 3 && prism.outline.front() == prism.outline.back(); }
  std::vector<Solid> body_of(MapKeys& keys, Solid solid) {
    const auto file = file_of(entry_, "file", folder_, faults_);
    const bool own_image = entry_.find("image") != nullptr;
    const auto image = own_image ? file_of(entry_, "image", folder_, faults_) : std::filesystem::path{};
    if (!file || !image) return {};  // told already
    const bool movingai = file->extension() == ".map";
    if (own_image && movingai) faults_.add(entry_.find("image")->key_place, fmt::format("'image' is given, but '{}' has none, expected a map_server YAML file with it", keys.file));
    if (keys.cell_size && !movingai)
      faults_.add(entry_.find("cell_size_m")->key_place, fmt::format("'cell_size_m' is given, but '{}' tells its own resolution, expected it with a .map file only", keys.file));
    if ((own_image && movingai) || (keys.cell_size && !movingai)) return {};
    MapOptions options{*image, keys.unknown_is_matter, keys.height, keys.cell_size};
    auto grid = read_any_map(*file, options);
    if (!grid) {
      faults_.take(grid.error());
      return {};
    }
    place_map(solid, std::move(*grid), options);
    return {std::move(solid)};
  }
  std::vector<Solid> body_of(MeshKeys& keys, const Solid& solid) {
    const auto file = file_of(entry_, "file", folder_, faults_);
    if (!file) return {};
    std::vector<std::pair<std::string, Node>> given;
    if (const Node* table = entry_.find("materials")) {
      if (table->table()) given = *table->table();
      else faults_.add(table->place, fmt::format("'materials' is {}, expected a table [solid.materials] of MTL names and materials", table->kind_in_words()));
    }
    std::map<std::string, std::uint32_t> chosen;  // asked for more than once: what is wrong is told once
    const auto choose = [&](const std::string& mtl) {
      for (const auto& [name, node] : given) {
        if (name != mtl) continue;
        if (const auto* text = std::get_if<std::string>(&node.content)) return materials_.index_of(*text, node.place);
        faults_.add(node.place, fmt::format("'{}' is {}, expected the name of a material", name, node.kind_in_words()));
      }
      return !mtl.empty() && materials_.knows(mtl) ? materials_.index_of(mtl, entry_.place) : solid.material;
    };
    const auto material_of = [&](const std::string& mtl) {
      const auto found = chosen.find(mtl);
      return found != chosen.end() ? found->second : chosen.emplace(mtl, choose(mtl)).first->second;
    };
    auto solids = solids_of_obj(*file, keys.up == "y", solid, {nullptr, keys.scale, keys.sheet_thickness}, material_of, world_);
    if (!solids) {
      faults_.take(solids.error());
      return {};
    }
    std::vector<std::string> mtl_names;
    for (const auto& [mtl, index] : chosen)
      if (!mtl.empty()) mtl_names.push_back(mtl);
    const std::string expected = mtl_names.empty() ? "none: its faces name no MTL materials, 'material' is enough" : fmt::format("one of '{}'", fmt::join(mtl_names, "', '"));
    for (const auto& [name, node] : given)
      if (!chosen.contains(name)) faults_.add(node.key_place, fmt::format("no face of '{}' has the MTL material '{}', expected {}{}", keys.file, name, expected, did_you_mean(name, mtl_names)));
    return std::move(*solids);
  }
  std::vector<Solid> body_of(TreeKeys& keys, const Solid& solid) {
    if (keys.spec.crown_base >= keys.spec.height) {
      const Node* base = entry_.find("crown_base_m");
      faults_.add(base ? base->place : entry_.place, fmt::format("'crown_base_m' is {}, expected less than height_m, {}", keys.spec.crown_base, keys.spec.height));
      return {};
    }
    return foliage(keys, solid, [&] { return grow_tree(keys.spec); });
  }
  std::vector<Solid> body_of(HedgeKeys& keys, const Solid& solid) {
    const glm::dvec3 size = keys.spec.size;
    if (const double leaves = size.x * size.y * size.z * keys.spec.leaves_per_m3; leaves > 1e6) {
      const Node *density = entry_.find("leaves_per_m3"), *sides = entry_.find("size_m");
      faults_.add(density ? density->place : sides ? sides->place : entry_.place, fmt::format("the hedge has {:.0f} leaves, expected at most 1000000: make leaves_per_m3 or size_m smaller, or repeat a shorter one", leaves));
      return {};
    }
    return foliage(keys, solid, [&] { return grow_hedge(keys.spec); });
  }
  template <class Grow>
  std::vector<Solid> foliage(const LeafKeys& keys, const Solid& solid, Grow&& grow) {
    const Node* leaf = entry_.find("leaf_material");
    const std::uint32_t leaf_material = materials_.index_of(keys.leaf_material, leaf ? leaf->place : entry_.place);
    if (!faults_.none()) return {};
    const Foliage plant = grow();
    std::vector<Solid> body;
    if (!plant.wood->triangles.empty()) {
      body.push_back(solid);
      body.back().shape = MeshSolid{plant.wood, keys.scale};
    }
    if (!plant.leaves->triangles.empty()) {
      body.push_back(solid);
      body.back().name += "/leaves";
      body.back().material = leaf_material;
      body.back().shape = MeshSolid{plant.leaves, keys.scale, keys.leaf_thickness};
    }
    return body;
  }

  // --- where they stand

  void add_motion(const Node& node, std::vector<Solid>& body) {
    MotionKeys keys;
    read_section(node, motion_section(), &keys, faults_);
    if (keys.waypoints.empty()) {
      if (const Node* points = node.find("waypoints_m"); points && points->array() && points->array()->empty()) faults_.add(points->place, "'waypoints_m' is empty, expected one or more");
      return;
    }
    if (const Node* position = entry_.find("position_m")) faults_.add(position->key_place, "'position_m' and [solid.motion] are both given, expected one: a moving solid is where its way-points are");
    auto motion = std::make_shared<Motion>();
    motion->points = keys.waypoints;
    if (changes_height(*motion) && !body.empty() && !world_.materials.empty() && world_.materials[body.front().material].stops_motion)
      faults_.add(node.find("waypoints_m")->place, "'waypoints_m' go up or down, expected one z: the solid stops motion, and contact is looked for in the plane");
    motion->speed = keys.speed;
    motion->start_s = keys.start_s;
    motion->spin = radians(keys.spin_deg_s);
    motion->mode = keys.mode == "loop" ? Motion::Mode::loop : keys.mode == "back_and_forth" ? Motion::Mode::back_and_forth : Motion::Mode::once;
    // Without a position of its own a solid is at 0, and a map where its own origin has it.
    for (Solid& solid : body) {
      const glm::dvec3 own = solid.position;
      solid.motion = motion;
      move_solid(solid, [&](const glm::dvec3& p) { return own + p; });
      solid.position = solid.motion->points.front();
    }
  }

  bool too_many(const Place& place, const std::vector<Solid>& body, double copies) {
    const double solids = static_cast<double>(world_.solids.size()) + static_cast<double>(body.size()) * copies;
    double bytes = 0.0;
    for (const Solid& solid : body) bytes += bytes_of(solid) * copies;
    if (solids > static_cast<double>(most_solids)) {
      faults_.add(place, fmt::format("that makes {:.0f} solids, expected at most {} in a world", solids, most_solids));
    } else if (copies > 1.0 && bytes > most_copied_bytes) {
      faults_.add(place, fmt::format("that makes copies of {:.0f} bytes, expected at most {:.0f}: copy a simpler shape less often", bytes, most_copied_bytes));
    } else {
      return false;
    }
    return true;
  }

  std::vector<Solid> repeated(const Node& node, std::vector<Solid> body) {
    RepeatKeys keys;
    read_section(node, repeat_section(), &keys, faults_);
    for (int i = 0; i < 3; ++i)
      if (keys.count[i] != std::floor(keys.count[i])) {
        faults_.add(node.find("count")->place, fmt::format("'count' has {}, expected whole numbers", keys.count[i]));
        return {};
      }
    if (body.empty() || too_many(node.place, body, keys.count.x * keys.count.y * keys.count.z)) return {};
    const glm::dmat3 turn = rotation_of(body.front());
    std::vector<Solid> all;
    int number = 0;
    for (double k = 0.0; k < keys.count.z; ++k)
      for (double j = 0.0; j < keys.count.y; ++j)
        for (double i = 0.0; i < keys.count.x; ++i) {
          ++number;
          for (const Solid& part : body) {
            all.push_back(part);
            all.back().name = numbered(part.name, number);
            const glm::dvec3 by = turn * (glm::dvec3(i, j, k) * keys.spacing);
            move_solid(all.back(), [&](const glm::dvec3& p) { return p + by; });
          }
        }
    return all;
  }

  std::vector<Solid> instances(std::vector<Solid> body) {
    const Place place = entry_.find("instances")->place;
    const auto file = file_of(entry_, "instances", folder_, faults_);
    if (!file) return {};
    const auto poses = read_pose_table(*file);
    if (!poses) {
      faults_.take(poses.error());
      return {};
    }
    if (too_many(place, body, static_cast<double>(poses->size()))) return {};
    std::vector<Solid> all;
    all.reserve(body.size() * poses->size());
    int number = 0;
    for (const TablePose& pose : *poses) {
      ++number;
      for (const Solid& part : body) {
        Solid& solid = all.emplace_back(part);
        solid.name = numbered(part.name, number);
        if (auto* mesh = std::get_if<MeshSolid>(&solid.shape)) {
          mesh->scale *= pose.scale;
        } else if (pose.scale != 1.0) {
          faults_.add(place, fmt::format("'instances' has a scale of {} in pose {}, expected 1: only meshes, trees and hedges can be scaled", pose.scale, number));
          return {};
        }
        const bool upright_only = std::holds_alternative<Wall>(solid.shape) || std::holds_alternative<MapSolid>(solid.shape);
        if (upright_only && (pose.pitch != 0.0 || pose.roll != 0.0)) {
          faults_.add(place, fmt::format("'instances' tilts a {} in pose {}, expected pitch_deg and roll_deg of 0", std::holds_alternative<Wall>(solid.shape) ? "wall" : "map", number));
          return {};
        }
        // The solid's own pose is within the pose of the table.
        const glm::dmat3 turn = rotation_of(pose.yaw, pose.pitch, pose.roll);
        move_solid(solid, [&](const glm::dvec3& p) { return pose.position + turn * (pose.scale * p); });
        if (pose.pitch == 0.0 && pose.roll == 0.0) {
          solid.yaw += pose.yaw;
        } else {
          const glm::dmat3 all_turns = turn * rotation_of(solid);
          const double level = std::hypot(all_turns[0][0], all_turns[0][1]);
          solid.pitch = std::atan2(-all_turns[0][2], level);
          // Where its x axis points straight up or down, yaw and roll turn it about the same axis: all of it is yaw.
          const bool steep = level < 1e-9;
          solid.yaw = steep ? std::atan2(-all_turns[1][0], all_turns[1][1]) : std::atan2(all_turns[0][1], all_turns[0][0]);
          solid.roll = steep ? 0.0 : std::atan2(all_turns[1][2], all_turns[2][2]);
        }
      }
    }
    return all;
  }

  /// "oak" and "oak/leaves" become "oak 3" and "oak 3/leaves".
  static std::string numbered(const std::string& name, int number) {
    const std::size_t slash = std::min(name.find('/'), name.size());
    return fmt::format("{} {}{}", name.substr(0, slash), number, name.substr(slash));
  }

  const Node& entry_;
  const std::filesystem::path& folder_;
  MaterialFinder& materials_;
  World& world_;
  Faults& faults_;
};

}  // namespace

std::optional<std::filesystem::path> file_of(const Node& table, const char* key, const std::filesystem::path& folder, Faults& faults) {
  const Node* node = table.find(key);
  const auto* name = node ? std::get_if<std::string>(&node->content) : nullptr;
  if (!name) return std::nullopt;
  const std::filesystem::path file = folder / *name;
  std::error_code unknown;
  if (!name->empty() && std::filesystem::exists(file, unknown)) return file;
  const std::string what = name->empty() ? "empty" : fmt::format("'{}', which does not exist", *name);
  faults.add(node->place, fmt::format("'{}' is {}, expected the path of a file, relative to the folder of this one", key, what));
  return std::nullopt;
}

void read_solid(const Node& entry, const std::filesystem::path& folder, MaterialFinder& materials, World& world, Faults& faults) {
  SolidReader(entry, folder, materials, world, faults).read();
}

void place_map(Solid& solid, GridMap grid, const MapOptions& options) {
  const Pose2 outer{glm::dvec2(solid.position), solid.yaw};
  const glm::dvec2 corner = outer.to_outer(grid.origin);
  solid.position = {corner.x, corner.y, solid.position.z};
  solid.yaw += grid.origin_yaw;
  MapSolid shape{std::move(grid), options.unknown_is_matter, options.height, {}};
  shape.blocks = merge_cells(shape);
  solid.shape = std::move(shape);
}

Result<GridMap> read_any_map(const std::filesystem::path& file, const MapOptions& options) {
  if (file.extension() != ".map") {
    if (options.cell_size) return Error{fmt::format("{}: a cell size is given, but only a .map file has none of its own", file.string())};
    return read_map_file(file, options.image);
  }
  if (!options.image.empty()) return Error{fmt::format("{}: a map image is given, but the map is not a map_server YAML file", file.string())};
  return read_movingai_map(file, options.cell_size.value_or(1.0));
}

Result<std::vector<Solid>> solids_of_obj(const std::filesystem::path& file, bool y_up, const Solid& pose, const MeshSolid& like, const std::function<std::uint32_t(const std::string&)>& material_of,
                                         World& world) {
  auto obj = read_obj(file, {y_up});
  if (!obj) return obj.error();
  std::vector<Solid> solids;
  for (const MeshPiece& piece : obj->pieces) {
    Solid& solid = solids.emplace_back(pose);
    const bool alone = obj->pieces.size() == 1;
    const std::string what = piece.material.empty() ? "" : "/" + piece.material;
    solid.name += alone ? "" : what + (piece.mesh->closed ? "" : "/sheets");
    solid.material = material_of(piece.material);
    solid.shape = MeshSolid{piece.mesh, like.scale, like.sheet_thickness};
  }
  for (std::string& notice : obj->notices) world.notices.push_back(std::move(notice));
  for (const ObjMaterial& mtl : obj->materials) {
    if (!(mtl.dissolve < 1.0)) continue;
    const Material& material = world.materials[material_of(mtl.name)];
    if (material.stops_light)
      world.notices.push_back(fmt::format("{}: MTL material '{}' has a dissolve of {}, so light may pass, but its material '{}' stops light; glass does not, for example", file.filename().string(),
                                          mtl.name, mtl.dissolve, material.name));
  }
  return solids;
}

}  // namespace thicket
