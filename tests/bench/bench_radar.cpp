// Whole scans, and what they cost on top of the tracing.
#include "bench_worlds.hpp"
#include "receiver.hpp"

namespace thicket::bench {
namespace {

constexpr const char* divided_room = "worlds/data/foliage_wall/divided_room.toml";

/// Where the mission map_radar passes the middle of the foliage wall.
const Pose vehicle = Pose::planar(-3.0, 0.3, 0.0, 0.4);

/// The scene's part of the same scan.
void tracing(benchmark::State& state, const Scene& scene, const ScanningRadarSpec& spec) {
  const Pose sensor = vehicle * Pose::planar(spec.position_m.x, spec.position_m.y, spec.position_m.z, 0.0);
  std::vector<Ray> rays;
  for (int i = 0; i < 360; ++i) {
    const glm::dvec2 d = direction(radians(i - 180.0));
    rays.push_back({sensor.position, sensor.orientation * glm::dvec3(d, 0.0), spec.range_max_m});
  }
  CrossingLists lists;
  for (auto _ : state) {
    scene.crossings(rays, spec.penetration_budget_db, lists);
    benchmark::DoNotOptimize(lists.items.data());
    benchmark::ClobberMemory();
  }
  per_item(state, "beam", static_cast<double>(rays.size()));
}

/// As many returns as the lobe of Billdal 2018 was meant to have rays, to the bins of an X4.
void receiver(benchmark::State& state, ReceiverSpec spec) {
  spec.bin_count = 1536;
  spec.bin_size_m = 0.0064256;
  spec.bandwidth_ghz = 1.5;
  RadarSpec wave;
  wave.frequency_ghz = 7.29;
  const Receiver receiver(spec, wave, 0.0, 9.87);
  Dice dice(5);
  std::vector<Return> returns;
  for (int i = 0; i < 58 * 58; ++i) returns.push_back({dice.between(0.5, 9.5), static_cast<float>(dice.between(0.0, 1e-6)), 0.0f});
  const Random random(1, 0);
  Profiles profiles;
  receiver.start(1, profiles);
  std::vector<Echo> detections;
  std::uint64_t number = 0;
  for (auto _ : state) {
    detections.clear();
    receiver.receive(returns, {}, random, number++, 0, profiles, detections);
    benchmark::DoNotOptimize(profiles.amplitude.data());
    benchmark::ClobberMemory();
  }
  per_item(state, "profile", 1.0);
}

}  // namespace

void register_radar() {
  const Scene scene = shipped_scene(divided_room);
  ScanningRadarSpec radar;
  radar.position_m.z = 0.4;
  ScanningRadarSpec side_rays = radar;
  side_rays.divergence = "side_rays";
  ScanningRadarSpec noisy = radar;
  noisy.range_noise_m = 0.02;
  LidarSpec lidar;
  lidar.position_m.z = 0.4;
  measure("radar/scan of 360/tracing alone", [=](benchmark::State& s) { tracing(s, scene, radar); });
  measure("radar/scan of 360/radar", [=](benchmark::State& s) { scans(s, scene, radar, vehicle, 1, "beam", 360.0); });
  measure("radar/scan of 360/radar, side rays", [=](benchmark::State& s) { scans(s, scene, side_rays, vehicle, 1, "beam", 360.0); });
  measure("radar/scan of 360/radar, range noise", [=](benchmark::State& s) { scans(s, scene, noisy, vehicle, 1, "beam", 360.0); });
  measure("radar/scan of 360/lidar", [=](benchmark::State& s) { scans(s, scene, lidar, vehicle, 1, "beam", 360.0); });
  ScanningRadarSpec fine = radar;
  fine.step_deg = 0.1;
  // Wall time: that is what the second thread is for.
  for (const std::size_t threads : {1, 2})
    measure("radar/scan of 3600, wall time/" + std::to_string(threads) + (threads == 1 ? " thread" : " threads"),
            [=](benchmark::State& s) { scans(s, scene, fine, vehicle, threads, "beam", 3600.0); })
        ->UseRealTime();
  ReceiverSpec quiet;
  quiet.noise = 0.0;
  ReceiverSpec cfar;
  cfar.detector = "ca_cfar";
  cfar.detection = "all";
  ReceiverSpec iq = cfar;
  iq.signal = "iq";
  measure("receiver/3364 returns, 1536 bins/profile alone", [=](benchmark::State& s) { receiver(s, quiet); });
  measure("receiver/3364 returns, 1536 bins/with noise", [=](benchmark::State& s) { receiver(s, ReceiverSpec{}); });
  measure("receiver/3364 returns, 1536 bins/with noise and CFAR", [=](benchmark::State& s) { receiver(s, cfar); });
  measure("receiver/3364 returns, 1536 bins/with I and Q, noise and CFAR", [=](benchmark::State& s) { receiver(s, iq); });
}

}  // namespace thicket::bench
