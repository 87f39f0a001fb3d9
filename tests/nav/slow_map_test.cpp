// The map's fast integrators against slow, obviously right ones.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "slow_map.hpp"

namespace thicket {
namespace {

struct Dice {
  std::mt19937 engine;
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); }
  bool chance(double of_one) { return between(0.0, 1.0) < of_one; }
  int below(int count) { return std::uniform_int_distribution<int>(0, count - 1)(engine); }
};

void add(Scan& scan, double azimuth, double elevation, const std::vector<Echo>& echoes, double sensed, BeamEnd end, bool starts_inside) {
  Beam beam;
  beam.azimuth = azimuth;
  beam.elevation = elevation;
  beam.direction = {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
  beam.first_echo = static_cast<std::uint32_t>(scan.echoes.size());
  beam.echo_count = static_cast<std::uint32_t>(echoes.size());
  beam.sensed_range = sensed;
  beam.end = end;
  beam.starts_inside = starts_inside;
  scan.beams.push_back(beam);
  scan.echoes.insert(scan.echoes.end(), echoes.begin(), echoes.end());
}

Pose somewhere(Dice& dice) { return Pose::planar(dice.between(-20.0, 20.0), dice.between(-20.0, 20.0), 0.5, dice.between(-pi, pi)); }

/// A sensor somewhere on a vehicle, which looks anywhere.
Scan mounted(Dice& dice) {
  Scan scan;
  scan.mount_position = {dice.between(-0.5, 0.5), dice.between(-0.5, 0.5), 0.3};
  scan.mount_orientation = Pose::planar(0.0, 0.0, 0.0, dice.between(-pi, pi)).orientation;
  return scan;
}

/// Beams through the open and through matter, from the open or from inside of it, level or not: fronts and backs of matter, borders of two matters, leaves.
Scan beams(Dice& dice, int count) {
  Scan scan = mounted(dice);
  for (int b = 0; b < count; ++b) {
    std::vector<Echo> echoes;
    const bool starts_inside = dice.chance(0.15);
    bool inside = starts_inside;
    double range = 0.0;
    for (int e = dice.below(5); e > 0; --e) {
      range += dice.chance(0.2) ? dice.between(0.02, 0.3) : dice.between(0.3, 1.5);  // thin walls too
      const Edge edge = inside ? (dice.chance(0.3) ? Edge::inner : Edge::back) : dice.chance(0.25) ? Edge::thin : Edge::front;
      echoes.push_back({.range = range, .amplitude = 1.0f, .edge = edge});
      inside = edge == Edge::front || edge == Edge::inner;
    }
    const bool stopped = inside && !echoes.empty() && dice.chance(0.6);
    add(scan, dice.between(-pi, pi), dice.chance(0.3) ? dice.between(-0.7, 0.7) : 0.0, echoes, stopped ? range : range + dice.between(0.1, 2.0), stopped ? BeamEnd::stopped : inside ? BeamEnd::exhausted : BeamEnd::open,
        starts_inside);
  }
  return scan;
}

/// Lobes of one opening, one in four of them silent.
Scan lobes(Dice& dice, int count) {
  Scan scan = mounted(dice);
  const double openings[] = {5.0, 30.0, 65.0, 90.0, 100.0, 180.0, 270.0, 360.0};
  scan.azimuth_opening = radians(openings[dice.below(8)]);
  for (int b = 0; b < count; ++b) {
    const double range = dice.between(0.1, 4.0), azimuth = dice.between(-pi, pi), elevation = dice.chance(0.3) ? dice.between(-0.7, 0.7) : 0.0;
    if (dice.chance(0.25)) add(scan, azimuth, elevation, {}, range, BeamEnd::open, false);
    else add(scan, azimuth, elevation, {{.range = range, .amplitude = 1.0f}}, dice.chance(0.5) ? range : range + 1.0, BeamEnd::open, false);
  }
  return scan;
}

/// Cells around a place of which anything may be known, and of one in three nothing.
ProbabilityGrid anything(Dice& dice, double resolution, const CellIndex& centre, int reach) {
  ProbabilityGrid grid;
  grid.width = grid.height = 2 * reach + 1;
  grid.resolution = resolution;
  grid.origin = glm::dvec2(static_cast<double>(centre.column - reach), static_cast<double>(centre.row - reach)) * resolution;
  for (int i = 0; i < grid.width * grid.height; ++i) {
    grid.probability.push_back(dice.chance(0.33) ? ProbabilityGrid::unknown : static_cast<float>(dice.chance(0.5) ? dice.between(0.1, 0.2) : dice.between(0.1, 0.98)));
    grid.through.push_back(dice.chance(0.1));
  }
  return grid;
}

double log_odds(const CellView& view) { return view.known ? std::log(view.probability / (1.0 - view.probability)) : 0.0; }

struct Tally {
  std::size_t told = 0, unsure = 0;  ///< cells that a scan said something of; those of them on a step of the rule
  std::size_t values = 0, known = 0, through = 0, outside = 0;  ///< cells that are not as they ought to be
};

void compare(const MapSpec& spec, const Scan& scan, const Pose& vehicle, OccupancyMap& map, Tally& tally) {
  const OccupancyMap before = map;
  map.integrate(scan, vehicle);
  const SlowScan slow(spec, scan, vehicle, before);
  constexpr double unit = 1.0 / 32.0;
  const double least = std::log(spec.clamp_low / (1.0 - spec.clamp_low)), most = std::log(spec.clamp_high / (1.0 - spec.clamp_high));
  std::size_t known_here = 0, known_before = 0;
  for (std::int64_t row = slow.low.row; row <= slow.high.row; ++row)
    for (std::int64_t column = slow.low.column; column <= slow.high.column; ++column) {
      const CellView was = before.view({column, row}), is = map.view({column, row});
      const Said& said = slow.at({column, row});
      known_here += is.known;
      known_before += was.known;
      tally.told += said.high != Said::nothing;
      tally.unsure += !said.sure();
      const auto after = [&](int evidence) { return evidence == Said::nothing ? log_odds(was) : std::clamp(log_odds(was) + evidence * unit, least, most); };
      // Nothing may be more than what is said of the free.
      const auto [lowest, highest] = said.low == Said::nothing && said.high != Said::nothing ? std::minmax({after(Said::nothing), after(said.least), after(said.high)}) : std::pair(after(said.low), after(said.high));
      tally.values += log_odds(is) < lowest - 1.01 * unit || log_odds(is) > highest + 1.01 * unit;
      tally.known += (is.known && !was.known && said.high == Said::nothing) || (!is.known && (was.known || said.low != Said::nothing));
      // Sensed through is what a beam passed inside of matter, unless another met a surface there.
      if (!said.sure()) continue;
      const bool through = said.high == Said::nothing ? was.sensed_through : said.through && said.high <= 0;
      tally.through += is.sensed_through != through;
    }
  tally.outside += map.known_cells() - known_here != before.known_cells() - known_before;
}

void check(const Tally& tally, double most_unsure) {
  CHECK(tally.told > 10000);
  CHECK(static_cast<double>(tally.unsure) <= most_unsure * static_cast<double>(tally.told));
  CHECK(tally.values == 0);
  CHECK(tally.known == 0);
  CHECK(tally.through == 0);
  CHECK(tally.outside == 0);
}

enum class Kind { sure_beams, unsure_beams, lobes };

/// Scans by dice: the first in a map where nothing is known or anything is, the next ones on what the others left.
Tally rounds_of(Kind kind, int rounds, unsigned seed) {
  Dice dice{std::mt19937(seed)};
  Tally tally;
  for (int round = 0; round < rounds; ++round) {
    MapSpec spec;
    spec.resolution_m = dice.between(0.08, 0.3);
    spec.evidence = "scans";
    spec.cell_bits = dice.chance(0.5) ? 8 : 16;
    if (dice.chance(0.3)) {
      spec.probability_hit = dice.between(0.55, 0.95);
      spec.probability_miss = dice.between(0.1, 0.48);
      spec.probability_detection = dice.between(0.1, 0.9);
      spec.lobe_share = dice.between(0.2, 1.0);
    }
    OccupancyMap map(spec);
    const Pose place = somewhere(dice);
    if (round % 2 == 1) REQUIRE(map.start_from(anything(dice, spec.resolution_m, map.cell_at(glm::dvec2(place.position)), 25)));
    const bool by_sensor = dice.chance(0.5);  // who says how sure ranges are
    for (int look = 0; look < 3; ++look) {
      Scan scan = kind == Kind::lobes ? lobes(dice, 1 + dice.below(3)) : beams(dice, 6);
      const double sigma = spec.resolution_m * (kind == Kind::sure_beams ? dice.between(0.0, 0.49) : kind == Kind::unsure_beams ? dice.between(0.5, 4.0) : dice.chance(0.4) ? 0.0 : dice.between(0.0, 3.0));
      scan.range_noise = by_sensor ? sigma : 0.7;
      if (look == 0 && !by_sensor) spec.range_sigma_m = sigma;
      if (look == 0) {
        // The map reads its keys once.
        const ProbabilityGrid known = map.to_probabilities();
        map = OccupancyMap(spec);
        if (!known.probability.empty()) REQUIRE(map.start_from(known));
      }
      compare(spec, scan, Pose::planar(place.position.x + dice.between(-0.5, 0.5), place.position.y + dice.between(-0.5, 0.5), 0.0, dice.between(-pi, pi)), map, tally);
    }
  }
  MESSAGE(tally.told << " cells told of, " << tally.unsure << " of them on a step of the rule");
  return tally;
}

}  // namespace

TEST_CASE("beams with sure ranges agree with a slow, obviously right map") { check(rounds_of(Kind::sure_beams, 300, 1), 0.002); }
TEST_CASE("beams whose ranges are not sure agree with a slow, obviously right map to a unit of evidence") { check(rounds_of(Kind::unsure_beams, 150, 2), 0.02); }
TEST_CASE("lobes agree with a slow, obviously right map to a unit of evidence") { check(rounds_of(Kind::lobes, 250, 3), 0.015); }

}  // namespace thicket
