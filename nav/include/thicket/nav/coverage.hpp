// Which bearings a contour covers, and where between them nothing looks: the gaps between lobes, the blind sector of a laser scanner.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "thicket/base/pose.hpp"
#include "thicket/nav/contour.hpp"

namespace thicket {

/// Bearings are told apart by half a degree. Two neighbouring beams see what is between them if they are at most 5 degrees apart, or at most one and a half times as far as beams are on average: a scanner
/// with few rays has no gaps, four lobes of 65 degrees have four.
class Coverage {
 public:
  static constexpr int bins = 720;

  /// Bin of a bearing in [-pi, pi].
  static int bin_of(double bearing) {
    const int bin = static_cast<int>((bearing + pi) * (bins / (2.0 * pi)));
    return bin < bins ? bin : 0;
  }

  /// Begins a new contour; then every point's bearing is noted, then `finish` finds the gaps. Returns whether other bearings are covered than the last time.
  void begin() { noted_.fill(0); }
  void note(double bearing) { noted_[static_cast<std::size_t>(bin_of(bearing))] = 1; }
  bool finish();
  /// All of it at once.
  void read(const Contour& contour);

  /// An interval of bearings that no beam covers.
  struct Gap {
    double from = 0.0;   ///< rad in [-pi, pi)
    double width = 0.0;  ///< rad, counter-clockwise from there
  };
  const std::vector<Gap>& gaps() const { return gaps_; }
  /// Whether a bearing in [-pi, pi] is covered.
  bool covers(double bearing) const { return covered_[static_cast<std::size_t>(bin_of(bearing))] != 0; }
  /// How much of the bearings within `half_width` (<= pi) about `centre` is not covered, rad.
  double unseen(double centre, double half_width) const;

 private:
  std::array<std::uint8_t, bins> noted_{}, last_{}, covered_{};
  std::vector<Gap> gaps_{{-pi, 2.0 * pi}};
};

}  // namespace thicket
