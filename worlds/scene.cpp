// Building a scene, and where its solids are at a time.
#include "thicket/worlds/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene_impl.hpp"

namespace thicket {
namespace {

/// Whether the numbers of a shape are finite.
struct FiniteShape {
  static bool finite_points(const std::vector<glm::dvec2>& points) {
    return std::ranges::all_of(points, [](const glm::dvec2& p) { return finite({p, 0.0}); });
  }
  bool operator()(const Box& b) const { return finite(b.size); }
  bool operator()(const Sphere& s) const { return std::isfinite(s.radius); }
  bool operator()(const Cylinder& c) const { return std::isfinite(c.radius) && std::isfinite(c.height); }
  bool operator()(const Wall& w) const { return std::isfinite(w.thickness) && std::isfinite(w.height) && finite_points(w.points); }
  bool operator()(const MapSolid& m) const { return std::isfinite(m.grid.resolution) && std::isfinite(m.height); }
  bool operator()(const Prism& p) const { return std::isfinite(p.height) && finite_points(p.outline) && std::ranges::all_of(p.holes, finite_points); }
  bool operator()(const MeshSolid& m) const { return m.mesh && m.scale > 0.0 && std::isfinite(m.scale) && std::isfinite(m.sheet_thickness) && finite(m.mesh->low) && finite(m.mesh->high); }
};

bool all_finite(const Solid& solid) {
  const bool still = !solid.motion || (std::isfinite(solid.motion->speed) && std::isfinite(solid.motion->spin) && std::ranges::all_of(solid.motion->points, [](const glm::dvec3& p) { return finite(p); }));
  return finite(solid.position) && finite({solid.yaw, solid.pitch, solid.roll}) && still && std::visit(FiniteShape{}, solid.shape);
}

/// Where a solid of a mesh, tilted or moving, stands; `centre` is its prototype's.
Placing placing_of(const Solid& solid, const Standing& standing, const glm::dvec3& centre, const glm::dvec3& origin) {
  Placing placing;
  placing.turn = rotation_of(standing.yaw, solid.pitch, solid.roll);
  placing.upright = solid.upright();
  if (const auto* mesh = std::get_if<MeshSolid>(&solid.shape)) placing.scale = mesh->scale;
  placing.position = (standing.position - origin) + placing.turn * (placing.scale * centre);
  return placing;
}

/// The mesh that a solid is traced as, or nothing.
std::shared_ptr<const Mesh> mesh_of(const Solid& solid) {
  if (const auto* mesh = std::get_if<MeshSolid>(&solid.shape)) return mesh->mesh;
  if (const auto* prism = std::get_if<Prism>(&solid.shape)) return prism_mesh(prism->outline, prism->holes, prism->height);
  return nullptr;
}

/// Makes the prototypes and instances of a world.
class SceneBuilder {
 public:
  explicit SceneBuilder(Scene::Impl& impl) : impl_(impl) {}

  void build() {
    for (std::uint32_t i = 0; i < impl_.world.solids.size(); ++i) {
      const Solid& solid = impl_.world.solids[i];
      if (needs_instance(solid)) add_instance(solid, i);
      else add_parts(solid, i, impl_.origin, impl_.fixed.parts);
    }
    impl_.fixed.slack = impl_.slack;
    for (const auto& prototype : impl_.prototypes) ::thicket::build(*prototype, impl_.device.get());
    impl_.fixed.scene = new_scene(impl_.device.get());
    attach(impl_.fixed, impl_.device.get(), impl_.fixed.scene.get());
    attach(impl_.instances, impl_.device.get(), impl_.fixed.scene.get());
    commit(impl_.fixed.scene.get());
    if (impl_.instances.empty()) return;
    impl_.contact = new_scene(impl_.device.get());
    attach(impl_.fixed, impl_.device.get(), impl_.contact.get());
    commit_with_boxes(impl_.instances, impl_.slack, impl_.device.get(), impl_.contact.get());
  }

 private:
  void add_instance(const Solid& solid, std::uint32_t index) {
    const auto* sheet = std::get_if<MeshSolid>(&solid.shape);
    const double scale = sheet ? sheet->scale : 1.0;
    Prototype* prototype = prototype_for(solid, index, scale);
    if (!prototype) return;
    const double thickness = sheet ? sheet->sheet_thickness : 0.0;
    impl_.has_volumes = impl_.has_volumes || prototype->closed();
    if (solid.motion) {
      impl_.movers.push_back({prototype, index, thickness});
      impl_.fastest = std::max(impl_.fastest, (solid.motion->points.size() > 1 ? solid.motion->speed : 0.0) + std::abs(solid.motion->spin) * reach_of(solid));
    } else {
      impl_.instances.push_back({prototype, index, thickness, placing_of(solid, {solid.position, solid.yaw}, prototype->centre, impl_.origin)});
    }
  }

  /// A mesh that many solids share has one prototype. Nothing for a solid without matter.
  Prototype* prototype_for(const Solid& solid, std::uint32_t index, double scale) {
    const std::shared_ptr<const Mesh> mesh = mesh_of(solid);
    Prototype*& shared = shared_[mesh.get()];
    if (mesh && shared) {
      shared->slack = std::max(shared->slack, padding(*shared, scale));
      return shared;
    }
    auto prototype = std::make_unique<Prototype>();
    if (mesh) {
      if (mesh->triangles.empty()) return nullptr;
      prototype->mesh = mesh;
      prototype->centre = 0.5 * (mesh->low + mesh->high);
      shared = prototype.get();
    } else {
      Solid own = solid;
      own.position = glm::dvec3(0.0);
      own.yaw = own.pitch = own.roll = 0.0;
      add_parts(own, index, glm::dvec3(0.0), prototype->parts);
      if (prototype->parts.count() == 0) return nullptr;
    }
    prototype->slack = padding(*prototype, scale);
    impl_.prototypes.push_back(std::move(prototype));
    return impl_.prototypes.back().get();
  }

  /// Embree's own single-precision ray is off by the scene's slack, in the units of the prototype, and so are the prototype's bounds.
  double padding(const Prototype& prototype, double scale) const {
    double size = 0.0;
    if (prototype.mesh) size = glm::length(prototype.mesh->high - prototype.mesh->low);
    return 4.0 * impl_.slack / scale + single_precision_slack * size;
  }

  Scene::Impl& impl_;
  std::map<const Mesh*, Prototype*> shared_;
};

}  // namespace

Instance Scene::Impl::stand(const Mover& mover, double time) const {
  const Solid& solid = world.solids[mover.solid];
  return {mover.prototype, mover.solid, mover.sheet_thickness, placing_of(solid, standing_at(solid, time), mover.prototype->centre, origin)};
}

Result<Scene> Scene::build(World world) {
  const auto start = std::chrono::steady_clock::now();
  auto impl = std::make_shared<Impl>();
  impl->world = std::move(world);
  for (const Solid& solid : impl->world.solids) {
    if (!all_finite(solid)) return Error{fmt::format("solid '{}' has a position, angle or size that is not finite, or a scale that is not above 0", solid.name)};
    if (solid.motion && impl->world.materials[solid.material].stops_motion && changes_height(*solid.motion))
      return Error{fmt::format("solid '{}' moves up or down, expected way-points of one height: it stops motion, and contact is looked for in the plane", solid.name)};
  }
  if (const auto all = whole_extent(impl->world)) {
    impl->origin = 0.5 * (all->low + all->high);
    const glm::dvec3 half = 0.5 * (all->high - all->low);
    if (!finite(impl->origin) || !finite(half)) return Error{"the world's extent is not finite"};
    impl->slack = single_precision_slack * std::max({half.x, half.y, half.z});
    impl->box = {-half - 2.0 * impl->slack, half + 2.0 * impl->slack};
    impl->diagonal = glm::distance(impl->box.low, impl->box.high);
  }
  for (const Solid& solid : impl->world.solids) {
    const Material& m = impl->world.materials[solid.material];
    impl->matter.push_back({solid.material, {true, m.stops_light, m.stops_motion}});
  }
  impl->level_cuts = LevelCuts(impl->world);
  for (const Material& material : impl->world.materials) impl->losses.push_back(material.attenuation_db_per_m);

  impl->device.reset(rtcNewDevice(nullptr));
  if (!impl->device) return Error{fmt::format("Embree could not be started (error {})", static_cast<int>(rtcGetDeviceError(nullptr)))};
  rtcSetDeviceMemoryMonitorFunction(
      impl->device.get(),
      [](void* user, ssize_t bytes, bool) {
        *static_cast<std::atomic<std::ptrdiff_t>*>(user) += bytes;
        return true;
      },
      &impl->bytes);
  SceneBuilder(*impl).build();
  if (const RTCError error = rtcGetDeviceError(impl->device.get()); error != RTC_ERROR_NONE)
    return Error{fmt::format("Embree could not build the scene (error {}{})", static_cast<int>(error), error == RTC_ERROR_OUT_OF_MEMORY ? ": out of memory" : "")};
  impl->build_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  Scene scene(std::move(impl));
  scene.set_time(0.0);
  return scene;
}

const World& Scene::world() const { return impl_->world; }
std::uint32_t Scene::material(std::uint32_t solid) const { return impl_->matter[solid].material; }
const LevelCuts& Scene::level_cuts() const { return impl_->level_cuts; }
bool Scene::moves() const { return !impl_->movers.empty(); }
glm::dvec3 Scene::velocity(std::uint32_t solid, const glm::dvec3& point) const {
  const Standing now = standing_at(impl_->world.solids[solid], time_);
  const glm::dvec3 arm = point - now.position;
  return now.velocity + now.turn_rate * glm::dvec3(-arm.y, arm.x, 0.0);
}
double Scene::fastest() const { return impl_->fastest; }

SceneFigures Scene::figures() const {
  SceneFigures figures{impl_->fixed.parts.count(), 0, impl_->instances.size() + impl_->movers.size(), impl_->movers.size(),
                       static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, impl_->bytes)), impl_->build_s};
  for (const auto& prototype : impl_->prototypes) {
    figures.parts += prototype->parts.count();
    if (prototype->mesh) figures.triangles += prototype->mesh->triangles.size();
  }
  return figures;
}

void Scene::set_time(double time) {
  const bool same = moving_ && time == time_;
  time_ = time;
  if (impl_->movers.empty() || same) return;
  const bool ours = moving_ && moving_.use_count() == 1;
  if (ours) std::atomic_thread_fence(std::memory_order_acquire);  // whoever dropped the last copy has finished with it
  else moving_ = std::make_shared<Moving>(Moving{impl_, {}, nullptr});
  moving_->instances.clear();
  for (const Mover& mover : impl_->movers) moving_->instances.push_back(impl_->stand(mover, time));
  if (ours) {
    update(moving_->instances, moving_->scene.get());
  } else {
    moving_->scene = new_scene(impl_->device.get());
    attach(moving_->instances, impl_->device.get(), moving_->scene.get());
  }
  commit(moving_->scene.get());
}

}  // namespace thicket
