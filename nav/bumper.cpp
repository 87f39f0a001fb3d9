#include "thicket/nav/bumper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "thicket/base/pose.hpp"

namespace thicket {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();

double share_of(const BumperSpec& spec) {
  if (spec.rule == "any") return 0.0;
  return spec.rule == "quantile" ? spec.quantile : 1.0;
}

}  // namespace

const Section& bumper_section() {
  using S = BumperSpec;
  static const Section section =
      SectionOf<S>("[bumpers]", "sectors of what the sensors see that are pressed or released")
          .key("count", &S::count, "", between(4, 36), "number of sectors; the first is centred on forward")
          .choice("rule", &S::rule, {"any", "all", "quantile", "band2012"},
                  "any: one near ray presses a bumper; all: every ray of the sector must be near (misses poles); quantile: a share of them; band2012: the 2012 text's, for comparison: every ray must end "
                  "between the clearance and press_margin_m (0.5) beyond it, so that matter nearer than the clearance releases it")
          .key("quantile", &S::quantile, "", above_up_to(0.0, 1.0), "for the rule quantile: the share of a sector's rays that must be near")
          .key("press_margin_m", &S::press_margin_m, "m", at_least(0.0),
               "pressed nearer than clearance + this; not given: 0.5 or the braking distance, whichever is more")
          .key("release_margin_m", &S::release_margin_m, "m", at_least(0.0), "released farther than the press distance + this")
          .key("sensors", &S::sensors, "names of the sensors that drive them, separated by commas; empty: the first, and if that is a lobe radar all lobe radars. The planner decides when the first of them has scanned");
  return section;
}

BumperRing::BumperRing(const BumperSpec& spec, double hull_radius, double press_distance, double clearance)
    : share_(share_of(spec)),
      band_(spec.rule == "band2012"),
      hull_radius_(hull_radius),
      press_distance_(press_distance),
      release_distance_(press_distance + spec.release_margin_m),
      band_low_(clearance),
      band_high_(clearance + spec.press_margin_m.value_or(0.5)),
      bumpers_(static_cast<std::size_t>(spec.count)),
      tallies_(bumpers_.size()) {
  const double half_sector = pi / static_cast<double>(bumpers_.size());
  for (std::size_t i = 0; i < bumpers_.size(); ++i) {
    bumpers_[i].centre = wrap_angle(2.0 * pi * static_cast<double>(i) / static_cast<double>(bumpers_.size()));
    bumpers_[i].distance = none;
    bumpers_[i].unseen = 2.0 * half_sector;
  }
}

void BumperRing::note_arc(Tally& tally, Bumper& bumper, const ContourPoint& point) {
  if (point.distance == none) return;
  const double bearing = bumper.centre + wrap_angle(point.bearing - bumper.centre);
  if (point.arc != tally.arc) tally.arc_low = tally.arc_high = bearing;
  tally.arc = point.arc;
  tally.arc_low = std::min(tally.arc_low, bearing);
  tally.arc_high = std::max(tally.arc_high, bearing);
  if (point.arc != tally.nearest_arc) return;
  bumper.bearing_low = tally.arc_low;
  bumper.bearing_high = tally.arc_high;
}

void BumperRing::read(const Contour& contour) {
  const auto count = static_cast<int>(bumpers_.size());
  for (std::size_t i = 0; i < bumpers_.size(); ++i) {
    Tally& tally = tallies_[i] = {};
    tally.nearest = none;
    tally.from = band_ ? hull_radius_ + band_low_ : 0.0;
    tally.to = hull_radius_ + (band_ ? band_high_ : bumpers_[i].pressed ? release_distance_ : press_distance_);
  }
  coverage_.begin();
  const double sectors_per_radian = static_cast<double>(count) / (2.0 * pi);
  for (const ContourPoint& point : contour) {
    const int sector = static_cast<int>(point.bearing * sectors_per_radian + count + 0.5);  // bearings are in [-pi, pi]: this is in [count / 2, 3 count / 2 + 1)
    const auto i = static_cast<std::size_t>(sector < count ? sector : sector - count);
    coverage_.note(point.bearing);
    Tally& tally = tallies_[i];
    ++tally.rays;
    tally.counted += point.distance >= tally.from && point.distance <= tally.to;
    if (point.distance < tally.nearest) {
      tally.nearest = point.distance;
      tally.nearest_arc = point.arc;
      bumpers_[i].bearing = point.bearing;
    }
    if (point.arc != no_arc) note_arc(tally, bumpers_[i], point);
  }
  const bool covered_anew = coverage_.finish();
  for (std::size_t i = 0; i < bumpers_.size(); ++i) {
    Bumper& b = bumpers_[i];
    const Tally& tally = tallies_[i];
    b.distance = tally.nearest - hull_radius_;
    if (tally.nearest_arc == no_arc) b.bearing_low = b.bearing_high = b.centre + wrap_angle(b.bearing - b.centre);
    b.pressed = tally.counted > 0 && static_cast<double>(tally.counted) + 1e-9 >= share_ * static_cast<double>(tally.rays);
    if (covered_anew) b.unseen = coverage_.unseen(b.centre, pi / static_cast<double>(count));
  }
}

const Bumper& BumperRing::at(double bearing) const {
  const auto count = static_cast<int>(bumpers_.size());
  const int sector = static_cast<int>(bearing * (static_cast<double>(count) / (2.0 * pi)) + count + 0.5) % count;
  return bumpers_[static_cast<std::size_t>(sector)];
}

bool BumperRing::any_pressed() const {
  return std::any_of(bumpers_.begin(), bumpers_.end(), [](const Bumper& b) { return b.pressed; });
}

double BumperRing::nearest() const {
  return std::min_element(bumpers_.begin(), bumpers_.end(), [](const Bumper& a, const Bumper& b) { return a.distance < b.distance; })->distance;
}

}  // namespace thicket
