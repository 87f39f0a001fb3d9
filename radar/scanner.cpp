// The two sensors that scan a plane: penetrating radar and lidar.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "antenna.hpp"
#include "echo_chain.hpp"
#include "light_path.hpp"
#include "table.hpp"
#include "thicket/radar/sensor.hpp"

namespace thicket {
namespace {

/// Shorter scans stay on one core: starting the others costs more than it saves (measured, tests/bench).
constexpr std::size_t beams_per_task = 512;

Pose mount_of(const ScannerSpec& spec) { return Pose::planar(spec.position_m.x, spec.position_m.y, spec.position_m.z, radians(spec.yaw_deg)); }

/// What both sensors share: beams in a plane, one ray each, one draw of range noise each.
class Scanner : public Sensor {
 public:
  Scanner(const ScannerSpec& spec, std::uint16_t index) : Sensor(spec), scanner_(spec), index_(index), mount_(mount_of(spec)), azimuths_(azimuths_of(spec)) {
    for (const double azimuth : azimuths_) directions_.emplace_back(std::cos(azimuth), std::sin(azimuth), 0.0);
  }

  void measure(const Scene& scene, const Platform& platform, double time, std::uint64_t number, const Random& random, Scan& scan) const final {
    scan.sensor = index_;
    scan.number = number;
    scan.time = time;
    scan.mount_position = mount_.position;
    scan.mount_orientation = mount_.orientation;
    scan.range_min = spec().range_min_m;
    scan.range_max = spec().range_max_m;
    scan.rays = azimuths_.size();
    scan.beams.resize(azimuths_.size());
    scan.echoes.clear();

    const Pose sensor = platform.pose * mount_;
    const std::vector<Material> as_seen = materials_as_seen(scene.world());
    const std::size_t tasks = (azimuths_.size() + beams_per_task - 1) / beams_per_task;
    if (tasks <= 1) {
      measure_beams(scene, as_seen, sensor, random, scan, 0, azimuths_.size(), scan.echoes);
    } else {
      std::vector<std::vector<Echo>> echoes(tasks);
      tbb::parallel_for(std::size_t{0}, tasks, [&](std::size_t task) {
        const std::size_t first = task * beams_per_task;
        measure_beams(scene, as_seen, sensor, random, scan, first, std::min(azimuths_.size(), first + beams_per_task), echoes[task]);
      });
      for (std::size_t task = 0; task < tasks; ++task) {
        const auto offset = static_cast<std::uint32_t>(scan.echoes.size());
        const std::size_t first = task * beams_per_task;
        for (std::size_t b = first; b < std::min(azimuths_.size(), first + beams_per_task); ++b) scan.beams[b].first_echo += offset;
        scan.echoes.insert(scan.echoes.end(), echoes[task].begin(), echoes[task].end());
      }
    }
  }

 protected:
  /// The ray that stands for a beam. Sets `beam.side` where it is not the middle one.
  virtual Ray ray(const Pose& sensor, const glm::dvec3& direction, std::size_t, std::uint64_t, const Random&, Beam&) const {
    return {sensor.position, sensor.orientation * direction, spec().range_max_m};
  }
  /// The world's materials as the sensor's wave meets them; nothing where they stand in the world as they are wanted.
  virtual std::vector<Material> materials_as_seen(const World& world) const = 0;
  virtual void trace(const Scene& scene, std::span<const Material> as_seen, std::span<const Ray> rays, std::span<Beam> beams, std::vector<Echo>& echoes) const = 0;

  /// Standard deviation, m, of the range of a beam that ends at `range`.
  virtual double range_noise(double) const { return spec().range_noise_m; }

 private:
  void measure_beams(const Scene& scene, std::span<const Material> as_seen, const Pose& sensor, const Random& random, Scan& scan, std::size_t first, std::size_t end,
                     std::vector<Echo>& echoes) const {
    std::vector<Ray> rays;
    rays.reserve(end - first);
    for (std::size_t b = first; b < end; ++b) {
      Beam& beam = scan.beams[b];
      beam = Beam{};
      beam.azimuth = azimuths_[b];
      beam.direction = directions_[b];
      rays.push_back(ray(sensor, directions_[b], b, scan.number, random, beam));
    }
    const std::span<Beam> beams(scan.beams.data() + first, end - first);
    trace(scene, as_seen, rays, beams, echoes);
    for (std::size_t b = first; b < end; ++b) {
      const double deviation = range_noise(scan.beams[b].sensed_range);
      if (deviation <= 0.0) continue;
      // One draw a beam, the jitter of its trigger: echoes of one beam keep their order and their distances.
      const double shift = deviation * random.normal(scan.number, static_cast<std::uint32_t>(b), RandomUse::range_noise, 0)[0];
      const Beam& beam = scan.beams[b];
      for (std::uint32_t e = 0; e < beam.echo_count; ++e) {
        double& range = echoes[beam.first_echo + e].range;
        range = std::clamp(range + shift, 0.0, spec().range_max_m);
      }
      if (beam.end != BeamEnd::open) scan.beams[b].sensed_range = std::clamp(beam.sensed_range + shift, 0.0, spec().range_max_m);
    }
  }

  ScannerSpec scanner_;
  std::uint16_t index_;
  Pose mount_;
  std::vector<double> azimuths_;
  std::vector<glm::dvec3> directions_;
};

class ScanningRadar final : public Scanner {
 public:
  ScanningRadar(const ScanningRadarSpec& spec, std::uint16_t index)
      : Scanner(spec, index), radar_(spec), limits_{spec.range_min_m, spec.range_max_m, spec.penetration_budget_db, std::pow(10.0, 0.1 * spec.detection_floor_db)} {}

  bool detects(const Material& material) const override { return visible(at_frequency(material, radar_.frequency_ghz), limits_.floor_power); }

 private:
  Ray ray(const Pose& sensor, const glm::dvec3& direction, std::size_t beam_index, std::uint64_t number, const Random& random, Beam& beam) const override {
    Ray middle = Scanner::ray(sensor, direction, beam_index, number, random, beam);
    if (radar_.divergence == "none") return middle;
    // Choose first, trace one (2012: each of the three rays has an equal chance to give the range).
    const double chance = random.uniform(number, static_cast<std::uint32_t>(beam_index), RandomUse::ray_choice, 0)[0];
    beam.side = chance < 1.0 / 3.0 ? 0 : chance < 2.0 / 3.0 ? 1 : -1;
    const glm::dvec3 left = sensor.orientation * glm::dvec3(-direction.y, direction.x, 0.0);
    const glm::dvec3 offset = static_cast<double>(beam.side) * radar_.side_offset_m * left;
    if (radar_.side_geometry == "parallel") {
      middle.origin += offset;
    } else {
      middle.direction = glm::normalize(middle.direction * radar_.range_max_m + offset);
    }
    return middle;
  }

  std::vector<Material> materials_as_seen(const World& world) const override {
    if (std::ranges::none_of(world.materials, &Material::depends_on_frequency)) return {};
    return at_frequency(world.materials, radar_.frequency_ghz);
  }

  void trace(const Scene& scene, std::span<const Material> as_seen, std::span<const Ray> rays, std::span<Beam> beams, std::vector<Echo>& echoes) const override {
    const std::span<const Material> materials = as_seen.empty() ? scene.world().materials : as_seen;
    CrossingLists lists;
    std::vector<double> losses;
    for (const Material& m : materials) losses.push_back(m.attenuation_db_per_m);
    scene.crossings(rays, losses, limits_.budget_db, lists);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      trace_echoes(scene.world(), materials, lists[i], rays[i].direction, limits_, beams[i], echoes);
      Beam& beam = beams[i];
      if (radar_.first_echo_only && beam.echo_count > 0) {
        echoes.resize(beam.first_echo + 1);
        beam.echo_count = 1;
        beam.end = BeamEnd::stopped;
        beam.sensed_range = echoes.back().range;
      }
    }
  }

  ScanningRadarSpec radar_;
  EchoLimits limits_;
};

class Lidar final : public Scanner {
 public:
  Lidar(const LidarSpec& spec, std::uint16_t index) : Scanner(spec, index), depth_max_(spec.optical_depth_max), noise_(spec.range_noise_table_m) {}

  bool detects(const Material& material) const override { return material.stops_light; }

 private:
  /// Only where there are media that light enters. To light, what a metre takes is the extinction: a surface is opaque, and the budget an optical depth.
  std::vector<Material> materials_as_seen(const World& world) const override {
    if (std::ranges::none_of(world.materials, &Material::light_medium)) return {};
    std::vector<Material> list(world.materials.size());
    for (std::size_t m = 0; m < list.size(); ++m) list[m].attenuation_db_per_m = world.materials[m].stops_light ? world.materials[m].light_extinction_per_m : 0.0;
    return list;
  }

  void trace(const Scene& scene, std::span<const Material> as_seen, std::span<const Ray> rays, std::span<Beam> beams, std::vector<Echo>& echoes) const override {
    if (!as_seen.empty()) return trace_through_media(scene, as_seen, rays, beams, echoes);
    std::vector<Hit> hits(rays.size());
    scene.closest_hits(rays, Stops::light, hits);
    for (std::size_t i = 0; i < rays.size(); ++i)
      add_echo(hits[i].solid != no_solid, {hits[i].range, hits[i].normal, 1.0}, rays[i], beams[i], echoes);
  }

  void trace_through_media(const Scene& scene, std::span<const Material> as_seen, std::span<const Ray> rays, std::span<Beam> beams, std::vector<Echo>& echoes) const {
    CrossingLists lists;
    std::vector<double> losses;
    for (const Material& m : as_seen) losses.push_back(m.attenuation_db_per_m);
    scene.crossings(rays, losses, depth_max_, lists);
    LightPath path;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const LightEnd end = path.end(scene.world(), as_seen, lists[i], rays[i].direction, depth_max_);
      add_echo(end.range <= rays[i].range_max, end, rays[i], beams[i], echoes);
    }
  }

  void add_echo(bool ended, const LightEnd& end, const Ray& ray, Beam& beam, std::vector<Echo>& echoes) const {
    beam.first_echo = static_cast<std::uint32_t>(echoes.size());
    beam.sensed_range = std::min(end.range, spec().range_max_m);
    if (!ended) return;
    beam.end = BeamEnd::stopped;
    if (end.range < spec().range_min_m) return;
    const double cosine = std::min(1.0, std::abs(glm::dot(end.normal, ray.direction)));
    echoes.push_back({end.range, static_cast<float>(std::sqrt(cosine) * end.through), static_cast<float>(cosine)});
    beam.echo_count = 1;
  }

  double range_noise(double range) const override { return noise_.empty() ? Scanner::range_noise(range) : value_at(noise_, range); }

  double depth_max_;
  std::vector<glm::dvec2> noise_;
};

}  // namespace

std::shared_ptr<const Sensor> make_sensor(const SensorSpec& spec, std::uint16_t index) {
  if (const auto* lidar = std::get_if<LidarSpec>(&spec)) return std::make_shared<Lidar>(*lidar, index);
  return std::make_shared<ScanningRadar>(std::get<ScanningRadarSpec>(spec), index);
}

}  // namespace thicket
