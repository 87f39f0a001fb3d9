// A world made traceable. Only scene*.cpp knows Embree.
//
// Rays and answers are spans of plain data in double precision. Inside, everything is relative to the scene's own origin, so that a world at 10^6 m
// is as exact as one at 0; Embree's single precision only decides which solids a ray can meet (with bounds padded for its rounding), and every distance is
// then solved in double precision. An answer depends on its own ray alone: not on the other rays of the span, on packets or on threads.
//
// A scene is a value: copies share everything but the poses of moving solids, which `set_time` gives.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "thicket/base/result.hpp"
#include "thicket/worlds/world.hpp"

namespace thicket {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr std::uint32_t no_solid = std::numeric_limits<std::uint32_t>::max();

/// A ray in world coordinates. It is traced if its origin is finite, its direction is of length 1 (to 1e-6) and 0 <= range_max, which may be infinite; any
/// other ray is *rejected*: it meets nothing, and the functions below count it.
struct Ray {
  glm::dvec3 origin{0.0};
  glm::dvec3 direction{1.0, 0.0, 0.0};
  double range_max = infinity;
};

/// The first surface on a ray: range in metres (+inf: none within range_max), the solid, and the surface's outward unit normal.
/// A ray that starts inside matter has range 0 and the normal against its direction.
struct Hit {
  double range = infinity;
  std::uint32_t solid = no_solid;
  glm::dvec3 normal{0.0};
};

/// A stretch of a ray inside one solid. Parts of a solid that touch or overlap are one stretch.
struct Crossing {
  double enter = 0.0;          ///< range of the entrance, m; 0 where the ray starts inside
  double leave = infinity;     ///< range of the exit, m; may lie beyond what was asked for
  std::uint32_t solid = no_solid;
  bool starts_inside = false;
  glm::dvec3 enter_normal{0.0};  ///< outward unit normals; zero at a start inside
  glm::dvec3 leave_normal{0.0};
};

/// Lists of crossings, one list per ray, in one array: list i is items[first[i] ... first[i + 1]).
struct CrossingLists {
  std::vector<Crossing> items;
  std::vector<std::uint32_t> first;

  std::span<const Crossing> operator[](std::size_t ray) const {
    return std::span(items).subspan(first[ray], first[ray + 1] - first[ray]);
  }
};

/// What a closest hit is looked for in.
enum class Stops : std::uint8_t { everything, light, motion };

/// The robot as contact sees it: an upright cylinder, z_low and z_high above the ground that its pose stands on (world z = pose z + ...).
struct Hull {
  double radius = 0.3;
  double z_low = 0.0;
  double z_high = 0.5;
};

/// The nearest matter that stops motion.
struct Clearance {
  double distance = infinity;  ///< horizontal distance from the hull, m; negative where the hull's axis is nearer than its radius; +inf: none within the limit
  std::uint32_t solid = no_solid;
};

/// Where a hull is, and when.
struct Moment {
  glm::dvec3 position{0.0};
  double time = 0.0;
};

/// What a scene is made of and what it took.
struct SceneFigures {
  std::size_t parts = 0;         ///< convex parts that are traced in closed form
  std::size_t triangles = 0;     ///< of meshes and prisms, each mesh counted once however often it stands
  std::size_t instances = 0;     ///< poses of meshes, of tilted and of moving solids
  std::size_t moving = 0;        ///< of these, the moving ones
  std::size_t memory_bytes = 0;  ///< of the acceleration structure, as Embree reports it
  double build_s = 0.0;          ///< wall time
};

class Scene {
 public:
  /// Builds the acceleration structure; the world is kept. Fails if Embree does, or if a solid's numbers are not finite. Moving solids stand where they are at time 0.
  static Result<Scene> build(World world);

  const World& world() const;
  /// Index of a solid's material: the world's, from a list that is near at hand.
  std::uint32_t material(std::uint32_t solid) const;

  /// Puts moving solids where they are at a time, s; costs nothing where nothing moves. Copies of this scene stay as they are.
  void set_time(double time);
  double time() const { return time_; }
  bool moves() const;
  /// How fast a point (in world coordinates) of a solid moves now, m/s; zero for one that stands still.
  glm::dvec3 velocity(std::uint32_t solid, const glm::dvec3& point) const;
  /// The greatest speed of any point of a moving solid, m/s; 0 where nothing moves.
  double fastest() const;
  const LevelCuts& level_cuts() const;

  /// hits[i] becomes the first surface on rays[i] of matter that stops what is named. Returns how many rays were rejected.
  std::size_t closest_hits(std::span<const Ray> rays, Stops stops, std::span<Hit> hits) const;

  /// All solids along each ray in one traversal, sorted by (enter, leave, solid). With a penetration budget in dB the list may leave out whatever lies
  /// behind the point where the ray is exhausted (behind the entrance of an opaque solid at the latest); an infinite budget with `through_opaque` gives everything up
  /// to range_max. Returns how many rays were rejected.
  std::size_t crossings(std::span<const Ray> rays, double budget_db, CrossingLists& lists, bool through_opaque = false) const;
  /// The same with other losses than the world's attenuations: `loss_per_m` of its materials in its order, as a wave of some frequency meets them, >= 0, infinite where
  /// it is stopped; in any unit that the budget is in too.
  std::size_t crossings(std::span<const Ray> rays, std::span<const double> loss_per_m, double budget, CrossingLists& lists, bool through_opaque = false) const;

  /// Clearance of the hull at a position (world x, y and the z that the hull stands on), as far as `limit`, at the scene's time or another one.
  Clearance clearance(const Hull& hull, const glm::dvec3& position, double limit) const { return clearance(hull, Moment{position, time_}, limit); }
  Clearance clearance(const Hull& hull, const Moment& moment, double limit) const;

  /// The first contact of a hull that moves along a path: `position_at(s)` for s in [0, length] gives a position or a `Moment`. Hull and solids together move at most
  /// 1 m per metre of s. Conservative advancement: each step goes as far as the clearance allows, so that nothing is tunnelled through, however thin or fast. Returns the s of contact
  /// (clearance below 1e-6 m), or +inf. `nearest` becomes the clearance that was seen last or at the contact, and `least` the least along the way
  /// (both looked for as far as `limit`).
  template <class Path>
  double first_contact(const Hull& hull, Path&& position_at, double length, double limit, Clearance& nearest, double& least) const;

  SceneFigures figures() const;

  struct Impl;    // scene_impl.hpp, not for others
  struct Moving;

 private:
  explicit Scene(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
  std::shared_ptr<const Impl> impl_;      // immutable: copies share it
  std::shared_ptr<Moving> moving_;        // what moves, as it stands at time_; changed only by its sole owner
  double time_ = 0.0;
};

template <class Path>
double Scene::first_contact(const Hull& hull, Path&& position_at, double length, double limit, Clearance& nearest, double& least) const {
  constexpr double touching = 1e-6, smallest_step = 1e-4, exact = 1e-9;
  // What is farther than the way that is left cannot be met: looking that far is enough, and `limit` widens it for the record.
  const auto look = [&](double s) { return clearance(hull, position_at(s), std::max({limit, length - s, touching})); };
  double s = 0.0, clear = 0.0;  // clear: where the last look found no contact
  for (;;) {
    nearest = look(s);
    // The smallest step may be more than the clearance allowed: where it touches, the contact lies somewhere between its ends.
    for (double middle = 0.5 * (clear + s); nearest.distance < touching && s - clear > exact && clear < middle && middle < s; middle = 0.5 * (clear + s)) {
      const Clearance there = look(middle);
      if (there.distance < touching) {
        s = middle;
        nearest = there;
      } else {
        clear = middle;
      }
    }
    least = std::min(least, nearest.distance);
    if (nearest.distance < touching) return s;
    if (s >= length) return infinity;
    clear = s;
    s = std::min(length, s + std::max(nearest.distance, smallest_step));
  }
}

}  // namespace thicket
