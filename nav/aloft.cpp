#include "thicket/nav/aloft.hpp"

#include <algorithm>
#include <cmath>

#include "fan.hpp"
#include "thicket/base/pose.hpp"

namespace thicket {
namespace {

constexpr double on_floor = 0.05;  // m: what is lower than this is the floor

/// The upward part of the highest unit vector in a beam's openings.
double highest(const Scan& scan, const Beam& beam, const glm::dquat& orientation) {
  double rise = -1.0;
  for_fan(scan, beam, radians(5.0), [&](const glm::dvec3& direction) { rise = std::max(rise, (orientation * direction).z); });
  if (scan.elevation_opening <= 0.0) return rise;
  return std::sin(std::min(0.5 * pi, std::asin(std::clamp(rise, -1.0, 1.0)) + 0.5 * scan.elevation_opening));
}

}  // namespace

void make_level(const Scan& scan, const Aloft& aloft, Scan& level) {
  level.sensor = scan.sensor;
  level.number = scan.number;
  level.time = scan.time;
  level.mount_position = aloft.tilt * scan.mount_position;
  level.mount_orientation = aloft.tilt * scan.mount_orientation;
  level.range_min = scan.range_min;
  level.range_max = scan.range_max;
  level.azimuth_opening = scan.azimuth_opening;
  level.elevation_opening = scan.elevation_opening;
  level.range_noise = scan.range_noise;
  level.beams.assign(scan.beams.begin(), scan.beams.end());
  level.echoes.assign(scan.echoes.begin(), scan.echoes.end());
  const double height = aloft.altitude + level.mount_position.z - std::max(on_floor, 3.0 * scan.range_noise);
  for (Beam& beam : level.beams)
    if (beam.echo_count > 0 && !beam.starts_inside && height + level.echoes[beam.first_echo].range * highest(level, beam, level.mount_orientation) <= 0.0) beam.echo_count = 0;
}

}  // namespace thicket
