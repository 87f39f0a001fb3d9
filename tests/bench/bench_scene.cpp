// Tracing and contact against bare Embree.
#include "bare_loops.hpp"
#include "bench_worlds.hpp"

namespace thicket::bench {
namespace {

// --- closest hits ---

void closest_thicket(benchmark::State& state, const World& world, const std::vector<Ray>& rays) {
  const Scene scene = or_exit(Scene::build(world));
  std::vector<Hit> hits(rays.size());
  for (auto _ : state) {
    scene.closest_hits(rays, Stops::everything, hits);
    benchmark::DoNotOptimize(hits.data());
    benchmark::ClobberMemory();
  }
  per_item(state, "ray", static_cast<double>(rays.size()));
}

// --- all surfaces ---

void surfaces_bare_single(benchmark::State& state, const World& world, const std::vector<Ray>& rays) {
  BareScene bare;
  bare.add(as_triangles(world), Wanted::all);
  bare.build();
  std::vector<RTCRayHit> prepared;
  for (const Ray& ray : rays) prepared.push_back(bare_ray(ray, 0));
  Gathering query;
  std::size_t surfaces = 0;
  for (auto _ : state) {
    surfaces = 0;
    for (const RTCRayHit& ray : prepared) {
      RTCRayHit traced = ray;
      start(query);
      query.met[0].clear();
      intersect(bare.get(), query, traced);
      benchmark::DoNotOptimize(query.met[0].data());
      surfaces += query.met[0].size();
    }
  }
  per_item(state, "ray", static_cast<double>(rays.size()));
  benchmark::DoNotOptimize(surfaces);
}

void surfaces_thicket(benchmark::State& state, const World& world, double budget_db, const std::vector<Ray>& rays) {
  const Scene scene = or_exit(Scene::build(world));
  CrossingLists lists;
  for (auto _ : state) {
    scene.crossings(rays, budget_db, lists, budget_db == infinity);
    benchmark::DoNotOptimize(lists.items.data());
    benchmark::ClobberMemory();
  }
  per_item(state, "ray", static_cast<double>(rays.size()));
}

// --- contact ---

constexpr Hull pioneer{0.356, 0.0, 0.277};

/// Clearance at 1000 places of the plane.
void clearance(benchmark::State& state, const Scene& scene, double limit) {
  Dice dice(5);
  std::vector<glm::dvec3> places;
  for (int i = 0; i < 1000; ++i) {
    const double x = dice.between(-9.0, 9.0), y = dice.between(-6.5, 6.5);
    places.emplace_back(x, y, 0.0);
  }
  for (auto _ : state)
    for (const glm::dvec3& place : places) benchmark::DoNotOptimize(scene.clearance(pioneer, place, limit));
  per_item(state, "query", 1000.0);
}

/// A second of driving at 0.7 m/s in steps of 0.05 s, as a mission does it: looking as far as the least clearance so far.
void drive(benchmark::State& state, const Scene& scene, const glm::dvec3& start) {
  constexpr double length = 0.035;
  for (auto _ : state) {
    double least = 1.0;
    for (int step = 0; step < 20; ++step) {
      const glm::dvec3 from = start + glm::dvec3(length * step, 0.0, 0.0);
      Clearance nearest;
      benchmark::DoNotOptimize(scene.first_contact(pioneer, [&](double s) { return from + glm::dvec3(s, 0.0, 0.0); }, length, least, nearest, least));
    }
  }
  per_item(state, "step", 20.0);
}

}  // namespace

void register_scene() {
  struct Rays {
    const char* name;
    std::vector<Ray> rays;
  };
  const std::vector<Rays> patterns = {{"360 horizontal", circle()}, {"58 x 58 fan", fan()}};
  struct Place {
    const char* name;
    World world;
  };
  const std::vector<Place> places = {{"200 boxes", box_room()}, {"100 spheres", sphere_field()}, {"office map", office_map()}};
  for (const auto& [place, world] : places) {
    for (const auto& [pattern, rays] : patterns) {
      const std::string name = std::string("closest/") + place + "/" + pattern;
      const bool spheres = std::holds_alternative<Sphere>(world.solids.front().shape);
      measure(name + "/Thicket", [=](benchmark::State& s) { closest_thicket(s, world, rays); });
      measure(name + "/Embree triangles", [=](benchmark::State& s) { closest_bare(s, world, false, rays); });
      if (spheres) measure(name + "/Embree float spheres", [=](benchmark::State& s) { closest_bare(s, world, true, rays); });
    }
  }
  const World bushes = thicket_room();
  for (const auto& [pattern, rays] : patterns) {
    const std::string name = std::string("all surfaces/80 bushes/") + pattern;
    measure(name + "/Thicket", [=](benchmark::State& s) { surfaces_thicket(s, bushes, infinity, rays); });
    measure(name + "/Thicket, 10 dB", [=](benchmark::State& s) { surfaces_thicket(s, bushes, 10.0, rays); });
    measure(name + "/Embree triangles, single", [=](benchmark::State& s) { surfaces_bare_single(s, bushes, rays); });
    measure(name + "/Embree triangles, by 8", [=](benchmark::State& s) { surfaces_bare(s, bushes, false, rays); });
    measure(name + "/Embree float spheres, by 8", [=](benchmark::State& s) { surfaces_bare(s, bushes, true, rays); });
  }
  const Scene office = or_exit(Scene::build(office_map())), boxes = or_exit(Scene::build(box_room()));
  measure("contact/clearance, 1 m/200 boxes", [=](benchmark::State& s) { clearance(s, boxes, 1.0); });
  measure("contact/clearance, 1 m/office map", [=](benchmark::State& s) { clearance(s, office, 1.0); });
  measure("contact/clearance, no limit/200 boxes", [=](benchmark::State& s) { clearance(s, boxes, infinity); });
  measure("contact/clearance, no limit/office map", [=](benchmark::State& s) { clearance(s, office, infinity); });
  measure("contact/first_contact of a step/office map", [=](benchmark::State& s) { drive(s, office, {-0.5, 0.0, 0.0}); });
}

}  // namespace thicket::bench
