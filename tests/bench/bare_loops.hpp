// Loops over bare Embree: what Thicket's rays and scans are held against.
#pragma once

#include "bare_embree.hpp"

namespace thicket::bench {

alignas(32) inline const int all_valid[8] = {-1, -1, -1, -1, -1, -1, -1, -1};

/// Both see the same to `tolerance` metres, but for rays that graze an edge.
inline bool agree(const Scene& scene, const BareScene& bare, const std::vector<Ray>& rays, double tolerance) {
  std::vector<Hit> hits(rays.size());
  scene.closest_hits(rays, Stops::everything, hits);
  std::size_t differ = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    RTCRayHit ray = bare_ray(rays[i], 0);
    BareContext context;
    start(context);
    intersect(bare.get(), context, ray);
    const double range = ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? infinity : static_cast<double>(ray.ray.tfar);
    differ += range != hits[i].range && !(std::abs(range - hits[i].range) < tolerance);
  }
  return differ * 100 <= rays.size();
}

/// Packets of eight, the nearest surface of each ray.
inline void closest_bare(benchmark::State& state, const World& world, bool user_geometry, const std::vector<Ray>& rays) {
  BareScene bare;
  if (user_geometry) bare.add(as_spheres(world), Wanted::closest);
  else bare.add(as_triangles(world), Wanted::closest);
  bare.build();
  const bool facets = !user_geometry && !as_spheres(world).empty();
  if (!agree(or_exit(Scene::build(world)), bare, rays, facets ? 0.02 : 1e-3)) return state.SkipWithError("the peers see different things");
  const std::vector<RTCRayHit8> packets = bare_packets(rays);
  for (auto _ : state) {
    BareContext context;
    start(context);
    for (const RTCRayHit8& packet : packets) {
      RTCRayHit8 traced = packet;
      intersect(all_valid, bare.get(), context, traced);
      benchmark::DoNotOptimize(traced);
    }
  }
  per_item(state, "ray", static_cast<double>(rays.size()));
}

/// Packets of eight, all surfaces of each ray.
inline void surfaces_bare(benchmark::State& state, const World& world, bool user_geometry, const std::vector<Ray>& rays) {
  BareScene bare;
  if (user_geometry) {
    // The room stays triangles, as it has no spheres.
    World room = world;
    std::erase_if(room.solids, [](const Solid& s) { return std::holds_alternative<Sphere>(s.shape); });
    bare.add(as_triangles(room), Wanted::all);
    bare.add(as_spheres(world), Wanted::all);
  } else {
    bare.add(as_triangles(world), Wanted::all);
  }
  bare.build();
  const std::vector<RTCRayHit8> packets = bare_packets(rays);
  Gathering query;
  for (auto _ : state) {
    for (const RTCRayHit8& packet : packets) {
      RTCRayHit8 traced = packet;
      start(query);
      for (auto& list : query.met) list.clear();
      intersect(all_valid, bare.get(), query, traced);
      for (auto& list : query.met) benchmark::DoNotOptimize(list.data());
      benchmark::ClobberMemory();
    }
  }
  per_item(state, "ray", static_cast<double>(rays.size()));
}

}  // namespace thicket::bench
