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
    // Matter lies behind its face: half a cell of it is told of, but nothing beyond its other face.
    for (std::size_t i = 0; i < beam.echo_count; ++i) {
      const Echo& e = scan.echoes_of(beam)[i];
      const double next = i + 1 < beam.echo_count ? scan.echoes_of(beam)[i + 1].range : 1e9;
      put(from + e.range * along, Seen::occupied);
      if (e.edge != Edge::back)
        for (double range = e.range; range < std::min(e.range + 0.5 * resolution, next); range += step) put(from + range * along, Seen::occupied);
    }
  }
  return cells;
}

MapSpec spec_at(double resolution) {
  MapSpec spec;
  spec.resolution_m = resolution;
  return spec;
}

/// Every scan counts, for tests of what repeats add up to.
MapSpec every_scan() {
  MapSpec spec = spec_at(0.1);
  spec.evidence = "scans";
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
  OccupancyMap map(every_scan());
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
  OccupancyMap map(every_scan());
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
  OccupancyMap map(every_scan());
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
  spec.lobe_share = 1.0;
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

namespace {

/// A way through random scans, beams and now and then through matter.
void wander(OccupancyMap& map, int scans, unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  for (int i = 0; i < scans; ++i) {
    ScanMaker maker;
    for (int b = 0; b < 40; ++b) {
      const double range = uniform(1.0, 8.0);
      if (b % 4 == 0) maker.beam(0.15 * b, {echo(range, Edge::front), echo(range + 0.7, Edge::back)}, range + 3.0, BeamEnd::open);
      else maker.beam(0.15 * b, {echo(range, Edge::front)}, range, BeamEnd::stopped);
    }
    maker.scan.time = i;
    map.integrate(maker.scan, Pose::planar(0.3 * i, uniform(-3.0, 3.0), 0.0, uniform(-3.0, 3.0)));
  }
}

MapSpec kept_in(const char* store, int bits = 8) {
  MapSpec spec = spec_at(0.1);
  spec.store = store;
  spec.cell_bits = bits;
  return spec;
}

double log_odds(double probability) { return std::log(probability / (1.0 - probability)); }

}  // namespace

TEST_CASE("dense and tiles agree cell for cell, the quadtree within its tolerance, 8 bits with 16 to their rounding") {
  OccupancyMap tiles(kept_in("tiles")), dense(kept_in("dense")), sixteen(kept_in("tiles", 16));
  MapSpec exact_spec = kept_in("quadtree"), loose_spec = exact_spec, loose_sixteen_spec = kept_in("quadtree", 16);
  exact_spec.tolerance = 0.0;
  loose_spec.tolerance = loose_sixteen_spec.tolerance = 0.05;
  OccupancyMap exact(exact_spec), loose(loose_spec), loose_sixteen(loose_sixteen_spec);
  for (OccupancyMap* map : {&tiles, &dense, &sixteen, &exact, &loose, &loose_sixteen}) wander(*map, 60, 3);
  const auto extent = tiles.extent();
  REQUIRE(extent);
  CHECK(dense.extent() == extent);
  CHECK(tiles.known_cells() == dense.known_cells());
  CHECK(tiles.known_cells() > 10000);
  double worst = 0.0, worst_sixteen = 0.0;
  std::size_t differ = 0, off = 0;
  for (std::int64_t row = extent->first.row; row < extent->second.row; ++row)
    for (std::int64_t column = extent->first.column; column < extent->second.column; ++column) {
      const CellView a = tiles.view({column, row}), b = dense.view({column, row}), c = exact.view({column, row}), d = loose.view({column, row}), e = sixteen.view({column, row});
      differ += a.known != b.known || a.probability != b.probability || a.sensed_through != b.sensed_through || a.last_seen != b.last_seen;
      differ += a.known != c.known || a.probability != c.probability || a.sensed_through != c.sensed_through;
      differ += a.known != d.known || a.sensed_through != d.sensed_through;
      if (a.known) worst = std::max(worst, std::abs(log_odds(a.probability) - log_odds(d.probability)));
      if (e.known) worst_sixteen = std::max(worst_sixteen, std::abs(log_odds(e.probability) - log_odds(loose_sixteen.view({column, row}).probability)));
      off += a.known && std::abs(log_odds(a.probability) - log_odds(e.probability)) > 1.01 / 32.0;
    }
  CHECK(differ == 0);
  CHECK(off == 0);
  CHECK(worst > 0.0);  // something was merged
  CHECK(worst <= log_odds(0.55) + 0.5 / 32.0);
  CHECK(worst_sixteen <= 256.0 / 4096.0);  // what a byte holds of the units of 16 bits
  CHECK(exact.memory_bytes() < dense.memory_bytes());
  CHECK(loose.memory_bytes() < dense.memory_bytes());
}

TEST_CASE("memory: tiles take at most 1.3 bytes a seen cell of 8 bits from a million on, the quadtree a quarter of a dense map of a large hall") {
  const auto drive = [](OccupancyMap& map, double step, int scans) {
    // An open hall of 200 x 200 m with a few posts in rows, seen 60 m far.
    for (int i = 0; i < scans; ++i) {
      const glm::dvec2 from(20.0 + step * (i % 16), 20.0 + 20.0 * (i / 16));
      ScanMaker maker;
      for (int b = 0; b < 1440; ++b) {
        const double bearing = 2.0 * pi * b / 1440.0;
        const glm::dvec2 d(std::cos(bearing), std::sin(bearing));
        const double x = (d.x > 0.0 ? 200.0 - from.x : from.x) / std::max(1e-9, std::abs(d.x)), y = (d.y > 0.0 ? 200.0 - from.y : from.y) / std::max(1e-9, std::abs(d.y)), range = std::min(x, y);
        if (range < 60.0) maker.beam(bearing, {echo(range, Edge::front)}, range, BeamEnd::stopped);
        else maker.beam(bearing, {}, 60.0, BeamEnd::open);
      }
      map.integrate(maker.scan, Pose::planar(from.x, from.y, 0.0, 0.0));
    }
  };
  OccupancyMap tiles(kept_in("tiles")), quadtree(kept_in("quadtree"));
  for (OccupancyMap* map : {&tiles, &quadtree}) drive(*map, 10.0, 144);
  const double seen = static_cast<double>(tiles.known_cells()), per_cell = static_cast<double>(tiles.memory_bytes()) / seen, share = static_cast<double>(quadtree.memory_bytes()) / (2000.0 * 2000.0);  // a dense map of bytes
  MESSAGE("bytes a seen cell: " << per_cell << " of " << seen << "; quadtree over dense: " << share);
  CHECK(seen > 1e6);
  CHECK(per_cell <= 1.3);
  CHECK(share <= 0.25);
}

TEST_CASE("repeats of a view add no certainty, with the same noise or with fresh; a changed one counts within 20 scans") {
  const Pose pose = Pose::planar(0.05, 0.05, 0.0, 0.0);
  std::mt19937 random(5);
  for (const bool fresh : {false, true}) {
    CAPTURE(fresh);
    OccupancyMap map(spec_at(0.1));
    const auto look = [&](double range) {
      ScanMaker maker;
      maker.beam(0.0, {echo(range, Edge::front)}, range, BeamEnd::stopped);
      map.integrate(maker.scan, pose);
    };
    const auto near = [&](double range) { return fresh ? range + std::normal_distribution<double>(0.0, 0.01)(random) : range; };
    look(near(1.0));
    const CellView once = map.view({5, 0});
    for (int i = 0; i < 500; ++i) {
      // What one look in fifty makes up is never taken in.
      look(i % 50 == 49 ? 0.5 : near(1.0));
      CHECK(map.view({5, 0}).probability == once.probability);
    }
    CHECK(map.view({10, 0}).probability < 0.71);
    CHECK(map.view({10, 0}).probability > 0.69);
    for (int i = 0; i < 20; ++i) look(near(0.5));
    CHECK(map.view({5, 0}).probability > 0.5);
    for (int i = 0; i < 20; ++i) look(near(2.0));
    CHECK(map.view({5, 0}).probability < 0.5);
    CHECK(map.view({10, 0}).probability < 0.5);
  }
}

TEST_CASE("an update makes a copy of the earlier map a copy of the later one, and is small where little changed") {
  for (const char* store : {"tiles", "dense", "quadtree"}) {
    CAPTURE(store);
    OccupancyMap map(kept_in(store));
    wander(map, 30, 4);
    OccupancyMap copy = map, earlier = map;
    CHECK(map.changes_since(earlier).size() < 16);
    wander(map, 2, 5);
    const auto update = map.changes_since(earlier);
    CHECK(update.size() > 100);
    CHECK(update.size() < map.known_cells());
    REQUIRE(copy.apply_changes(update));
    const ProbabilityGrid a = map.to_probabilities(), b = copy.to_probabilities();
    REQUIRE(a.probability.size() == b.probability.size());
    std::size_t differ = 0;
    for (std::size_t i = 0; i < a.probability.size(); ++i) differ += a.known(i) != b.known(i) || a.sensed_through(i) != b.sensed_through(i) || (a.known(i) && std::abs(a.probability[i] - b.probability[i]) > 0.01f);
    CHECK(differ == 0);
    CHECK_FALSE(copy.apply_changes(std::span(update).first(update.size() - 1)));
    CHECK_FALSE(copy.apply_changes(std::span(update).subspan(1)));
  }
}

TEST_CASE("the squares that changed, drawn over a picture of the earlier map, are a picture of the later one, and back") {
  for (const char* store : {"tiles", "dense", "quadtree"})
    for (const int bits : {8, 16}) {
      CAPTURE(store);
      CAPTURE(bits);
      MapSpec spec;
      spec.store = store;
      spec.cell_bits = bits;
      spec.evidence = "scans";
      OccupancyMap map(spec);
      const auto look = [&](double x) {
        ScanMaker maker;
        for (int i = 0; i < 40; ++i) maker.beam(0.15 * i, {echo(3.0 + 0.05 * i, Edge::front), echo(3.6 + 0.05 * i, Edge::back)}, 6.0, BeamEnd::open);
        map.integrate(maker.scan, Pose::planar(x, 0.4, 0.0, 0.1));
      };
      std::map<std::pair<std::int64_t, std::int64_t>, CellLook> picture;
      int squares = 0;
      const auto paint = [&](const CellIndex& corner, std::span<const CellLook> looks) {
        ++squares;
        for (std::size_t i = 0; i < looks.size(); ++i) picture[{corner.column + static_cast<std::int64_t>(i % 64), corner.row + static_cast<std::int64_t>(i / 64)}] = looks[i];
      };
      const auto check = [&](const OccupancyMap& of) {
        std::size_t known = 0, wrong = 0;
        for (const auto& [cell, seen] : picture) {
          const CellIndex index{cell.first, cell.second};
          const CellView view = of.view(index);
          known += seen.known;
          wrong += seen.known != view.known || seen.sensed_through != view.sensed_through || seen.surely_free != of.surely_free(index) || (view.known && std::abs(seen.probability / 255.0 - view.probability) > 0.012);
        }
        CHECK(wrong == 0);
        CHECK(known == of.known_cells());
      };
      look(0.0);
      const OccupancyMap first = map;
      first.changed_tiles(nullptr, paint);
      check(first);
      const int all = squares;
      squares = 0;
      map.changed_tiles(&first, paint);
      CHECK(squares == 0);
      look(40.0);
      map.changed_tiles(&first, paint);
      CHECK(squares > 0);
      CHECK(squares <= all + 4);
      check(map);
      first.changed_tiles(&map, paint);
      check(first);
    }
}

TEST_CASE("a map can begin with what another knew, on the same grid") {
  OccupancyMap first(spec_at(0.1)), second(spec_at(0.1)), coarse(spec_at(0.2));
  wander(first, 20, 6);
  const ProbabilityGrid known = first.to_probabilities();
  REQUIRE(second.start_from(known));
  CHECK(second.known_cells() == first.known_cells());
  CHECK(second.changes_since(first).size() < 16);
  CHECK_FALSE(coarse.start_from(known));
  ProbabilityGrid aside = known;
  aside.origin.x += 0.03;
  const auto refused = second.start_from(aside);
  REQUIRE_FALSE(refused);
  CHECK(refused.error().message.find("multiple") != std::string::npos);
}

TEST_CASE("a lobe frees all of its opening, and of its arc what other looks left over becomes matter") {
  OccupancyMap map(spec_at(0.1));
  const auto look = [&](const glm::dvec2& from, double yaw, std::vector<Echo> echoes, double sensed) {
    ScanMaker maker;
    maker.scan.azimuth_opening = radians(60.0);
    maker.scan.range_noise = 0.05;
    maker.beam(0.0, std::move(echoes), sensed, BeamEnd::open);
    map.integrate(maker.scan, Pose::planar(from.x, from.y, 0.0, yaw));
  };
  look({0.05, 0.05}, 0.0, {echo(3.0, Edge::front)}, 3.0);
  CHECK(map.view(map.cell_at({1.5, 0.5})).probability < 0.5);
  CHECK(map.view(map.cell_at({1.5, -0.5})).probability < 0.5);
  CHECK_FALSE(map.view(map.cell_at({1.5, 1.2})).known);  // outside of the opening
  CHECK_FALSE(map.view(map.cell_at({3.5, 0.0})).known);  // behind the arc
  CHECK_FALSE(map.view(map.cell_at({3.0, 0.0})).probability > 0.6);  // one of many
  // A post at (3, 0) seen from elsewhere: arcs that cross there.
  for (int i = 0; i < 30; ++i) {
    const double angle = -1.0 + 2.0 * i / 29.0;
    const glm::dvec2 from = glm::dvec2(3.0, 0.0) - 3.0 * direction(angle);
    look(from, angle + 0.15, {echo(3.0, Edge::front)}, 3.0);
    look(from, angle - 0.15, {echo(3.0, Edge::front)}, 3.0);
  }
  CHECK(std::max(map.view(map.cell_at({3.0, 0.0})).probability, map.view(map.cell_at({2.99, -0.01})).probability) > 0.5);
  CHECK(map.view(map.cell_at({2.0, 0.0})).probability < 0.2);
}

}  // namespace thicket
