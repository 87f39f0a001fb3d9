// What was seen before from the same place. Private to the room.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "thicket/base/pose.hpp"
#include "thicket/scan/scan.hpp"

namespace thicket {

/// Tells looks that are new from looks that repeat one.
///
/// A second look along a bearing from where the sensor stood before is no independent witness: its errors may be the same, and an error that comes once in a thousand looks comes for certain to who stands long enough.
/// So of the last looks from one place the median counts (by the first echo, none being the farthest), as soon as there are enough of them: what one look in fifty makes up never gets through, and what really changed does so
/// after half of them. It is drawn as it was made, from its own pose: along today's bearing its range would be that of another thing.
/// A place is left with a move by more than `same_place`; thin beams of scanners are told apart by their bearing, so that a turn on the spot shows which of them are new; of lobes, and of beams above one another, a turn by more
/// than an eighth of the opening (a quarter of a degree) makes all of them new.
class ViewMemory {
 public:
  static constexpr std::size_t looks = 17, enough = looks / 2 + 1;

  /// Beams of one look.
  struct Part {
    Scan scan;
    Pose sensor;
  };
  /// Divides a scan's beams. Valid until the next call.
  struct Views {
    const Scan* fresh = nullptr;     ///< null: no beam is new
    std::span<const Part> repeated;  ///< for the others the median of their looks
  };
  Views take(const Scan& scan, const Pose& sensor, double same_place);

 private:
  struct Look {
    Pose sensor;
    double yaw = 0.0;
    std::vector<Beam> beams;
    std::vector<Echo> echoes;
    std::vector<std::int32_t> at_bin;  ///< of a scanner: the beam in each bin of bearings, -1: none
    double first_range(std::size_t beam) const { return beams[beam].echo_count > 0 ? echoes[beams[beam].first_echo].range : 1e300; }
  };
  struct Place {
    glm::dvec3 position{0.0};
    std::deque<std::shared_ptr<const Look>> looks;  ///< oldest first; never changed, so that copies of a map share them
  };
  std::map<std::uint16_t, Place> places_;  ///< by sensor
  Scan fresh_;
  std::vector<Part> repeated_;
};

}  // namespace thicket
