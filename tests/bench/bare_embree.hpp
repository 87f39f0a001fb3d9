// Embree as one would use it without Thicket, in single precision: what the scene's rates are held against.
#pragma once

#if __has_include(<embree4/rtcore.h>) && !defined(THICKET_EMBREE3)
#include <embree4/rtcore.h>
#define BARE_EMBREE_MAJOR 4
#else
#include <embree3/rtcore.h>
#define BARE_EMBREE_MAJOR 3
#endif

#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "bench_worlds.hpp"

namespace thicket::bench {

#if BARE_EMBREE_MAJOR == 4
using BareContext = RTCRayQueryContext;
inline void start(BareContext& context) { rtcInitRayQueryContext(&context); }
inline RTCIntersectArguments coherent(BareContext& context) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  return arguments;
}
inline void intersect(RTCScene scene, BareContext& context, RTCRayHit& ray) {
  RTCIntersectArguments arguments = coherent(context);
  rtcIntersect1(scene, &ray, &arguments);
}
inline void intersect(const int* valid, RTCScene scene, BareContext& context, RTCRayHit8& rays) {
  RTCIntersectArguments arguments = coherent(context);
  rtcIntersect8(valid, scene, &rays, &arguments);
}
#else
using BareContext = RTCIntersectContext;
inline void start(BareContext& context) {
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
}
inline void intersect(RTCScene scene, BareContext& context, RTCRayHit& ray) { rtcIntersect1(scene, &context, &ray); }
inline void intersect(const int* valid, RTCScene scene, BareContext& context, RTCRayHit8& rays) { rtcIntersect8(valid, scene, &context, &rays); }
#endif

/// Where a ray met a surface.
struct BareHit {
  float range;
  unsigned primitive;
};

/// A query that gathers: what the callbacks append to, one list per ray of the packet.
struct Gathering : BareContext {
  std::array<std::vector<BareHit>, 8> met;
};

struct Triangles {
  std::vector<glm::vec3> vertices;
  std::vector<std::array<unsigned, 3>> faces;

  /// A box in a frame that is turned by `yaw`.
  void add_box(const glm::dvec3& frame, double yaw, const glm::dvec3& low, const glm::dvec3& high) {
    const auto first = static_cast<unsigned>(vertices.size());
    for (unsigned corner = 0; corner < 8; ++corner) {
      const glm::dvec3 p((corner & 1) ? high.x : low.x, (corner & 2) ? high.y : low.y, (corner & 4) ? high.z : low.z);
      const double c = std::cos(yaw), s = std::sin(yaw);
      vertices.emplace_back(frame + glm::dvec3(c * p.x - s * p.y, s * p.x + c * p.y, p.z));
    }
    constexpr unsigned sides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& q : sides) {
      faces.push_back({first + q[0], first + q[1], first + q[2]});
      faces.push_back({first + q[0], first + q[2], first + q[3]});
    }
  }

  /// An octahedron whose faces were split four ways `levels` times: 8 * 4^levels triangles.
  void add_sphere(const glm::dvec3& centre, double radius, int levels) {
    const auto point = [&](const glm::dvec3& p) {
      vertices.emplace_back(centre + radius * glm::normalize(p));
      return static_cast<unsigned>(vertices.size() - 1);
    };
    const auto split = [&](auto&& self, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, int level) -> void {
      if (level == 0) {
        const unsigned i = point(a), j = point(b), k = point(c);
        faces.push_back({i, j, k});
        return;
      }
      const glm::dvec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
      self(self, a, ab, ca, level - 1);
      self(self, ab, b, bc, level - 1);
      self(self, ca, bc, c, level - 1);
      self(self, ab, bc, ca, level - 1);
    };
    for (const double x : {-1.0, 1.0})
      for (const double y : {-1.0, 1.0})
        for (const double z : {-1.0, 1.0}) split(split, {x, 0.0, 0.0}, {0.0, y, 0.0}, {0.0, 0.0, z}, levels);
  }
};

/// The same world as triangles; spheres as octahedra split `levels` times.
inline Triangles as_triangles(const World& world, int levels = 4) {
  Triangles all;
  for (const Solid& solid : world.solids) {
    if (const auto* box = std::get_if<Box>(&solid.shape)) all.add_box(solid.position, solid.yaw, -0.5 * box->size, 0.5 * box->size);
    if (const auto* sphere = std::get_if<Sphere>(&solid.shape)) all.add_sphere(solid.position, sphere->radius, levels);
    if (const auto* map = std::get_if<MapSolid>(&solid.shape)) {
      const double cell = map->grid.resolution;
      for (const CellBlock& b : map->blocks)
        all.add_box(solid.position, solid.yaw, {b.column * cell, b.row * cell, 0.0}, {(b.column + b.columns) * cell, (b.row + b.rows) * cell, map->height});
    }
  }
  return all;
}

/// Centres and radii of the spheres of a world.
inline std::vector<glm::vec4> as_spheres(const World& world) {
  std::vector<glm::vec4> spheres;
  for (const Solid& solid : world.solids)
    if (const auto* sphere = std::get_if<Sphere>(&solid.shape)) spheres.emplace_back(glm::vec3(solid.position), static_cast<float>(sphere->radius));
  return spheres;
}

enum class Wanted { closest, all };

/// An Embree scene: robust and of medium quality, as Thicket's own.
class BareScene {
 public:
  BareScene() : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_.get())) {
    rtcSetDeviceMemoryMonitorFunction(
        device_.get(),
        [](void* user, ssize_t bytes, bool) {
          *static_cast<std::atomic<std::ptrdiff_t>*>(user) += bytes;
          return true;
        },
        &bytes_);
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_MEDIUM);
  }
  BareScene(const BareScene&) = delete;
  BareScene& operator=(const BareScene&) = delete;
  ~BareScene() = default;

  void add(const Triangles& triangles, Wanted wanted) {
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<glm::vec3*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), triangles.vertices.size()));
    std::copy(triangles.vertices.begin(), triangles.vertices.end(), vertices);
    auto* faces = static_cast<std::array<unsigned, 3>*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(std::array<unsigned, 3>), triangles.faces.size()));
    std::copy(triangles.faces.begin(), triangles.faces.end(), faces);
    if (wanted == Wanted::all) rtcSetGeometryIntersectFilterFunction(geometry, &record_and_reject);
    attach(geometry);
  }
  void add(std::vector<glm::vec4> spheres, Wanted wanted) {
    spheres_ = std::move(spheres);
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(spheres_.size()));
    rtcSetGeometryUserData(geometry, spheres_.data());
    rtcSetGeometryBoundsFunction(geometry, &sphere_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, wanted == Wanted::all ? &sphere_function<true> : &sphere_function<false>);
    attach(geometry);
  }
  void build() { rtcCommitScene(scene_.get()); }

  RTCScene get() const { return scene_.get(); }
  std::ptrdiff_t bytes() const { return bytes_; }  ///< as Embree reports them, the triangles included

 private:
  void attach(RTCGeometry geometry) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);
  }

  static void record_and_reject(const RTCFilterFunctionNArguments* arguments) {
    auto& query = *static_cast<Gathering*>(arguments->context);
    for (unsigned i = 0; i < arguments->N; ++i) {
      if (arguments->valid[i] != -1) continue;
      arguments->valid[i] = 0;
      query.met[RTCRayN_id(arguments->ray, arguments->N, i)].push_back(
          {RTCRayN_tfar(arguments->ray, arguments->N, i), RTCHitN_primID(arguments->hit, arguments->N, i)});
    }
  }

  static void sphere_bounds(const RTCBoundsFunctionArguments* arguments) {
    const glm::vec4& s = static_cast<const glm::vec4*>(arguments->geometryUserPtr)[arguments->primID];
    *arguments->bounds_o = {s.x - s.w, s.y - s.w, s.z - s.w, 0.0f, s.x + s.w, s.y + s.w, s.z + s.w, 0.0f};
  }

  /// Single precision throughout; takes the nearer root in front of the ray, or records both and takes none.
  template <bool gather>
  static void sphere_function(const RTCIntersectFunctionNArguments* arguments) {
    RTCRayN* rays = RTCRayHitN_RayN(arguments->rayhit, arguments->N);
    RTCHitN* hits = RTCRayHitN_HitN(arguments->rayhit, arguments->N);
    const unsigned n = arguments->N;
    const glm::vec4& sphere = static_cast<const glm::vec4*>(arguments->geometryUserPtr)[arguments->primID];
    for (unsigned i = 0; i < n; ++i) {
      if (arguments->valid[i] != -1) continue;
      const glm::vec3 origin(RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i));
      const glm::vec3 direction(RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i));
      const glm::vec3 to_centre = glm::vec3(sphere) - origin;
      const float nearest = glm::dot(to_centre, direction);
      const glm::vec3 off = to_centre - nearest * direction;
      const float half_squared = sphere.w * sphere.w - glm::dot(off, off);
      if (!(half_squared > 0.0f)) continue;
      const float half = std::sqrt(half_squared);
      float& far = RTCRayN_tfar(rays, n, i);
      if constexpr (gather) {
        auto& met = static_cast<Gathering*>(arguments->context)->met[RTCRayN_id(rays, n, i)];
        if (nearest - half >= 0.0f) met.push_back({nearest - half, arguments->primID});
        if (nearest + half >= 0.0f) met.push_back({nearest + half, arguments->primID});
      } else {
        const float range = nearest - half >= 0.0f ? nearest - half : nearest + half;
        if (!(range >= RTCRayN_tnear(rays, n, i) && range < far)) continue;
        far = range;
        const glm::vec3 normal = origin + range * direction - glm::vec3(sphere);
        RTCHitN_Ng_x(hits, n, i) = normal.x;
        RTCHitN_Ng_y(hits, n, i) = normal.y;
        RTCHitN_Ng_z(hits, n, i) = normal.z;
        RTCHitN_u(hits, n, i) = RTCHitN_v(hits, n, i) = 0.0f;
        RTCHitN_primID(hits, n, i) = arguments->primID;
        RTCHitN_geomID(hits, n, i) = arguments->geomID;
        RTCHitN_instID(hits, n, i, 0) = arguments->context->instID[0];
      }
    }
  }

  struct Release {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  };
  std::vector<glm::vec4> spheres_;
  std::atomic<std::ptrdiff_t> bytes_{0};  // outlives the device
  std::unique_ptr<RTCDeviceTy, Release> device_;
  std::unique_ptr<RTCSceneTy, Release> scene_;
};

inline RTCRayHit bare_ray(const Ray& ray, unsigned id) {
  RTCRayHit bare{};
  const glm::vec3 origin(ray.origin), direction(ray.direction);
  bare.ray = {origin.x, origin.y, origin.z, 0.0f, direction.x, direction.y, direction.z, 0.0f, std::numeric_limits<float>::infinity(), ~0u, id, 0};
  bare.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  return bare;
}

/// Packets of eight, ready to go; the last one is filled up with rays that end before they start.
inline std::vector<RTCRayHit8> bare_packets(const std::vector<Ray>& rays) {
  std::vector<RTCRayHit8> packets((rays.size() + 7) / 8);
  for (std::size_t i = 0; i < 8 * packets.size(); ++i) {
    RTCRayHit8& p = packets[i / 8];
    const std::size_t lane = i % 8;
    RTCRayHit one = bare_ray(i < rays.size() ? rays[i] : Ray{}, static_cast<unsigned>(lane));
    if (i >= rays.size()) one.ray.tfar = -1.0f;
    p.ray.org_x[lane] = one.ray.org_x;
    p.ray.org_y[lane] = one.ray.org_y;
    p.ray.org_z[lane] = one.ray.org_z;
    p.ray.dir_x[lane] = one.ray.dir_x;
    p.ray.dir_y[lane] = one.ray.dir_y;
    p.ray.dir_z[lane] = one.ray.dir_z;
    p.ray.tnear[lane] = 0.0f;
    p.ray.tfar[lane] = one.ray.tfar;
    p.ray.time[lane] = 0.0f;
    p.ray.mask[lane] = ~0u;
    p.ray.id[lane] = static_cast<unsigned>(lane);
    p.ray.flags[lane] = 0;
    p.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
  }
  return packets;
}

}  // namespace thicket::bench
