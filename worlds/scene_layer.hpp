// What Embree traces: prototypes, instances of them, and the layers that hold them. Private to scene*.cpp.
#pragma once

#include <memory>
#include <type_traits>
#include <vector>

#include "collectors.hpp"
#include "embree.hpp"
#include "parts.hpp"
#include "triangle_rays.hpp"

namespace thicket {

/// Single-precision numbers that are handed to Embree may be off by this part of the scene's size; bounds and limits are padded by it.
constexpr double single_precision_slack = 1e-6;

struct DeviceDeleter {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneDeleter {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, DeviceDeleter>;
using EmbreeScene = std::unique_ptr<RTCSceneTy, SceneDeleter>;

/// The kinds of parts, which are also Embree's geometry numbers; instances come after them.
inline constexpr std::uint32_t sphere_kind = 0, cylinder_kind = 1, box_kind = 2, triangle_kind = 3, instance_kind = 4;

/// Matter in a frame of its own.
struct Prototype {
  Parts parts;
  std::shared_ptr<const Mesh> mesh;  ///< or triangles, of a mesh
  glm::dvec3 centre{0.0};            ///< of the mesh, whose frame may be far from it: what is traced is relative to this
  double slack = 0.0;                ///< how much bounds are padded, in this frame
  EmbreeScene scene;

  bool closed() const { return mesh && mesh->closed; }
  std::array<glm::dvec3, 3> corners(std::uint32_t triangle) const {
    const glm::uvec3& t = mesh->triangles[triangle];
    return {mesh->vertices[t.x] - centre, mesh->vertices[t.y] - centre, mesh->vertices[t.z] - centre};
  }

  /// `use(part)` with a sphere, cylinder or box.
  template <class Use>
  decltype(auto) with_part(std::uint32_t kind, std::uint32_t part, Use&& use) const {
    switch (kind) {
      case sphere_kind: return use(parts.spheres[part]);
      case cylinder_kind: return use(parts.cylinders[part]);
      default: return use(parts.boxes[part]);
    }
  }
};

/// A prototype somewhere.
struct Instance {
  const Prototype* prototype = nullptr;
  std::uint32_t solid = no_solid;
  double sheet_thickness = 0.0;
  Placing placing;
};

/// One ray of a packet, in double precision, relative to the scene's origin.
struct LaneRay {
  glm::dvec3 origin{0.0}, direction{1.0, 0.0, 0.0};
  double range_max = -1.0;
  double shift = 0.0;     ///< how far along the ray Embree's own ray starts
  bool to_end = false;    ///< range_max lies behind everything there is
};

/// What the intersect callbacks need to know of a packet; Embree hands it through. One of the two collectors is there.
struct Query : embree::Context {
  const LaneRay* lanes = nullptr;
  const std::vector<Instance>* instances = nullptr;
  const Instance* inside_of = nullptr;  ///< the instance, where its prototype is traced by itself
  bool surfaces_only = false;           ///< nothing but closed meshes is wanted
  Nearest* nearest = nullptr;
  Gatherer* gatherer = nullptr;

  void collect_in(Nearest& collector) { nearest = &collector; }
  void collect_in(Gatherer& collector) { gatherer = &collector; }
  double meet(unsigned lane, const PartCrossing& crossing) { return nearest ? nearest->meet(lane, crossing) : gatherer->meet(lane, crossing); }
  double meet(unsigned lane, const SurfaceHit& hit) { return nearest ? nearest->meet(lane, hit, triangle_kind) : gatherer->meet(lane, hit, triangle_kind); }

  /// Whether what is entered at a range is behind all that a lane still wants.
  bool behind(unsigned lane, double enter) const { return nearest && enter > nearest->range[lane]; }

  /// The instance that Embree is in, or nothing.
  const Instance* instance() const { return instID[0] == RTC_INVALID_GEOMETRY_ID ? inside_of : &(*instances)[instID[0] - instance_kind]; }
  /// A lane's ray in the frame of an instance; kept until another instance is asked for, since Embree stays in one until it is through with it.
  const ShearedRay& inner_ray(const Instance& in, unsigned lane) {
    if (kept_for != &in) {
      kept_for = &in;
      kept.fill(false);
    }
    if (!kept[lane]) {
      inner[lane] = ShearedRay(in.placing.to_inner(lanes[lane].origin), in.placing.direction_to_inner(lanes[lane].direction));
      kept[lane] = true;
    }
    return inner[lane];
  }

  const Instance* kept_for = nullptr;
  std::array<bool, packet> kept{};
  std::array<ShearedRay, packet> inner;
};

/// Makes the prototype's own Embree scene, for instances.
void build(Prototype& prototype, RTCDevice device);
/// Puts parts, triangles or instances into a scene that is not committed yet.
void attach(const Prototype& prototype, RTCDevice device, RTCScene scene);
void attach(const std::vector<Instance>& instances, RTCDevice device, RTCScene scene);
/// Puts a box for each instance into a scene for point queries, as geometry `instance_kind`, and commits it: Embree's own queries through instances miss things where these are scaled.
void commit_with_boxes(const std::vector<Instance>& instances, double slack, RTCDevice device, RTCScene scene);
/// Puts the instances where they stand now; the scene must be committed afterwards.
void update(const std::vector<Instance>& instances, RTCScene scene);

EmbreeScene new_scene(RTCDevice device);
/// Builds what was attached.
void commit(RTCScene scene);

}  // namespace thicket
