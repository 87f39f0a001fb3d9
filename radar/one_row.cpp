#include "one_row.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace thicket {

std::optional<OneRow> OneRow::make(const LobeRadarSpec& spec, const RaySampler& sampler) {
  if (spec.rows == "all" || (spec.rows == "auto" && spec.sampling == "jitter") || spec.echoes != "receiver" || spec.signal != "amplitude" || spec.law != "radar_equation" || spec.section != "square" || spec.gain == "table") return std::nullopt;
  OneRow one;
  const auto cells = sampler.antenna().rays();
  for (const SubRay& cell : cells)
    if (cell.azimuth == cells.front().azimuth) one.rows_.push_back(cell);
  one.columns_ = cells.size() / one.rows_.size();
  one.reach_ = spec.range_max_m * std::sin(0.5 * radians(spec.elevation_opening_deg));
  one.jitter_ = spec.sampling == "jitter";
  return one;
}

bool OneRow::holds(const TraceContext& context) const {
  if (!context.first_surface_only || context.multipath) return false;
  const glm::dvec3 up = context.sensor.orientation * glm::dvec3(0.0, 0.0, 1.0);
  if (std::abs(up.x) > 1e-9 || std::abs(up.y) > 1e-9 || up.z < 0.0) return false;
  const double z = context.sensor.position.z;
  const auto heights = context.scene.level_cuts().about(z);
  return heights && heights->x <= z - reach_ && heights->y >= z + reach_;
}

PhysicsPart OneRow::model_of(const TraceContext& context) const {
  if (holds(context)) return {"elevation rows", false, "the world is the same at every height in sight: one row of rays stands for all"};
  return {"elevation rows", true, !context.first_surface_only ? "what lets the wave through takes more from a slanted ray" : context.multipath ? "mirrors send slanted rays on" : "the world changes with the height, or the lobe is not level"};
}

std::vector<OneRow::Row> OneRow::rows_of(const TraceContext& context) const {
  std::vector<Row> rows;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    double elevation = rows_[r].elevation;
    // (The columns take the first numbers.)
    if (jitter_) elevation += (context.random.uniform(context.scan, 0, RandomUse::sampling, static_cast<std::uint32_t>(columns_ + r))[0] - 0.5) * rows_[r].elevation_cell;
    rows.push_back({std::sin(elevation), std::cos(elevation), 1.0 / std::cos(elevation), context.antenna.gain(0.0, elevation)});
  }
  return rows;
}

std::size_t OneRow::returns(const TraceContext& context, const RaySampler& sampler, std::vector<Return>& returns) const {
  const Antenna& antenna = sampler.antenna();
  const auto cells = antenna.rays();
  const glm::dmat3 turn = glm::mat3_cast(context.sensor.orientation);
  std::vector<Ray> rays(columns_);
  std::vector<double> off(columns_);  // rad, azimuth in the lobe
  for (std::size_t c = 0; c < columns_; ++c) {
    off[c] = cells[c].azimuth;
    if (jitter_) off[c] += (context.random.uniform(context.scan, 0, RandomUse::sampling, static_cast<std::uint32_t>(c))[0] - 0.5) * cells[c].azimuth_cell;
    rays[c] = {context.sensor.position, turn * glm::dvec3(std::cos(off[c]), std::sin(off[c]), 0.0), context.range_max};
  }
  std::vector<Hit> hits(columns_);
  context.scene.closest_hits(rays, Stops::everything, hits);

  returns.clear();
  const std::vector<Row> rows = rows_of(context);
  const double limit = context.range_max * context.range_max;
  for (std::size_t c = 0; c < columns_; ++c) {
    const Hit& hit = hits[c];
    if (hit.solid == no_solid || hit.range == 0.0) continue;  // none, or it starts inside
    const WaveMaterial& material = context.materials[context.scene.material(hit.solid)];
    if (!material.visible) continue;
    const double level_cosine = std::min(1.0, std::abs(glm::dot(hit.normal, rays[c].direction)));
    glm::dvec3 velocity(0.0);
    if (context.radar.radial_velocity) velocity = (context.scene.moves() ? context.scene.velocity(hit.solid, rays[c].origin + hit.range * rays[c].direction) : glm::dvec3(0.0)) - context.velocity;
    const double along = glm::dot(velocity, rays[c].direction);
    const double column_gain = antenna.gain(off[c], 0.0);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const double range = hit.range * rows[r].slant;
      if (range > context.range_max || range < context.range_min) continue;
      const double cosine = level_cosine * rows[r].cosine;
      const RayTraits& traits = sampler.traits()[r * columns_ + c];
      double power = material.diffuse >= 1.0 ? material.reflectivity * cosine : backscatter(material, material.reflectivity, cosine, traits.spread);
      if (!context.radar.range_compensation) power *= limit / (std::max(range, nearest_range) * std::max(range, nearest_range));
      if (!(power >= context.floor_power)) continue;
      // A Gaussian gain is a product: that of the column times that of the row.
      const double share = jitter_ ? antenna.share(cells[r * columns_ + c], column_gain * rows[r].gain, rows[r].cosine) : static_cast<double>(traits.share);
      returns.push_back({range, static_cast<float>(share * power), static_cast<float>(along * rows[r].cosine + velocity.z * rows[r].sine)});
    }
  }
  return columns_;
}

}  // namespace thicket
