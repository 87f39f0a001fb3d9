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
  std::uint32_t solid = no_solid;
  const Instance* inside_of = nullptr;  ///< the instance whose prototype is being asked

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

void ask(RTCScene scene, const glm::dvec3& middle, double radius, RTCPointQueryFunction look, void* user) {
  RTCPointQuery query;
  query.x = static_cast<float>(middle.x);
  query.y = static_cast<float>(middle.y);
  query.z = static_cast<float>(middle.z);
  query.time = 0.0f;
  query.radius = static_cast<float>(radius);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene, &query, &context, look, user);
}

glm::dvec3 middle_of(const Search& search) { return {search.axis, 0.5 * (search.z_low + search.z_high)}; }
double inner_radius(const Search& search, const Instance& instance) { return search.radius() / instance.placing.scale + instance.prototype->slack; }

bool look_in_prototype(RTCPointQueryFunctionArguments* arguments) {
  Search& search = *static_cast<Search*>(arguments->userPtr);
  if (!search.look(search.inside_of, arguments->geomID, arguments->primID)) return false;
  arguments->query->radius = static_cast<float>(inner_radius(search, *search.inside_of));
  return true;
}

/// Asks the prototype of an instance, in its own frame. True if something nearer was there.
bool look_in_instance(const Instance& instance, Search& search) {
  if (!search.matter[instance.solid].stops[static_cast<std::size_t>(Stops::motion)]) return false;
  const double before = search.best;
  const std::uint32_t solid = search.solid;
  search.inside_of = &instance;
  ask(instance.prototype->scene.get(), instance.placing.to_inner(middle_of(search)), inner_radius(search, instance), &look_in_prototype, &search);
  return search.best < before || search.solid != solid;
}

bool look_in_scene(RTCPointQueryFunctionArguments* arguments) {
  Search& search = *static_cast<Search*>(arguments->userPtr);
  const bool instance = arguments->geomID == instance_kind;
  if (!(instance ? look_in_instance((*search.instances)[arguments->primID], search) : search.look(nullptr, arguments->geomID, arguments->primID))) return false;
  arguments->query->radius = static_cast<float>(search.radius());
  return true;
}

/// Whether a point is on a closed mesh.
struct Touch {
  const std::vector<Instance>* instances = nullptr;
  glm::dvec3 point;  ///< relative to the scene's origin
  double slack;      ///< of Embree's single-precision sphere
  const Instance* inside_of = nullptr;
  bool found = false;

  static constexpr double near = 1e-9;  // m

  void look_in(const Instance& instance) {
    if (found || !instance.prototype->closed()) return;
    inside_of = &instance;
    const double scale = instance.placing.scale;
    ask(instance.prototype->scene.get(), instance.placing.to_inner(point), near / scale + 4.0 * instance.prototype->slack, &look, this);
  }
  static bool look(RTCPointQueryFunctionArguments* arguments) {
    Touch& touch = *static_cast<Touch*>(arguments->userPtr);
    if (touch.found) return false;
    const Placing& placing = touch.inside_of->placing;
    const auto [a, b, c] = touch.inside_of->prototype->corners(arguments->primID);
    touch.found = triangle_distance(placing.to_inner(touch.point), a, b, c) * placing.scale <= near;
    return false;
  }
  static bool look_in_scene(RTCPointQueryFunctionArguments* arguments) {
    Touch& touch = *static_cast<Touch*>(arguments->userPtr);
    if (arguments->geomID == instance_kind) touch.look_in((*touch.instances)[arguments->primID]);
    return false;
  }
};

}  // namespace

bool Scene::Impl::on_surface(const glm::dvec3& point, const Moving* moving) const {
  Touch touch{&instances, point, 4.0 * slack + single_precision_slack * glm::length(point)};
  if (contact) ask(contact.get(), point, Touch::near + touch.slack, &Touch::look_in_scene, &touch);
  if (moving)
    for (const Instance& instance : moving->instances) touch.look_in(instance);
  return touch.found;
}

Clearance Scene::clearance(const Hull& hull, const Moment& moment, double limit) const {
  Clearance answer;
  const glm::dvec3 at = moment.position - impl_->origin;
  if (impl_->empty() || !finite(at) || !(limit >= 0.0)) return answer;
  const double z_low = at.z + hull.z_low, z_high = at.z + hull.z_high;

  // Beyond the far corner of the box there is nothing: a limit that reaches that far is as good as an infinite one, and finite.
  const glm::dvec2 to_far_corner = glm::max(glm::abs(glm::dvec2(at) - glm::dvec2(impl_->box.low)), glm::abs(glm::dvec2(at) - glm::dvec2(impl_->box.high)));
  const double best = std::min(limit + hull.radius, glm::length(to_far_corner));
  // Single precision is asked for a point and a radius that are off by no more than the slack that is added.
  Search search{impl_->matter, glm::dvec2(at), z_low, z_high, best, 4.0 * impl_->slack + single_precision_slack * (glm::length(at) + best)};
  search.instances = &impl_->instances;
  search.fixed = &impl_->fixed;
  ask(impl_->contact ? impl_->contact.get() : impl_->fixed.scene.get(), middle_of(search), search.radius(), &look_in_scene, &search);

  // A hull with its axis inside a closed mesh may be far from any of its triangles.
  const auto inside = [&](const Windings& windings) {
    for (const auto& [solid, winding] : windings.of) {
      if (winding <= 0 || search.best <= 0.0 || !impl_->matter[solid].stops[static_cast<std::size_t>(Stops::motion)]) continue;
      search.best = 0.0;
      search.solid = solid;
    }
  };
  if (impl_->has_volumes) inside(impl_->windings(middle_of(search), nullptr));
  for (const Mover& mover : impl_->movers) {
    // At the moment's own time, which need not be the scene's: the way of a step is looked at in between.
    const Instance standing = impl_->stand(mover, moment.time);
    look_in_instance(standing, search);
    if (mover.prototype->closed()) inside(impl_->windings_in(standing, middle_of(search)));
  }
  if (search.solid != no_solid) answer = {search.best - hull.radius, search.solid};
  return answer;
}

}  // namespace thicket
