// What the table, the CSV, the JSON and the picture of a scan report have in common. Private to the room.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "thicket/sim/scan_report.hpp"

namespace thicket {

inline double to_db(double amplitude) { return amplitude > 0.0 ? 20.0 * std::log10(amplitude) : -std::numeric_limits<double>::infinity(); }

const char* to_string(Edge edge);
const char* to_string(BeamEnd end);

/// Whether the sensor tells how fast the range of its echoes changes.
bool measures_velocity(const SensorSpec& spec);

/// One scan in a line.
struct ScanFigures {
  std::size_t echoes = 0;
  const Echo* first = nullptr;      ///< the nearest; nullptr: there is no echo
  const Echo* strongest = nullptr;
  double power = 0.0;               ///< sum of the squares of amplitudes
  std::optional<double> top_range, top_amplitude;  ///< of the largest value in the profiles
};
ScanFigures figures_of(const Scan& scan);

/// A local maximum of a profile.
struct Top {
  double range = 0.0, amplitude = 0.0, threshold = 0.0;
};
/// The strongest tops of a beam's profile, at most `most`, by falling amplitude.
std::vector<Top> strongest_tops(const Profiles& profiles, std::size_t beam, std::size_t most);

/// What the poses of a way are drawn and told over.
struct WayAxis {
  std::string label;  ///< with unit
  std::vector<double> values;
};
/// The labels if they have a name; else metres, or what changes where the sensor stays in one place.
WayAxis way_axis(const ScanReport& report);
/// Metres from the first pose to each.
std::vector<double> way_lengths(const std::vector<ScanPose>& poses);

}  // namespace thicket
