#include "thicket/worlds/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "collectors.hpp"
#include "embree.hpp"
#include "part_rays.hpp"

namespace thicket {
namespace {

/// Single-precision numbers that are handed to Embree may be off by this part of the scene's size; bounds and limits are padded by it.
constexpr double single_precision_slack = 1e-6;

struct DeviceDeleter {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneDeleter {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};

bool finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Whether the numbers of a shape are finite.
struct FiniteShape {
  bool operator()(const Box& b) const { return finite(b.size); }
  bool operator()(const Sphere& s) const { return std::isfinite(s.radius); }
  bool operator()(const Cylinder& c) const { return std::isfinite(c.radius) && std::isfinite(c.height); }
  bool operator()(const Wall& w) const {
    return std::isfinite(w.thickness) && std::isfinite(w.height) && std::ranges::all_of(w.points, [](const glm::dvec2& p) { return finite({p, 0.0}); });
  }
  bool operator()(const MapSolid& m) const { return std::isfinite(m.grid.resolution) && std::isfinite(m.height); }
  bool operator()(const Prism& p) const {
    return std::isfinite(p.height) && std::ranges::all_of(p.outline, [](const glm::dvec2& q) { return finite({q, 0.0}); });
  }
  bool operator()(const MeshSolid& m) const { return std::isfinite(m.scale) && finite(m.mesh->low) && finite(m.mesh->high); }
};

bool traceable(const Ray& ray) { return finite(ray.origin) && std::abs(glm::length(ray.direction) - 1.0) <= 1e-6 && ray.range_max >= 0.0; }  // NaN fails

/// One ray of a packet, in double precision, relative to the scene's origin.
struct LaneRay {
  glm::dvec3 origin{0.0}, direction{1.0, 0.0, 0.0};
  double range_max = -1.0;
  double shift = 0.0;  ///< how far along the ray Embree's own ray starts
};

}  // namespace

/// What Embree's bounds callbacks read.
struct SceneParts {
  double slack = 0.0;  ///< single-precision slack in metres
  Parts parts;
};

struct Scene::Impl : SceneParts {
  World world;
  std::vector<Matter> matter;  ///< of every solid
  glm::dvec3 origin{0.0};
  Bounds box{glm::dvec3(0.0), glm::dvec3(0.0)};  ///< of all parts, padded, relative to the origin
  double diagonal = 0.0;                         ///< of the box
  std::size_t parts_count = 0;
  std::atomic<std::ptrdiff_t> bytes{0};
  std::unique_ptr<RTCDeviceTy, DeviceDeleter> device;
  std::unique_ptr<RTCSceneTy, SceneDeleter> scene;

  template <class Part>
  void add_geometry(const std::vector<Part>& list);

  /// Finds where a ray enters the scene's box (`lane.shift`), and how far Embree's ray goes from there. False if it misses the box.
  bool enter(LaneRay& lane, float& far) const;

  /// Traces packet after packet; `consumer(ray, lane, lane_ray)` takes what `collector` has of each ray. Returns the number of rejected rays.
  template <class Collect, class Consumer>
  std::size_t trace(std::span<const Ray> rays, Collect& collector, Consumer&& consumer) const;

  /// Makes one crossing of the parts of each solid that touch or overlap.
  void join_parts(const LaneRay& lane, std::vector<PartCrossing>& met, double stop, std::vector<Crossing>& out) const;

  template <class Use>
  decltype(auto) with_part(std::uint32_t kind, std::uint32_t part, Use&& use) const {
    switch (kind) {
      case 0: return use(parts.spheres[part]);
      case 1: return use(parts.cylinders[part]);
      default: return use(parts.boxes[part]);
    }
  }

  glm::dvec3 normal(const LaneRay& lane, const PartCrossing& c, double range, int face) const {
    return with_part(c.kind, c.part, [&](const auto& part) { return part_normal(part, lane.origin + range * lane.direction, face); });
  }
};

namespace {

template <class Part>
const std::vector<Part>& parts_of(const Parts& parts) {
  if constexpr (std::is_same_v<Part, SpherePart>) return parts.spheres;
  else if constexpr (std::is_same_v<Part, CylinderPart>) return parts.cylinders;
  else return parts.boxes;
}
template <class Part>
constexpr std::uint32_t kind_of = std::is_same_v<Part, SpherePart> ? 0 : std::is_same_v<Part, CylinderPart> ? 1 : 2;

/// What the intersect callbacks need to know of a packet; Embree hands it through. One of the two collectors is there.
struct Query : embree::Context {
  const Parts* parts = nullptr;
  const LaneRay* lanes = nullptr;
  Nearest* nearest = nullptr;
  Gatherer* gatherer = nullptr;

  void collect_in(Nearest& collector) { nearest = &collector; }
  void collect_in(Gatherer& collector) { gatherer = &collector; }
  double meet(unsigned lane, const PartCrossing& crossing) { return nearest ? nearest->meet(lane, crossing) : gatherer->meet(lane, crossing); }
};

template <class Part>
void bounds_callback(const RTCBoundsFunctionArguments* arguments) {
  const auto& impl = *static_cast<const SceneParts*>(arguments->geometryUserPtr);
  const Bounds bounds = part_bounds(parts_of<Part>(impl.parts)[arguments->primID]);
  const glm::vec3 low(bounds.low - impl.slack), high(bounds.high + impl.slack);
  *arguments->bounds_o = {low.x, low.y, low.z, 0.0f, high.x, high.y, high.z, 0.0f};
}

/// Solves the part for every active ray in double precision. No hit is ever accepted: the collector keeps what it wants, and only the far end of the
/// ray is drawn in, so that Embree skips what lies behind.
template <class Part>
void intersect_callback(const RTCIntersectFunctionNArguments* arguments) {
  auto& query = *static_cast<Query*>(arguments->context);
  RTCRayN* rays = RTCRayHitN_RayN(arguments->rayhit, arguments->N);
  const Part& part = parts_of<Part>(*query.parts)[arguments->primID];
  for (unsigned i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] != -1) continue;
    const unsigned lane_index = RTCRayN_id(rays, arguments->N, i);
    const LaneRay& lane = query.lanes[lane_index];
    PartCrossing crossing;
    if (!cross(part, lane.origin, lane.direction, crossing.interval)) continue;
    // A part that is left at 0 counts where another part of its solid goes on from there: the ray then starts inside.
    if (!(crossing.interval.leave >= 0.0) || crossing.interval.enter > lane.range_max) continue;
    crossing.solid = part.solid;
    crossing.kind = kind_of<Part>;
    crossing.part = arguments->primID;
    const double limit = query.meet(lane_index, crossing) - lane.shift;
    float& far = RTCRayN_tfar(rays, arguments->N, i);
    // Rounded up, so that what lies at the same range is still met and ties are settled by order and not by chance.
    const double padded = std::max(0.0, limit + std::abs(limit) * single_precision_slack + 1e-30);
    if (padded < static_cast<double>(far)) far = static_cast<float>(padded);
  }
}

}  // namespace

template <class Part>
void Scene::Impl::add_geometry(const std::vector<Part>& list) {
  if (list.empty()) return;
  RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(list.size()));
  rtcSetGeometryUserData(geometry, static_cast<SceneParts*>(this));
  rtcSetGeometryBoundsFunction(geometry, &bounds_callback<Part>, nullptr);
  rtcSetGeometryIntersectFunction(geometry, &intersect_callback<Part>);
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_MEDIUM);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene.get(), geometry, kind_of<Part>);
  rtcReleaseGeometry(geometry);
}

bool Scene::Impl::enter(LaneRay& lane, float& far) const {
  if (glm::all(glm::lessThanEqual(box.low, lane.origin)) && glm::all(glm::lessThanEqual(lane.origin, box.high))) {
    // Most rays start inside, and there is nothing behind the diagonal.
    far = static_cast<float>(std::min(lane.range_max, diagonal) * (1.0 + single_precision_slack) + slack);
    return true;
  }
  double near = 0.0, end = lane.range_max;
  for (int axis = 0; axis < 3; ++axis) {
    const double o = lane.origin[axis], d = lane.direction[axis];
    if (d == 0.0) {
      if (o < box.low[axis] || o > box.high[axis]) return false;
      continue;
    }
    const double a = (box.low[axis] - o) / d, b = (box.high[axis] - o) / d;
    near = std::max(near, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  if (!(near <= end)) return false;
  lane.shift = near;
  far = static_cast<float>((end - near) * (1.0 + single_precision_slack) + slack);
  return true;
}

template <class Collect, class Consumer>
std::size_t Scene::Impl::trace(std::span<const Ray> rays, Collect& collector, Consumer&& consumer) const {
  std::size_t rejected = 0;
  std::array<LaneRay, packet> lanes;
  Query query;
  embree::start(query);
  query.parts = &parts;
  query.lanes = lanes.data();
  query.collect_in(collector);
  for (std::size_t first = 0; first < rays.size(); first += packet) {
    alignas(32) int valid[packet];
    alignas(32) RTCRayHit8 batch;
    bool any = false;
    for (unsigned i = 0; i < packet; ++i) {
      // Lanes without a ray get one that ends before it starts: Embree ignores `valid` where a packet is wider than the processor's vectors.
      lanes[i] = LaneRay{};
      float far = -1.0f;
      valid[i] = 0;
      if (first + i < rays.size()) {
        const Ray& ray = rays[first + i];
        if (!traceable(ray)) {
          ++rejected;
        } else {
          lanes[i] = {ray.origin - origin, ray.direction, ray.range_max, 0.0};
          if (parts_count > 0 && enter(lanes[i], far)) valid[i] = -1;
          any = any || valid[i];
        }
      }
      const glm::vec3 start(valid[i] ? lanes[i].origin + lanes[i].shift * lanes[i].direction : glm::dvec3(0.0));
      const glm::vec3 along(lanes[i].direction);
      batch.ray.org_x[i] = start.x;
      batch.ray.org_y[i] = start.y;
      batch.ray.org_z[i] = start.z;
      batch.ray.dir_x[i] = along.x;
      batch.ray.dir_y[i] = along.y;
      batch.ray.dir_z[i] = along.z;
      batch.ray.tnear[i] = 0.0f;
      batch.ray.tfar[i] = valid[i] ? far : -1.0f;
      batch.ray.time[i] = 0.0f;
      batch.ray.mask[i] = ~0u;
      batch.ray.id[i] = i;
      batch.ray.flags[i] = 0;
      batch.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
    collector.reset();
    if (any) embree::intersect8(valid, scene.get(), query, batch);
    for (unsigned i = 0; i < packet && first + i < rays.size(); ++i) consumer(first + i, i, lanes[i]);
  }
  return rejected;
}

Result<Scene> Scene::build(World world) {
  auto impl = std::make_shared<Impl>();
  impl->world = std::move(world);
  for (const Solid& solid : impl->world.solids)
    if (!finite(solid.position) || !std::isfinite(solid.yaw) || !std::visit(FiniteShape{}, solid.shape))
      return Error{fmt::format("solid '{}' has a position, yaw or size that is not finite", solid.name)};
  if (const auto all = extent(impl->world)) {
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
  impl->parts = make_parts(impl->world, impl->origin);
  impl->parts_count = impl->parts.spheres.size() + impl->parts.cylinders.size() + impl->parts.boxes.size();

  impl->device.reset(rtcNewDevice(nullptr));
  if (!impl->device) return Error{fmt::format("Embree could not be started (error {})", static_cast<int>(rtcGetDeviceError(nullptr)))};
  rtcSetDeviceMemoryMonitorFunction(
      impl->device.get(),
      [](void* user, ssize_t bytes, bool) {
        *static_cast<std::atomic<std::ptrdiff_t>*>(user) += bytes;
        return true;
      },
      &impl->bytes);
  impl->scene.reset(rtcNewScene(impl->device.get()));
  rtcSetSceneFlags(impl->scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(impl->scene.get(), RTC_BUILD_QUALITY_MEDIUM);
  impl->add_geometry(impl->parts.spheres);
  impl->add_geometry(impl->parts.cylinders);
  impl->add_geometry(impl->parts.boxes);
  rtcCommitScene(impl->scene.get());
  if (const RTCError error = rtcGetDeviceError(impl->device.get()); error != RTC_ERROR_NONE)
    return Error{fmt::format("Embree could not build the scene (error {})", static_cast<int>(error))};
  return Scene(std::move(impl));
}

const World& Scene::world() const { return impl_->world; }
std::size_t Scene::memory_bytes() const { return static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, impl_->bytes)); }
std::size_t Scene::parts() const { return impl_->parts_count; }

std::size_t Scene::closest_hits(std::span<const Ray> rays, Stops stops, std::span<Hit> hits) const {
  Nearest nearest{impl_->matter, stops};
  return impl_->trace(rays, nearest, [&](std::size_t ray, unsigned lane, const LaneRay& lane_ray) {
    Hit& hit = hits[ray];
    hit = Hit{};
    if (nearest.range[lane] == infinity) return;
    const PartCrossing& met = nearest.best[lane];
    hit.range = nearest.range[lane];
    hit.solid = met.solid;
    hit.normal = met.interval.enter > 0.0 ? impl_->normal(lane_ray, met, hit.range, met.interval.enter_face) : -lane_ray.direction;
  });
}

std::size_t Scene::crossings(std::span<const Ray> rays, double budget_db, CrossingLists& lists, bool through_opaque) const {
  return crossings(rays, impl_->world.materials, budget_db, lists, through_opaque);
}

std::size_t Scene::crossings(std::span<const Ray> rays, std::span<const Material> materials, double budget_db, CrossingLists& lists, bool through_opaque) const {
  lists.items.clear();
  lists.first.assign(1, 0);
  Gatherer gatherer{impl_->matter, depths_of(materials, budget_db, through_opaque)};
  return impl_->trace(rays, gatherer, [&](std::size_t, unsigned lane, const LaneRay& lane_ray) {
    impl_->join_parts(lane_ray, gatherer.met[lane], gatherer.stop[lane], lists.items);
    lists.first.push_back(static_cast<std::uint32_t>(lists.items.size()));
  });
}

void Scene::Impl::join_parts(const LaneRay& lane, std::vector<PartCrossing>& met, double stop, std::vector<Crossing>& out) const {
  // What starts behind the stop may or may not have been met, by the order of the traversal: it is left out, so that the list is the same for any order.
  if (stop < infinity) std::erase_if(met, [stop](const PartCrossing& c) { return c.interval.enter > stop; });
  // Where no solid was met twice, as is usual, every part is a crossing and the parts can be sorted as the crossings will be.
  const bool one_part_each = solids_differ(met);
  if (one_part_each) std::sort(met.begin(), met.end(), ByRange{});
  else std::sort(met.begin(), met.end(), BySolid{});
  const std::size_t begin = out.size();
  for (std::size_t i = 0; i < met.size();) {
    const PartCrossing& first = met[i];
    const PartCrossing* last = &met[i];  // the part that is left last
    for (++i; i < met.size() && met[i].solid == first.solid && met[i].interval.enter <= last->interval.leave; ++i)
      if (met[i].interval.leave > last->interval.leave) last = &met[i];
    if (!(last->interval.leave > 0.0)) continue;
    Crossing& crossing = out.emplace_back();
    crossing.solid = first.solid;
    crossing.starts_inside = first.interval.enter < 0.0;
    crossing.enter = std::max(0.0, first.interval.enter);
    crossing.leave = last->interval.leave;
    if (!crossing.starts_inside) crossing.enter_normal = normal(lane, first, crossing.enter, first.interval.enter_face);
    crossing.leave_normal = normal(lane, *last, crossing.leave, last->interval.leave_face);
  }
  if (one_part_each) return;
  std::sort(out.begin() + static_cast<std::ptrdiff_t>(begin), out.end(), [](const Crossing& a, const Crossing& b) {
    if (a.enter != b.enter) return a.enter < b.enter;
    if (a.leave != b.leave) return a.leave < b.leave;
    return a.solid < b.solid;
  });
}

Clearance Scene::clearance(const Hull& hull, const glm::dvec3& position, double limit) const {
  Clearance answer;
  const glm::dvec3 at = position - impl_->origin;
  if (impl_->parts_count == 0 || !finite(at) || !(limit >= 0.0)) return answer;
  const double z_low = at.z + hull.z_low, z_high = at.z + hull.z_high;

  // Beyond the far corner of the box there is nothing: a limit that reaches that far is as good as an infinite one, and finite.
  const glm::dvec2 to_far_corner = glm::max(glm::abs(glm::dvec2(at) - glm::dvec2(impl_->box.low)), glm::abs(glm::dvec2(at) - glm::dvec2(impl_->box.high)));
  double best = std::min(limit + hull.radius, glm::length(to_far_corner));

  struct State {
    const Impl& impl;
    glm::dvec2 axis;
    double z_low, z_high, half_height;
    double slack;
    double best;
    std::uint32_t solid = no_solid;
    float radius() const {
      const double across = std::max(0.0, best);
      return static_cast<float>(std::sqrt(across * across + half_height * half_height) + slack);
    }
  };
  // Single precision is asked for a point and a radius that are off by no more than the slack that is added.
  const double slack = 4.0 * impl_->slack + single_precision_slack * (glm::length(at) + best);
  State state{*impl_, glm::dvec2(at), z_low, z_high, 0.5 * (z_high - z_low), slack, best};

  RTCPointQuery query;
  query.x = static_cast<float>(at.x);
  query.y = static_cast<float>(at.y);
  query.z = static_cast<float>(0.5 * (z_low + z_high));
  query.time = 0.0f;
  query.radius = state.radius();
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(
      impl_->scene.get(), &query, &context,
      [](RTCPointQueryFunctionArguments* arguments) {
        State& s = *static_cast<State*>(arguments->userPtr);
        return s.impl.with_part(arguments->geomID, arguments->primID, [&](const auto& part) {
          if (!s.impl.matter[part.solid].stops[static_cast<std::size_t>(Stops::motion)]) return false;
          const double distance = axis_distance(part, s.axis, s.z_low, s.z_high);
          const bool nearer = distance < s.best || (distance == s.best && part.solid < s.solid);
          if (!nearer) return false;
          s.best = distance;
          s.solid = part.solid;
          arguments->query->radius = s.radius();
          return true;
        });
      },
      &state);
  if (state.solid != no_solid) answer = {state.best - hull.radius, state.solid};
  return answer;
}

}  // namespace thicket
