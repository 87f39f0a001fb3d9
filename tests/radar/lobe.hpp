// Lobes that tests look through, and what comes back in all.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "one_beam.hpp"

namespace thicket {

/// A lobe at the vehicle's origin without noise, whose profile holds the power of each return in the two bins next to it.
inline LobeRadarSpec bare_lobe(double opening_deg = 65.0, int rays = 58, double range_max = 10.0) {
  LobeRadarSpec spec;
  spec.position_m = {0.0, 0.0, 0.0};
  spec.azimuth_opening_deg = spec.elevation_opening_deg = opening_deg;
  spec.azimuth_rays = spec.elevation_rays = rays;
  spec.range_max_m = range_max;
  spec.penetration_budget_db = infinity;
  spec.detection_floor_db = -200.0;
  spec.slab_max_m = 0.0;
  spec.echoes = "receiver";
  spec.bin_size_m = 0.05;
  spec.noise = 0.0;
  spec.threshold = 1e-9;
  return spec;
}

/// Sum of the powers in a scan's profile.
inline double received_power(const Scan& scan) {
  double sum = 0.0;
  for (const float amplitude : scan.profiles.amplitude_of(0)) sum += static_cast<double>(amplitude) * static_cast<double>(amplitude);
  return sum;
}
inline double received_power(const SensorSpec& spec, const Scene& scene, const Pose& pose = {}, std::uint64_t number = 0) { return received_power(measured(spec, scene, pose, number)); }

/// Mean and its standard error over scans.
struct Estimate {
  double mean = 0.0, error = 0.0;
};
template <class Sample>
Estimate estimate(int count, Sample&& sample) {
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < count; ++i) {
    const double value = sample(static_cast<std::uint64_t>(i));
    sum += value;
    squares += value * value;
  }
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean) / (count - 1))};
}
/// Of the received power, with rays at other places in each scan.
inline Estimate mean_power(LobeRadarSpec spec, const Scene& scene, int scans, const Pose& pose = {}) {
  spec.sampling = "jitter";
  const auto sensor = make_sensor(spec, 0);
  Scan scan;
  return estimate(scans, [&](std::uint64_t number) {
    sensor->measure(scene, pose, 0.0, number, Random(1, 0), scan);
    return received_power(scan);
  });
}

/// sr: of a rectangular opening.
inline double solid_angle(double azimuth_deg, double elevation_deg) { return radians(azimuth_deg) * 2.0 * std::sin(0.5 * radians(elevation_deg)); }

/// What a target of a radar cross-section (m^2) at a range returns to a flat lobe, against a perfect diffuse reflector that fills it squarely at range_max:
/// both follow P_t G^2 lambda^2 / (4 pi)^3, the target with sigma / R^4, the reflector with 4 Omega / R_max^2.
inline double power_of(double cross_section, double range, const LobeRadarSpec& spec) {
  return cross_section * std::pow(spec.range_max_m, 2) / (4.0 * solid_angle(spec.azimuth_opening_deg, spec.elevation_opening_deg) * std::pow(range, 4));
}

inline std::uint32_t rough_metal(HandMadeWorld& w) { return w.material("rough metal", 1.0, infinity); }
inline std::uint32_t mirror(HandMadeWorld& w, double roughness = 0.0) {
  const auto index = w.material("mirror", 1.0, infinity);
  w.world.materials[index].roughness = roughness;
  return index;
}

}  // namespace thicket
