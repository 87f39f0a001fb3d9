// Images of synthetic aperture as a mission makes them: which sensor, which files, and what they tell of the map.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "thicket/base/probability_grid.hpp"
#include "thicket/base/result.hpp"
#include "thicket/radar/sar.hpp"
#include "thicket/sim/map_score.hpp"

namespace thicket {

struct Mission;
class Simulation;

/// The sensor whose scans make the image, as a place in `sensors`: that of `sar.sensor`, else the first lobe radar with a receiver. Nothing if there is none.
std::optional<std::size_t> sar_sensor(const Mission& mission);
/// What is wrong with a [sar] that is enabled, for its person; nothing if it is well, or off.
std::optional<std::string> sar_fault(const Mission& mission);
/// The empty image of a mission without such a fault; nothing if [sar] is off.
std::optional<SarImage> begin_sar(const Mission& mission);

/// A map without the cells that the image has no return from.
struct SarFusion {
  ProbabilityGrid map;      ///< what was taken off is 1/2: known, and claimed no more
  std::size_t claimed = 0;  ///< cells with a probability of matter above 1/2, before
  std::size_t judged = 0;   ///< those of them that the image has a say in
  std::size_t removed = 0;  ///< those of them that were taken off
};
/// Takes claimed cells off a map: those whose strongest mean return (amplitude by looks, over the cell and 5 cm around it) is below `fuse_threshold_db` against the strongest within `fuse_radius_m`.
/// The image has no say in cells that it did not see all of, over `fuse_aperture_deg` at least: those stay.
SarFusion fuse_sar(const ProbabilityGrid& map, const SarImage& image);

/// What a run's image comes to.
struct SarReport {
  SarGrid grid;
  std::vector<SarPeak> peaks;
  std::optional<SarFusion> fusion;          ///< with `sar.fuse`
  std::optional<MapScore> before, after;    ///< of the fusion, where the map can be judged (cell_centre, 0.2 m)
};
/// Errors: the run has no image, or no scan has come into it.
Result<SarReport> report_sar(const Simulation& simulation);

/// Writes sar.png (dB, axes in metres), sar.npy (amplitude, float32, row 0 at the bottom) and sar.json (what it is, and its peaks); after a fusion map_fused.pgm and map_fused.yaml too. Errors as `write_file`.
Result<Done> write_sar(const std::filesystem::path& folder, const Simulation& simulation, const SarReport& report);
/// The names of all files that `write_sar` may write.
const std::vector<std::string>& sar_files();

/// `sar.json`. The same run gives the same bytes.
std::string sar_json(const Simulation& simulation, const SarReport& report);
/// A few lines for a person.
std::string sar_text(const Simulation& simulation, const SarReport& report);

}  // namespace thicket
