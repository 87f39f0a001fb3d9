// The laser scanner.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "antenna.hpp"
#include "light_path.hpp"
#include "mount.hpp"
#include "sensors.hpp"
#include "table.hpp"

namespace thicket {
namespace {

/// Shorter scans stay on one core: starting the others costs more than it saves (measured, tests/bench).
constexpr std::size_t beams_per_task = 512;

class Lidar final : public Sensor {
 public:
  Lidar(const LidarSpec& spec, std::uint16_t index) : Sensor(spec), lidar_(spec), index_(index), mount_(mount_of(spec)), azimuths_(azimuths_of(spec)) {
    for (const double azimuth : azimuths_) directions_.emplace_back(std::cos(azimuth), std::sin(azimuth), 0.0);
  }

  bool detects(const Material& material) const override { return material.stops_light; }

  std::vector<PhysicsPart> model_of(const Scene& scene, const Platform&) const override {
    if (light_losses(scene.world()).empty()) return {{"media", false, "nothing lets light in: of each ray the first surface is all"}};
    return {{"media", true, "light gets into some of the matter"}};
  }

  void measure(const Scene& scene, const Platform& platform, double time, std::uint64_t number, const Random& random, Scan& scan) const override {
    head(spec(), mount_, index_, time, number, scan);
    scan.rays = azimuths_.size();
    scan.beams.assign(azimuths_.size(), Beam{});
    const Pose sensor = platform.pose * mount_;
    const std::vector<double> losses = light_losses(scene.world());
    // A beam has one echo at most: each task writes to its own place, and what is empty is left out afterwards.
    std::vector<Echo> echoes(azimuths_.size());
    const std::size_t tasks = (azimuths_.size() + beams_per_task - 1) / beams_per_task;
    const auto task = [&](std::size_t t) {
      const std::size_t first = t * beams_per_task, end = std::min(azimuths_.size(), first + beams_per_task);
      measure_beams(scene, losses, sensor, scan.beams, first, end, echoes);
    };
    if (tasks <= 1) task(0);
    else tbb::parallel_for(std::size_t{0}, tasks, task);
    BeamNoise noise(random, number);
    for (std::size_t b = 0; b < scan.beams.size(); ++b) {
      Beam& beam = scan.beams[b];
      beam.first_echo = static_cast<std::uint32_t>(scan.echoes.size());
      if (beam.echo_count > 0) scan.echoes.push_back(echoes[b]);
      const auto& table = lidar_.range_noise_table_m;
      const double deviation = table.empty() ? spec().range_noise_m : value_at(table, beam.sensed_range);
      if (deviation <= 0.0 || beam.echo_count == 0) continue;
      shift_beam(beam, std::span(scan.echoes).subspan(beam.first_echo, beam.echo_count), deviation * noise.of(b), spec().range_max_m);
    }
  }

 private:
  /// Only where there are media that light enters. To light, what a metre takes is the extinction: a surface is opaque, and the budget an optical depth.
  static std::vector<double> light_losses(const World& world) {
    if (std::ranges::none_of(world.materials, &Material::light_medium)) return {};
    std::vector<double> losses;
    for (const Material& material : world.materials) losses.push_back(material.stops_light ? material.light_extinction_per_m : 0.0);
    return losses;
  }

  void measure_beams(const Scene& scene, std::span<const double> losses, const Pose& sensor, std::vector<Beam>& beams, std::size_t first, std::size_t end, std::vector<Echo>& echoes) const {
    std::vector<Ray> rays;
    rays.reserve(end - first);
    for (std::size_t b = first; b < end; ++b) {
      beams[b].azimuth = azimuths_[b];
      beams[b].direction = directions_[b];
      rays.push_back({sensor.position, sensor.orientation * directions_[b], spec().range_max_m});
    }
    if (losses.empty()) {
      std::vector<Hit> hits(rays.size());
      scene.closest_hits(rays, Stops::light, hits);
      for (std::size_t i = 0; i < rays.size(); ++i) end_beam(hits[i].solid != no_solid, {hits[i].range, hits[i].normal, 1.0}, rays[i], beams[first + i], echoes[first + i]);
      return;
    }
    CrossingLists lists;
    scene.crossings(rays, losses, lidar_.optical_depth_max, lists);
    LightPath path;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const LightEnd at = path.end(scene.world(), losses, lists[i], rays[i].direction, lidar_.optical_depth_max);
      end_beam(at.range <= rays[i].range_max, at, rays[i], beams[first + i], echoes[first + i]);
    }
  }

  void end_beam(bool ended, const LightEnd& end, const Ray& ray, Beam& beam, Echo& echo) const {
    beam.sensed_range = std::min(end.range, spec().range_max_m);
    if (!ended) return;
    beam.end = BeamEnd::stopped;
    if (end.range < spec().range_min_m) return;
    const double cosine = std::min(1.0, std::abs(glm::dot(end.normal, ray.direction)));
    echo = {end.range, static_cast<float>(std::sqrt(cosine) * end.through), static_cast<float>(cosine)};
    beam.echo_count = 1;
  }

  LidarSpec lidar_;
  std::uint16_t index_;
  Pose mount_;
  std::vector<double> azimuths_;
  std::vector<glm::dvec3> directions_;
};

}  // namespace

std::shared_ptr<const Sensor> make_lidar(const LidarSpec& spec, std::uint16_t index) { return std::make_shared<Lidar>(spec, index); }

}  // namespace thicket
