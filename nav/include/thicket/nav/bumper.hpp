// Long-range bumpers: sectors of a scan that are pressed or released (Rozeboom 2012, section 5.2).
#pragma once

#include <string>
#include <vector>

#include "thicket/base/schema.hpp"
#include "thicket/nav/contour.hpp"

namespace thicket {

/// The keys of [bumpers].
struct BumperSpec {
  int count = 8;
  std::string rule = "any";               ///< "any": one ray presses it | "all": all rays of the sector must
  std::optional<double> press_margin_m;   ///< beyond the clearance; not given: 0.5 (2012) or the braking distance, whichever is more
  double release_margin_m = 0.1;          ///< hysteresis, beyond the press distance
};
const Section& bumper_section();

/// One sector.
struct Bumper {
  double centre = 0.0;              ///< bearing of the sector's middle, rad
  double distance = 0.0;            ///< from the hull to the nearest matter, m; +inf: none
  double bearing = 0.0;             ///< of that matter, rad
  bool pressed = false;
};

/// A ring of equal sectors; sector 0 is centred on forward, the others follow counter-clockwise.
class BumperRing {
 public:
  /// `press_distance` in metres from the hull.
  BumperRing(const BumperSpec& spec, double hull_radius, double press_distance);

  void read(const Contour& contour);

  const std::vector<Bumper>& bumpers() const { return bumpers_; }
  double press_distance() const { return press_distance_; }
  bool any_pressed() const;
  /// The nearest distance of all, from the hull.
  double nearest() const;

 private:
  bool all_rule_;
  double hull_radius_, press_distance_, release_distance_;
  std::vector<Bumper> bumpers_;
  std::vector<double> farthest_;
};

}  // namespace thicket
