// Standing still. The 2018 maps grew obstacles that were not there; a map must not, for as long as it stands, and must see a change all the same.
#include <fmt/format.h>

#include <functional>
#include <memory>

#include "map_peers.hpp"
#include "study_mapping.hpp"
#include "study_tables.hpp"
#include "thicket/nav/occupancy_map.hpp"
#include "thicket/sim/map_score.hpp"

namespace thicket::study {
namespace {

using namespace map_work;

constexpr std::size_t settled = 10;  // scans, after which nothing that is not there may be claimed that was not before

/// A mapper, whichever.
struct Mapper {
  std::string name;
  std::function<void(const Step&)> integrate;
  std::function<ProbabilityGrid()> cells;
};

std::vector<Mapper> mappers_of(const Instrument& instrument, double resolution) {
  MapSpec spec;
  spec.resolution_m = resolution;
  spec.lobe_share = 1.0;  // lobes of this work see walls however aslant
  const auto ours = std::make_shared<OccupancyMap>(spec);
  const auto plain = std::make_shared<LogOddsGrid>(resolution);
  const double width = instrument.width;
  const bool one_range = instrument.one_range;
  return {{"Thicket",
           [ours](const Step& step) {
             for (const Scan& scan : step.scans) ours->integrate(scan, step.pose_in_space());
           },
           [ours] { return ours->to_probabilities(); }},
          {"plain log-odds", [plain, one_range, width](const Step& step) { plain->integrate(one_range ? as_fans(step, width) : step); }, [plain] { return plain->to_probabilities(); }}};
}

/// Cells of the hall that a map claims.
std::vector<std::uint8_t> claims(const ProbabilityGrid& map, const Raster& raster) {
  std::vector<std::uint8_t> claimed(raster.count());
  const int column = static_cast<int>(std::lround((map.origin.x + half_side) / raster.resolution)), row = static_cast<int>(std::lround((map.origin.y + half_side) / raster.resolution));
  for (int y = std::max(0, -row); y < std::min(map.height, raster.cells - row); ++y)
    for (int x = std::max(0, -column); x < std::min(map.width, raster.cells - column); ++x)
      claimed[static_cast<std::size_t>(raster.index(x + column, y + row))] = map.probability[map.index(x, y)] > 0.5f;
  return claimed;
}

/// Which cells no noise explains: more than 4 sigma, and half a cell's diagonal, from all matter.
std::vector<std::uint8_t> far_cells(const Hall& hall, const Raster& raster, double sigma) {
  std::vector<std::uint8_t> far(raster.count());
  const double reach = 4.0 * sigma + raster.resolution * std::sqrt(0.5);
  for (int y = 0; y < raster.cells; ++y)
    for (int x = 0; x < raster.cells; ++x) far[static_cast<std::size_t>(raster.index(x, y))] = hall.distance({raster.centre(x), raster.centre(y)}) > reach;
  return far;
}

/// A box of 0.6 m ahead of the robot, and the cells of its front that rays without noise end in.
struct Change {
  Block box;
  std::vector<int> front;
};
Change change_of(const Instrument& instrument, const Raster& raster) {
  Source source({instrument.name, instrument.lobes, instrument.rays, instrument.width, instrument.range_max, 0.0, instrument.one_range}, {true, false, 0.0});
  const Pose2 pose = way().front();
  const glm::dvec2 middle = pose.position + 3.0 * direction(pose.yaw);
  Change change{{middle.x - 0.3, middle.y - 0.3, middle.x + 0.3, middle.y + 0.3}, {}};
  source.hall.blocks.push_back(change.box);
  const Step step = source.next();
  for (const Reading& ray : (instrument.one_range ? as_fans(step, instrument.width) : step).rays) {
    const glm::dvec2 end = pose.position + (ray.range + 0.01) * direction(ray.bearing);
    if (change.box.distance(end) == 0.0) change.front.push_back(raster.index(raster.cell(end.x), raster.cell(end.y)));
  }
  std::sort(change.front.begin(), change.front.end());
  change.front.erase(std::unique(change.front.begin(), change.front.end()), change.front.end());
  return change;
}

/// Whether a cell that is claimed lies within so many metres of a cell.
bool claimed_near(int index, double distance, const std::vector<std::uint8_t>& claimed, const Raster& raster) {
  const int reach = static_cast<int>(distance / raster.resolution + 1e-6), column = index % raster.cells, row = index / raster.cells;
  for (int y = std::max(0, row - reach); y <= std::min(raster.cells - 1, row + reach); ++y)
    for (int x = std::max(0, column - reach); x <= std::min(raster.cells - 1, column + reach); ++x)
      if (std::hypot(x - column, y - row) <= distance / raster.resolution + 1e-6 && claimed[static_cast<std::size_t>(raster.index(x, y))]) return true;
  return false;
}

/// How many scans it takes until at least half of the front has a claimed cell within two sigma, or no longer has.
std::string scans_until(bool there, Source& source, const Mapper& mapper, const Change& change, const Raster& raster, std::size_t most) {
  const double near = std::max(2.0 * source.instrument().sigma, raster.resolution);
  for (std::size_t scan = 1; scan <= most; ++scan) {
    mapper.integrate(source.next());
    const auto claimed = claims(mapper.cells(), raster);
    const auto of_front = std::count_if(change.front.begin(), change.front.end(), [&](int i) { return claimed_near(i, near, claimed, raster); });
    const bool half = 2 * of_front >= static_cast<std::ptrdiff_t>(change.front.size());
    if (half == there) return std::to_string(scan);
  }
  return fmt::format("not in {}", most);
}

struct Watch {
  std::vector<std::uint8_t> before, ever;  ///< far cells claimed within the first scans; wrongly claimed since
};

void stand(const Instrument& instrument, bool identical, const StillOptions& o, std::vector<Row>& rows, std::vector<Row>& changes) {
  const Raster raster(o.resolution);
  Source source(instrument, {true, identical, o.clutter});
  const TruthGrid truth = or_exit(source.hall.truth(o.resolution, Convention::any_overlap));
  const auto far = far_cells(source.hall, raster, instrument.sigma);
  const std::vector<Mapper> mappers = mappers_of(instrument, o.resolution);
  std::vector<Watch> watches(mappers.size(), {std::vector<std::uint8_t>(raster.count()), std::vector<std::uint8_t>(raster.count())});
  const std::string noise = identical ? "identical" : "fresh";
  std::size_t milestone = settled;
  for (std::size_t scan = 1; scan <= o.scans; ++scan) {
    const Step step = source.next();
    for (const Mapper& mapper : mappers) mapper.integrate(step);
    const bool tell = scan == milestone || scan == o.scans;
    if (!tell && scan > settled && scan % o.every != 0) continue;
    for (std::size_t m = 0; m < mappers.size(); ++m) {
      const ProbabilityGrid map = mappers[m].cells();
      const auto claimed = claims(map, raster);
      std::size_t now = 0, ever = 0;
      for (std::size_t i = 0; i < claimed.size(); ++i) {
        const bool wrong = claimed[i] && far[i];
        if (scan <= settled) watches[m].before[i] |= wrong;
        else watches[m].ever[i] |= wrong && !watches[m].before[i];
        now += wrong;
        ever += watches[m].ever[i];
      }
      if (!tell) continue;
      const MapScore s = or_exit(score_map(map, truth));
      rows.push_back({instrument.name, noise, mappers[m].name, std::to_string(scan), std::to_string(now), std::to_string(ever), fixed(s.claimed_nll, 3), fixed(s.claimed_mean_p, 3), fixed(s.nll, 4), fixed(s.precision, 3)});
    }
    if (tell) milestone *= 10;
  }
  // A box comes, stays for as many scans again (but not for ever), and goes.
  const Change change = change_of(instrument, raster);
  for (const Mapper& mapper : mappers) {
    Source later = source;
    later.hall.blocks.push_back(change.box);
    later.changed();
    const std::string came = scans_until(true, later, mapper, change, raster, o.most);
    for (std::size_t i = 0; i < std::min<std::size_t>(o.scans, 1000); ++i) mapper.integrate(later.next());
    later.hall.blocks.pop_back();
    later.changed();
    const std::string went = scans_until(false, later, mapper, change, raster, o.most);
    changes.push_back({instrument.name, noise, mapper.name, std::to_string(o.scans), came, went, std::to_string(change.front.size())});
  }
}

}  // namespace

void study_still(const StillOptions& o) {
  std::vector<Row> rows, changes;
  for (const Instrument& instrument : {Instrument::radar4x58(), Instrument::lidar360(), Instrument::lidar1440(), Instrument::lobe2018()}) {
    if (std::find(o.works.begin(), o.works.end(), instrument.name) == o.works.end()) continue;
    for (const bool identical : {false, true}) stand(instrument, identical, o, rows, changes);
  }
  fmt::print("Standing still, {:g} % clutter, cells of {:g} m, clamps 0.1192 and 0.971, truth any_overlap. Wrong: claimed and more than 4 σ from all matter; looked for in each of the first {} scans and in every {}th:\n\n{}\n",
             100.0 * o.clutter, o.resolution, settled, o.every,
             markdown({"work", "noise", "map", "scans", "wrong now", fmt::format("new since scan {}", settled), "NLL of claimed", "mean p of claimed", "NLL of all", "precision @ 0.2 m"}, rows, 3));
  fmt::print("Then a box of 0.6 m is put 3 m ahead, and after {} scans more taken away: scans until at least half of the cells of its front have a claimed one within 2 σ (at least a cell), and until they no longer have:\n\n{}",
             std::min<std::size_t>(o.scans, 1000), markdown({"work", "noise", "map", "scans before", "until occupied", "until free", "cells of the front"}, changes, 3));
}

}  // namespace thicket::study
