// From rays to their echoes: through matter, off mirrors, back to the sensor. Private to the room.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "antenna.hpp"
#include "medium_walk.hpp"
#include "thicket/base/pose.hpp"
#include "thicket/base/random.hpp"
#include "thicket/radar/sensor.hpp"
#include "thicket/scan/scan.hpp"
#include "thicket/worlds/scene.hpp"
#include "wave.hpp"

namespace thicket {

/// The 1/R^2 of what is nearer is that of this, m.
inline constexpr double nearest_range = 0.01;

/// What a ray that leaves the sensor stands for.
struct RayTraits {
  float spread = 0.0f;       ///< rad, the angle that it stands for
  float gain = 1.0f;         ///< one-way, of the antenna along it (for echoes that come back along another direction)
  float share = 1.0f;        ///< of what a target that fills the beam returns
  std::uint32_t beam = 0;
  std::uint32_t number = 0;  ///< of the ray in its scan, for random numbers
  std::int8_t side = 0;      ///< of a side ray
};

/// What became of one.
struct RayEnd {
  std::uint32_t first_echo = 0, echo_count = 0;  ///< in `Traced::echoes`, by increasing range
  double sensed_range = 0.0;                     ///< m
  BeamEnd end = BeamEnd::open;
  bool starts_inside = false;
};

struct Traced {
  std::vector<Echo> echoes;  ///< amplitudes as if the ray filled a beam
  std::vector<RayEnd> rays;
  std::uint64_t count = 0;   ///< rays traced, bounces and looks back to the sensor included
};

/// What all rays of a scan share.
struct TraceContext {
  TraceContext(const Scene& scene, const RadarSpec& radar, double range_min, double range_max, const Antenna& antenna, const Pose& sensor, const glm::dvec3& velocity, const Random& random,
               std::uint64_t scan);

  const Scene& scene;
  const RadarSpec& radar;
  double range_min, range_max, floor_power;
  const Antenna& antenna;
  Pose sensor;
  glm::dvec3 velocity;  ///< of the sensor, m/s
  const Random& random;
  std::uint64_t scan;
  std::vector<WaveMaterial> materials;
  std::vector<double> losses;  ///< of the materials, dB/m
  double list_budget_db = 0.0; ///< as far as solids are listed along a ray
  bool first_surface_only;     ///< nothing in the world lets a wave through
  bool multipath;              ///< waves go on from what mirrors them, and something does
  bool printed;
};

/// What tracing by this context models of what the world could show: penetration, interfaces, leaves, multipath.
std::vector<PhysicsPart> parts_of_world(const TraceContext& context);

/// Traces rays. The echoes of a ray depend on the ray and the context alone.
///
/// A wave that meets a surface comes straight back (by `backscatter`), the way it came; what is mirrored goes on, for `bounces_max` surfaces in all. From the second surface on what is sent towards the sensor
/// directly (by `bistatic`) arrives too, with half of its whole way as range; of the diffuse part the same way in the other direction brings as much again. Without compensation powers go with
/// (range_max / way back)^2: how the wave thins out on its way out is in the rays themselves.
void trace_rays(const TraceContext& context, std::span<const Ray> rays, std::span<const RayTraits> traits, Traced& traced);

}  // namespace thicket
