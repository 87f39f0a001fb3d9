// One way through the hall, every mapper, both truths.
#include <fmt/format.h>

#include "map_peers.hpp"
#include "study_mapping.hpp"
#include "study_tables.hpp"
#include "thicket/nav/occupancy_map.hpp"
#include "thicket/sim/map_score.hpp"

namespace thicket::study {
namespace {

using namespace map_work;

/// A map of someone's; without cells it was not built.
struct Entry {
  std::string mapper;
  ProbabilityGrid map;
};

ProbabilityGrid our_map(const std::vector<Step>& steps, double resolution) {
  MapSpec spec;
  spec.resolution_m = resolution;
  spec.lobe_share = 1.0;  // lobes of this work see walls however aslant
  OccupancyMap map(spec);
  for (const Step& step : steps)
    for (const Scan& scan : step.scans) map.integrate(scan, step.pose_in_space());
  return map.to_probabilities();
}

std::vector<Entry> maps_of(const Instrument& instrument, double resolution) {
  const std::vector<Step> way = map_work::steps(instrument);
  std::vector<Step> rays;
  for (const Step& step : way) rays.push_back(instrument.one_range ? as_fans(step, instrument.width) : step);
  const std::string fan = instrument.one_range ? " (a fan of rays 1° apart)" : "";

  std::vector<Entry> entries = {{"Thicket", our_map(way, resolution)}};
  LogOddsGrid plain(resolution);
  for (const Step& step : rays) plain.integrate(step);
  entries.push_back({"plain log-odds" + fan, plain.to_probabilities()});
#ifdef THICKET_OCTOMAP
  OctoMapPeer octomap(resolution, instrument.range_max);
  for (const Step& step : rays) octomap.integrate(step);
  entries.push_back({"OctoMap" + fan, octomap.to_probabilities()});
#else
  entries.push_back({"OctoMap: not built: apt install liboctomap-dev", {}});
#endif
  if (instrument.lobes > 1) {  // a radar
    LogOddsGrid area(resolution);
    for (const Step& step : way) area.integrate_lobes(step, instrument);
    entries.push_back({"areas, ±2σ band (2018)", area.to_probabilities()});
  }
  return entries;
}

}  // namespace

void study_quality(const QualityOptions& o) {
  const Hall hall = map_work::hall();
  const TruthGrid centre = or_exit(hall.truth(o.resolution, Convention::cell_centre)), overlap = or_exit(hall.truth(o.resolution, Convention::any_overlap));
  std::vector<std::vector<Row>> rows(2);
  for (const Instrument& instrument : {Instrument::radar4x58(), Instrument::lidar360(), Instrument::lidar1440(), Instrument::lobe2018()}) {
    for (const Entry& entry : maps_of(instrument, o.resolution)) {
      for (const bool any : {false, true}) {
        if (entry.map.probability.empty()) {
          rows[any].push_back({instrument.name, entry.mapper, "-", "-", "-", "-", "-", "-", "-"});
          continue;
        }
        const MapScore s = or_exit(score_map(entry.map, any ? overlap : centre, o.tolerance));
        rows[any].push_back({instrument.name, entry.mapper, fixed(s.coverage, 3), fixed(s.f1, 3), fixed(s.precision, 3), fixed(s.strict_precision, 3), fixed(s.claimed_nll, 3), fixed(s.claimed_mean_p, 3), fixed(s.edge_error_m, 3)});
      }
    }
  }
  const Row head = {"work", "map", "coverage", fmt::format("F1 @ {:g} m", o.tolerance), "precision", "strict precision", "NLL of claimed", "mean p of claimed", "edge error, m"};
  for (const bool any : {false, true})
    fmt::print("Cells of {:g} m, clamps 0.1192 and 0.971, truth {}:\n\n{}\n", o.resolution, to_string(any ? Convention::any_overlap : Convention::cell_centre), markdown(head, rows[any], 2));
}

}  // namespace thicket::study
