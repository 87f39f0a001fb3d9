// Mapping on the hall of map_work.hpp, beside what others do: cost per distinct cell and scan, and of a lobe per touched cell.
#include <fmt/format.h>

#include <memory>

#include "bench_worlds.hpp"
#include "map_peers.hpp"
#include "thicket/nav/occupancy_map.hpp"

namespace thicket::bench {
namespace {

using namespace map_work;

struct Work {
  Instrument instrument;
  std::vector<Step> steps;
  double distinct = 0.0;  ///< cells under the rays, per scan, added up
};

/// The whole way, from an empty map on, as the peers were measured; making and emptying the map is not part of it.
template <class Make, class Integrate>
void whole_way(benchmark::State& state, const Work& work, Make make, Integrate integrate) {
  for (auto _ : state) {
    state.PauseTiming();
    auto map = make();
    state.ResumeTiming();
    for (const Step& step : work.steps) integrate(map, step);
    benchmark::ClobberMemory();
    state.PauseTiming();
    {
      const auto emptied = std::move(map);
    }
    state.ResumeTiming();
  }
  per_item(state, "distinct cell", work.distinct);
  state.counters["ms in all"] = benchmark::Counter(1e-3, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

MapSpec spec_of(double resolution) {
  MapSpec spec;
  spec.resolution_m = resolution;
  spec.lobe_share = 1.0;  // as the peer: all of the opening
  return spec;
}

void integrate_ours(const std::unique_ptr<OccupancyMap>& map, const Step& step) {
  for (const Scan& scan : step.scans) map->integrate(scan, step.pose_in_space());
}

void register_work(const Instrument& instrument, double resolution) {
  const auto work = std::make_shared<Work>(Work{instrument, map_work::steps(instrument), 0.0});
  work->distinct = distinct_cells(work->steps, resolution);
  const std::string what = fmt::format("mapping/{}/{:g} m/", instrument.name, resolution);
  measure(what + "u8 overwrite (nav2)", [=](benchmark::State& s) {
    whole_way(s, *work, [=] { return OverwriteGrid(resolution); }, [](OverwriteGrid& map, const Step& step) { map.integrate(step); });
  });
  measure(what + "int8 log-odds and epoch", [=](benchmark::State& s) {
    whole_way(s, *work, [=] { return EpochGrid(resolution); }, [](EpochGrid& map, const Step& step) { map.integrate(step); });
  });
#ifdef THICKET_OCTOMAP
  measure(what + "OctoMap", [=](benchmark::State& s) {
    whole_way(s, *work, [=] { return std::make_unique<OctoMapPeer>(resolution, work->instrument.range_max); }, [](const std::unique_ptr<OctoMapPeer>& map, const Step& step) { map->integrate(step); });
  });
#endif
  measure(what + "Thicket", [=](benchmark::State& s) { whole_way(s, *work, [=] { return std::make_unique<OccupancyMap>(spec_of(resolution)); }, integrate_ours); });
}

/// Lobes of 58 degrees and 20 m with one range: an arc tangent a cell, and ours.
void register_lobe(double resolution) {
  const auto work = std::make_shared<Work>(Work{Instrument::lobe58(), map_work::steps(Instrument::lobe58()), 0.0});
  LogOddsGrid counted(resolution);
  double touched = 0.0;
  for (const Step& step : work->steps) touched += static_cast<double>(counted.integrate_lobes(step, work->instrument));
  const std::string what = fmt::format("mapping/{}/{:g} m/", work->instrument.name, resolution);
  measure(what + "atan2 a cell", [=](benchmark::State& state) {
    LogOddsGrid map(resolution);
    for (auto _ : state)
      for (const Step& step : work->steps) benchmark::DoNotOptimize(map.integrate_lobes(step, work->instrument));
    per_item(state, "touched cell", touched);
  });
  measure(what + "Thicket", [=](benchmark::State& state) {
    double own = 0.0;  // it may touch others, and what its rule says of them is its own
    for (const Step& step : work->steps)
      for (const Scan& scan : step.scans) {
        OccupancyMap one(spec_of(resolution));
        one.integrate(scan, step.pose_in_space());
        own += static_cast<double>(one.known_cells());
      }
    const auto map = std::make_unique<OccupancyMap>(spec_of(resolution));
    for (auto _ : state)
      for (const Step& step : work->steps) integrate_ours(map, step);
    per_item(state, "touched cell", own);
  });
}

}  // namespace

void register_mapping() {
  for (const Instrument& instrument : {Instrument::radar4x58(), Instrument::lidar360(), Instrument::lidar1440()}) register_work(instrument, 0.05);
  register_lobe(0.05);
}

}  // namespace thicket::bench
