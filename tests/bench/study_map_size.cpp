// Whether a scan costs more in a map that is large already: the same scans into a map of the hall, and into one that has seen places all over 5 x 5 km besides.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

#include "map_work.hpp"
#include "study_mapping.hpp"
#include "study_tables.hpp"
#include "thicket/nav/occupancy_map.hpp"

namespace thicket::study {
namespace {

using namespace map_work;

double milliseconds_of(OccupancyMap& map, const std::vector<Step>& steps) {
  const auto begin = std::chrono::steady_clock::now();
  for (const Step& step : steps)
    for (const Scan& scan : step.scans) map.integrate(scan, step.pose_in_space());
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

void study_size(const SizeOptions& o) {
  std::vector<Row> rows;
  for (const Instrument& instrument : {Instrument::radar4x58(), Instrument::lidar360()}) {
    const std::vector<Step> steps = map_work::steps(instrument);
    MapSpec spec;
    spec.resolution_m = o.resolution;
    OccupancyMap small(spec), large(spec);
    // Looks from places all over, none of them in the hall.
    std::mt19937 engine(3);
    std::uniform_real_distribution<double> place(-2500.0, 2500.0);
    for (int i = 0; i < o.places;) {
      const glm::dvec2 at{place(engine), place(engine)};
      if (std::max(std::abs(at.x), std::abs(at.y)) < 100.0) continue;
      for (const Scan& scan : steps[static_cast<std::size_t>(i) % steps.size()].scans) large.integrate(scan, Pose::planar(at.x, at.y, 1.0, 0.0));
      ++i;
    }
    // One way through the hall each, not counted; then pairs, each begun by the other.
    milliseconds_of(small, steps);
    milliseconds_of(large, steps);
    std::vector<double> ratios;
    double of_small = 0.0, of_large = 0.0;
    for (int pair = 0; pair < o.pairs; ++pair) {
      double a = 0.0, b = 0.0;
      if (pair % 2 == 0) a = milliseconds_of(small, steps), b = milliseconds_of(large, steps);
      else b = milliseconds_of(large, steps), a = milliseconds_of(small, steps);
      ratios.push_back(std::log(b / a));
      of_small += a;
      of_large += b;
    }
    double mean = 0.0, square = 0.0;
    for (const double r : ratios) mean += r / static_cast<double>(ratios.size());
    for (const double r : ratios) square += (r - mean) * (r - mean);
    const double off = 1.96 * std::sqrt(square / static_cast<double>(ratios.size() - 1) / static_cast<double>(ratios.size()));
    const auto per_scan = [&](double all) { return fixed(1000.0 * all / o.pairs / static_cast<double>(steps.size()), 1); };
    rows.push_back({instrument.name, std::to_string(small.known_cells()), std::to_string(large.known_cells()), per_scan(of_small), per_scan(of_large), fixed(std::exp(mean), 3), fmt::format("{} to {}", fixed(std::exp(mean - off), 3), fixed(std::exp(mean + off), 3))});
  }
  fmt::print("The hall alone, and after looks from {} places all over 5 x 5 km; cells of {:g} m, {} pairs of runs of 200 scans in turn:\n\n{}", o.places, o.resolution, o.pairs,
             markdown({"work", "known cells, 50 m", "known cells, 5 km", "µs a scan, 50 m", "µs a scan, 5 km", "ratio", "95 %"}, rows, 1));
}

}  // namespace thicket::study
