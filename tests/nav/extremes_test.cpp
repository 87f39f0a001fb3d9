// The map at the ends of what it is made for: updates without end, places without end. Bounds and results: docs/extremes.md.
#include <doctest/doctest.h>

#include <cmath>

#include "thicket/nav/occupancy_map.hpp"

namespace thicket {
namespace {

/// A beam along x from the vehicle's origin with an echo at a range; without one, open up to there.
Scan one_beam(double range, bool echo) {
  Scan scan;
  Beam beam;
  beam.direction = {1.0, 0.0, 0.0};
  beam.sensed_range = range;
  beam.end = echo ? BeamEnd::stopped : BeamEnd::open;
  beam.echo_count = echo ? 1 : 0;
  scan.beams.push_back(beam);
  if (echo) scan.echoes.push_back({range, 1.0f, 1.0f, 0.0f, Edge::front});
  return scan;
}

MapSpec of(int bits, const char* evidence) {
  MapSpec spec;
  spec.cell_bits = bits;
  spec.evidence = evidence;
  return spec;
}

}  // namespace

TEST_CASE("extremes: time: a million updates of one cell leave it at its clamp, where a further one changes nothing, so that 10^9 do") {
  for (const int bits : {8, 16}) {
    for (const char* evidence : {"scans", "views"}) {
      CAPTURE(bits);
      CAPTURE(evidence);
      OccupancyMap map(of(bits, evidence));
      const Scan hit = one_beam(0.25, true), miss = one_beam(0.25, false);
      const Pose pose = Pose::planar(0.05, 0.05, 0.0, 0.0);
      const int updates = bits == 8 && evidence == std::string("scans") ? 1000000 : 10000;
      for (int i = 0; i < 1000; ++i) map.integrate(hit, pose);
      const double matter = map.view({3, 0}).probability, open = map.view({1, 0}).probability;
      for (int i = 1000; i < updates; ++i) map.integrate(hit, pose);
      CHECK(map.view({3, 0}).probability == matter);
      CHECK(map.view({1, 0}).probability == open);
      if (evidence == std::string("views")) continue;  // one look, however often
      CHECK(map.cells_updated() == static_cast<std::uint64_t>(updates) * 4);  // three cells of the way, and that of the echo
      // At the clamps, to the nearest of the cells' units; and ever so often hit, 10 looks through it change its mind.
      CHECK(std::abs(std::log(matter / (1.0 - matter)) - std::log(0.971 / 0.029)) <= 0.5 / (bits == 8 ? 32.0 : 4096.0) + 1e-12);
      CHECK(std::abs(std::log(open / (1.0 - open)) - std::log(0.1192 / 0.8808)) <= 0.5 / (bits == 8 ? 32.0 : 4096.0) + 1e-12);
      const Scan through = one_beam(0.55, false);
      for (int i = 0; i < 10; ++i) map.integrate(through, pose);
      CHECK(map.view({3, 0}).probability < 0.5);
      for (int i = 0; i < 1000; ++i) map.integrate(miss, pose);
      CHECK(map.surely_free({1, 0}));
    }
  }
}

TEST_CASE("extremes: place: 2^14, 2^20 and 2^27 m away a map of dyadic cells is the same, cell for cell") {
  for (const char* store : {"tiles", "quadtree"}) {
    MapSpec spec;
    spec.store = store;
    spec.resolution_m = 0.125;
    Scan scan;
    for (int i = 0; i < 64; ++i) {
      const double azimuth = 0.0981747704 * (i - 32);
      Beam beam;
      beam.azimuth = azimuth;
      beam.direction = {std::cos(azimuth), std::sin(azimuth), 0.0};
      beam.first_echo = static_cast<std::uint32_t>(scan.echoes.size());
      beam.echo_count = 1;
      beam.sensed_range = 2.0 + 0.03 * i;
      beam.end = BeamEnd::stopped;
      scan.beams.push_back(beam);
      scan.echoes.push_back({beam.sensed_range, 1.0f, 1.0f, 0.0f, Edge::front});
    }
    OccupancyMap home(spec);
    home.integrate(scan, Pose::planar(0.3125, 0.4375, 0.0, 0.3));
    const auto extent = home.extent();
    REQUIRE(extent);
    for (const double far : {0x1p14, 0x1p20, 0x1p27}) {
      CAPTURE(store);
      CAPTURE(far);
      OccupancyMap away(spec);
      away.integrate(scan, Pose::planar(0.3125 + far, 0.4375 - far, 0.0, 0.3));
      CHECK(away.known_cells() == home.known_cells());
      const auto shift = static_cast<std::int64_t>(far * 8.0);
      std::size_t differ = 0;
      for (std::int64_t row = extent->first.row; row < extent->second.row; ++row)
        for (std::int64_t column = extent->first.column; column < extent->second.column; ++column) {
          const CellView a = home.view({column, row}), b = away.view({column + shift, row - shift});
          differ += a.known != b.known || a.probability != b.probability || a.sensed_through != b.sensed_through;
        }
      CHECK(differ == 0);
    }
  }
}

}  // namespace thicket
