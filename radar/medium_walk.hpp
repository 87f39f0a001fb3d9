// A ray's way through matter: stretches of one medium, and the surfaces between them. Private to the room.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <glm/geometric.hpp>

#include "thicket/worlds/scene.hpp"
#include "wave.hpp"

namespace thicket {

/// Where the medium changes. Null is the open.
struct Surface {
  double range = 0.0;
  const WaveMaterial* before = nullptr;
  const WaveMaterial* after = nullptr;
  const WaveMaterial* reflector = nullptr;  ///< the denser side
  std::uint32_t solid = no_solid;           ///< the reflector's
  glm::dvec3 normal{0.0};                   ///< unit; either side
  double cosine = 1.0;                      ///< of incidence, 0...1
  double slab = 0.0;                        ///< m, thickness of the slab that this is, with the open (or what is as good) on both sides; 0: an interface
  double slab_path = 0.0;                   ///< m, way through the slab
};

/// Walks along the crossings of a ray. At every point the solid of highest attenuation counts.
class MediumWalk {
 public:
  /// `slab_max`: thickness in m up to which a solid in the open that has two parallel faces is one surface, with the open behind it; 0: none is.
  MediumWalk(const Scene& scene, std::span<const WaveMaterial> materials, double slab_max) : scene_(scene), materials_(materials), slab_max_(slab_max) {}

  /// What the ray starts in; null is the open.
  const WaveMaterial* start(std::span<const Crossing> crossings) {
    crossings_ = crossings;
    events_.clear();
    active_.clear();
    media_.clear();
    for (std::uint32_t i = 0; i < crossings.size(); ++i) {
      media_.push_back(&materials_[scene_.material(crossings[i].solid)]);
      if (crossings[i].starts_inside) active_.push_back(i);
      else events_.push_back({crossings[i].enter, i, true});
      events_.push_back({crossings[i].leave, i, false});
    }
    std::sort(events_.begin(), events_.end(), [](const Event& a, const Event& b) {
      if (a.range != b.range) return a.range < b.range;
      return a.crossing != b.crossing ? a.crossing < b.crossing : a.enters > b.enters;
    });
    medium_ = strongest();
    return material(medium_);
  }

  /// After `start`: calls `stretch(material, solid, from, to)` for each stretch that lies in matter, and `surface(Surface)` where the medium changes, in order, as far as range_max; ends where one of them
  /// returns false.
  template <class Stretch, class OnSurface>
  void walk(const glm::dvec3& direction, double range_max, Stretch&& stretch, OnSurface&& on_surface) {
    double at = 0.0;
    for (std::size_t e = 0; e < events_.size();) {
      const double range = events_[e].range;
      if (medium_ != open_space && !stretch(*material(medium_), crossings_[medium_].solid, at, std::min(range, range_max))) return;
      if (range > range_max) return;
      // Everything that begins or ends here happens at once: two solids that share a face have no gap between them.
      const Event first = events_[e];
      for (; e < events_.size() && events_[e].range <= range + same_place; ++e) {
        if (events_[e].enters) active_.push_back(events_[e].crossing);
        else std::erase(active_, events_[e].crossing);
      }
      const std::uint32_t before = medium_;
      medium_ = strongest();
      at = range;
      if (same(before, medium_)) continue;
      Surface surface = surface_at(range, before, first, direction);
      if (slab_max_ > 0.0 && is_open(before) && medium_ != open_space && e < events_.size() && is_slab(e, surface)) {
        surface.slab_path = events_[e].range - range;
        surface.slab = surface.slab_path * surface.cosine;
        surface.after = surface.before;
        at = events_[e].range;
        std::erase(active_, medium_);
        medium_ = before;
        ++e;
      }
      if (!on_surface(surface)) return;
    }
  }

 private:
  static constexpr std::uint32_t open_space = ~0u;
  /// Faces nearer to one another than this touch: the numbers of two solids that share a face meet only to rounding.
  static constexpr double same_place = 1e-9;  // m

  /// An end of a crossing.
  struct Event {
    double range;
    std::uint32_t crossing;
    bool enters;
  };

  const WaveMaterial* material(std::uint32_t c) const { return c == open_space ? nullptr : media_[c]; }
  bool same(std::uint32_t a, std::uint32_t b) const { return material(a) == material(b); }
  double density(std::uint32_t c) const { return c == open_space ? 0.0 : material(c)->density; }

  /// The crossing that counts among those that are active: the densest; of those as dense the one that was entered first, and of these the first solid (so that it is the one that a closest hit finds).
  std::uint32_t strongest() const {
    std::uint32_t best = open_space;
    for (const std::uint32_t c : active_)
      if (best == open_space || density(c) > density(best) || (density(c) == density(best) && earlier(c, best))) best = c;
    return best;
  }
  bool earlier(std::uint32_t a, std::uint32_t b) const {
    const Crossing &x = crossings_[a], &y = crossings_[b];
    return x.enter != y.enter ? x.enter < y.enter : x.solid < y.solid;
  }

  Surface surface_at(double range, std::uint32_t before, const Event& first, const glm::dvec3& direction) const {
    const bool denser_behind = density(medium_) > density(before) || before == open_space;
    const std::uint32_t reflector = denser_behind && medium_ != open_space ? medium_ : before;
    const Crossing& crossing = crossings_[reflector];
    const auto here = [range](double end) { return std::abs(end - range) <= same_place; };
    Surface surface{range, material(before), material(medium_), material(reflector), crossing.solid};
    surface.normal = here(crossing.enter) && !crossing.starts_inside ? crossing.enter_normal : here(crossing.leave) ? crossing.leave_normal : glm::dvec3(0.0);
    if (surface.normal == glm::dvec3(0.0)) {  // the reflector goes on: the surface is the other solid's
      const Crossing& other = crossings_[first.crossing];
      surface.normal = first.enters ? other.enter_normal : other.leave_normal;
    }
    surface.cosine = std::min(1.0, std::abs(glm::dot(surface.normal, direction)));
    return surface;
  }

  bool is_open(std::uint32_t c) const { return c == open_space || media_[c]->clear(); }

  /// Whether the medium that was just entered from the open is left by event e into the open again, through a face parallel to the first.
  bool is_slab(std::size_t e, const Surface& surface) const {
    const Event& next = events_[e];
    if (next.enters || next.crossing != medium_ || media_[medium_]->opaque() || media_[medium_]->crown()) return false;
    if (!std::ranges::all_of(active_, [&](std::uint32_t c) { return c == medium_ || is_open(c); })) return false;
    const Crossing& crossing = crossings_[medium_];
    const bool alone = e + 1 == events_.size() || events_[e + 1].range > next.range + same_place;
    return alone && (next.range - surface.range) * surface.cosine <= slab_max_ && glm::dot(crossing.enter_normal, crossing.leave_normal) < -0.999;
  }

  const Scene& scene_;
  std::span<const WaveMaterial> materials_;
  double slab_max_;
  std::span<const Crossing> crossings_;
  // A thread's memory, kept from walk to walk.
  struct Scratch {
    std::vector<Event> events;
    std::vector<std::uint32_t> active;
    std::vector<const WaveMaterial*> media;
  };
  static Scratch& scratch() {
    thread_local Scratch of_thread;
    return of_thread;
  }
  std::vector<Event>& events_ = scratch().events;
  std::vector<std::uint32_t>& active_ = scratch().active;      // crossings that the ray is in
  std::vector<const WaveMaterial*>& media_ = scratch().media;  // of the crossings
  std::uint32_t medium_ = open_space;
};

}  // namespace thicket
