// Inverse sensor models: what a scan says of the cells around the sensor. Private to the room.
#pragma once

#include <array>
#include <vector>

#include <glm/vec2.hpp>

#include "thicket/base/pose.hpp"
#include "thicket/scan/scan.hpp"
#include "prior.hpp"
#include "rows.hpp"
#include "tables.hpp"

namespace thicket {

/// Draws scans into a window.
///
/// A thin beam: free before its first echo, sensed through between the edges of matter, occupied at each echo and half a cell behind a face, nothing behind its end. Where its ranges are less sure than half a cell, each cell
/// within two sigma of an echo may be the one that gave it: as likely as it was occupied before, times the normal error of the range (the mixture of Thrun, Burgard & Fox 2005, section 9.3, beam by beam). If it is that one
/// it is occupied, if the echo is from farther on the beam went through it, and if it is from nearer nothing is said: so noise does not thicken walls backward.
///
/// A beam with an opening (a lobe) tells how far, not where: its opening, or the share of it whose silence counts, is free before the first echo, with the certainty of its probability of detection; of the arc at the echo just one place need be matter.
/// Each cell there is as likely to be it as it was occupied before, times the normal error (Elfes 1987, in the form of Konolige 1997): cells known free stay so, and what is left of the arc gets all.
class SensorModel {
 public:
  explicit SensorModel(const MapSpec& spec);

  /// How far the scan has anything to say, m, sigma included.
  double reach(const Scan& scan) const;
  /// `sensor`: its pose in the world. `prior`: what was known before the scan, placed as the window is. The window lies around the sensor and holds `reach`.
  void draw(const Scan& scan, const Pose& sensor, Prior& prior, Window& window) const;

  /// Standard deviation of a scan's ranges, m.
  double sigma(const Scan& scan) const;
  int hit() const { return hit_; }
  int miss() const { return miss_; }

 private:
  void draw_beams(const Scan& scan, const Pose& sensor, Prior& prior, Window& window) const;
  void draw_lobe(const Scan& scan, const Beam& beam, const glm::dvec2& from, double axis, double shrink, Prior& prior, Window& window) const;

  double resolution_, sigma_;
  double lobe_share_;
  double least_probability_;  ///< of matter in a cell: the clamp
  int hit_, miss_, unseen_;  ///< evidence of an echo, of a beam that went through, of a lobe that saw nothing there
  /// Where the matter may be that gave the echo of a beam.
  struct Candidate {
    Code* code;
    float likelihood;
    Level level;
  };
  mutable std::vector<Candidate> candidates_;  ///< scratch
  mutable std::vector<Piece> arc_;
  std::array<double, 256> probability_missed_;  ///< of matter in a cell of a level, after a beam that went through it
};

}  // namespace thicket
