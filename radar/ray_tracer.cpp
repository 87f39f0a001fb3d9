#include "ray_tracer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace thicket {
namespace {

/// Ways that a sent ray may split into at mirrors that let some of it through: each of n panes doubles them, and without a floor there is no end to it. The ways with the fewest bounces come first.
constexpr std::uint32_t most_ways = 1000;

double from_db(double db) { return std::exp((0.1 * std::numbers::ln10) * db); }

/// A wave on a leg of its way out.
struct Leg {
  std::uint32_t index = 0;      ///< of the ray that was sent, in the span
  double length = 0.0;          ///< m, of the legs before
  double excess = 0.0;          ///< m, by which these seemed longer
  double one_way = 1.0;         ///< fraction of the power that gets to the beginning of this leg
  double loss_db = 0.0;         ///< of that inside matter, for the penetration budget
  double rate = 0.0;            ///< m/s, at which the way out so far grows
  std::uint8_t bounces = 1;     ///< surfaces met at the end of this leg
};

/// A look from a surface back to the sensor.
struct LookBack {
  Ray ray;
  std::uint32_t index = 0;
  double power = 0.0;   ///< that arrives if nothing is in the way
  double range = 0.0;   ///< m, half of the whole way
  float cosine = 1.0f, velocity = 0.0f;
  std::uint8_t bounces = 2;
};

/// A thread's memory, kept from task to task.
struct Scratch {
  std::vector<Hit> hits;
  CrossingLists lists;
  std::vector<std::uint32_t> owners;  ///< of the echoes, with multipath
  std::vector<std::uint32_t> ways;    ///< that each ray has split into, with multipath
  std::vector<Leg> mirrored, legs;
  std::vector<Ray> mirrored_rays, rays;  ///< theirs; rays of looks, too
  std::vector<LookBack> looks;
};
Scratch& scratch() {
  thread_local Scratch of_thread;
  return of_thread;
}

/// Traces a scan's rays. What the scan does not need is not compiled in: without multipath nothing is kept of who met what.
template <bool multipath>
class RayTracer {
 public:
  RayTracer(const TraceContext& context, std::span<const RayTraits> traits, Traced& traced)
      : c_(context), traits_(traits), traced_(traced), walk_(context.scene, context.materials, context.radar.slab_max_m), s_(scratch()) {
    s_.owners.clear();
    s_.mirrored.clear();
    s_.mirrored_rays.clear();
    s_.looks.clear();
  }

  void trace(std::span<const Ray> rays) {
    traced_.echoes.clear();
    traced_.echoes.reserve(rays.size());
    traced_.rays.resize(rays.size());
    traced_.count = 0;
    if constexpr (multipath) s_.ways.assign(rays.size(), 0);
    Leg first;
    trace_all(rays, [&](std::uint32_t i) -> const Leg& {
      first.index = i;
      if (c_.radar.radial_velocity) first.rate = -glm::dot(c_.velocity, rays[i].direction);
      return first;
    });
    if constexpr (multipath) bounce();
  }

 private:
  /// Follows each ray of a list; `leg_of(i)` tells what goes along it.
  template <class LegOf>
  void trace_all(std::span<const Ray> rays, LegOf&& leg_of) {
    traced_.count += rays.size();
    if (c_.first_surface_only) {
      s_.hits.resize(rays.size());
      c_.scene.closest_hits(rays, Stops::everything, s_.hits);
      for (std::uint32_t i = 0; i < rays.size(); ++i) follow_to_hit(leg_of(i), rays[i], s_.hits[i]);
    } else {
      c_.scene.crossings(rays, c_.losses, c_.list_budget_db, s_.lists);
      for (std::uint32_t i = 0; i < rays.size(); ++i) follow(leg_of(i), rays[i], s_.lists[i]);
    }
  }

  void follow_to_hit(const Leg& leg, const Ray& ray, const Hit& hit) {
    begin(ray);
    if (hit.solid == no_solid) return finish(leg);
    const WaveMaterial& material = c_.materials[c_.scene.material(hit.solid)];
    if (hit.range == 0.0) {  // it starts inside
      end_ = {BeamEnd::exhausted, 0.0};
      starts_inside_ = material.visible;
      return finish(leg);
    }
    start_with(leg);
    const double cosine = std::min(1.0, std::abs(glm::dot(hit.normal, ray.direction)));
    if constexpr (multipath) {
      meet(leg, {hit.range, nullptr, &material, &material, hit.solid, hit.normal, cosine});
    } else {  // nothing goes on from here: what comes back is all
      if (material.visible) {
        const double sent_back = material.diffuse >= 1.0 ? material.reflectivity * cosine : backscatter(material, material.reflectivity, cosine, spread_on(leg, material, hit.solid, hit.range));
        add_echo(leg, hit.range, sent_back, material.reflectivity, cosine, Edge::front, hit.solid);
      }
      end_ = {BeamEnd::stopped, hit.range};
    }
    finish(leg);
  }

  void follow(const Leg& leg, const Ray& ray, std::span<const Crossing> crossings) {
    begin(ray);
    if (crossings.empty()) return finish(leg);
    start_with(leg);
    const WaveMaterial* inside = walk_.start(crossings);
    starts_inside_ = inside && inside->visible;
    if (inside && inside->opaque()) {
      end_ = {BeamEnd::exhausted, 0.0};
      return finish(leg);
    }
    walk_.walk(
        ray.direction, ray.range_max, [&](const WaveMaterial& material, std::uint32_t solid, double from, double to) { return pass_through(leg, material, solid, from, to); },
        [&](const Surface& surface) { return meet(leg, surface); });
    finish(leg);
  }

  void begin(const Ray& ray) {
    ray_ = &ray;
    excess_ = 0.0;
    starts_inside_ = false;
    end_ = {BeamEnd::open, ray.range_max};
    first_ = static_cast<std::uint32_t>(traced_.echoes.size());
  }

  void start_with(const Leg& leg) {
    one_way_ = leg.one_way;
    loss_db_ = leg.loss_db;
    excess_ = leg.excess;
    leaves_ = 0;
  }

  void finish(const Leg& leg) {
    if (leg.bounces > 1) return;  // where a beam ends is told by the wave that has met no mirror
    const double seems = end_.why == BeamEnd::open ? end_.range : std::min(c_.range_max, end_.range + excess_);
    traced_.rays[leg.index] = {first_, static_cast<std::uint32_t>(traced_.echoes.size()) - first_, seems, end_.why, starts_inside_};
  }

  /// Power under which a perfect diffuse reflector at a range (m, the whole way out) would not be seen, before the factor of its range.
  double floor_at(double range) const {
    if (c_.radar.range_compensation || c_.printed) return c_.floor_power;
    const double ratio = std::max(range, nearest_range) / c_.range_max;
    return c_.floor_power * ratio * ratio;
  }

  /// A stretch inside matter. False if the wave ends in it: its budget is used up, or a perfect diffuse reflector there would come back below the floor.
  bool pass_through(const Leg& leg, const WaveMaterial& material, std::uint32_t solid, double from, double to) {
    if (material.crown()) return pass_leaves(leg, material, solid, from, to);
    if (material.attenuation_db_per_m > 0.0) {
      const double through = material.attenuation_db_per_m * (to - from), after = one_way_ * from_db(-through);
      const double floor = floor_at(leg.length + from);
      if (loss_db_ + through >= c_.radar.penetration_budget_db || after * after <= floor) {
        const double bearable = std::min(c_.radar.penetration_budget_db - loss_db_, -5.0 * std::log10(floor / (one_way_ * one_way_)));
        end_ = {BeamEnd::exhausted, std::min(ray_->range_max, from + std::max(0.0, bearable) / material.attenuation_db_per_m)};
        return false;
      }
      loss_db_ += through;
      one_way_ = after;
    }
    excess_ += (material.index - 1.0) * (to - from);
    return true;
  }

  /// Leaves at random places: the free path between two of them is exponential (as in HELIOS++), and they point anywhere, so that those that a ray meets have cosines with the density 2 cos.
  bool pass_leaves(const Leg& leg, const WaveMaterial& crown, std::uint32_t solid, double from, double to) {
    for (double at = from;;) {
      const auto u = c_.random.uniform(c_.scan, traits_[leg.index].number, RandomUse::foliage, static_cast<std::uint32_t>(leg.bounces) << 16 | (leaves_++ & 0xffffu));
      at += -std::log(u[0]) / crown.leaves_per_m;
      if (at >= to) return true;
      const double cosine = std::sqrt(u[1]);
      if (crown.visible) add_echo(leg, at, crown.leaf_reflectivity * cosine, crown.leaf_reflectivity, cosine, Edge::thin, solid);
      loss_db_ += crown.leaf_loss_db;
      one_way_ *= from_db(-crown.leaf_loss_db);
      if (loss_db_ >= c_.radar.penetration_budget_db || one_way_ * one_way_ <= floor_at(leg.length + at)) {
        end_ = {crown.leaf_loss_db == infinity ? BeamEnd::stopped : BeamEnd::exhausted, at};
        return false;
      }
    }
  }

  Interface interface_at(const Surface& surface) const {
    return surface.slab > 0.0 ? slab_interface(*surface.reflector, c_.radar.frequency_ghz, surface.slab, surface.cosine)
                              : interface_between(surface.before, surface.after, *surface.reflector, surface.cosine, c_.radar.fresnel);
  }

  /// A surface. False if the wave ends there.
  bool meet(const Leg& leg, const Surface& surface) {
    const WaveMaterial& reflector = *surface.reflector;
    const bool was_matter = surface.before && surface.before->visible, is_matter = surface.after && surface.after->visible;
    if (reflector.crown()) return true;  // its leaves are met inside
    const Interface interface = interface_at(surface);
    const double spread = spread_on(leg, reflector, surface.solid, surface.range);
    if (was_matter || is_matter || (surface.slab > 0.0 && reflector.visible)) {
      const Edge edge = surface.slab > 0.0 ? Edge::thin : !was_matter ? Edge::front : is_matter ? Edge::inner : Edge::back;
      add_echo(leg, surface.range, backscatter(reflector, interface.reflectivity, surface.cosine, spread), interface.reflectivity, surface.cosine, edge, surface.solid);
    }
    if constexpr (multipath) {
      if (!was_matter) scatter(leg, surface, interface);
    }
    if (surface.after && surface.after->opaque()) {
      end_ = {BeamEnd::stopped, surface.range};
      return false;
    }
    if (surface.slab > 0.0) {
      loss_db_ += reflector.attenuation_db_per_m * surface.slab_path;  // which is in what passes already
      excess_ += (reflector.index - 1.0) * surface.slab_path;
    }
    one_way_ *= interface.passed;
    if (loss_db_ > c_.radar.penetration_budget_db || one_way_ * one_way_ < floor_at(leg.length + surface.range)) {
      end_ = {BeamEnd::exhausted, surface.range};
      return false;
    }
    return true;
  }

  /// The angle that a ray stands for where it meets a surface: over its cell the normal of a sphere turns too, by the way over the radius. (Not of a cylinder, which is round one way and straight the
  /// other.) Only for what is smooth, and only so far that a lobe is still one.
  double spread_on(const Leg& leg, const WaveMaterial& material, std::uint32_t solid, double at) const {
    constexpr double widest = 0.25;  // rad
    const double spread = traits_[leg.index].spread;
    if (material.diffuse >= 1.0 || solid == no_solid || spread >= widest) return spread;
    const auto* sphere = std::get_if<Sphere>(&c_.scene.world().solids[solid].shape);
    return sphere ? std::min(widest, spread * (1.0 + (leg.length + at) / sphere->radius)) : spread;
  }

  /// How much stronger a return is by the length of its way back, or weaker, in m; `range`: half of its whole way.
  double range_factor(double back, double range) const {
    const double ratio = (c_.radar.range_compensation ? range : c_.range_max) / std::max(back, nearest_range);
    return ratio * ratio;
  }

  /// What comes back the way it went. `sent_back`: as `backscatter` tells.
  void add_echo(const Leg& leg, double at, double sent_back, double reflectivity, double cosine, Edge edge, std::uint32_t solid) {
    const double way = leg.length + at;
    double amplitude = one_way_;  // the root of what gets there and back
    if (c_.printed) {
      const double ratio = way / c_.range_max;
      amplitude *= std::sqrt(reflectivity) * cosine * ratio * ratio;  // eq. 4.2 of Billdal 2018
    } else {
      amplitude *= std::sqrt(sent_back);
      if (!c_.radar.range_compensation) amplitude *= c_.range_max / std::max(way, nearest_range);
    }
    const double range = way + excess_;
    if (!(amplitude * amplitude >= c_.floor_power) || range < c_.range_min || range > c_.range_max) return;
    float velocity = 0.0f;
    if (c_.radar.radial_velocity) velocity = static_cast<float>(leg.rate + moving(solid, at, ray_->direction));
    push(leg.index, {range, static_cast<float>(amplitude), static_cast<float>(cosine), velocity, edge, leg.bounces});
  }

  /// How fast the way along a leg grows by the motion of the solid at its end; `change`: in minus out.
  double moving(std::uint32_t solid, double at, const glm::dvec3& change) const {
    if (solid == no_solid || !c_.scene.moves()) return 0.0;
    return glm::dot(c_.scene.velocity(solid, ray_->origin + at * ray_->direction), change);
  }

  void push(std::uint32_t index, const Echo& echo) {
    traced_.echoes.push_back(echo);
    if constexpr (multipath) s_.owners.push_back(index);
  }

  /// What a surface mirrors goes on, and from the second one on what it sends to the sensor is looked after.
  void scatter(const Leg& leg, const Surface& surface, const Interface& interface) {
    const WaveMaterial& reflector = *surface.reflector;
    const glm::dvec3 in = ray_->direction, normal = glm::dot(surface.normal, in) > 0.0 ? -surface.normal : surface.normal;
    const glm::dvec3 point = offset_origin(ray_->origin + surface.range * in, normal);
    const double way = leg.length + surface.range;
    if (leg.bounces > 1 && !c_.printed) look_back(leg, surface, interface, point, normal);
    if (leg.bounces >= c_.radar.bounces_max || reflector.diffuse >= 1.0) return;
    Leg next = leg;
    next.one_way = one_way_ * (1.0 - reflector.diffuse) * interface.mirrored;
    if (next.one_way < floor_at(way) || way >= c_.range_max || s_.ways[leg.index] == most_ways) return;
    ++s_.ways[leg.index];
    const glm::dvec3 out = glm::normalize(in - 2.0 * glm::dot(in, normal) * normal);
    next.length = way;
    next.excess = excess_;
    next.loss_db = loss_db_;
    if (c_.radar.radial_velocity) next.rate = leg.rate + moving(surface.solid, surface.range, in - out);
    ++next.bounces;
    s_.mirrored.push_back(next);
    s_.mirrored_rays.push_back({point, out, c_.range_max - way});
  }

  void look_back(const Leg& leg, const Surface& surface, const Interface& interface, const glm::dvec3& point, const glm::dvec3& normal) {
    const RayTraits& sent = traits_[leg.index];
    const glm::dvec3 to_sensor = c_.sensor.position - point;
    const double back = glm::length(to_sensor), range = 0.5 * (leg.length + surface.range + back) + 0.5 * excess_;
    if (!(back > 0.0) || range > c_.range_max || range < c_.range_min) return;
    const glm::dvec3 out = to_sensor / back;
    const WaveMaterial& reflector = *surface.reflector;
    const double sent_back = bistatic(reflector, interface, ray_->direction, out, normal, spread_on(leg, reflector, surface.solid, surface.range), c_.radar.fresnel && surface.slab == 0.0);
    // The diffuse share comes again by the same way in the other direction, which no ray is sent along; mirrored ways are found from both ends.
    const double again = reflector.diffuse * interface.reflectivity * std::max(0.0, glm::dot(out, normal));
    double power = (sent_back + again) * one_way_ * range_factor(back, range);
    // The ray stands for the gain along itself, twice; what comes back by another direction has the gain of that.
    const double gain = c_.antenna.gain(beam_frame(sent, -out));
    if (!(sent.gain > 0.0f) || !(gain > 0.0)) return;
    power *= gain / static_cast<double>(sent.gain);
    if (power < c_.floor_power) return;
    LookBack look{{point, out, back}, leg.index, power, range, static_cast<float>(std::max(0.0, glm::dot(out, normal))), 0.0f, leg.bounces};
    if (c_.radar.radial_velocity) look.velocity = static_cast<float>(0.5 * (leg.rate + moving(surface.solid, surface.range, ray_->direction - out) + glm::dot(c_.velocity, out)));
    s_.looks.push_back(look);
  }

  /// A direction of the world in the frame of the ray's beam.
  glm::dvec3 beam_frame(const RayTraits& sent, const glm::dvec3& direction) const {
    const glm::dvec3 d = glm::inverse(c_.sensor.orientation) * direction;
    const double azimuth = c_.antenna.beam_azimuths()[sent.beam];
    const double cosine = std::cos(azimuth), sine = std::sin(azimuth);
    return {cosine * d.x + sine * d.y, -sine * d.x + cosine * d.y, d.z};
  }

  /// Leg after leg; then the echoes by ray and range.
  void bounce() {
    std::vector<Leg>& legs = s_.legs;
    std::vector<Ray>& rays = s_.rays;
    while (!s_.mirrored.empty()) {
      legs.swap(s_.mirrored);
      rays.swap(s_.mirrored_rays);
      s_.mirrored.clear();
      s_.mirrored_rays.clear();
      trace_all(rays, [&](std::uint32_t i) -> const Leg& { return legs[i]; });
    }
    arrive();
    std::vector<std::uint32_t> order(traced_.echoes.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return s_.owners[a] != s_.owners[b] ? s_.owners[a] < s_.owners[b] : traced_.echoes[a].range < traced_.echoes[b].range;
    });
    std::vector<Echo> sorted;
    sorted.reserve(order.size());
    for (RayEnd& ray : traced_.rays) ray.first_echo = ray.echo_count = 0;
    for (const std::uint32_t i : order) {
      RayEnd& ray = traced_.rays[s_.owners[i]];
      if (ray.echo_count++ == 0) ray.first_echo = static_cast<std::uint32_t>(sorted.size());
      sorted.push_back(traced_.echoes[i]);
    }
    traced_.echoes = std::move(sorted);
  }

  /// What is between the surfaces and the sensor takes its part of what is looked back for.
  void arrive() {
    if (s_.looks.empty()) return;
    std::vector<Ray>& rays = s_.rays;
    rays.clear();
    for (const LookBack& look : s_.looks) rays.push_back(look.ray);
    traced_.count += rays.size();
    c_.scene.crossings(rays, c_.losses, c_.list_budget_db, s_.lists);
    for (std::size_t i = 0; i < s_.looks.size(); ++i) {
      const LookBack& look = s_.looks[i];
      const Passage way = passage(look.ray, s_.lists[i]);
      const double power = look.power * way.passed, range = look.range + 0.5 * way.excess;
      if (power >= c_.floor_power && range <= c_.range_max) push(look.index, {range, static_cast<float>(std::sqrt(power)), look.cosine, look.velocity, Edge::front, look.bounces});
    }
  }

  /// What gets along a ray to its end: a fraction of the power, nothing once the penetration budget is used up; and how much longer the way seems, m.
  struct Passage {
    double passed = 1.0, excess = 0.0;
  };
  Passage passage(const Ray& ray, std::span<const Crossing> crossings) {
    Passage way;
    if (crossings.empty()) return way;
    const WaveMaterial* inside = walk_.start(crossings);
    if (inside && inside->opaque()) return {0.0, 0.0};
    double loss_db = 0.0;
    const auto lose = [&](double db) {
      loss_db += db;
      way.passed = loss_db < c_.radar.penetration_budget_db ? way.passed * from_db(-db) : 0.0;
      return way.passed > 0.0;
    };
    walk_.walk(
        ray.direction, ray.range_max,
        [&](const WaveMaterial& material, std::uint32_t, double from, double to) {
          way.excess += (material.index - 1.0) * (to - from);
          return lose((material.crown() ? material.density : material.attenuation_db_per_m) * (to - from));  // of leaves, the mean
        },
        [&](const Surface& surface) {
          if (surface.after && surface.after->opaque()) way.passed = 0.0;
          if (way.passed == 0.0) return false;
          if (surface.reflector->crown()) return true;
          if (surface.slab > 0.0) way.excess += (surface.reflector->index - 1.0) * surface.slab_path;
          way.passed *= interface_at(surface).passed;
          return true;
        });
    return way;
  }

  struct End {
    BeamEnd why;
    double range;
  };

  const TraceContext& c_;
  std::span<const RayTraits> traits_;
  Traced& traced_;
  MediumWalk walk_;
  Scratch& s_;
  // The wave on the leg that is followed.
  const Ray* ray_ = nullptr;
  double one_way_ = 1.0, loss_db_ = 0.0, excess_ = 0.0;
  std::uint32_t leaves_ = 0, first_ = 0;
  bool starts_inside_ = false;
  End end_{BeamEnd::open, 0.0};
};

/// Whether every solid is opaque, so that nothing behind the first surface matters.
bool all_opaque(const World& world, const std::vector<WaveMaterial>& materials) {
  return std::ranges::all_of(world.solids, [&](const Solid& solid) { return materials[solid.material].opaque(); });
}

/// Whether some solid mirrors a part of what it sends back.
bool any_mirror(const World& world, const std::vector<WaveMaterial>& materials) {
  return std::ranges::any_of(world.solids, [&](const Solid& solid) { return materials[solid.material].diffuse < 1.0; });
}

}  // namespace

TraceContext::TraceContext(const Scene& in, const RadarSpec& with, double from, double to, const Antenna& of, const Pose& at, const glm::dvec3& moving, const Random& dice, std::uint64_t number)
    : scene(in), radar(with), range_min(from), range_max(to), floor_power(from_db(with.detection_floor_db)), antenna(of), sensor(at), velocity(moving), random(dice), scan(number),
      materials(wave_materials(in.world(), with, floor_power)), first_surface_only(with.surfaces == "auto" && all_opaque(in.world(), materials)),
      multipath(with.bounces_max > 1 && (with.surfaces != "auto" || any_mirror(in.world(), materials))), printed(with.law == "printed") {
  // Where leaves are at random places it is not known beforehand how far the budget takes a wave.
  list_budget_db = std::ranges::any_of(materials, &WaveMaterial::crown) ? infinity : with.penetration_budget_db;
  for (const WaveMaterial& material : materials) losses.push_back(material.attenuation_db_per_m);
}

void trace_rays(const TraceContext& context, std::span<const Ray> rays, std::span<const RayTraits> traits, Traced& traced) {
  if (context.multipath) RayTracer<true>(context, traits, traced).trace(rays);
  else RayTracer<false>(context, traits, traced).trace(rays);
}

}  // namespace thicket
