#include "thicket/nav/bumper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "thicket/base/pose.hpp"

namespace thicket {

const Section& bumper_section() {
  using S = BumperSpec;
  static const Section section = SectionOf<S>("[bumpers]", "sectors of the first sensor's scan that are pressed or released")
                                     .key("count", &S::count, "", between(4, 36), "number of sectors; the first is centred on forward")
                                     .choice("rule", &S::rule, {"any", "all"}, "any: one near ray presses a bumper; all: every ray of the sector must be near (misses poles)")
                                     .key("press_margin_m", &S::press_margin_m, "m", at_least(0.0),
                                          "pressed nearer than clearance + this; not given: 0.5 or the braking distance, whichever is more")
                                     .key("release_margin_m", &S::release_margin_m, "m", at_least(0.0), "released farther than the press distance + this");
  return section;
}

BumperRing::BumperRing(const BumperSpec& spec, double hull_radius, double press_distance)
    : all_rule_(spec.rule == "all"),
      hull_radius_(hull_radius),
      press_distance_(press_distance),
      release_distance_(press_distance + spec.release_margin_m),
      bumpers_(static_cast<std::size_t>(spec.count)),
      farthest_(bumpers_.size()) {
  for (std::size_t i = 0; i < bumpers_.size(); ++i) {
    bumpers_[i].centre = wrap_angle(2.0 * pi * static_cast<double>(i) / static_cast<double>(bumpers_.size()));
    bumpers_[i].distance = std::numeric_limits<double>::infinity();
  }
}

void BumperRing::read(const Contour& contour) {
  constexpr double none = std::numeric_limits<double>::infinity();
  const auto count = static_cast<long>(bumpers_.size());
  for (Bumper& b : bumpers_) b.distance = none;
  std::fill(farthest_.begin(), farthest_.end(), 0.0);
  for (const ContourPoint& point : contour) {
    const long sector = std::lround(point.bearing / (2.0 * pi) * static_cast<double>(count));
    const auto i = static_cast<std::size_t>((sector % count + count) % count);
    const double distance = point.distance - hull_radius_;
    farthest_[i] = std::max(farthest_[i], distance);
    if (distance < bumpers_[i].distance) {
      bumpers_[i].distance = distance;
      bumpers_[i].bearing = point.bearing;
    }
  }
  for (std::size_t i = 0; i < bumpers_.size(); ++i) {
    Bumper& b = bumpers_[i];
    const double deciding = all_rule_ && b.distance < none ? farthest_[i] : b.distance;
    b.pressed = deciding <= (b.pressed ? release_distance_ : press_distance_);
  }
}

bool BumperRing::any_pressed() const {
  return std::any_of(bumpers_.begin(), bumpers_.end(), [](const Bumper& b) { return b.pressed; });
}

double BumperRing::nearest() const {
  return std::min_element(bumpers_.begin(), bumpers_.end(), [](const Bumper& a, const Bumper& b) { return a.distance < b.distance; })->distance;
}

}  // namespace thicket
