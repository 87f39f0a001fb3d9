// Where an antenna sends its rays, and how much of the power each of them stands for. Private to the room.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "thicket/radar/sensor_spec.hpp"

namespace thicket {

/// One ray of a beam, against the beam's axis. It stands for a cell of directions about it.
struct SubRay {
  double azimuth = 0.0, elevation = 0.0;            ///< rad; the azimuth adds to the beam's
  double azimuth_cell = 0.0, elevation_cell = 0.0;  ///< rad, full widths of its cell (of a cone's ray: of a square as large as its cell, or as high as its row)
  double lateral = 0.0;   ///< m, how far left of the sensor it starts (parallel side rays)
  double share = 1.0;     ///< of what a beam-filling target returns: g^2 (two-way) times the cell's solid angle, over the integral of g^2 over the opening
  double gain = 1.0;      ///< one-way, along it
  std::int8_t side = 0;   ///< +1 the left side ray, -1 the right one
  std::uint32_t index = 0;  ///< its place in `rays`
};

/// An antenna without its mount: the azimuths of its beams, the rays of one beam (the same for all), and its gain.
class Antenna {
 public:
  explicit Antenna(const ScanningRadarSpec& spec);
  explicit Antenna(const LobeRadarSpec& spec);

  /// rad, in the sensor's frame; one for a lobe.
  const std::vector<double>& beam_azimuths() const { return azimuths_; }
  /// At the middles of their cells, row by row from the lowest. The shares sum to 1. An elliptic section has every cell that it touches; a ray whose middle is outside has share 0,
  /// and nothing to do but when it is jittered.
  std::span<const SubRay> rays() const { return rays_; }
  /// One of `rays` somewhere in its cell, u in (0, 1)^2: its angles and its share are those of that place (so that the mean over u of a sum over rays is the integral over the
  /// opening). Without an elevation opening a scanner's ray stays in the plane, but for that of a cone, which is anywhere in its ring of the disc; with one, discs are moved up
  /// and down over it, and count by the cosine of the elevation of their middles.
  SubRay jittered(const SubRay& ray, const std::array<double, 2>& u) const;

  /// The same for a lobe in steps, for who turns the ray himself: where in its cell (azimuth, elevation), and its share once its gain and the cosine of its elevation are known.
  static glm::dvec2 place_in(const SubRay& cell, const std::array<double, 2>& u) { return {cell.azimuth + (u[0] - 0.5) * cell.azimuth_cell, cell.elevation + (u[1] - 0.5) * cell.elevation_cell}; }
  double share(const SubRay& cell, double gain, double cos_elevation) const {
    return two_way_solid_angle_ > 0.0 ? gain * gain * cos_elevation * cell.azimuth_cell * cell.elevation_cell / two_way_solid_angle_ : 0.0;
  }
  bool is_lobe() const { return lobe_; }

  /// One-way power gain against the axis, 0...1 (more, if a table has its top off the axis), towards angles (rad) off a beam's axis; 0 outside the opening. A scanner's opening is
  /// here a step wide, and as high where it looks along its plane alone.
  double gain(double azimuth, double elevation) const;
  /// The same for a direction in the frame of a beam (x along its axis, y left, z up), any length > 0.
  double gain(const glm::dvec3& direction) const;
  /// On the axis, against an isotropic antenna without loss: 4 pi / integral of g, g as in `gain`.
  double directivity() const { return directivity_; }
  /// sr: integral of g^2 over the opening.
  double two_way_solid_angle() const { return two_way_solid_angle_; }
  /// rad, full: in what an echo of a beam may lie; 0 for a beam that is one ray. A cone adds its own to the elevation opening.
  glm::dvec2 opening() const { return opening_; }

 private:
  /// A drawn disc is a disc that is moved up and down: the cone of every row.
  enum class Section { rectangle, ellipse, drawn_disc };
  enum class Gain { flat, gaussian, table };

  /// rad: how far to either side the section reaches at an elevation; negative where it does not reach at all.
  double half_width(double elevation) const;
  /// `gain` without its end at the border.
  double gain_within(double azimuth, double elevation) const;
  /// Directivity and two-way solid angle.
  void integrate();
  SubRay jittered_in_cone(const SubRay& ray, const std::array<double, 2>& u) const;
  void make_shares_sum_to_one();

  std::vector<double> azimuths_;
  std::vector<SubRay> rays_;
  bool lobe_ = false;
  Section section_ = Section::rectangle;
  glm::dvec2 half_{0.0};               // rad, of the section
  Gain gain_ = Gain::flat;
  glm::dvec2 half_power_{1.0};         // rad, off the axis: where a Gaussian has half its power
  std::vector<glm::dvec2> table_;      // rad, dB
  double rows_opening_ = 0.0;          // rad, elevation over which a scanner's rows are spread
  std::uint32_t rows_ = 1, in_row_ = 1;
  double directivity_ = 1.0, two_way_solid_angle_ = 1.0;
  glm::dvec2 opening_{0.0};
};

/// The directions of a scanner's beams, rad, counter-clockwise from its x axis: all of a full circle, or a sector with a beam at both ends.
std::vector<double> azimuths_of(const ScannerSpec& spec);

/// Billdal 2018, eq. 4.4 (from 4.3): rays over an opening (rad) so that neighbours are `spacing` (m) apart at `range` (m): n = opening / (2 atan(spacing / (2 range))) + 1, rounded to
/// the nearest; at least 2.
std::int64_t rays_for_spacing(double opening, double spacing, double range);

}  // namespace thicket
