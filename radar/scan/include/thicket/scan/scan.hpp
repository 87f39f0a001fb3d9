// What a sensor tells the rest of the program: plain data, no physics.
#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace thicket {

/// Which side of matter an echo comes from. A receiver tells them by the extended return that matter gives between its edges.
enum class Edge : std::uint8_t {
  front,  ///< from the open into matter
  inner,  ///< from one matter into another
  back,   ///< out of matter into the open
  thin,   ///< matter too thin to have an inside: both its faces are one echo (a leaf, a sheet)
};

/// One return of a beam.
struct Echo {
  double range = 0.0;              ///< m, >= 0: half the way of the wave, which without bounces is the distance along the beam
  float amplitude = 0.0f;          ///< field quantity, its square is a power; docs/radar.md says what 1 is
  float incidence_cosine = 1.0f;   ///< of the angle between beam and surface normal, 0 (grazing) ... 1
  float radial_velocity = 0.0f;    ///< m/s, rate of change of `range`, > 0 receding; 0 where the sensor does not measure it
  Edge edge = Edge::front;
  std::uint8_t bounces = 1;        ///< surfaces that the wave met on its way out, 1: seen directly
};

/// Why a beam senses no farther.
enum class BeamEnd : std::uint8_t {
  open,       ///< it went to the end of the sensor's range
  stopped,    ///< at the surface of opaque matter
  exhausted,  ///< inside matter, its penetration budget used up
};

/// What one direction of the antenna measured.
struct Beam {
  double azimuth = 0.0;    ///< rad in the sensor's frame, counter-clockwise from its x axis
  double elevation = 0.0;  ///< rad, upward
  glm::dvec3 direction{1.0, 0.0, 0.0};  ///< the same as a unit vector of the sensor's frame
  double sensed_range = 0.0;      ///< m; as far as the beam sensed anything (for an exhausted beam a point inside matter)
  std::uint32_t first_echo = 0;   ///< index into Scan::echoes
  std::uint32_t echo_count = 0;   ///< echoes by increasing range
  BeamEnd end = BeamEnd::open;
  bool starts_inside = false;     ///< the sensor itself is inside matter that it can see
  std::int8_t side = 0;           ///< beam divergence: +1 the left side ray was used, -1 the right one, 0 the middle one
};

/// Amplitude over range as a receiver sees it, one profile per beam, one after another.
struct Profiles {
  std::uint32_t bins = 0;    ///< per profile; 0: there are none
  double first_range = 0.0;  ///< m, of the middle of bin 0; may be negative
  double bin_size = 0.0;     ///< m
  std::vector<float> amplitude;          ///< with noise, smoothing and saturation
  std::vector<float> threshold;          ///< what a top must reach to be detected, bin by bin
  std::vector<std::complex<float>> iq;   ///< of an I/Q receiver; else empty

  double range(std::uint32_t bin) const { return first_range + bin * bin_size; }
  std::span<const float> amplitude_of(std::size_t beam) const { return std::span(amplitude).subspan(beam * bins, bins); }
  std::span<const float> threshold_of(std::size_t beam) const { return std::span(threshold).subspan(beam * bins, bins); }
};

/// What one sensor measured at one time.
struct Scan {
  std::uint16_t sensor = 0;   ///< which sensor of the vehicle
  std::uint64_t number = 0;   ///< counts this sensor's scans from 0
  double time = 0.0;          ///< s
  glm::dvec3 mount_position{0.0};                      ///< the sensor's frame in the vehicle's: x forward, y left, z up
  glm::dquat mount_orientation{1.0, 0.0, 0.0, 0.0};
  double range_min = 0.0, range_max = 0.0;  ///< m
  double azimuth_opening = 0.0, elevation_opening = 0.0;  ///< rad, full: an echo of a beam lies anywhere in this about its direction; 0: along its direction
  double range_noise = 0.0;                 ///< m, standard deviation of the ranges as the sensor's maker states it; 0: not stated
  std::uint64_t rays = 0;                   ///< rays traced for it
  std::vector<Beam> beams;
  std::vector<Echo> echoes;
  Profiles profiles;          ///< where the sensor has a receiver

  std::span<const Echo> echoes_of(const Beam& beam) const { return std::span(echoes).subspan(beam.first_echo, beam.echo_count); }
};

}  // namespace thicket
