// What a world costs before the first ray, and what meshes, movers and large maps cost afterwards.
#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>

#include "bare_loops.hpp"
#include "bench_worlds.hpp"
#include "bumpy_sphere.hpp"
#include "thicket/base/map_file.hpp"
#include "thicket/worlds/generators.hpp"

namespace thicket::bench {
namespace {

/// Made when first asked for: not by runs that leave it out, and not anew for every repetition.
template <class T>
class Late {
 public:
  explicit Late(std::function<std::unique_ptr<T>()> make) : shared_(std::make_shared<Shared>(std::move(make))) {}
  T& operator*() const {
    if (!shared_->made) shared_->made = shared_->make();
    return *shared_->made;
  }
  T* operator->() const { return &**this; }

 private:
  struct Shared {
    explicit Shared(std::function<std::unique_ptr<T>()> how) : make(std::move(how)) {}
    std::function<std::unique_ptr<T>()> make;
    std::unique_ptr<T> made;
  };
  std::shared_ptr<Shared> shared_;
};
template <class Make>
auto late(Make make) {
  using T = decltype(make());
  return Late<T>([make] { return std::make_unique<T>(make()); });
}

/// Milliseconds of all threads together, so that what else the machine does counts little.
class CpuTime {
 public:
  void begin() { start_ = std::clock(); }
  void end() { total_ += 1e3 * static_cast<double>(std::clock() - start_) / CLOCKS_PER_SEC; }
  void state_in(benchmark::State& state) const { state.counters["ms"] = total_ / static_cast<double>(state.iterations()); }

 private:
  std::clock_t start_ = 0;
  double total_ = 0.0;
};

/// All meshes of a world, each where it stands, as one.
Triangles flattened(const World& world) {
  Triangles all;
  for (const Solid& solid : world.solids) {
    const auto* shape = std::get_if<MeshSolid>(&solid.shape);
    if (!shape) continue;
    const auto first = static_cast<unsigned>(all.vertices.size());
    const glm::dmat3 turn = rotation_of(solid);
    for (const glm::dvec3& v : shape->mesh->vertices) all.vertices.emplace_back(solid.position + turn * (shape->scale * v));
    for (const glm::uvec3& t : shape->mesh->triangles) all.faces.push_back({first + t.x, first + t.y, first + t.z});
  }
  return all;
}

World world_of(const SharedMesh& mesh) {
  World world = empty_world();
  add(world, MeshSolid{mesh}, glm::dvec3(0.0));
  return world;
}

// --- building ---

void build_thicket(benchmark::State& state, const Late<World>& world, const std::string& item, double items) {
  CpuTime time;
  std::size_t bytes = 0;
  for (World copy = *world; auto _ : state) {
    World given = copy;
    time.begin();
    const Scene scene = or_exit(Scene::build(std::move(given)));
    time.end();
    bytes = scene.figures().memory_bytes;
  }
  time.state_in(state);
  state.counters["bytes per " + item] = static_cast<double>(bytes) / items;
}

void build_bare(benchmark::State& state, const Late<World>& world, const std::string& item, double items) {
  const Triangles triangles = flattened(*world);
  CpuTime time;
  std::ptrdiff_t bytes = 0;
  for (auto _ : state) {
    time.begin();
    BareScene bare;
    bare.add(triangles, Wanted::closest);
    bare.build();
    time.end();
    bytes = bare.bytes();
  }
  time.state_in(state);
  state.counters["bytes per " + item] = static_cast<double>(bytes) / items;
}

void register_builds() {
  struct Size {
    const char* name;
    std::uint32_t around, rings;
  };
  for (const auto& [name, around, rings] : {Size{"10^3", 25, 21}, {"10^4", 100, 51}, {"10^5", 250, 201}, {"10^6", 1000, 501}, {"10^7", 2500, 2001}}) {
    const double count = 2.0 * around * (rings - 1);
    const auto world = late([around, rings] { return world_of(bumpy_sphere(around, rings)); });
    const std::string group = std::string("build/mesh of ") + name + " triangles/";
    auto* ours = measure(group + "Thicket", [=](benchmark::State& s) { build_thicket(s, world, "triangle", count); });
    auto* bare = measure(group + "Embree triangles", [=](benchmark::State& s) { build_bare(s, world, "triangle", count); });
    for (auto* one : {ours, bare})
      if (count > 1e6) one->Iterations(1)->Repetitions(1);
  }
  // Trees whose leaves are one mesh, or each a mesh of its own.
  const auto trees = [](int count, bool shared) {
    return late([=] {
      World world = empty_world();
      const SharedMesh leaves = grow_tree({}).leaves;
      Dice dice(6);
      for (int i = 0; i < count; ++i) {
        const double x = dice.between(-300.0, 300.0), y = dice.between(-300.0, 300.0);
        add(world, MeshSolid{shared ? leaves : std::make_shared<Mesh>(*leaves)}, {x, y, 0.0}, dice.between(-pi, pi), foliage);
      }
      return world;
    });
  };
  for (const auto& [name, count, shared] : {std::tuple("10000, one mesh", 10000, true), {"100, one mesh", 100, true}, {"100, a mesh each", 100, false}}) {
    const auto world = trees(count, shared);
    measure(std::string("build/trees of 8000 triangles/") + name, [=, n = count](benchmark::State& s) { build_thicket(s, world, "tree", n); });
  }
}

// --- rays ---

World mesh_spheres() {
  World world = empty_world();
  Triangles octahedron;
  octahedron.add_sphere(glm::dvec3(0.0), 1.0, 4);
  std::vector<glm::uvec3> triangles;
  for (const auto& f : octahedron.faces) {
    const glm::dvec3 a(octahedron.vertices[f[0]]), b(octahedron.vertices[f[1]]), c(octahedron.vertices[f[2]]);
    const bool outward = glm::dot(glm::cross(b - a, c - a), a) > 0.0;
    triangles.emplace_back(f[0], outward ? f[1] : f[2], outward ? f[2] : f[1]);
  }
  const SharedMesh sphere = make_mesh({octahedron.vertices.begin(), octahedron.vertices.end()}, std::move(triangles));
  for (const Solid& solid : sphere_field().solids) add(world, MeshSolid{sphere, std::get<Sphere>(solid.shape).radius}, solid.position);
  return world;
}

/// Two bumpy spheres, 8 and 4 m wide, of 10^6 triangles (one mesh) on either side of the sensor.
World large_mesh() {
  World world = empty_world();
  const SharedMesh mesh = bumpy_sphere(1000, 501);
  add(world, MeshSolid{mesh, 4.0}, {7.0, 0.0, sensor_height});
  add(world, MeshSolid{mesh, 2.0}, {-3.0, 0.0, sensor_height});
  return world;
}

void trace_thicket(benchmark::State& state, const Late<Scene>& scene, const std::vector<Ray>& rays, bool all) {
  std::vector<Hit> hits(rays.size());
  CrossingLists lists;
  scene->closest_hits(rays, Stops::everything, hits);  // also builds what is late
  for (auto _ : state) {
    if (all) scene->crossings(rays, infinity, lists, true);
    else scene->closest_hits(rays, Stops::everything, hits);
    benchmark::ClobberMemory();
  }
  per_item(state, "ray", static_cast<double>(rays.size()));
}

void trace_bare(benchmark::State& state, const Late<BareScene>& bare, const std::vector<Ray>& rays) {
  const std::vector<RTCRayHit8> packets = bare_packets(rays);
  Gathering query;
  RTCScene scene = bare->get();
  for (auto _ : state) {
    for (const RTCRayHit8& packet : packets) {
      RTCRayHit8 traced = packet;
      start(query);
      for (auto& list : query.met) list.clear();
      intersect(all_valid, scene, query, traced);
      benchmark::DoNotOptimize(traced);
      benchmark::ClobberMemory();
    }
  }
  per_item(state, "ray", static_cast<double>(rays.size()));
}

/// A lobe of the same rays and what it makes of them, by the default physics.
void trace_lobe(benchmark::State& state, const Late<Scene>& scene) {
  LobeRadarSpec spec;
  spec.position_m = {0.0, 0.0, sensor_height};
  spec.range_max_m = 30.0;
  scans(state, *scene, spec, Pose{}, 1, "ray", 58.0 * 58.0);
}

void register_rays() {
  const std::vector<std::pair<const char*, std::function<World()>>> places = {
      {"100 mesh spheres", mesh_spheres}, {"2 meshes of 10^6", large_mesh}, {"100 leafy trees", [] { return leafy_thicket(100, 15.0); }}};
  for (const auto& [place, make] : places) {
    const auto world = late(make);
    const auto scene = late([=] { return or_exit(Scene::build(*world)); });
    for (const bool all : {false, true}) {
      const auto bare = Late<BareScene>([=] {
        auto made = std::make_unique<BareScene>();
        made->add(flattened(*world), all ? Wanted::all : Wanted::closest);
        made->build();
        return made;
      });
      for (const auto& [pattern, rays] : {std::pair("360 horizontal", circle()), {"58 x 58 fan", fan()}}) {
        const std::string name = std::string(all ? "all surfaces/" : "closest/") + place + "/" + pattern;
        measure(name + "/Thicket", [=, r = rays](benchmark::State& s) { trace_thicket(s, scene, r, all); });
        measure(name + "/Embree triangles", [=, r = rays](benchmark::State& s) { trace_bare(s, bare, r); });
      }
    }
    measure(std::string("lobe/") + place + "/lobe by its budget", [=](benchmark::State& s) { trace_lobe(s, scene); });
  }
}

// --- movers ---

World movers(int count) {
  World world = box_room();
  Dice dice(8);
  for (int i = 0; i < count; ++i) {
    const glm::dvec2 from = place_in_room(dice), to = place_in_room(dice);
    add(world, Box{{0.5, 0.5, 1.7}}, {from.x, from.y, 0.85}, 0.0);
    world.solids.back().motion = std::make_shared<Motion>(Motion{{{from, 0.85}, {to, 0.85}}, 1.0, 0.0, 0.3, Motion::Mode::back_and_forth});
  }
  return world;
}

void register_movers() {
  for (const int count : {0, 1, 10, 100}) {
    const auto scene = late([=] { return or_exit(Scene::build(movers(count))); });
    const std::string peer = std::to_string(count) + " movers";
    measure("motion/scan of 360 among 200 boxes/" + peer, [=](benchmark::State& s) { trace_thicket(s, scene, circle(), false); });
    if (count == 0) continue;
    measure("motion/set_time/" + peer, [=](benchmark::State& s) {
      double time = 0.0;
      for (auto _ : s) scene->set_time(time += 0.1);
      per_item(s, "call", 1.0);
    });
  }
}

// --- a map of 2000 x 2000 cells ---

constexpr int map_side = 2000;

/// The text of a PGM: a fifth of the cells at random, or rooms of 5 x 5 m with doors.
std::string map_pixels(bool random) {
  std::string pixels(static_cast<std::size_t>(map_side) * map_side, '\xfe');
  Dice dice(9);
  for (int row = 0; row < map_side; ++row) {
    for (int column = 0; column < map_side; ++column) {
      const bool wall = (row % 100 < 2 && column % 100 > 20) || (column % 100 < 2 && row % 100 > 20);
      const bool ragged = (row % 100 == 2 || column % 100 == 2) && row % 100 > 1 && column % 100 > 1 && dice.between(0.0, 1.0) < 0.1;
      const bool matter = random ? dice.between(0.0, 1.0) < 0.2 : wall || ragged || dice.between(0.0, 1.0) < 0.001;
      if (matter) pixels[static_cast<std::size_t>(row) * map_side + static_cast<std::size_t>(column)] = '\0';
    }
  }
  return pixels;
}

/// A map_server map in a folder of its own, which goes with it.
class MapFile {
 public:
  explicit MapFile(bool random) : folder_(std::filesystem::temp_directory_path() / ("thicket_bench_" + std::to_string(std::chrono::steady_clock::now().time_since_epoch().count()))) {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "map.pgm", std::ios::binary) << "P5\n" << map_side << ' ' << map_side << "\n255\n" << map_pixels(random);
    std::ofstream(yaml()) << "image: map.pgm\nresolution: 0.05\norigin: [-50.0, -50.0, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
  }
  MapFile(const MapFile&) = delete;
  MapFile& operator=(const MapFile&) = delete;
  ~MapFile() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  std::filesystem::path yaml() const { return folder_ / "map.yaml"; }

 private:
  std::filesystem::path folder_;
};

template <class Work>
void measure_ms(const std::string& name, Work work) {
  measure(name, [=](benchmark::State& state) {
    CpuTime time;
    for (auto _ : state) work(time);
    time.state_in(state);
  });
}

Late<World> register_loading(bool random) {
  const auto file = Late<MapFile>([=] { return std::make_unique<MapFile>(random); });
  const auto world = late([=] { return or_exit(read_world(file->yaml())); });
  const std::string group = std::string("load/2000 x 2000 cells, ") + (random ? "a fifth at random" : "rooms") + "/";
  const auto timed = [](CpuTime& time, auto&& work) {
    time.begin();
    benchmark::DoNotOptimize(work());
    time.end();
  };
  measure_ms(group + "read_world", [=](CpuTime& time) { const auto yaml = file->yaml(); timed(time, [&] { return or_exit(read_world(yaml)); }); });
  measure_ms(group + "read_map_file, its first part", [=](CpuTime& time) { const auto yaml = file->yaml(); timed(time, [&] { return or_exit(read_map_file(yaml)); }); });
  measure_ms(group + "Scene::build", [=](CpuTime& time) { World copy = *world; timed(time, [&] { return or_exit(Scene::build(std::move(copy))); }); });
  return world;
}

// --- contact ---

constexpr Hull pioneer{0.356, 0.0, 0.277};

std::vector<glm::dvec3> contact_places() {
  Dice dice(10);
  std::vector<glm::dvec3> places;
  for (int i = 0; i < 1000; ++i) {
    const double x = dice.between(-9.0, 9.0);
    places.emplace_back(x, dice.between(-9.0, 9.0), 0.0);
  }
  return places;
}

void register_contact(const Late<World>& rooms) {
  const std::vector<std::pair<const char*, Late<Scene>>> places = {
      {"200 boxes", late([] { return or_exit(Scene::build(box_room())); })},
      {"25 trees, 100000 leaves", late([] { return or_exit(Scene::build(leafy_thicket(25, 8.0))); })},
      {"map of 2000 x 2000, rooms", late([=] { return or_exit(Scene::build(*rooms)); })}};
  for (const double limit : {0.5, 5.0}) {
    for (const auto& [place, scene] : places) {
      measure(std::string("contact/clearance, ") + (limit < 1.0 ? "0.5 m/" : "5 m/") + place, [=, s = scene](benchmark::State& state) {
        const auto at = contact_places();
        benchmark::DoNotOptimize(s->figures());
        for (auto _ : state)
          for (const glm::dvec3& p : at) benchmark::DoNotOptimize(s->clearance(pioneer, p, limit));
        per_item(state, "query", static_cast<double>(at.size()));
      });
    }
  }
  for (const auto& [place, scene] : places) {
    measure(std::string("contact/first_contact of 2 cm/") + place, [=, s = scene](benchmark::State& state) {
      const auto at = contact_places();
      benchmark::DoNotOptimize(s->figures());
      for (auto _ : state) {
        for (const glm::dvec3& p : at) {
          Clearance nearest;
          double least = 0.02;
          benchmark::DoNotOptimize(s->first_contact(pioneer, [&](double way) { return p + glm::dvec3(way, 0.0, 0.0); }, 0.02, least, nearest, least));
        }
      }
      per_item(state, "step", static_cast<double>(at.size()));
    });
  }
}

}  // namespace

void register_worlds() {
  register_builds();
  register_rays();
  register_movers();
  register_loading(true);
  register_contact(register_loading(false));
}

}  // namespace thicket::bench
