// What an image of synthetic aperture costs: pixels x scans.
#include <tbb/global_control.h>

#include "bench_worlds.hpp"
#include "thicket/radar/sar.hpp"
#include "thicket/radar/sensor.hpp"

namespace thicket::bench {
namespace {

/// A scan of an X4M05 with I and Q among boxes; bins of 6.4 mm or of 5.14 cm.
Scan scan_of(double bin_size) {
  Faults faults;
  const auto entry = or_exit(parse_document("preset = 'x4m05'\nsignal = 'iq'\nposition_m = [0, 0, 0]", "bench"));
  auto spec = std::get<LobeRadarSpec>(read_sensor(entry, faults));
  spec.bin_size_m = bin_size;
  spec.bin_count = static_cast<std::int64_t>(9.87 / bin_size);
  const Scene scene = or_exit(Scene::build(box_room()));
  Scan scan;
  make_sensor(spec, 0)->measure(scene, Pose::planar(0.0, 0.0, sensor_height, 0.0), 0.0, 0, Random(1, 0), scan);
  return scan;
}

/// 8 x 8 m before a lobe that moves sideways, pixels of 2 cm.
void add_scans(benchmark::State& state, const Scan& scan, const std::string& method, std::size_t threads, const std::string& window) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
  SarSpec spec;
  spec.bounds_m = {0.5, -4.0, 8.5, 4.0};
  spec.window = window;
  SarImage image(spec, method, 7.29);
  int step = 0;
  for (auto _ : state) image.add(scan, Pose::planar(0.0, 0.01 * (++step % 200), sensor_height, 0.0));
  state.counters["pixels x scans per s"] = benchmark::Counter(static_cast<double>(image.pixels_added()), benchmark::Counter::kIsRate);
  state.counters["scans per s"] = benchmark::Counter(static_cast<double>(image.scans()), benchmark::Counter::kIsRate);
}

}  // namespace

void register_sar() {
  const Scan fine = scan_of(0.0064256), coarse = scan_of(0.0514);
  for (const std::size_t threads : {1, 2}) {
    const std::string on = threads == 1 ? ", 1 thread" : ", 2 threads";
    measure("sar/back-projection" + on + "/bins of 6.4 mm", [=](benchmark::State& s) { add_scans(s, fine, "back_projection", threads, "none"); })->UseRealTime();
    measure("sar/back-projection" + on + "/bins of 5.14 cm", [=](benchmark::State& s) { add_scans(s, coarse, "back_projection", threads, "none"); })->UseRealTime();
    measure("sar/back-projection" + on + "/Hann's window", [=](benchmark::State& s) { add_scans(s, fine, "back_projection", threads, "hann"); })->UseRealTime();
    measure("sar/simple sum" + on + "/bins of 6.4 mm", [=](benchmark::State& s) { add_scans(s, fine, "simple_sum", threads, "none"); })->UseRealTime();
  }
}

}  // namespace thicket::bench
