// What is kept of the parts that the rays of a packet meet. Private to scene.cpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "parts.hpp"
#include "thicket/worlds/scene.hpp"

namespace thicket {

/// Rays that are traced together; a ray of a packet is a lane.
inline constexpr unsigned packet = 8;

/// What tracing needs to know of a solid, close together.
struct Matter {
  std::uint32_t material = 0;
  std::array<bool, 3> stops{};  ///< by `Stops`
};

struct Instance;

/// A part that a lane met; of a mesh, a stretch between two triangles of its surface.
struct PartCrossing {
  PartInterval interval;
  std::uint32_t solid = no_solid;
  std::uint32_t kind = 0, part = 0;
  std::uint32_t leave_part = 0;        ///< the part that the leave face belongs to, of the same kind
  const Instance* instance = nullptr;  ///< nothing: in the scene's frame
};

/// A triangle of a closed mesh that a lane met. Which of them begin and end a stretch is known only when all are.
struct SurfaceHit {
  double range;
  std::uint32_t solid;
  std::uint32_t triangle;
  const Instance* instance;
  bool enters;
};
/// Entrances first where ranges are equal: a ray that grazes an edge then enters before it leaves.
struct BySolidAndRange {
  bool operator()(const SurfaceHit& a, const SurfaceHit& b) const {
    if (a.solid != b.solid) return a.solid < b.solid;
    if (a.range != b.range) return a.range < b.range;
    if (a.enters != b.enters) return a.enters;
    return a.triangle < b.triangle;
  }
};

/// How often closed meshes are wound around a point: the solids for which that is not 0. Inside of those for which it is positive.
struct Windings {
  std::vector<std::pair<std::uint32_t, int>> of;

  int find(std::uint32_t solid) const {
    for (const auto& [s, winding] : of)
      if (s == solid) return winding;
    return 0;
  }
};

/// One total order of what is met at the same range.
inline bool before(const PartCrossing& a, const PartCrossing& b) {
  if (a.solid != b.solid) return a.solid < b.solid;
  if (a.kind != b.kind) return a.kind < b.kind;
  return a.part < b.part;
}

/// For joining: the parts of a solid one after the other, by entrance.
struct BySolid {
  bool operator()(const PartCrossing& a, const PartCrossing& b) const {
    if (a.solid != b.solid) return a.solid < b.solid;
    if (a.interval.enter != b.interval.enter) return a.interval.enter < b.interval.enter;
    return before(a, b);
  }
};
/// As crossings are listed.
struct ByRange {
  bool operator()(const PartCrossing& a, const PartCrossing& b) const {
    const double enter_a = std::max(0.0, a.interval.enter), enter_b = std::max(0.0, b.interval.enter);
    if (enter_a != enter_b) return enter_a < enter_b;
    if (a.interval.leave != b.interval.leave) return a.interval.leave < b.interval.leave;
    return a.solid < b.solid;
  }
};
/// Whether every part is of another solid. (Many parts are not looked through: false.)
inline bool solids_differ(const std::vector<PartCrossing>& met) {
  if (met.size() > 16) return false;
  for (std::size_t i = 1; i < met.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (met[i].solid == met[j].solid) return false;
  return true;
}

/// The nearest part that blocks.
struct Nearest {
  const std::vector<Matter>& matter;
  Stops stops;
  std::array<PartCrossing, packet> best{};
  std::array<double, packet> range{};

  void reset() { range.fill(infinity); }
  /// Takes in a part that a ray of the packet crosses. Returns the range behind which nothing more is wanted.
  double meet(unsigned lane, const PartCrossing& crossing) {
    if (!matter[crossing.solid].stops[static_cast<std::size_t>(stops)] || crossing.interval.leave == 0.0) return infinity;
    const double at = std::max(0.0, crossing.interval.enter);
    if (at < range[lane] || (at == range[lane] && before(crossing, best[lane]))) {
      range[lane] = at;
      best[lane] = crossing;
    }
    return range[lane];
  }
  double meet(unsigned lane, const SurfaceHit& hit, std::uint32_t kind) {
    if (!hit.enters) return infinity;  // what a ray starts inside of is found by windings
    return meet(lane, {{hit.range, infinity, 0, 0}, hit.solid, kind, hit.triangle, hit.triangle, hit.instance});
  }
};

/// How far a ray gets inside each material before its budget is used up, m.
inline std::vector<double> depths_of(std::span<const double> loss_per_m, double budget, bool through_opaque) {
  std::vector<double> depths;
  depths.reserve(loss_per_m.size());
  for (const double loss : loss_per_m) depths.push_back(through_opaque || !(loss > 0.0) ? infinity : loss == infinity ? 0.0 : budget / loss);
  return depths;
}

/// All parts as far as the budget reaches.
struct Gatherer {
  const std::vector<Matter>& matter;
  std::vector<double> depths;  ///< by material: `depths_of`
  std::array<std::vector<PartCrossing>, packet> met{};
  std::array<std::vector<SurfaceHit>, packet> surfaces{};
  std::array<double, packet> stop{};

  void reset() {
    for (auto& list : met) list.clear();
    for (auto& list : surfaces) list.clear();
    stop.fill(infinity);
  }
  /// As `Nearest::meet`.
  double meet(unsigned lane, const PartCrossing& crossing) {
    met[lane].push_back(crossing);
    // A part that is deep enough to use up the whole budget by itself ends the ray, whatever else lies on it. Deeper by more than rounding: whoever adds up
    // the losses along the list must come to the same end, or he would go on where the list does not.
    const double end = std::max(0.0, crossing.interval.enter) + depths[matter[crossing.solid].material];
    if (end * (1.0 + 1e-12) < crossing.interval.leave) stop[lane] = std::min(stop[lane], end);
    return stop[lane];
  }
  double meet(unsigned lane, const SurfaceHit& hit, std::uint32_t) {
    surfaces[lane].push_back(hit);
    // How deep it is behind here is not known yet; only for opaque matter that does not matter.
    if (hit.enters && depths[matter[hit.solid].material] == 0.0) stop[lane] = std::min(stop[lane], hit.range);
    return stop[lane];
  }
};

}  // namespace thicket
