#include "ray_sampler.hpp"

#include <algorithm>
#include <cmath>

#include <glm/gtc/quaternion.hpp>

namespace thicket {
namespace {

/// How wide, in cells, the specular lobe of a mirror is taken at least (`RayTraits::spread`): narrow enough to fade with the tilt, wide enough that a regular grid of rays sums it to 0.1 dB, in a corner too.
constexpr double lobe_in_cells = 1.0;

/// Turns (cosine, sine) on by a small angle. Up to 0.1 rad the series is exact to rounding.
void turn_on(double& cosine, double& sine, double by) {
  if (by == 0.0) return;
  double c, s;
  if (std::abs(by) <= 0.1) {
    const double x = by * by;
    s = by * (1.0 + x * (-1.0 / 6 + x * (1.0 / 120 + x * (-1.0 / 5040 + x * (1.0 / 362880)))));
    c = 1.0 + x * (-0.5 + x * (1.0 / 24 + x * (-1.0 / 720 + x * (1.0 / 40320 + x * (-1.0 / 3628800)))));
  } else {
    c = std::cos(by);
    s = std::sin(by);
  }
  const double turned = c * cosine - s * sine;
  sine = s * cosine + c * sine;
  cosine = turned;
}

}  // namespace

RaySampler::Angles RaySampler::angles_of(double azimuth, double elevation) { return {std::cos(azimuth), std::sin(azimuth), std::cos(elevation), std::sin(elevation)}; }

RaySampler::RaySampler(Antenna antenna, bool jitter, std::size_t drawn_from) : antenna_(std::move(antenna)), jitter_(jitter), drawn_from_(drawn_from) {
  for (const SubRay& ray : antenna_.rays())
    if (jitter || ray.share > 0.0) cells_.push_back(ray);  // the middles of the cells on the border of an ellipse are outside it
  for (std::uint32_t beam = 0; beam < antenna_.beam_azimuths().size(); ++beam) {
    for (const SubRay& cell : cells_) {
      angles_.push_back(angles_of(antenna_.beam_azimuths()[beam] + cell.azimuth, cell.elevation));
      directions_.push_back(direction_of(angles_.back()));
      RayTraits& traits = traits_.emplace_back();
      traits.spread = static_cast<float>(lobe_in_cells * std::max(cell.azimuth_cell, cell.elevation_cell));
      traits.gain = static_cast<float>(cell.gain);
      traits.share = static_cast<float>(cell.share);
      traits.beam = beam;
      traits.number = static_cast<std::uint32_t>(traits_.size() - 1);
      traits.side = cell.side;
    }
  }
}

void RaySampler::sample(std::size_t first, const Pose& sensor, double range_max, const Random& random, std::uint64_t scan, std::span<Ray> rays, std::span<RayTraits> traits) const {
  const glm::dmat3 turn = glm::mat3_cast(sensor.orientation);
  std::size_t beam = first / rays_per_beam(), slot = first % rays_per_beam();
  std::array<double, 4> draw{};
  std::uint64_t drawn = ~std::uint64_t{0};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    std::size_t which = slot;
    if (drawn_from_ > 1) {
      // Choose first, trace one (2012: each of the three rays has an equal chance to give the range).
      const double chance = random.uniform(scan, static_cast<std::uint32_t>(beam), RandomUse::ray_choice, static_cast<std::uint32_t>(slot))[0];
      which = slot * drawn_from_ + std::min(drawn_from_ - 1, static_cast<std::size_t>(chance * static_cast<double>(drawn_from_)));
    }
    const std::size_t all = beam * cells_.size() + which;
    const SubRay& cell = cells_[which];
    glm::dvec3 local = directions_[all];
    if (!always_the_same()) traits[i] = traits_[all];
    if (jitter_) {
      // Two rays share a draw.
      if (const std::uint64_t pair = std::uint64_t{beam} << 32 | which / 2; pair != drawn) {
        drawn = pair;
        draw = random.uniform(scan, static_cast<std::uint32_t>(beam), RandomUse::sampling, static_cast<std::uint32_t>(which / 2));
      }
      const std::array<double, 2> u = which % 2 ? std::array{draw[2], draw[3]} : std::array{draw[0], draw[1]};
      Angles a = angles_[all];
      if (antenna_.is_lobe()) {
        const glm::dvec2 place = Antenna::place_in(cell, u);
        turn_on(a.cos_azimuth, a.sin_azimuth, place.x - cell.azimuth);
        turn_on(a.cos_elevation, a.sin_elevation, place.y - cell.elevation);
        const double gain = antenna_.gain(place.x, place.y);
        traits[i].gain = static_cast<float>(gain);
        traits[i].share = static_cast<float>(antenna_.share(cell, gain, a.cos_elevation));
      } else {
        const SubRay placed = antenna_.jittered(cell, u);
        turn_on(a.cos_azimuth, a.sin_azimuth, placed.azimuth - cell.azimuth);
        turn_on(a.cos_elevation, a.sin_elevation, placed.elevation - cell.elevation);
        traits[i].share = static_cast<float>(placed.share);
      }
      local = direction_of(a);
    }
    rays[i].origin = sensor.position;
    rays[i].direction = turn * local;
    rays[i].range_max = range_max;
    if (cell.lateral != 0.0) {
      const double azimuth = antenna_.beam_azimuths()[beam];
      rays[i].origin += turn * (cell.lateral * glm::dvec3(-std::sin(azimuth), std::cos(azimuth), 0.0));
    }
    if (++slot == rays_per_beam()) {
      slot = 0;
      ++beam;
    }
  }
}

}  // namespace thicket
