// The answers of a scene to rays.
#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "part_rays.hpp"
#include "scene_impl.hpp"
#include "thicket/worlds/scene.hpp"

namespace thicket {
namespace {

/// Of length 1 to 1e-6, which its square is to 2e-6.
bool traceable(const Ray& ray) { return finite(ray.origin) && std::islessequal(std::abs(glm::dot(ray.direction, ray.direction) - 1.0), 2e-6) && std::isgreaterequal(ray.range_max, 0.0); }  // NaN fails, quietly

}  // namespace

glm::dvec3 Scene::Impl::normal(const LaneRay& lane, const PartCrossing& c, double range, std::uint32_t part, int face) const {
  const glm::dvec3 point = lane.origin + range * lane.direction;
  if (!c.instance) return fixed.with_part(c.kind, part, [&](const auto& p) { return part_normal(p, point, face); });
  const Prototype& prototype = *c.instance->prototype;
  const Placing& placing = c.instance->placing;
  if (c.kind == triangle_kind) {
    const auto [a, b, d] = prototype.corners(part);
    const glm::dvec3 outward = placing.turn * unit_normal(a, b, d);
    const bool along = glm::dot(outward, lane.direction) > 0.0, leaves = range > c.interval.enter;
    // A triangle without area, which only closes a gap between others, has no side: as if it were met squarely.
    if (outward == glm::dvec3(0.0)) return leaves ? lane.direction : -lane.direction;
    // A sheet has no outside: its normals are against the ray where it is entered, and along it where it is left.
    if (prototype.closed()) return outward;
    return along == leaves ? outward : -outward;
  }
  return placing.turn * prototype.with_part(c.kind, part, [&](const auto& p) { return part_normal(p, placing.to_inner(point), face); });
}

bool Scene::Impl::enter(LaneRay& lane, float& far) const {
  if (glm::all(glm::lessThanEqual(box.low, lane.origin)) && glm::all(glm::lessThanEqual(lane.origin, box.high))) {
    // Most rays start inside, and there is nothing behind the diagonal.
    lane.to_end = lane.range_max >= diagonal;
    far = static_cast<float>(std::min(lane.range_max, diagonal) * (1.0 + single_precision_slack) + slack);
    return true;
  }
  double near = 0.0, end = infinity;
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
  lane.to_end = end <= lane.range_max;
  end = std::min(end, lane.range_max);
  if (!(near <= end)) return false;
  lane.shift = near;
  far = static_cast<float>((end - near) * (1.0 + single_precision_slack) + slack);
  return true;
}

template <class Collect, class Consumer>
std::size_t Scene::Impl::trace(std::span<const Ray> rays, const Moving* moving, Collect& collector, Consumer&& consumer) const {
  std::size_t rejected = 0;
  std::array<LaneRay, packet> lanes;
  Query query;
  embree::start(query);
  query.lanes = lanes.data();
  query.collect_in(collector);
  const bool nothing = empty();
  alignas(32) int valid[packet];
  alignas(32) RTCRayHit8 batch;
  for (unsigned i = 0; i < packet; ++i) {  // what Embree leaves as it is
    batch.ray.tnear[i] = batch.ray.time[i] = 0.0f;
    batch.ray.mask[i] = ~0u;
    batch.ray.id[i] = i;
    batch.ray.flags[i] = 0;
  }
  for (std::size_t first = 0; first < rays.size(); first += packet) {
    bool any = false;
    for (unsigned i = 0; i < packet; ++i) {
      LaneRay& lane = lanes[i];
      float far = -1.0f;
      valid[i] = 0;
      if (first + i < rays.size() && traceable(rays[first + i])) {
        const Ray& ray = rays[first + i];
        // (Member by member: a whole one would be put together aside and copied by wider loads than its stores, which stalls.)
        lane.origin = ray.origin - origin;
        lane.direction = ray.direction;
        lane.range_max = ray.range_max;
        lane.shift = 0.0;
        lane.to_end = false;
        if (!nothing && enter(lane, far)) {
          valid[i] = -1;
          any = true;
        }
      } else {
        rejected += first + i < rays.size();
        lane = LaneRay{};
      }
      // Lanes without a ray get one that ends before it starts: Embree ignores `valid` where a packet is wider than the processor's vectors.
      const glm::vec3 start(valid[i] ? lane.shift == 0.0 ? lane.origin : lane.origin + lane.shift * lane.direction : glm::dvec3(0.0));
      const glm::vec3 along(lane.direction);
      batch.ray.org_x[i] = start.x;
      batch.ray.org_y[i] = start.y;
      batch.ray.org_z[i] = start.z;
      batch.ray.dir_x[i] = along.x;
      batch.ray.dir_y[i] = along.y;
      batch.ray.dir_z[i] = along.z;
      batch.ray.tfar[i] = valid[i] ? far : -1.0f;
      batch.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      batch.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    collector.reset();
    query.kept_for = nullptr;  // the rays are others
    if (any) {
      query.instances = &instances;
      embree::intersect8(valid, fixed.scene.get(), query, batch);
      if (moving) {
        query.instances = &moving->instances;
        embree::intersect8(valid, moving->scene.get(), query, batch);  // with the rays as far as they are still wanted
      }
    }
    for (unsigned i = 0; i < packet && first + i < rays.size(); ++i) consumer(first + i, i, lanes[i]);
  }
  return rejected;
}

namespace {

/// Collects the closed meshes along a line.
class WindingCount {
 public:
  /// `losses`: of the world's materials, as many as there are.
  WindingCount(const std::vector<Matter>& matter, std::span<const double> losses, const LaneRay& lane) : gatherer_{matter, depths_of(losses, infinity, true)} {
    lanes_[0] = lane;
    gatherer_.reset();
    embree::start(query_);
    query_.lanes = lanes_.data();
    query_.surfaces_only = true;
    query_.collect_in(gatherer_);
  }

  void through(RTCScene scene, const std::vector<Instance>* instances, const Instance* inside_of, const glm::dvec3& origin, const glm::dvec3& direction, float far) {
    query_.instances = instances;
    query_.inside_of = inside_of;
    RTCRayHit ray{};
    const glm::vec3 start(origin), along(direction);
    ray.ray = {start.x, start.y, start.z, 0.0f, along.x, along.y, along.z, 0.0f, far, ~0u, 0, 0};
    ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree::intersect1(scene, query_, ray);
  }

  Windings windings() {
    std::vector<SurfaceHit>& hits = gatherer_.surfaces[0];
    std::sort(hits.begin(), hits.end(), BySolidAndRange{});
    Windings answer;
    for (std::size_t i = 0; i < hits.size();) {
      const std::uint32_t solid = hits[i].solid;
      int winding = 0;
      for (; i < hits.size() && hits[i].solid == solid; ++i) winding += hits[i].enters ? -1 : 1;
      if (winding != 0) answer.of.emplace_back(solid, winding);
    }
    return answer;
  }

 private:
  Gatherer gatherer_;
  std::array<LaneRay, packet> lanes_;
  Query query_;
};

}  // namespace

Windings Scene::Impl::windings(const glm::dvec3& point, const Moving* moving, const glm::dvec3& along) const {
  LaneRay lane{point, along, infinity, 0.0, false};
  float far = 0.0f;
  if (!has_volumes || !enter(lane, far)) return {};
  WindingCount count(matter, losses, lane);
  const glm::dvec3 start = point + lane.shift * along;
  count.through(fixed.scene.get(), &instances, nullptr, start, along, far);
  if (moving) count.through(moving->scene.get(), &moving->instances, nullptr, start, along, far);
  return count.windings();
}

Windings Scene::Impl::windings_in(const Instance& instance, const glm::dvec3& point) const {
  WindingCount count(matter, losses, {point, upward, infinity, 0.0, false});
  const Placing& p = instance.placing;
  count.through(instance.prototype->scene.get(), nullptr, &instance, p.to_inner(point), p.direction_to_inner(upward), std::numeric_limits<float>::max());
  return count.windings();
}

namespace {

/// What is true of the place that rays start from; those of one scan start at one, so it is looked for once.
struct AtOrigin {
  const Scene::Impl& impl;
  const Scene::Moving* moving;
  glm::dvec3 origin{NAN};
  Windings windings{};
  bool on_surface = false;

  void look(const glm::dvec3& from) {
    if (from == origin) return;
    origin = from;
    windings = impl.windings(from, moving);
    on_surface = impl.on_surface(from, moving);
  }
};

}  // namespace

std::size_t Scene::closest_hits(std::span<const Ray> rays, Stops stops, std::span<Hit> hits) const {
  Nearest nearest{impl_->matter, stops};
  AtOrigin start{*impl_, moving_.get()};
  return impl_->trace(rays, moving_.get(), nearest, [&](std::size_t ray, unsigned lane, const LaneRay& lane_ray) {
    Hit& hit = hits[ray];
    hit = Hit{};
    if (impl_->has_volumes && lane_ray.range_max >= 0.0) {
      start.look(lane_ray.origin);
      if (start.on_surface) {
        // What it goes into from here is told by what it goes through.
        CrossingLists through;
        const Ray whole{rays[ray].origin, rays[ray].direction, infinity};
        crossings({&whole, 1}, infinity, through, true);
        const auto first = std::ranges::find_if(through.items, [&](const Crossing& c) { return impl_->matter[c.solid].stops[static_cast<std::size_t>(stops)]; });
        if (first != through.items.end() && first->enter <= lane_ray.range_max) hit = {first->enter, first->solid, first->starts_inside ? -lane_ray.direction : first->enter_normal};
        return;
      }
      for (const auto& [solid, winding] : start.windings.of)
        if (winding > 0 && impl_->matter[solid].stops[static_cast<std::size_t>(stops)]) {
          hit = {0.0, solid, -lane_ray.direction};
          return;
        }
    }
    if (nearest.range[lane] == infinity || nearest.range[lane] > lane_ray.range_max) return;
    const PartCrossing& met = nearest.best[lane];
    hit.range = nearest.range[lane];
    hit.solid = met.solid;
    hit.normal = met.interval.enter > 0.0 || met.kind == triangle_kind ? impl_->normal(lane_ray, met, hit.range, met.part, met.interval.enter_face) : -lane_ray.direction;
  });
}

namespace {

constexpr double touching = 1e-9;  // m

/// Makes stretches of the surfaces of closed meshes, and appends them; what is left behind the limit is left at infinity. `to_end`: no surface on the ray is missing;
/// else `at_start` tells what it starts inside of.
void pair_surfaces(std::vector<SurfaceHit>& hits, bool to_end, const Windings& at_start, double limit, std::vector<PartCrossing>& out) {
  std::sort(hits.begin(), hits.end(), BySolidAndRange{});
  for (std::size_t i = 0; i < hits.size();) {
    const std::uint32_t solid = hits[i].solid;
    std::size_t end = i;
    int sum = 0;
    for (; end < hits.size() && hits[end].solid == solid; ++end) sum += hits[end].enters ? 1 : -1;
    // A closed mesh is left as often as it is entered, so what is left too often was started inside of.
    int winding = to_end ? -sum : at_start.find(solid);
    PartCrossing open;
    const auto begin = [&](double range, const SurfaceHit& at) {
      open = {{range, infinity, 0, 0}, solid, triangle_kind, at.triangle, at.triangle, at.instance};
    };
    if (winding > 0) begin(-infinity, hits[i]);
    const std::size_t first_out = out.size();
    const auto close = [&](const PartCrossing& stretch) {
      // Pieces of one mesh that touch have no gap between them but for rounding.
      const bool goes_on = out.size() > first_out && stretch.interval.enter - out.back().interval.leave <= touching;
      if (!goes_on) return out.push_back(stretch);
      out.back().interval.leave = stretch.interval.leave;
      out.back().leave_part = stretch.leave_part;
    };
    int owed = 0;  // exits that came before their entrances by rounding
    for (; i < end; ++i) {
      const SurfaceHit& hit = hits[i];
      if (hit.enters) {
        if (owed > 0 && winding == 0) {
          --owed;
        } else if (++winding == 1) {
          begin(hit.range, hit);
        }
      } else if (winding == 0) {
        ++owed;
      } else if (--winding == 0) {
        // Behind the limit it is chance which surfaces were met.
        open.interval.leave = hit.range <= limit ? hit.range : infinity;
        open.leave_part = hit.triangle;
        if (open.interval.leave > std::max(0.0, open.interval.enter) && open.interval.enter <= limit) close(open);
      }
    }
    if (winding > 0 && open.interval.enter <= limit) close(open);  // it is left somewhere behind what was looked at
  }
}

}  // namespace

std::size_t Scene::crossings(std::span<const Ray> rays, double budget_db, CrossingLists& lists, bool through_opaque) const {
  return crossings(rays, impl_->losses, budget_db, lists, through_opaque);
}

std::size_t Scene::crossings(std::span<const Ray> rays, std::span<const double> loss_per_m, double budget, CrossingLists& lists, bool through_opaque) const {
  lists.items.clear();
  lists.first.assign(1, 0);
  Gatherer gatherer{impl_->matter, depths_of(loss_per_m, budget, through_opaque)};
  AtOrigin start{*impl_, moving_.get()};
  return impl_->trace(rays, moving_.get(), gatherer, [&](std::size_t, unsigned lane, const LaneRay& lane_ray) {
    if (impl_->has_volumes && lane_ray.range_max >= 0.0) {
      const bool to_end = lane_ray.to_end && gatherer.stop[lane] == infinity;
      if (!to_end) start.look(lane_ray.origin);
      // On an edge or a corner it depends on the direction what lies ahead.
      Windings along;
      if (!to_end && start.on_surface) along = impl_->windings(lane_ray.origin, moving_.get(), lane_ray.direction);
      const Windings& around = to_end || start.on_surface ? along : start.windings;  // to the end: nothing need be known of the start
      pair_surfaces(gatherer.surfaces[lane], to_end, around, std::min(lane_ray.range_max, gatherer.stop[lane]), gatherer.met[lane]);
      // What the ray starts inside of and leaves behind everything that was looked at.
      for (const auto& [solid, winding] : around.of)
        if (winding > 0 && std::ranges::none_of(gatherer.surfaces[lane], [s = solid](const SurfaceHit& hit) { return hit.solid == s; }))
          gatherer.met[lane].push_back({{-infinity, infinity, 0, 0}, solid, triangle_kind, 0, 0, nullptr});
    }
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
    if (!crossing.starts_inside) crossing.enter_normal = normal(lane, first, crossing.enter, first.part, first.interval.enter_face);
    if (crossing.leave < infinity) crossing.leave_normal = normal(lane, *last, crossing.leave, last->leave_part, last->interval.leave_face);
  }
  if (one_part_each) return;
  std::sort(out.begin() + static_cast<std::ptrdiff_t>(begin), out.end(), [](const Crossing& a, const Crossing& b) {
    if (a.enter != b.enter) return a.enter < b.enter;
    if (a.leave != b.leave) return a.leave < b.leave;
    return a.solid < b.solid;
  });
}

}  // namespace thicket
