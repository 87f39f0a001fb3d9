// How well a lobe's rays measure what is small: the received power of a regular grid against rays drawn in their cells. Prints the tables of docs/radar_sampling.md. Nothing here is a test, and
// nothing depends on the machine.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "bench_worlds.hpp"
#include "thicket/radar/sensor.hpp"

namespace thicket::bench {
namespace {

constexpr double opening_deg = 65.0;
constexpr int scans_of_a_place = 20;  // a second of the X4M05

struct Target {
  std::string name;
  World world;
  int samples_at_30;  ///< for 30 rays a side; finer grids vary less, and take fewer
  double exact;       ///< the integral of 4 cos^2 / r^4 over what the sensor sees of it
};

/// Over a facet grid; `at(u, v)` gives point, unit normal and area of the whole.
template <class At>
double integral(At&& at) {
  constexpr int steps = 2000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const auto [point, normal, area] = at((i + 0.5) / steps, (j + 0.5) / steps);
      const double r = glm::length(point), cosine = -glm::dot(point, normal) / r;
      if (cosine > 0.0) sum += 4.0 * cosine * cosine * area / std::pow(r, 4) / (static_cast<double>(steps) * steps);
    }
  }
  return sum;
}
struct Facet {
  glm::dvec3 point, normal;
  double area;
};

World diffuse(Shape shape, double range) {
  World world;
  world.materials.push_back({"perfect diffuse reflector", 1.0, infinity, 1.0, true, true});
  add(world, std::move(shape), {range, 0.0, 0.0});
  return world;
}
Target sphere(double radius, int samples) {
  constexpr double range = 9.5;
  return {fmt::format("sphere, radius {} m, at {} m", radius, range), diffuse(Sphere{radius}, range), samples, integral([=](double u, double v) {
            const double z = 2.0 * u - 1.0, bearing = 2.0 * pi * v, s = std::sqrt(1.0 - z * z);
            const glm::dvec3 normal(s * std::cos(bearing), s * std::sin(bearing), z);
            return Facet{glm::dvec3(range, 0.0, 0.0) + radius * normal, normal, 4.0 * pi * radius * radius};
          })};
}
Target wire(double thickness, double length, int samples) {
  constexpr double range = 10.0;
  const double radius = 0.5 * thickness;
  return {fmt::format("wire, {:g} mm thick, {:g} m long, at {:g} m", 1000.0 * thickness, length, range), diffuse(Cylinder{radius, length}, range), samples, integral([=](double u, double v) {
            const double bearing = 2.0 * pi * u;
            const glm::dvec3 normal(std::cos(bearing), std::sin(bearing), 0.0);
            return Facet{glm::dvec3(range, 0.0, length * (v - 0.5)) + radius * normal, normal, 2.0 * pi * radius * length};
          })};
}

LobeRadarSpec lobe(int rays, const char* sampling) {
  LobeRadarSpec spec;
  spec.position_m = {0.0, 0.0, 0.0};
  spec.azimuth_opening_deg = spec.elevation_opening_deg = opening_deg;
  spec.azimuth_rays = spec.elevation_rays = rays;
  spec.range_max_m = 12.0;
  spec.detection_floor_db = -300.0;
  spec.scattering = "lambert";
  spec.echoes = "receiver";
  spec.bin_size_m = 0.05;
  spec.noise = 0.0;
  spec.sampling = sampling;
  return spec;
}

/// What a sample gives in the mean, and by how much one is off, against the exact power.
struct Statistics {
  double bias = 0.0, error_of_bias = 0.0, deviation = 0.0;
};
/// `power(i, scan)`, each from its own arguments alone: any number of threads gives the same.
template <class Power>
Statistics statistics(int count, double exact, Power&& power) {
  std::vector<double> values(static_cast<std::size_t>(count));
  constexpr int together = 64;
  tbb::parallel_for(0, (count + together - 1) / together, [&](int part) {
    Scan scan;
    for (int i = part * together; i < std::min(count, (part + 1) * together); ++i) values[static_cast<std::size_t>(i)] = power(i, scan) / exact;
  });
  double sum = 0.0, squares = 0.0;
  for (const double value : values) {
    sum += value;
    squares += value * value;
  }
  const double mean = sum / count, deviation = std::sqrt(std::max(0.0, squares / count - mean * mean));
  return {mean - 1.0, deviation / std::sqrt(count), deviation};
}

/// Straight ahead to within a cell of the grid both ways: over whole cells a regular grid is right in the mean, over a part of them it is not.
Pose aim(std::uint64_t number, int rays) {
  Dice dice(number + 1);
  const double cell = radians(opening_deg) / rays, yaw = dice.between(-cell, cell), pitch = dice.between(-cell, cell);
  Pose pose = Pose::planar(0.0, 0.0, 0.0, yaw);
  pose.orientation = pose.orientation * glm::angleAxis(pitch, glm::dvec3(0.0, 1.0, 0.0));
  return pose;
}

double received(const Sensor& sensor, const Scene& scene, const Pose& pose, std::uint64_t number, Scan& scan) {
  sensor.measure(scene, pose, 0.0, number, Random(1, 0), scan);
  double sum = 0.0;
  for (const float amplitude : scan.profiles.amplitude_of(0)) sum += static_cast<double>(amplitude) * static_cast<double>(amplitude);
  return sum;
}

std::string percent(double fraction) { return std::abs(fraction) < 0.001 ? fmt::format("{:.2f} %", 100.0 * fraction) : fmt::format("{:.{}f} %", 100.0 * fraction, fraction < 0.0995 ? 1 : 0); }
std::string with_error(const Statistics& s) { return fmt::format("{:+.2g} ± {:.2g} %", 100.0 * s.bias, 100.0 * s.error_of_bias); }

void study() {
  const std::vector<Target> targets = {sphere(0.1, 20000), sphere(0.5, 6000), wire(0.003, 2.0, 40000)};
  fmt::print("| target | rays | grid: deviation | grid: bias | jitter: deviation | jitter: bias | jitter: deviation of the mean of {} scans |\n"
             "|---|---|---:|---:|---:|---:|---:|\n",
             scans_of_a_place);
  for (const Target& target : targets) {
    const Scene scene = or_exit(Scene::build(target.world));
    for (const int rays : {30, 58, 200}) {
      const int samples = static_cast<int>(target.samples_at_30 * std::pow(30.0 / rays, 1.5));
      const auto grid = make_sensor(lobe(rays, "regular"), 0), jitter = make_sensor(lobe(rays, "jitter"), 0);
      const LobeRadarSpec spec = lobe(rays, "regular");
      const double exact = target.exact * std::pow(spec.range_max_m, 2) / (4.0 * radians(opening_deg) * 2.0 * std::sin(0.5 * radians(opening_deg)));
      const auto scan_of = [&](const Sensor& sensor) {
        return [&](int i, Scan& scan) { return received(sensor, scene, aim(static_cast<std::uint64_t>(i), rays), static_cast<std::uint64_t>(i), scan); };
      };
      const Statistics of_grid = statistics(samples, exact, scan_of(*grid)), of_jitter = statistics(samples, exact, scan_of(*jitter));
      // Standing still a grid gives the same again and again.
      const Statistics together = statistics(samples / scans_of_a_place, exact, [&](int i, Scan& scan) {
        double sum = 0.0;
        for (int s = 0; s < scans_of_a_place; ++s) sum += received(*jitter, scene, aim(static_cast<std::uint64_t>(i), rays), static_cast<std::uint64_t>(i * scans_of_a_place + s), scan);
        return sum / scans_of_a_place;
      });
      fmt::print("| {} | {} × {} | {} | {} | {} | {} | {} |\n", target.name, rays, rays, percent(of_grid.deviation), with_error(of_grid), percent(of_jitter.deviation), with_error(of_jitter),
                 percent(together.deviation));
      std::fflush(stdout);
    }
  }
}

}  // namespace
}  // namespace thicket::bench

int main() {
  thicket::bench::study();
  return 0;
}
