// The charts of docs/performance.md: what each of them varies.
#include "study_charts.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <memory>

#include "bench_worlds.hpp"
#include "bumpy_sphere.hpp"
#include "map_work.hpp"
#include "thicket/nav/occupancy_map.hpp"

namespace thicket::study {
namespace {

using namespace bench;
using SharedScene = std::shared_ptr<const Scene>;

SharedScene scene_of(World world) { return std::make_shared<const Scene>(or_exit(Scene::build(std::move(world)))); }

ScanningRadarSpec scanner_of(double rays, double range = 30.0) {
  ScanningRadarSpec spec;
  spec.position_m = {0.0, 0.0, 0.0};
  spec.step_deg = 360.0 / rays;
  spec.range_max_m = range;
  return spec;
}

/// The preset, standing on its own.
LobeRadarSpec lobe_of(std::int64_t edge = 58) {
  Faults faults;
  auto spec = std::get<LobeRadarSpec>(read_sensor(or_exit(parse_document("preset = 'x4m05'\nposition_m = [0, 0, 0]", "study")), faults));
  spec.azimuth_rays = spec.elevation_rays = edge;
  return spec;
}

/// Scans one after another from one place, on so many threads.
std::function<void()> scanning(const SharedScene& scene, const SensorSpec& spec, std::size_t threads = 1) {
  const auto sensor = make_sensor(spec, 0);
  const auto scan = std::make_shared<Scan>();
  const auto number = std::make_shared<std::uint64_t>(0);
  return [=] {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    sensor->measure(*scene, Pose::planar(0.0, 0.0, sensor_height, 0.0), 0.0, (*number)++, Random(1, 0), *scan);
  };
}

/// Lobes all around, measured side by side as a simulation does it.
std::function<void()> lobes(const SharedScene& scene, int count, std::size_t threads) {
  const auto sensors = std::make_shared<std::vector<std::shared_ptr<const Sensor>>>();
  for (int i = 0; i < count; ++i) {
    LobeRadarSpec spec = lobe_of();
    spec.yaw_deg = 360.0 * i / count;
    sensors->push_back(make_sensor(spec, static_cast<std::uint16_t>(i)));
  }
  const auto scans = std::make_shared<std::vector<Scan>>(sensors->size());
  const auto number = std::make_shared<std::uint64_t>(0);
  return [=] {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    const std::uint64_t now = (*number)++;
    tbb::parallel_for(std::size_t{0}, sensors->size(), [&](std::size_t i) {
      (*sensors)[i]->measure(*scene, Pose::planar(0.0, 0.0, sensor_height, 0.0), 0.0, now, Random(1, static_cast<std::uint16_t>(i)), (*scans)[i]);
    });
  };
}

/// Boxes of 0.5 m in a square field, none nearer than 1.5 m to its middle.
World field(int boxes, double half_side) {
  World world = empty_world();
  Dice dice(21);
  for (int i = 0; i < boxes;) {
    const double x = dice.between(-half_side, half_side), y = dice.between(-half_side, half_side), yaw = dice.between(-pi, pi);
    if (std::hypot(x, y) < 1.5) continue;
    add(world, Box{{0.5, 0.5, 2.0}}, {x, y, 1.0}, yaw);
    ++i;
  }
  return world;
}

Chart rays() {
  Chart chart{"rays", "Rays", {"A scan among 200 boxes, one thread: a scanning radar, and the lobe x4m05 with its receiver"}, "rays of a scan", "a scan, ms", 1e-3, {}};
  const SharedScene boxes = scene_of(box_room());
  for (const double count : {36.0, 120.0, 360.0, 1200.0, 3600.0, 12000.0, 36000.0}) chart.cases.push_back({"scanning radar", count, scanning(boxes, scanner_of(count))});
  for (const std::int64_t edge : {6, 12, 24, 58, 116, 190}) chart.cases.push_back({"lobe", static_cast<double>(edge * edge), scanning(boxes, lobe_of(edge))});
  return chart;
}

Chart triangles() {
  Chart chart{"triangles", "Triangles", {"A fan of 58 × 58 rays on a closed mesh of 1 m radius, 3 m away, one thread"}, "triangles of the mesh", "a ray, ns", 1e-9, {}};
  const auto fan_rays = std::make_shared<const std::vector<Ray>>(fan());
  for (const std::uint32_t rings : {6u, 16u, 51u, 159u, 501u}) {
    World world = empty_world();
    add(world, MeshSolid{bumpy_sphere(2 * rings, rings)}, {3.0, 0.0, 0.5});
    const double count = 4.0 * rings * (rings - 1.0);
    const SharedScene scene = scene_of(std::move(world));
    const auto hits = std::make_shared<std::vector<Hit>>(fan_rays->size());
    const auto lists = std::make_shared<CrossingLists>();
    const double items = static_cast<double>(fan_rays->size());
    chart.cases.push_back({"first surface", count, [=] { scene->closest_hits(*fan_rays, Stops::everything, *hits); }, items});
    chart.cases.push_back({"all surfaces", count, [=] { scene->crossings(*fan_rays, infinity, *lists, true); }, items});
  }
  return chart;
}

Chart solids() {
  Chart chart{"solids", "Solids", {"A scan of 360 rays and 30 m among boxes of 0.5 m, one thread"}, "boxes", "a scan, µs", 1e-6, {}};
  for (const int count : {10, 100, 1000, 10000, 100000}) {
    const double half_side = std::sqrt(static_cast<double>(count));  // a box for every 4 m²
    chart.cases.push_back({"a field that grows, a box every 4 m²", static_cast<double>(count), scanning(scene_of(field(count, half_side)), scanner_of(360.0))});
    if (count <= 10000) chart.cases.push_back({"a field of 60 × 60 m that fills", static_cast<double>(count), scanning(scene_of(field(count, 30.0)), scanner_of(360.0))});
  }
  return chart;
}

/// Scans of a hall into a map that has seen so many places of 5 x 5 km besides.
Chart map_size() {
  using namespace map_work;
  Chart chart{"map_size", "Size of the map", {"A scan of the hall of 50 × 50 m into a map that knows other places all over 5 × 5 km besides, cells of 0.1 m"}, "cells that the map knows", "a scan, µs", 1e-6, {}};
  for (const Instrument& instrument : {Instrument::lidar360(), Instrument::radar4x58()}) {
    const auto steps = std::make_shared<const std::vector<Step>>(map_work::steps(instrument));
    for (const int places : {0, 30, 300, 3000}) {
      MapSpec spec;
      spec.resolution_m = 0.1;
      const auto map = std::make_shared<OccupancyMap>(spec);
      Dice dice(3);
      for (int i = 0; i < places;) {
        const double x = dice.between(-2500.0, 2500.0), y = dice.between(-2500.0, 2500.0);
        if (std::max(std::abs(x), std::abs(y)) < 100.0) continue;
        for (const Scan& scan : (*steps)[static_cast<std::size_t>(i) % steps->size()].scans) map->integrate(scan, Pose::planar(x, y, 1.0, 0.0));
        ++i;
      }
      const auto once = [=] {
        for (const Step& step : *steps)
          for (const Scan& scan : step.scans) map->integrate(scan, step.pose_in_space());
      };
      once();  // what it knows from here on
      chart.cases.push_back({instrument.name, static_cast<double>(map->known_cells()), once, static_cast<double>(steps->size())});
    }
  }
  return chart;
}

Chart range() {
  Chart chart{"range", "Range", {"360 rays in a sparse field (a box every 400 m²): a scan, and its part of a new map of 20 scans a metre apart"}, "largest range, m", "a scan, µs", 1e-6, {}};
  const SharedScene scene = scene_of(field(2000, 450.0));
  for (const double range : {3.0, 10.0, 30.0, 100.0, 300.0}) {
    chart.cases.push_back({"the scan", range, scanning(scene, scanner_of(360.0, range))});
    constexpr int count = 20;
    const auto scans = std::make_shared<std::vector<Scan>>(count);
    const auto sensor = make_sensor(scanner_of(360.0, range), 0);
    const auto pose = [](int i) { return Pose::planar(static_cast<double>(i), 0.3 * i, sensor_height, 0.0); };
    for (int i = 0; i < count; ++i) sensor->measure(*scene, pose(i), 0.1 * i, static_cast<std::uint64_t>(i), Random(1, 0), (*scans)[static_cast<std::size_t>(i)]);
    for (const double resolution : {0.1, 0.4}) {
      MapSpec spec;
      spec.resolution_m = resolution;
      chart.cases.push_back({fmt::format("the map, cells of {:g} m", resolution), range, [=] {
                               OccupancyMap map(spec);
                               for (int i = 0; i < count; ++i) map.integrate((*scans)[static_cast<std::size_t>(i)], pose(i));
                             }, static_cast<double>(count)});
    }
  }
  return chart;
}

Chart lobe_count() {
  Chart chart{"lobes", "Lobes", {"A look of all lobes (x4m05, 58 × 58 rays and receiver, spread over the circle) among 200 boxes, CPU time of all threads"}, "lobes", "a look, ms", 1e-3, {}};
  const SharedScene boxes = scene_of(box_room());
  for (const int count : {1, 2, 4, 8, 16})
    for (const std::size_t threads : {1, 2}) chart.cases.push_back({threads == 1 ? "1 thread" : "2 threads", static_cast<double>(count), lobes(boxes, count, threads)});
  return chart;
}

Chart threads() {
  Chart chart{"threads", "Threads", {"Wall time of a scan among 200 boxes"}, "threads", "a scan, ms", 1e-3, {}};
  const SharedScene boxes = scene_of(box_room());
  for (const std::size_t count : {1, 2, 4}) {
    const auto x = static_cast<double>(count);
    chart.cases.push_back({"scanning radar of 3600 rays", x, scanning(boxes, scanner_of(3600.0), count), 1.0, true});
    chart.cases.push_back({"one lobe of 58 × 58", x, scanning(boxes, lobe_of(), count), 1.0, true});
    chart.cases.push_back({"four lobes of 58 × 58", x, lobes(boxes, 4, count), 1.0, true});
  }
  return chart;
}

}  // namespace

const std::vector<ChartMaker>& chart_makers() {
  static const std::vector<ChartMaker> list = {{"rays", rays}, {"triangles", triangles}, {"solids", solids}, {"map_size", map_size}, {"range", range}, {"lobes", lobe_count}, {"threads", threads}};
  return list;
}

}  // namespace thicket::study
