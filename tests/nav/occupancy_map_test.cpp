#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <random>

#include <glm/geometric.hpp>

#include "thicket/nav/occupancy_map.hpp"

namespace thicket {
namespace {

/// A scan with one beam per given list of echoes, from a sensor at the vehicle's origin.
struct ScanMaker {
  Scan scan;
  void beam(double azimuth, std::vector<Echo> echoes, double sensed, BeamEnd end) {
    Beam beam;
    beam.azimuth = azimuth;
    beam.direction = {std::cos(azimuth), std::sin(azimuth), 0.0};
    beam.first_echo = static_cast<std::uint32_t>(scan.echoes.size());
    beam.echo_count = static_cast<std::uint32_t>(echoes.size());
    beam.sensed_range = sensed;
    beam.end = end;
    scan.beams.push_back(beam);
    scan.echoes.insert(scan.echoes.end(), echoes.begin(), echoes.end());
  }
};

Echo echo(double range, Edge edge) { return {range, 1.0f, 1.0f, 0.0f, edge}; }

enum class Seen { nothing, free, through, occupied };

/// Slow and obviously right: walks each beam in steps of a hundredth of a cell and asks what the middle of each step is.
std::map<std::pair<std::int64_t, std::int64_t>, Seen> slow_picture(const Scan& scan, const Pose& vehicle, double resolution) {
  std::map<std::pair<std::int64_t, std::int64_t>, Seen> cells;
  const auto put = [&](const glm::dvec2& p, Seen seen) {
    auto& cell = cells[{static_cast<std::int64_t>(std::floor(p.x / resolution)), static_cast<std::int64_t>(std::floor(p.y / resolution))}];
    cell = std::max(cell, seen);
  };
  for (const Beam& beam : scan.beams) {
    const glm::dvec2 along(vehicle.orientation * beam.direction), from(vehicle.position);
    const double step = 0.01 * resolution;
    for (double range = 0.5 * step; range < beam.sensed_range; range += step) {
      bool inside = beam.starts_inside;
      for (const Echo& e : scan.echoes_of(beam))
        if (e.range <= range) inside = e.edge != Edge::back;
      put(from + range * along, inside ? Seen::through : Seen::free);
    }
    for (const Echo& e : scan.echoes_of(beam)) put(from + e.range * along, Seen::occupied);
  }
  return cells;
}

MapSpec spec_at(double resolution) {
  MapSpec spec;
  spec.resolution_m = resolution;
  return spec;
}

}  // namespace

TEST_CASE("a beam leaves free cells before its echo, an occupied one at it, and nothing behind") {
  OccupancyMap map(spec_at(0.1));
  ScanMaker maker;
  maker.beam(0.0, {echo(1.05, Edge::front)}, 1.05, BeamEnd::stopped);
  map.integrate(maker.scan, Pose::planar(0.05, 0.05, 0.0, 0.0));
  for (int column = 0; column <= 10; ++column) {
    const CellView view = map.view({column, 0});
    CHECK(view.known);
    CHECK(view.probability == doctest::Approx(0.4).epsilon(0.02));
    CHECK_FALSE(view.sensed_through);
  }
  CHECK(map.view({11, 0}).probability == doctest::Approx(0.7).epsilon(0.02));
  CHECK_FALSE(map.view({12, 0}).known);
  CHECK_FALSE(map.view({5, 1}).known);
  CHECK(map.known_cells() == 12);
}

TEST_CASE("between the edges of matter cells are sensed through, behind its back they are free again, behind an exhausted end unknown") {
  OccupancyMap map(spec_at(0.1));
  ScanMaker maker;
  maker.beam(0.0, {echo(0.5, Edge::front), echo(1.0, Edge::back), echo(1.5, Edge::front)}, 1.8, BeamEnd::exhausted);
  map.integrate(maker.scan, Pose::planar(0.05, 0.05, 0.0, 0.0));
  CHECK(map.view({3, 0}).probability < 0.5);
  CHECK_FALSE(map.view({3, 0}).sensed_through);
  CHECK(map.view({5, 0}).probability > 0.5);   // front
  CHECK(map.view({7, 0}).sensed_through);      // inside
  CHECK(map.view({7, 0}).probability < 0.5);
  CHECK(map.view({10, 0}).probability > 0.5);  // back
  CHECK_FALSE(map.view({12, 0}).sensed_through);
  CHECK(map.view({12, 0}).probability < 0.5);  // open again
  CHECK(map.view({15, 0}).probability > 0.5);  // the second front
  CHECK(map.view({17, 0}).sensed_through);
  CHECK_FALSE(map.view({19, 0}).known);
}

TEST_CASE("a surface exactly on the border of two cells is matter in the cell behind it") {
  OccupancyMap map(spec_at(0.1));
  ScanMaker maker;
  for (const double jitter : {0.0, 1e-15, -1e-15}) maker.beam(0.0, {echo(1.0 + jitter, Edge::front)}, 1.0 + jitter, BeamEnd::stopped);
  map.integrate(maker.scan, Pose::planar(0.0, 0.05, 0.0, 0.0));
  CHECK(map.view({10, 0}).probability > 0.5);
  CHECK(map.view({9, 0}).probability < 0.5);
  CHECK_FALSE(map.view({11, 0}).known);
}

TEST_CASE("one scan updates a cell once, and occupied wins") {
  OccupancyMap map(spec_at(0.1));
  ScanMaker maker;
  for (int i = 0; i < 50; ++i) maker.beam(0.0005 * i, {echo(1.05, Edge::front)}, 1.05, BeamEnd::stopped);
  maker.beam(0.0, {}, 3.0, BeamEnd::open);  // goes through the cell that the others hit
  map.integrate(maker.scan, Pose::planar(0.05, 0.05, 0.0, 0.0));
  CHECK(map.view({5, 0}).probability == doctest::Approx(0.4).epsilon(0.02));
  CHECK(map.view({11, 0}).probability == doctest::Approx(0.7).epsilon(0.02));
}

TEST_CASE("log-odds are clamped and the map can change its mind") {
  OccupancyMap map(spec_at(0.1));
  ScanMaker hit, miss;
  hit.beam(0.0, {echo(1.05, Edge::front)}, 1.05, BeamEnd::stopped);
  miss.beam(0.0, {}, 3.0, BeamEnd::open);
  const Pose pose = Pose::planar(0.05, 0.05, 0.0, 0.0);
  for (int i = 0; i < 1000; ++i) map.integrate(hit.scan, pose);
  CHECK(map.view({11, 0}).probability == doctest::Approx(0.971).epsilon(0.005));
  CHECK(map.view({5, 0}).probability == doctest::Approx(0.1192).epsilon(0.01));
  CHECK(map.surely_free({5, 0}));
  for (int i = 0; i < 10; ++i) map.integrate(miss.scan, pose);
  CHECK(map.view({11, 0}).probability < 0.5);
}

TEST_CASE("the map agrees with a slow, obviously right one on random scans") {
  std::mt19937 random(7);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  for (int round = 0; round < 40; ++round) {
    const double resolution = uniform(0.05, 0.3);
    const Pose vehicle = Pose::planar(uniform(-20.0, 20.0), uniform(-20.0, 20.0), 0.0, uniform(-3.0, 3.0));
    ScanMaker maker;
    for (int b = 0; b < 8; ++b) {
      std::vector<Echo> echoes;
      double range = 0.0;
      const int count = static_cast<int>(uniform(0.0, 4.0));
      for (int e = 0; e < count; ++e) {
        range += uniform(0.3, 2.0);
        echoes.push_back(echo(range, e % 2 ? Edge::back : Edge::front));
      }
      const bool stopped = count % 2 == 1;
      maker.beam(uniform(-3.0, 3.0), echoes, stopped ? range : range + uniform(0.1, 2.0), stopped ? BeamEnd::stopped : BeamEnd::open);
    }
    OccupancyMap map(spec_at(resolution));
    map.integrate(maker.scan, vehicle);
    const auto expected = slow_picture(maker.scan, vehicle, resolution);
    std::size_t different = 0;
    for (const auto& [index, seen] : expected) {
      const CellView view = map.view({index.first, index.second});
      const Seen found = !view.known ? Seen::nothing : view.probability > 0.5 ? Seen::occupied : view.sensed_through ? Seen::through : Seen::free;
      different += found != seen;
    }
    // A cell may differ where a beam clips its corner by less than a step of the slow walk, or where a stretch ends on its border.
    CHECK(different <= 2 + expected.size() / 50);
    CHECK(map.known_cells() <= expected.size() + 2 + expected.size() / 50);
    CHECK(map.known_cells() + 2 + expected.size() / 50 >= expected.size());
  }
}

TEST_CASE("a copy shares tiles and does not see later writes") {
  OccupancyMap map(spec_at(0.1));
  ScanMaker maker;
  maker.beam(0.0, {echo(1.05, Edge::front)}, 1.05, BeamEnd::stopped);
  const Pose pose = Pose::planar(0.05, 0.05, 0.0, 0.0);
  map.integrate(maker.scan, pose);
  const OccupancyMap copy = map;
  for (int i = 0; i < 20; ++i) map.integrate(maker.scan, pose);
  CHECK(copy.view({11, 0}).probability == doctest::Approx(0.7).epsilon(0.02));
  CHECK(map.view({11, 0}).probability > 0.9);
}

TEST_CASE("cells far out and below zero have their own place, and memory follows what was seen") {
  OccupancyMap map(spec_at(0.1));
  ScanMaker maker;
  maker.beam(0.0, {echo(1.0, Edge::front)}, 1.0, BeamEnd::stopped);
  map.integrate(maker.scan, Pose::planar(-1000.05, -2000.05, 0.0, 0.0));
  const std::size_t one = map.memory_bytes();
  map.integrate(maker.scan, Pose::planar(50000.05, 70000.05, 0.0, 0.0));
  CHECK(map.view(map.cell_at({-999.05, -2000.05})).probability > 0.5);
  CHECK(map.view(map.cell_at({50001.05, 70000.05})).probability > 0.5);
  CHECK(map.memory_bytes() <= 2 * one + 8192);
}

TEST_CASE("for map_server the map is trinary, and what was sensed through stays unknown") {
  OccupancyMap map(spec_at(0.1));
  ScanMaker maker;
  maker.beam(0.0, {echo(0.5, Edge::front), echo(1.0, Edge::back)}, 1.5, BeamEnd::open);
  for (int i = 0; i < 10; ++i) map.integrate(maker.scan, Pose::planar(0.05, 0.05, 0.0, 0.0));
  const GridMap grid = map.to_grid();
  CHECK(grid.height == 1);
  CHECK(grid.origin.x == doctest::Approx(0.0));
  CHECK(grid.at(2, 0) == CellState::free);
  CHECK(grid.at(5, 0) == CellState::occupied);
  CHECK(grid.at(7, 0) == CellState::unknown);
  CHECK(grid.at(12, 0) == CellState::free);
}

TEST_CASE("a beam with an opening is free up to its echo and occupied along the whole arc") {
  ScanMaker maker;
  maker.scan.azimuth_opening = pi / 2;
  maker.beam(0.0, {echo(2.0, Edge::front)}, 2.0, BeamEnd::stopped);
  MapSpec spec;
  spec.resolution_m = 0.1;
  OccupancyMap map(spec);
  map.integrate(maker.scan, Pose{});
  for (const double bearing : {-0.7, -0.3, 0.0, 0.2, 0.75}) {
    CAPTURE(bearing);
    for (double r = 0.15; r < 1.8; r += 0.05) {
      const CellView cell = map.view(map.cell_at(r * direction(bearing)));
      CHECK(cell.known);
      CHECK(cell.probability < 0.5);
    }
    CHECK(map.view(map.cell_at(2.03 * direction(bearing))).probability + map.view(map.cell_at(1.97 * direction(bearing))).probability > 0.9);
    CHECK_FALSE(map.view(map.cell_at(2.3 * direction(bearing))).known);
  }
  for (const double bearing : {-1.0, 1.0, 3.0}) CHECK_FALSE(map.view(map.cell_at(1.0 * direction(bearing))).known);
}

TEST_CASE("behind a thin echo it is open again") {
  ScanMaker maker;
  maker.beam(0.0, {echo(1.05, Edge::thin), echo(2.05, Edge::front)}, 2.05, BeamEnd::stopped);
  OccupancyMap map(MapSpec{});
  map.integrate(maker.scan, Pose{});
  CHECK(map.view(map.cell_at({1.06, 0.0})).probability > 0.5);
  CHECK(map.view(map.cell_at({1.55, 0.0})).probability < 0.5);
  CHECK_FALSE(map.view(map.cell_at({1.55, 0.0})).sensed_through);
}

}  // namespace thicket
