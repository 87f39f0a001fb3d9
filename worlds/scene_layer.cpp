#include "scene_layer.hpp"

#include <cmath>
#include <map>

#include <glm/common.hpp>

#include "part_rays.hpp"
#include "thicket/base/float_traps.hpp"

namespace thicket {
namespace {

template <class Part>
const std::vector<Part>& parts_of(const Parts& parts) {
  if constexpr (std::is_same_v<Part, SpherePart>) return parts.spheres;
  else if constexpr (std::is_same_v<Part, CylinderPart>) return parts.cylinders;
  else return parts.boxes;
}
template <class Part>
constexpr std::uint32_t kind_of = std::is_same_v<Part, SpherePart> ? sphere_kind : std::is_same_v<Part, CylinderPart> ? cylinder_kind : box_kind;

const Prototype& prototype_of(void* user) { return *static_cast<const Prototype*>(user); }

void give_bounds(const Bounds& bounds, double slack, RTCBounds& out) {
  const glm::vec3 low(bounds.low - slack), high(bounds.high + slack);
  out = {low.x, low.y, low.z, 0.0f, high.x, high.y, high.z, 0.0f};
}

template <class Part>
void part_bounds_callback(const RTCBoundsFunctionArguments* arguments) {
  const Prototype& prototype = prototype_of(arguments->geometryUserPtr);
  give_bounds(part_bounds(parts_of<Part>(prototype.parts)[arguments->primID]), prototype.slack, *arguments->bounds_o);
}

void triangle_bounds_callback(const RTCBoundsFunctionArguments* arguments) {
  const Prototype& prototype = prototype_of(arguments->geometryUserPtr);
  const auto [a, b, c] = prototype.corners(arguments->primID);
  give_bounds({glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))}, prototype.slack, *arguments->bounds_o);
}

/// Draws in the far end of Embree's ray to what a collector still wants.
void draw_in(RTCRayN* rays, unsigned count, unsigned i, double limit) {
  float& far = RTCRayN_tfar(rays, count, i);
  // Rounded up, so that what lies at the same range is still met and ties are settled by order and not by chance.
  const double padded = std::max(0.0, limit + std::abs(limit) * single_precision_slack + 1e-30);
  if (padded < static_cast<double>(far)) far = static_cast<float>(padded);
}

/// Solves the part for every active ray in double precision. No hit is ever accepted: the collector keeps what it wants, and only the far end of the
/// ray is drawn in, so that Embree skips what lies behind.
template <class Part>
void part_callback(const RTCIntersectFunctionNArguments* arguments) {
  auto& query = *static_cast<Query*>(arguments->context);
  if (query.surfaces_only) return;
  RTCRayN* rays = RTCRayHitN_RayN(arguments->rayhit, arguments->N);
  const Part& part = parts_of<Part>(prototype_of(arguments->geometryUserPtr).parts)[arguments->primID];
  const Instance* instance = query.instance();
  for (unsigned i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] != -1) continue;
    const unsigned lane_index = RTCRayN_id(rays, arguments->N, i);
    const LaneRay& lane = query.lanes[lane_index];
    PartInterval interval;
    if (instance) {
      const ShearedRay& inner = query.inner_ray(*instance, lane_index);
      if (!cross(part, inner.origin, inner.direction, interval)) continue;
    } else if (!cross(part, lane.origin, lane.direction, interval)) {
      continue;
    }
    // A part that is left at 0 counts where another part of its solid goes on from there: the ray then starts inside.
    if (!(interval.leave >= 0.0) || interval.enter > lane.range_max || query.behind(lane_index, interval.enter)) continue;
    PartCrossing crossing;
    crossing.interval = interval;
    crossing.solid = instance ? instance->solid : part.solid;
    crossing.kind = kind_of<Part>;
    crossing.part = crossing.leave_part = arguments->primID;
    crossing.instance = instance;
    draw_in(rays, arguments->N, i, query.meet(lane_index, crossing) - lane.shift);
  }
}

/// As above, for a triangle: a surface of a volume, or a piece of a sheet. Triangles are always in an instance.
void triangle_callback(const RTCIntersectFunctionNArguments* arguments) {
  auto& query = *static_cast<Query*>(arguments->context);
  const Prototype& prototype = prototype_of(arguments->geometryUserPtr);
  const bool volume = prototype.closed();
  if (query.surfaces_only && !volume) return;
  RTCRayN* rays = RTCRayHitN_RayN(arguments->rayhit, arguments->N);
  const auto [a, b, c] = prototype.corners(arguments->primID);
  const Instance& instance = *query.instance();
  for (unsigned i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] != -1) continue;
    const unsigned lane_index = RTCRayN_id(rays, arguments->N, i);
    const LaneRay& lane = query.lanes[lane_index];
    const ShearedRay& inner = query.inner_ray(instance, lane_index);
    TriangleHit hit;
    if (!meet(inner, a, b, c, hit)) continue;
    double limit = infinity;
    if (volume) {
      limit = query.meet(lane_index, SurfaceHit{hit.range, instance.solid, arguments->primID, &instance, hit.enters});
    } else if (hit.range <= lane.range_max) {
      // The way through a sheet: thickness / cos(incidence), but no longer than the triangle is.
      const double scale = instance.placing.scale;
      const double cosine = std::abs(glm::dot(unit_normal(a, b, c), inner.direction)) * scale;
      const double longest = scale * std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
      const double way = cosine * longest > instance.sheet_thickness ? instance.sheet_thickness / cosine : longest;
      limit = query.meet(lane_index, PartCrossing{{hit.range, hit.range + way, 0, 0}, instance.solid, triangle_kind, arguments->primID, arguments->primID, &instance});
    }
    draw_in(rays, arguments->N, i, limit - lane.shift);
  }
}

void attach(RTCDevice device, RTCScene scene, const Prototype& prototype, std::uint32_t kind, std::size_t count, RTCBoundsFunction bounds, RTCIntersectFunctionN intersect) {
  if (count == 0) return;
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(count));
  rtcSetGeometryUserData(geometry, const_cast<Prototype*>(&prototype));
  rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect);
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_MEDIUM);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, kind);
  rtcReleaseGeometry(geometry);
}

template <class Part>
void attach_parts(RTCDevice device, RTCScene scene, const Prototype& prototype) {
  attach(device, scene, prototype, kind_of<Part>, parts_of<Part>(prototype.parts).size(), &part_bounds_callback<Part>, &part_callback<Part>);
}

void place(RTCGeometry geometry, const Placing& p) {
  std::array<float, 12> columns{};
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row)
      columns[static_cast<std::size_t>(3 * column + row)] = static_cast<float>(column < 3 ? p.scale * p.turn[column][row] : p.position[row]);
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
  rtcCommitGeometry(geometry);
}

}  // namespace

EmbreeScene new_scene(RTCDevice device) {
  EmbreeScene scene(rtcNewScene(device));
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_MEDIUM);
  return scene;
}

void commit(RTCScene scene) {
  // Embree sorts boxes with lanes that hold infinities and nothing: invalid operations whose results it masks.
  const NoFloatTraps guard;
  rtcCommitScene(scene);
}

void attach(const Prototype& prototype, RTCDevice device, RTCScene scene) {
  attach_parts<SpherePart>(device, scene, prototype);
  attach_parts<CylinderPart>(device, scene, prototype);
  attach_parts<BoxPart>(device, scene, prototype);
  if (prototype.mesh) attach(device, scene, prototype, triangle_kind, prototype.mesh->triangles.size(), &triangle_bounds_callback, &triangle_callback);
}

void build(Prototype& prototype, RTCDevice device) {
  prototype.scene = new_scene(device);
  attach(prototype, device, prototype.scene.get());
  commit(prototype.scene.get());
}

void attach(const std::vector<Instance>& instances, RTCDevice device, RTCScene scene) {
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, instances[i].prototype->scene.get());
    rtcSetGeometryTimeStepCount(geometry, 1);
    place(geometry, instances[i].placing);
    rtcAttachGeometryByID(scene, geometry, instance_kind + i);
    rtcReleaseGeometry(geometry);
  }
}

namespace {

/// The box that holds what a prototype has.
Bounds bounds_of(const Prototype& prototype) {
  if (prototype.mesh) return {prototype.mesh->low - prototype.centre, prototype.mesh->high - prototype.centre};
  Bounds all{glm::dvec3(infinity), glm::dvec3(-infinity)};
  const auto take = [&all](const auto& parts) {
    for (const auto& part : parts) all = join(all, part_bounds(part));
  };
  take(prototype.parts.spheres);
  take(prototype.parts.cylinders);
  take(prototype.parts.boxes);
  return all;
}

}  // namespace

void commit_with_boxes(const std::vector<Instance>& instances, double slack, RTCDevice device, RTCScene scene) {
  // Read when the scene is committed.
  struct Boxes {
    std::vector<Bounds> of;
    double slack;
  } boxes{{}, slack};
  std::map<const Prototype*, Bounds> inner;
  for (const Instance& instance : instances) {
    const auto found = inner.try_emplace(instance.prototype).first;
    if (found->second.low == found->second.high) found->second = bounds_of(*instance.prototype);
    const Bounds& b = found->second;
    const Placing& p = instance.placing;
    const glm::dvec3 middle = p.to_outer(0.5 * (b.low + b.high)), half = 0.5 * p.scale * (b.high - b.low);
    const glm::dvec3 reach = glm::abs(p.turn[0]) * half.x + glm::abs(p.turn[1]) * half.y + glm::abs(p.turn[2]) * half.z;
    boxes.of.push_back({middle - reach, middle + reach});
  }
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(boxes.of.size()));
  rtcSetGeometryUserData(geometry, &boxes);
  const RTCBoundsFunction bounds = [](const RTCBoundsFunctionArguments* arguments) {
    const auto& from = *static_cast<const Boxes*>(arguments->geometryUserPtr);
    give_bounds(from.of[arguments->primID], from.slack, *arguments->bounds_o);
  };
  rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, [](const RTCIntersectFunctionNArguments*) {});
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, instance_kind);
  rtcReleaseGeometry(geometry);
  commit(scene);
}

void update(const std::vector<Instance>& instances, RTCScene scene) {
  for (std::uint32_t i = 0; i < instances.size(); ++i) place(rtcGetGeometry(scene, instance_kind + i), instances[i].placing);
}

}  // namespace thicket
