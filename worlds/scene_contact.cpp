// How near a hull is to matter.
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene_impl.hpp"
#include "thicket/worlds/scene.hpp"

namespace thicket {
namespace {

/// The nearest matter so far.
struct Search {
  const std::vector<Matter>& matter;
  glm::dvec2 axis;
  double z_low, z_high;
  double best;
  double slack;                        ///< how much Embree's single-precision sphere is widened
  const std::vector<Instance>* instances = nullptr;
  const Prototype* fixed = nullptr;
  const Instance* inside_of = nullptr;
  std::uint32_t solid = no_solid;

  /// Of the sphere about the middle of the axis that holds everything nearer than the best.
  double radius() const {
    const double across = std::max(0.0, best), half = 0.5 * (z_high - z_low);
    return std::sqrt(across * across + half * half) + slack;
  }
  double distance(const Instance* instance, std::uint32_t kind, std::uint32_t part) const {
    if (!instance) return fixed->with_part(kind, part, [&](const auto& p) { return axis_distance(p, axis, z_low, z_high); });
    const Prototype& prototype = *instance->prototype;
    const Placing& placing = instance->placing;
    if (kind == triangle_kind) {
      auto corners = prototype.corners(part);
      for (glm::dvec3& corner : corners) corner = placing.to_outer(corner);
      return axis_distance(corners, axis, z_low, z_high);
    }
    if (!placing.upright) return prototype.with_part(kind, part, [&](const auto& p) { return axis_distance(placing, p, axis, z_low, z_high); });
    const glm::dvec3 low = placing.to_inner({axis, z_low});
    return prototype.with_part(kind, part, [&](const auto& p) { return axis_distance(p, glm::dvec2(low), low.z, low.z + (z_high - z_low)); });
  }
  /// True if that was nearer.
  bool look(const Instance* instance, std::uint32_t kind, std::uint32_t part) {
    const std::uint32_t of = instance ? instance->solid : fixed->with_part(kind, part, [](const auto& p) { return p.solid; });
    if (!matter[of].stops[static_cast<std::size_t>(Stops::motion)]) return false;
    const double found = distance(instance, kind, part);
    if (!(found < best || (found == best && of < solid))) return false;
    best = found;
    solid = of;
    return true;
  }
};

bool look_callback(RTCPointQueryFunctionArguments* arguments) {
  Search& search = *static_cast<Search*>(arguments->userPtr);
  const RTCPointQueryContext& context = *arguments->context;
  const Instance* instance = context.instStackSize > 0 ? &(*search.instances)[context.instID[0] - instance_kind] : search.inside_of;
  if (!search.look(instance, arguments->geomID, arguments->primID)) return false;
  // In an instance the query's radius is still the one outside of it, but where a prototype is asked by itself.
  const double scale = search.inside_of ? search.inside_of->placing.scale : 1.0;
  arguments->query->radius = static_cast<float>(search.radius() / scale);
  return true;
}

void ask(RTCScene scene, const glm::dvec3& middle, double radius, Search& search) {
  RTCPointQuery query;
  query.x = static_cast<float>(middle.x);
  query.y = static_cast<float>(middle.y);
  query.z = static_cast<float>(middle.z);
  query.time = 0.0f;
  query.radius = static_cast<float>(radius);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene, &query, &context, &look_callback, &search);
}

}  // namespace

Clearance Scene::clearance(const Hull& hull, const Moment& moment, double limit) const {
  Clearance answer;
  const glm::dvec3 at = moment.position - impl_->origin;
  if (impl_->empty() || !(std::isfinite(at.x) && std::isfinite(at.y) && std::isfinite(at.z)) || !(limit >= 0.0)) return answer;
  const double z_low = at.z + hull.z_low, z_high = at.z + hull.z_high;

  // Beyond the far corner of the box there is nothing: a limit that reaches that far is as good as an infinite one, and finite.
  const glm::dvec2 to_far_corner = glm::max(glm::abs(glm::dvec2(at) - glm::dvec2(impl_->box.low)), glm::abs(glm::dvec2(at) - glm::dvec2(impl_->box.high)));
  const double best = std::min(limit + hull.radius, glm::length(to_far_corner));
  // Single precision is asked for a point and a radius that are off by no more than the slack that is added.
  Search search{impl_->matter, glm::dvec2(at), z_low, z_high, best, 4.0 * impl_->slack + single_precision_slack * (glm::length(at) + best)};
  search.instances = &impl_->instances;
  search.fixed = &impl_->fixed;
  const glm::dvec3 middle(search.axis, 0.5 * (z_low + z_high));
  ask(impl_->fixed.scene.get(), middle, search.radius(), search);

  for (const Mover& mover : impl_->movers) {
    if (!impl_->matter[mover.solid].stops[static_cast<std::size_t>(Stops::motion)]) continue;
    // At the moment's own time, which need not be the scene's: the way of a step is looked at in between.
    const Instance instance = impl_->stand(mover, moment.time);
    search.inside_of = &instance;
    ask(mover.prototype->scene.get(), instance.placing.to_inner(middle), (search.radius() + mover.prototype->slack) / instance.placing.scale, search);
  }

  // A hull with its axis inside a closed mesh may be far from any of its triangles.
  if (impl_->has_volumes) {
    for (const auto& [solid, winding] : impl_->windings(middle, moving_.get()).of) {
      if (winding <= 0 || !impl_->matter[solid].stops[static_cast<std::size_t>(Stops::motion)]) continue;
      search.best = std::min(search.best, 0.0);
      if (search.solid == no_solid || search.best == 0.0) search.solid = solid;
      if (search.best > -infinity) answer = {search.best - hull.radius, search.solid};
    }
  }
  if (search.solid != no_solid) answer = {search.best - hull.radius, search.solid};
  return answer;
}

}  // namespace thicket
