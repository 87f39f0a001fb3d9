// What a radar models in a world, in words.
#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "ray_tracer.hpp"

namespace thicket {
namespace {

/// The first solid whose material is such, or none.
template <class Such>
const Solid* first_solid(const TraceContext& context, Such&& such) {
  const World& world = context.scene.world();
  const auto found = std::ranges::find_if(world.solids, [&](const Solid& solid) { return std::invoke(such, context.materials[solid.material]); });
  return found == world.solids.end() ? nullptr : &*found;
}

}  // namespace

std::vector<PhysicsPart> parts_of_world(const TraceContext& context) {
  std::vector<PhysicsPart> parts;
  const auto add = [&](const char* name, const Solid* cause, const char* does, const char* without) {
    parts.push_back({name, cause != nullptr, cause ? fmt::format("'{}' {}", cause->name, does) : without});
  };
  const Solid* through = first_solid(context, [](const WaveMaterial& m) { return !m.opaque(); });
  if (context.first_surface_only || through) add("penetration", through, "lets the wave in", "nothing lets the wave in: of each ray the first surface is all");
  else parts.push_back({"penetration", true, "nothing lets the wave in, but surfaces = \"all\" asks for it"});
  if (!context.radar.fresnel) parts.push_back({"angle of interfaces", false, "fresnel = false"});
  else if (context.first_surface_only) parts.push_back({"angle of interfaces", false, "opaque matter reflects as much at any angle"});
  else add("angle of interfaces", first_solid(context, [](const WaveMaterial& m) { return m.dielectric && m.reflectivity > 0.0; }), "is a dielectric", "there is no dielectric");
  if (context.radar.statistical_foliage) add("leaves at random places", first_solid(context, &WaveMaterial::crown), "has a density of leaves", "nothing has a density of leaves");
  else parts.push_back({"leaves at random places", false, "statistical_foliage = false"});
  if (context.radar.bounces_max <= 1) parts.push_back({"multipath", false, "bounces_max = 1"});
  else add("multipath", context.multipath ? first_solid(context, [](const WaveMaterial& m) { return m.diffuse < 1.0; }) : nullptr, "is smooth enough to mirror", "nothing is smooth enough to mirror");
  return parts;
}

}  // namespace thicket
