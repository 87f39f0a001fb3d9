#include "editor.hpp"

#include <fmt/format.h>

#include <algorithm>


namespace thicket::gui {
namespace {

constexpr std::size_t most_changes = 1000, most_bytes = std::size_t{64} << 20;
constexpr std::size_t farthest_state = 40;  // how many changes are gone through for a state that is shown

std::size_t bytes_of(const std::optional<Solid>& solid) {
  if (!solid) return 0;
  std::size_t bytes = sizeof(Solid);
  if (const auto* map = std::get_if<MapSolid>(&solid->shape)) bytes += map->grid.cells.size() + map->blocks.size() * sizeof(CellBlock);
  if (const auto* wall = std::get_if<Wall>(&solid->shape)) bytes += wall->points.size() * sizeof(glm::dvec2);
  if (const auto* prism = std::get_if<Prism>(&solid->shape)) bytes += prism->outline.size() * sizeof(glm::dvec2);
  return bytes;
}

struct SameShape {
  const Shape& other;
  bool operator()(const Box& a) const { return a.size == std::get<Box>(other).size; }
  bool operator()(const Sphere& a) const { return a.radius == std::get<Sphere>(other).radius; }
  bool operator()(const Cylinder& a) const {
    const auto& b = std::get<Cylinder>(other);
    return a.radius == b.radius && a.height == b.height;
  }
  bool operator()(const Wall& a) const {
    const auto& b = std::get<Wall>(other);
    return a.points == b.points && a.thickness == b.thickness && a.height == b.height;
  }
  bool operator()(const MapSolid& a) const {
    const auto& b = std::get<MapSolid>(other);
    return a.grid.width == b.grid.width && a.grid.height == b.grid.height && a.grid.resolution == b.grid.resolution && a.unknown_is_matter == b.unknown_is_matter && a.height == b.height &&
           a.grid.cells == b.grid.cells;
  }
  bool operator()(const Prism& a) const {
    const auto& b = std::get<Prism>(other);
    return a.outline == b.outline && a.holes == b.holes && a.height == b.height;
  }
  bool operator()(const MeshSolid& a) const {
    const auto& b = std::get<MeshSolid>(other);
    const bool same_mesh = a.mesh == b.mesh || (a.mesh->vertices == b.mesh->vertices && a.mesh->triangles == b.mesh->triangles);
    return same_mesh && a.scale == b.scale && a.sheet_thickness == b.sheet_thickness;
  }
};

bool same_motion(const std::shared_ptr<const Motion>& a, const std::shared_ptr<const Motion>& b) {
  if (a == b) return true;
  return a && b && a->points == b->points && a->speed == b->speed && a->start_s == b->start_s && a->spin == b->spin && a->mode == b->mode;
}

bool same_solid(const Solid& a, const Solid& b) {
  // A moving solid is where its way-points are, whatever its position says.
  return a.name == b.name && a.material == b.material && (a.motion || a.position == b.position) && a.yaw == b.yaw && a.pitch == b.pitch && a.roll == b.roll && same_motion(a.motion, b.motion) &&
         a.shape.index() == b.shape.index() && std::visit(SameShape{b.shape}, a.shape);
}

bool same_material(const Material& a, const Material& b) {
  const bool same_dielectric = a.dielectric.has_value() == b.dielectric.has_value() &&
                               (!a.dielectric || (a.dielectric->a == b.dielectric->a && a.dielectric->b == b.dielectric->b && a.dielectric->c == b.dielectric->c && a.dielectric->d == b.dielectric->d));
  return a.name == b.name && a.reflectivity == b.reflectivity && a.attenuation_db_per_m == b.attenuation_db_per_m && a.roughness == b.roughness && a.stops_light == b.stops_light &&
         a.stops_motion == b.stops_motion && a.light_extinction_per_m == b.light_extinction_per_m && a.leaves_per_m == b.leaves_per_m && a.attenuation_exponent == b.attenuation_exponent && same_dielectric &&
         a.source == b.source;
}

const std::vector<Material>& shipped_materials() {
  static const std::vector<Material> list = [] {
    auto read = material_presets();
    return read ? std::move(*read) : std::vector<Material>();
  }();
  return list;
}

/// Where the material is, or what is to be added to have it there.
std::optional<std::uint32_t> find_or_add(const World& world, const std::string& name, std::vector<Material>& added) {
  const auto named = [&](const Material& m) { return m.name == name; };
  if (const auto own = std::ranges::find_if(world.materials, named); own != world.materials.end()) return static_cast<std::uint32_t>(own - world.materials.begin());
  const auto shipped = std::ranges::find_if(shipped_materials(), named);
  if (shipped == shipped_materials().end()) return std::nullopt;
  added.push_back(*shipped);
  return static_cast<std::uint32_t>(world.materials.size());
}

}  // namespace

bool same_world(const World& a, const World& b) {
  return a.name == b.name && a.source == b.source && a.bounds == b.bounds && std::ranges::equal(a.materials, b.materials, same_material) && std::ranges::equal(a.solids, b.solids, same_solid);
}

void Editor::follow(const Snapshot& now) {
  if (!now.simulation) return;
  const World& shown = now.simulation->scene().world();
  const bool refused = now.message.error && now.message.number != seen_message_;
  if (open_ && seen_ == &shown && seen_world_ == now.world_revision && seen_run_ == now.run_revision && !(refused && under_way_ > 0)) {
    seen_message_ = now.message.number;
    return;
  }
  const std::uint64_t arrived = now.world_revision - seen_world_;
  const bool waiting = open_ && under_way_ > arrived && !(refused && under_way_ > 0);
  if (!waiting) {
    if (!open_ || !same_world(world_, shown)) {
      if (!open_ || !find_state(shown)) {
        world_ = shown;
        changes_.clear();
        done_ = bytes_ = 0;
      }
      ++revision_;
      if (refused) message = now.message.text;
    }
    under_way_ = 0;
    changed_ = false;
    open_ = true;
  } else {
    under_way_ -= arrived;
  }
  seen_ = &shown;
  seen_world_ = now.world_revision;
  seen_run_ = now.run_revision;
  seen_message_ = now.message.number;
}

/// Whether some undoing or redoing leads to what is shown; then it is done.
bool Editor::find_state(const World& shown) {
  World state = world_;
  for (std::size_t i = done_; i > 0 && done_ - i < farthest_state; --i) {
    revert(state, changes_[i - 1]);
    if (!same_world(state, shown)) continue;
    done_ = i - 1;
    world_ = std::move(state);
    return true;
  }
  state = world_;
  for (std::size_t i = done_; i < changes_.size() && i - done_ < farthest_state; ++i) {
    apply(state, changes_[i]);
    if (!same_world(state, shown)) continue;
    done_ = i + 1;
    world_ = std::move(state);
    return true;
  }
  return false;
}

void Editor::apply(World& world, const Change& c) {
  world.materials.insert(world.materials.end(), c.materials.begin(), c.materials.end());
  const auto place = world.solids.begin() + c.at;
  if (!c.before) world.solids.insert(place, *c.after);
  else if (!c.after) world.solids.erase(place);
  else *place = *c.after;
}

void Editor::revert(World& world, const Change& c) {
  const auto place = world.solids.begin() + c.at;
  if (!c.before) world.solids.erase(place);
  else if (!c.after) world.solids.insert(place, *c.before);
  else *place = *c.before;
  world.materials.resize(world.materials.size() - c.materials.size());
}

void Editor::make(Change change) {
  message.clear();
  apply(world_, change);
  for (std::size_t i = done_; i < changes_.size(); ++i) bytes_ -= bytes_of(changes_[i].before) + bytes_of(changes_[i].after);
  changes_.resize(done_);
  bytes_ += bytes_of(change.before) + bytes_of(change.after);
  changes_.push_back(std::move(change));
  while (changes_.size() > 1 && (changes_.size() > most_changes || bytes_ > most_bytes)) {
    bytes_ -= bytes_of(changes_.front().before) + bytes_of(changes_.front().after);
    changes_.erase(changes_.begin());
  }
  done_ = changes_.size();
  ++revision_;
  changed_ = true;
}

std::uint32_t Editor::add(Solid solid) {
  Change change;
  change.at = static_cast<std::uint32_t>(world_.solids.size());
  const auto names = material_names(world_);
  if (std::ranges::find(names, new_material) == names.end()) new_material = names.empty() ? "" : names.front();
  if (const auto material = find_or_add(world_, new_material, change.materials)) solid.material = *material;
  if (solid.name.empty()) solid.name = fresh_name(kind_of(solid));
  const std::uint32_t at = change.at;
  change.after = std::move(solid);
  make(std::move(change));
  return at;
}

void Editor::replace(std::uint32_t at, Solid solid) {
  if (at >= world_.solids.size() || same_solid(world_.solids[at], solid)) return;
  make({at, world_.solids[at], std::move(solid), {}});
}

void Editor::erase(std::uint32_t at) {
  if (at < world_.solids.size()) make({at, world_.solids[at], std::nullopt, {}});
}

std::uint32_t Editor::copy(std::uint32_t at, const glm::dvec2& offset) {
  Solid solid = world_.solids[at];
  solid.name = fresh_name(kind_of(solid));
  solid.position += glm::dvec3(offset, 0.0);
  if (solid.motion) {
    auto motion = std::make_shared<Motion>(*solid.motion);
    for (glm::dvec3& p : motion->points) p += glm::dvec3(offset, 0.0);
    solid.motion = std::move(motion);
  }
  const auto last = static_cast<std::uint32_t>(world_.solids.size());
  make({last, std::nullopt, std::move(solid), {}});
  return last;
}

bool Editor::set_material(std::uint32_t at, const std::string& name) {
  if (at >= world_.solids.size()) return false;
  Change change{at, world_.solids[at], world_.solids[at], {}};
  const auto material = find_or_add(world_, name, change.materials);
  if (!material) return false;
  if (change.after->material == *material) return true;
  change.after->material = *material;
  make(std::move(change));
  return true;
}

bool Editor::undo() {
  if (done_ == 0) return false;
  revert(world_, changes_[--done_]);
  ++revision_;
  return changed_ = true;
}

bool Editor::redo() {
  if (done_ == changes_.size()) return false;
  apply(world_, changes_[done_++]);
  ++revision_;
  return changed_ = true;
}

std::optional<World> Editor::take() {
  if (!changed_) return std::nullopt;
  changed_ = false;
  ++under_way_;
  return world_;
}

std::string Editor::fresh_name(const std::string& kind) const {
  for (std::size_t i = 1;; ++i) {
    const std::string name = fmt::format("{} {}", kind, i);
    if (std::ranges::none_of(world_.solids, [&](const Solid& s) { return s.name == name; })) return name;
  }
}

std::vector<std::string> material_names(const World& world) {
  std::vector<std::string> names;
  for (const Material& material : world.materials) names.push_back(material.name);
  for (const Material& material : shipped_materials())
    if (std::ranges::find(names, material.name) == names.end()) names.push_back(material.name);
  return names;
}

const char* kind_of(const Solid& solid) {
  constexpr const char* names[] = {"box", "sphere", "cylinder", "wall", "map", "prism", "mesh"};
  static_assert(std::variant_size_v<Shape> == std::size(names));
  return names[solid.shape.index()];
}

}  // namespace thicket::gui
