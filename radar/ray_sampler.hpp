// The rays of a scan, as the antenna sends them. Private to the room.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "antenna.hpp"
#include "ray_tracer.hpp"
#include "thicket/base/pose.hpp"
#include "thicket/base/random.hpp"

namespace thicket {

/// Which rays of each scan are traced, where they point and what they stand for. Rays come beam by beam.
class RaySampler {
 public:
  /// `jitter`: somewhere in their cells, elsewhere in each scan. `drawn_from`: one of so many neighbouring rays of a beam is drawn, 1: all are traced.
  RaySampler(Antenna antenna, bool jitter, std::size_t drawn_from);

  const Antenna& antenna() const { return antenna_; }
  std::size_t rays_per_beam() const { return cells_.size() / drawn_from_; }
  std::size_t count() const { return rays_per_beam() * antenna_.beam_azimuths().size(); }
  /// How many rays of a beam a traced one stands for.
  std::size_t drawn_from() const { return drawn_from_; }
  /// Every scan has the same rays, and `traits()` are theirs.
  bool always_the_same() const { return !jitter_ && drawn_from_ == 1; }
  std::span<const RayTraits> traits() const { return traits_; }
  /// Of `count()` rays in the sensor's frame, unit vectors, as long as they are always the same.
  std::span<const glm::dvec3> directions() const { return directions_; }

  /// Rays [first, first + rays.size()) of a scan, from a sensor's pose; sets the traits too where they are not always the same.
  void sample(std::size_t first, const Pose& sensor, double range_max, const Random& random, std::uint64_t scan, std::span<Ray> rays, std::span<RayTraits> traits) const;

 private:
  /// Cosine and sine of a ray's azimuth (with its beam's) and elevation.
  struct Angles {
    double cos_azimuth, sin_azimuth, cos_elevation, sin_elevation;
  };
  static Angles angles_of(double azimuth, double elevation);
  static glm::dvec3 direction_of(const Angles& a) { return {a.cos_elevation * a.cos_azimuth, a.cos_elevation * a.sin_azimuth, a.sin_elevation}; }

  Antenna antenna_;
  bool jitter_;
  std::size_t drawn_from_;
  std::vector<SubRay> cells_;           // of a beam
  // Of all cells of all beams:
  std::vector<RayTraits> traits_;
  std::vector<Angles> angles_;
  std::vector<glm::dvec3> directions_;
};

}  // namespace thicket
