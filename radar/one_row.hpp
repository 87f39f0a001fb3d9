// A lobe in a world that is the same at every height that it sees: one level row of rays stands for all rows. Private to the room.
#pragma once

#include <optional>
#include <vector>

#include "ray_sampler.hpp"
#include "ray_tracer.hpp"
#include "receiver.hpp"

namespace thicket {

/// In a pure extrusion a ray of azimuth a and elevation e meets what the level ray of azimuth a meets, at its range over cos e, under an incidence whose cosine is that of the level ray times cos e. So one ray per column is
/// traced, and what the others bring back is worked out. Only for a level lobe with a receiver whose grid is a product of azimuths and elevations (square section; flat or Gaussian gain), where the first surface is all there is and
/// returns are powers. Jitter moves whole columns and whole rows: the place of each in its cells is drawn anew in each scan. The
/// mean over scans is right then, but a scan has 58 places of a column less to meet what is thin: by itself ("auto") only a regular grid is taken so, of which the profile is the same.
class OneRow {
 public:
  /// Nothing if the lobe is none of these, whatever the world.
  static std::optional<OneRow> make(const LobeRadarSpec& spec, const RaySampler& sampler);

  /// Whether it holds for this scan.
  bool holds(const TraceContext& context) const;
  /// Whether it does, in words.
  PhysicsPart model_of(const TraceContext& context) const;
  /// What all rays of the lobe bring back, those of a column one after another. The strengths are what each ray's share makes of its power. Returns how many rays were traced.
  std::size_t returns(const TraceContext& context, const RaySampler& sampler, std::vector<Return>& returns) const;

 private:
  /// Of a scan.
  struct Row {
    double sine, cosine, slant;  ///< of the elevation, and 1 over its cosine
    double gain;                 ///< one-way, in the middle of the row
  };
  std::vector<Row> rows_of(const TraceContext& context) const;

  std::vector<SubRay> rows_;  ///< a cell of each
  std::size_t columns_ = 0;
  double reach_ = 0.0;   ///< m, how far above and below itself the sensor sees
  bool jitter_ = false;
};

}  // namespace thicket
