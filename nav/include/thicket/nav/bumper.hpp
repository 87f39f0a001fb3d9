// Long-range bumpers: sectors of a scan that are pressed or released (Rozeboom 2012, section 5.2).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "thicket/base/schema.hpp"
#include "thicket/nav/contour.hpp"
#include "thicket/nav/coverage.hpp"

namespace thicket {

/// The keys of [bumpers].
struct BumperSpec {
  int count = 8;
  std::string rule = "any";               ///< "any": one ray presses it | "all": all rays of the sector must | "quantile": a share of them | "band2012": all, and none may be too near
  double quantile = 0.5;                  ///< of the rule "quantile": the share of the sector's rays
  std::optional<double> press_margin_m;   ///< beyond the clearance; not given: 0.5 (2012) or the braking distance, whichever is more
  double release_margin_m = 0.1;          ///< hysteresis, beyond the press distance
  std::string sensors;                    ///< names, separated by commas, of the sensors whose scans they are made of; empty: the first, and if that is a lobe all lobes
};
const Section& bumper_section();

/// One sector.
struct Bumper {
  double centre = 0.0;              ///< bearing of the sector's middle, rad
  double distance = 0.0;            ///< from the hull to the nearest matter, m; +inf: none
  double bearing = 0.0;             ///< of that matter, rad
  bool pressed = false;
  double bearing_low = 0.0, bearing_high = 0.0;  ///< that matter is somewhere between, rad, low <= high, at most half a sector from `centre` (behind the robot beyond pi): what a lobe tells; equal for a thin ray
  double unseen = 0.0;              ///< how much of the sector no beam covers, rad
};

/// A ring of equal sectors; sector 0 is centred on forward, the others follow counter-clockwise.
///
/// A bumper is pressed when enough of its sector's rays end within the press distance, and released when not enough of them end within the release distance any more. Rays without an echo
/// count as far away; a sector without rays is never pressed. The rule "band2012" is the text's, literally: pressed when all rays end between `clearance` and `clearance` + margin, so that one ray that
/// ends nearer releases it, and without hysteresis.
class BumperRing {
 public:
  /// `press_distance` and `clearance` in metres from the hull; the clearance matters for the rule "band2012" alone.
  BumperRing(const BumperSpec& spec, double hull_radius, double press_distance, double clearance = 0.0);

  void read(const Contour& contour);

  const std::vector<Bumper>& bumpers() const { return bumpers_; }
  /// The one that a bearing lies in; rad in [-pi, pi].
  const Bumper& at(double bearing) const;
  double press_distance() const { return press_distance_; }
  bool any_pressed() const;
  /// The nearest distance of all, from the hull.
  double nearest() const;

 private:
  /// What a sector adds up over a contour.
  struct Tally {
    double from = 0.0, to = 0.0;   ///< between these distances from the axis a ray counts, m
    double nearest = 0.0;          ///< from the axis, m
    std::uint32_t rays = 0, counted = 0;
    std::uint32_t arc = no_arc, nearest_arc = no_arc;  ///< that the last point, and the nearest, belongs to
    double arc_low = 0.0, arc_high = 0.0;              ///< bearings of the last one's points in this sector
  };
  static void note_arc(Tally& tally, Bumper& bumper, const ContourPoint& point);

  double share_;  ///< of a sector's rays that must count; 0: one ray is enough
  bool band_;
  double hull_radius_, press_distance_, release_distance_, band_low_, band_high_;
  std::vector<Bumper> bumpers_;
  std::vector<Tally> tallies_;
  Coverage coverage_;
};

}  // namespace thicket
