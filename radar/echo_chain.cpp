#include "echo_chain.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace thicket {
namespace {

constexpr std::size_t open_space = static_cast<std::size_t>(-1);

/// Faces nearer to one another than this touch: the numbers of two solids that share a face meet only to rounding.
constexpr double same_place = 1e-9;  // m

/// An end of a crossing.
struct Event {
  double range;
  std::size_t crossing;
  bool enters;
};

/// The wave on its way: what is left of it and where it is.
class Wave {
 public:
  Wave(const World& world, std::span<const Material> materials, std::span<const Crossing> crossings, const EchoLimits& limits)
      : world_(world), materials_(materials), crossings_(crossings), limits_(limits) {}

  /// The crossing that counts among those that are active; crossings come in a fixed order, so ties are settled the same way every time.
  std::size_t strongest(const std::vector<std::size_t>& active) const {
    std::size_t best = open_space;
    for (const std::size_t c : active)
      if (best == open_space || attenuation(c) > attenuation(best) || (attenuation(c) == attenuation(best) && material_index(c) < material_index(best))) best = c;
    return best;
  }
  const Material& material(std::size_t c) const { return materials_[material_index(c)]; }
  std::uint32_t material_index(std::size_t c) const { return world_.solids[crossings_[c].solid].material; }
  double attenuation(std::size_t c) const { return c == open_space ? 0.0 : material(c).attenuation_db_per_m; }
  bool is_matter(std::size_t c) const { return c != open_space && visible(material(c), limits_.floor_power); }
  bool same(std::size_t a, std::size_t b) const {
    if (a == open_space || b == open_space) return a == b;
    return material_index(a) == material_index(b);
  }

 private:
  const World& world_;
  std::span<const Material> materials_;
  std::span<const Crossing> crossings_;
  const EchoLimits& limits_;
};

}  // namespace

void trace_echoes(const World& world, std::span<const Material> materials, std::span<const Crossing> crossings, const glm::dvec3& direction, const EchoLimits& limits, Beam& beam,
                  std::vector<Echo>& echoes) {
  beam.first_echo = static_cast<std::uint32_t>(echoes.size());
  beam.echo_count = 0;
  beam.end = BeamEnd::open;
  beam.sensed_range = limits.range_max;
  beam.starts_inside = false;
  if (crossings.empty()) return;

  thread_local std::vector<Event> events;  // scratch: emptied on every call
  thread_local std::vector<std::size_t> active;
  events.clear();
  active.clear();
  for (std::size_t i = 0; i < crossings.size(); ++i) {
    if (!crossings[i].starts_inside) events.push_back({crossings[i].enter, i, true});
    events.push_back({crossings[i].leave, i, false});
    if (crossings[i].starts_inside) active.push_back(i);
  }
  std::sort(events.begin(), events.end(), [](const Event& a, const Event& b) {
    if (a.range != b.range) return a.range < b.range;
    return a.crossing != b.crossing ? a.crossing < b.crossing : a.enters > b.enters;
  });

  const Wave wave(world, materials, crossings, limits);
  std::size_t medium = wave.strongest(active);
  beam.starts_inside = wave.is_matter(medium);
  if (medium != open_space && wave.material(medium).opaque()) {
    beam.end = BeamEnd::exhausted;
    beam.sensed_range = 0.0;
    return;
  }
  double at = 0.0, loss_db = 0.0, passed = 1.0;  // passed: fraction of power that the interfaces let through, one way
  // What may be lost inside matter until the budget is used up or a perfect reflector would come back below the floor.
  const auto bearable_loss = [&] { return std::min(limits.budget_db, -5.0 * std::log10(limits.floor_power / (passed * passed))); };
  double most_db = bearable_loss();

  for (std::size_t e = 0; e < events.size();) {
    const double range = events[e].range;
    if (medium != open_space && wave.attenuation(medium) > 0.0) {
      const double through = wave.attenuation(medium) * (std::min(range, limits.range_max) - at);
      if (loss_db + through >= most_db) {
        beam.end = BeamEnd::exhausted;
        beam.sensed_range = std::min(limits.range_max, at + (most_db - loss_db) / wave.attenuation(medium));
        break;
      }
      loss_db += through;
    }
    if (range > limits.range_max) break;

    // Everything that begins or ends here happens at once: two solids that share a face have no gap between them.
    const Event* surface = &events[e];
    for (; e < events.size() && events[e].range <= range + same_place; ++e) {
      if (events[e].enters) {
        active.push_back(events[e].crossing);
      } else {
        std::erase(active, events[e].crossing);
      }
    }
    const std::size_t before = medium;
    medium = wave.strongest(active);
    at = range;
    if (wave.same(before, medium)) continue;

    const bool denser_behind = wave.attenuation(medium) > wave.attenuation(before) || before == open_space;
    const std::size_t reflector = denser_behind && medium != open_space ? medium : before;
    const Crossing& crossing = crossings[reflector];
    const auto here = [range](double end) { return std::abs(end - range) <= same_place; };
    glm::dvec3 normal = here(crossing.enter) && !crossing.starts_inside ? crossing.enter_normal : here(crossing.leave) ? crossing.leave_normal : glm::dvec3(0.0);
    if (normal == glm::dvec3(0.0)) {  // the reflector goes on: the surface is the other solid's
      const Crossing& other = crossings[surface->crossing];
      normal = surface->enters ? other.enter_normal : other.leave_normal;
    }
    const double cosine = std::min(1.0, std::abs(glm::dot(normal, direction)));
    const double reflectivity = wave.material(reflector).reflectivity;
    const double two_way = passed * passed * std::pow(10.0, -0.2 * loss_db);
    const double power = reflectivity * cosine * two_way;
    const bool was_matter = wave.is_matter(before), is_matter = wave.is_matter(medium);
    if (power >= limits.floor_power && range >= limits.range_min && (was_matter || is_matter)) {
      const Edge edge = !was_matter ? Edge::front : is_matter ? Edge::inner : Edge::back;
      echoes.push_back({range, static_cast<float>(std::sqrt(power)), static_cast<float>(cosine), 0.0f, edge});
      ++beam.echo_count;
    }
    if (medium != open_space && wave.material(medium).opaque()) {
      beam.end = BeamEnd::stopped;
      beam.sensed_range = range;
      break;
    }
    passed *= 1.0 - reflectivity;
    most_db = bearable_loss();
    if (loss_db > most_db) {
      beam.end = BeamEnd::exhausted;
      beam.sensed_range = range;
      break;
    }
  }
}

}  // namespace thicket
