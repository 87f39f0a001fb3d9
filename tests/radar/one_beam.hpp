// Sensors that tests look through.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "../hand_made_world.hpp"
#include "thicket/radar/sensor.hpp"

namespace thicket {

/// A radar with one beam along its x axis, at the vehicle's origin, that sees and passes whatever a test does not forbid, with everything else left out.
inline ScanningRadarSpec one_beam_radar() {
  ScanningRadarSpec spec;
  spec.position_m = {0.0, 0.0, 0.0};
  spec.fov_deg = 1.0;
  spec.step_deg = 180.0;
  spec.range_max_m = 100.0;
  spec.penetration_budget_db = infinity;
  spec.detection_floor_db = -300.0;
  spec.slab_max_m = 0.0;
  spec.scattering = "lambert";
  spec.fresnel = false;
  return spec;
}

inline Scan measured(const SensorSpec& spec, const Scene& scene, const Pose& vehicle = {}, std::uint64_t number = 0,
                     std::uint64_t seed = 1) {
  Scan scan;
  make_sensor(spec, 0)->measure(scene, vehicle, 0.0, number, Random(seed, 0), scan);
  return scan;
}

/// The beam of a sensor that has one.
struct OneBeam {
  Beam beam;
  std::vector<Echo> echoes;

  double power(std::size_t echo) const {
    return static_cast<double>(echoes.at(echo).amplitude) * static_cast<double>(echoes.at(echo).amplitude);
  }
  double power_sum() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < echoes.size(); ++i) sum += power(i);
    return sum;
  }
};
inline OneBeam looked(const SensorSpec& spec, const Scene& scene, const Pose& vehicle = {}) {
  const Scan scan = measured(spec, scene, vehicle);
  REQUIRE(scan.beams.size() == 1);
  const auto echoes = scan.echoes_of(scan.beams[0]);
  return {scan.beams[0], {echoes.begin(), echoes.end()}};
}

/// Amplitudes are single precision: half a unit in their last place, twice for the square.
constexpr double single_precision = 0x1p-22;
inline doctest::Approx as_power(double power) {
  return doctest::Approx(power).epsilon(single_precision).scale(0.0);
}

}  // namespace thicket
