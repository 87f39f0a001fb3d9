// What a scene holds. Private to scene*.cpp.
#pragma once

#include <atomic>
#include <cmath>

#include "scene_layer.hpp"

namespace thicket {

inline bool finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// A solid that moves, in its prototype's frame.
struct Mover {
  const Prototype* prototype = nullptr;
  std::uint32_t solid = no_solid;
  double sheet_thickness = 0.0;
};

/// A line that leaves most scenes soon, and lies along no wall.
inline constexpr glm::dvec3 upward(0.36, 0.48, 0.8);

struct Scene::Impl {
  World world;
  std::vector<Matter> matter;  ///< of every solid
  std::vector<double> losses;  ///< of every material: attenuation, dB/m
  glm::dvec3 origin{0.0};
  Bounds box{glm::dvec3(0.0), glm::dvec3(0.0)};  ///< of all there is at any time, padded, relative to the origin
  double diagonal = 0.0;                         ///< of the box
  double slack = 0.0;
  LevelCuts level_cuts{World{}};
  bool has_volumes = false;  ///< closed meshes, which a ray or a hull can be inside of
  double build_s = 0.0, fastest = 0.0;
  std::atomic<std::ptrdiff_t> bytes{0};
  Device device;
  std::vector<std::unique_ptr<Prototype>> prototypes;
  Prototype fixed;                  ///< parts in the scene's frame, and the Embree scene of all that stands still
  std::vector<Instance> instances;  ///< that stand still
  EmbreeScene contact;              ///< where there are instances, the same for hulls: parts, and a box for each instance, whose prototype is then asked by itself
  std::vector<Mover> movers;

  bool empty() const { return fixed.parts.count() == 0 && instances.empty() && movers.empty(); }

  /// Finds where a ray enters the scene's box (`lane.shift`), and how far Embree's ray goes from there. False if it misses the box.
  bool enter(LaneRay& lane, float& far) const;

  /// Traces packet after packet; `consumer(ray, lane, lane_ray)` takes what `collector` has of each ray. Returns the number of rejected rays.
  template <class Collect, class Consumer>
  std::size_t trace(std::span<const Ray> rays, const Moving* moving, Collect& collector, Consumer&& consumer) const;

  /// The closed meshes that a point (relative to the origin) is inside of, told by a line from it: any line, but where the point is on a surface.
  Windings windings(const glm::dvec3& point, const Moving* moving, const glm::dvec3& along = upward) const;
  /// The same for one instance alone.
  Windings windings_in(const Instance& instance, const glm::dvec3& point) const;
  /// Whether a point is within a nanometre of the surface of a closed mesh.
  bool on_surface(const glm::dvec3& point, const Moving* moving) const;

  /// Makes crossings of the parts of each solid that touch or overlap.
  void join_parts(const LaneRay& lane, std::vector<PartCrossing>& met, double stop, std::vector<Crossing>& out) const;

  /// Where a mover stands at a time.
  Instance stand(const Mover& mover, double time) const;

  glm::dvec3 normal(const LaneRay& lane, const PartCrossing& c, double range, std::uint32_t part, int face) const;
};

/// The moving solids at one time.
struct Scene::Moving {
  std::shared_ptr<const Impl> impl;  ///< outlives the Embree scene, which reports its memory there
  std::vector<Instance> instances;
  EmbreeScene scene;
};

}  // namespace thicket
