// Where a sensor sits on its vehicle. Private to the room.
#pragma once

#include <array>

#include "thicket/base/pose.hpp"
#include "thicket/base/random.hpp"
#include "thicket/radar/sensor.hpp"

namespace thicket {

inline Pose mount_of(const MountedSpec& spec) {
  Pose mount = Pose::planar(spec.position_m.x, spec.position_m.y, spec.position_m.z, radians(spec.yaw_deg));
  if (spec.pitch_deg != 0.0) mount.orientation = mount.orientation * glm::angleAxis(radians(spec.pitch_deg), glm::dvec3(0.0, 1.0, 0.0));
  if (spec.roll_deg != 0.0) mount.orientation = mount.orientation * glm::angleAxis(radians(spec.roll_deg), glm::dvec3(1.0, 0.0, 0.0));
  return mount;
}

/// What a scan says of itself; its echoes are empty afterwards, its beams those of before.
inline void head(const MountedSpec& spec, const Pose& mount, std::uint16_t sensor, double time, std::uint64_t number, Scan& scan) {
  scan.sensor = sensor;
  scan.number = number;
  scan.time = time;
  scan.mount_position = mount.position;
  scan.mount_orientation = mount.orientation;
  scan.range_min = spec.range_min_m;
  scan.range_max = spec.range_max_m;
  scan.azimuth_opening = scan.elevation_opening = 0.0;
  scan.rays = 0;
  scan.range_noise = spec.range_noise_m;
  scan.echoes.clear();
  scan.profiles.bins = 0;
}

/// A standard normal number for each beam of a scan. Four neighbours share a draw: ask in the order of the beams.
class BeamNoise {
 public:
  BeamNoise(const Random& random, std::uint64_t scan) : random_(random), scan_(scan) {}
  double of(std::size_t beam) {
    if (const std::size_t four = beam / 4; four != drawn_) {
      drawn_ = four;
      numbers_ = random_.normal(scan_, static_cast<std::uint32_t>(four), RandomUse::range_noise, 0);
    }
    return numbers_[beam % 4];
  }

 private:
  const Random& random_;
  std::uint64_t scan_;
  std::size_t drawn_ = static_cast<std::size_t>(-1);
  std::array<double, 4> numbers_{};
};

/// One draw of range noise for a beam, the jitter of its trigger: its echoes keep their order and their distances.
inline void shift_beam(Beam& beam, std::span<Echo> echoes, double shift, double range_max) {
  for (Echo& echo : echoes) echo.range = std::clamp(echo.range + shift, 0.0, range_max);
  if (beam.end != BeamEnd::open) beam.sensed_range = std::clamp(beam.sensed_range + shift, 0.0, range_max);
}

}  // namespace thicket
