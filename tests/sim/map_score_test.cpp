// Scores computed by hand, and by brute force.
#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "distance_rows.hpp"
#include "thicket/sim/map_score.hpp"

namespace thicket {
namespace {

/// A truth of one character a cell, the top row first: '#' solid, 'p' penetrable, anything else free.
MapTruth truth_of(const std::vector<std::string>& rows, double resolution = 0.1, const glm::dvec2& low = {0.0, 0.0}) {
  MapTruth truth;
  truth.solid.resolution = resolution;
  truth.solid.low = low;
  truth.solid.width = static_cast<int>(rows.at(0).size());
  truth.solid.height = static_cast<int>(rows.size());
  for (auto row = rows.rbegin(); row != rows.rend(); ++row)
    for (const char c : *row) {
      truth.solid.blocked.push_back(c == '#');
      truth.penetrable.push_back(c == 'p');
    }
  return truth;
}

/// A map the same way: 0...9 are tenths of a probability, anything else is unknown.
ProbabilityGrid map_of(const std::vector<std::string>& rows, double resolution = 0.1, const glm::dvec2& origin = {0.0, 0.0}) {
  ProbabilityGrid map{static_cast<int>(rows.at(0).size()), static_cast<int>(rows.size()), resolution, origin, {}, {}};
  for (auto row = rows.rbegin(); row != rows.rend(); ++row)
    for (const char c : *row) map.probability.push_back(c >= '0' && c <= '9' ? 0.1f * static_cast<float>(c - '0') : ProbabilityGrid::unknown);
  return map;
}

MapScore score(const ProbabilityGrid& map, const MapTruth& truth, double tolerance = 0.2) {
  const auto result = score_map(map, truth, tolerance);
  REQUIRE_MESSAGE(static_cast<bool>(result), (result ? "" : result.error().message));
  return *result;
}

doctest::Approx about(double value) { return doctest::Approx(value).epsilon(1e-6); }

}  // namespace

TEST_CASE("a perfect map has a perfect score, and deep cells are not asked for") {
  const MapTruth truth = truth_of({".....", ".###.", ".###.", ".###.", "....."});
  const MapScore s = score(map_of({"11111", "19991", "19?91", "19991", "11111"}), truth, 0.0);
  CHECK(s.judged == 24);  // 25 without the one in the middle of the block
  CHECK(s.observed == 24);
  CHECK(s.coverage == 1.0);
  CHECK(s.claimed == 8);
  CHECK(s.surface == 8);
  CHECK(s.f1 == 1.0);
  CHECK(s.strict_precision == 1.0);
  CHECK(s.strict_recall == 1.0);
  CHECK(s.edge_error_m == 0.0);
  CHECK(s.edge_error_95_m == 0.0);
  CHECK(s.claimed_mean_p == about(0.9));
  CHECK(s.claimed_nll == about(-std::log(0.9)));
  CHECK(s.nll == about(-std::log(0.9)));  // both 0.9 for matter and 1 - 0.1 for none
}

TEST_CASE("the tolerance decides how far off a claim may be, and cells exactly at it are within") {
  const MapTruth truth = truth_of({"......#"});
  const ProbabilityGrid two_off = map_of({"1111811"});
  CHECK(score(two_off, truth, 0.2).f1 == 1.0);
  CHECK(score(two_off, truth, 0.2).strict_precision == 0.0);
  CHECK(score(two_off, truth, 0.2).strict_recall == 0.0);
  CHECK(score(two_off, truth, 0.19).f1 == 0.0);
  CHECK(score(two_off, truth).edge_error_m == about(0.2));
  CHECK(score(two_off, truth).edge_error_95_m == about(0.2));
  // The same at another size of cells, whose multiples are not exact: 4 cells of 0.05 m, 0.6 m of 0.2 m.
  CHECK(score(map_of({"81111"}, 0.05), truth_of({"....#"}, 0.05), 0.2).f1 == 1.0);
  CHECK(score(map_of({"8111"}, 0.2), truth_of({"...#"}, 0.2), 0.6).f1 == 1.0);
  CHECK(score(map_of({"8111"}, 0.2), truth_of({"...#"}, 0.2), 0.59).f1 == 0.0);
}

TEST_CASE("precision and recall, strict and tolerant, and NLL, by hand") {
  //                                          surface at columns 2 and 9; claims at 2 (0.9), 5 (0.8) and 8 (0.6); column 0 is unknown
  const MapTruth truth = truth_of({"..#......#"});
  const MapScore s = score(map_of({"?1911811" "61"}), truth, 0.1);
  CHECK(s.judged == 10);
  CHECK(s.observed == 9);
  CHECK(s.coverage == about(0.9));
  CHECK(s.claimed == 3);
  CHECK(s.surface == 2);
  CHECK(s.precision == about(2.0 / 3.0));
  CHECK(s.recall == 1.0);
  CHECK(s.f1 == about(0.8));
  CHECK(s.strict_precision == about(1.0 / 3.0));
  CHECK(s.strict_recall == about(0.5));
  CHECK(s.strict_f1 == about(0.4));
  CHECK(s.claimed_mean_p == about((0.9 + 0.8 + 0.6) / 3.0));
  CHECK(s.claimed_nll == about(-(std::log(0.9) + std::log(0.2) + std::log(0.4)) / 3.0));
  CHECK(s.nll == about(-(6.0 * std::log(0.9) + std::log(0.2) + std::log(0.4) + std::log(0.1)) / 9.0));
  // Claims are 0, 3 and 1 cells from surfaces, surfaces 0 and 1 from claims.
  CHECK(s.edge_error_m == about(0.1 * 0.5 * (4.0 / 3.0 + 0.5)));
  CHECK(s.edge_error_95_m == about(0.3));
}

TEST_CASE("0.5 claims nothing, and an unknown surface is neither missed nor a help") {
  const MapTruth truth = truth_of({"#....#"});
  const MapScore half = score(map_of({"5....."}), truth);
  CHECK(half.claimed == 0);
  CHECK(half.surface == 1);
  CHECK(half.f1 == 0.0);
  CHECK(half.recall == 0.0);
  CHECK(std::isnan(half.precision));
  CHECK(std::isnan(half.claimed_nll));
  CHECK(std::isnan(half.edge_error_m));
  CHECK(std::isnan(half.edge_error_95_m));
  // The right one is not known: a claim beside it is 4 cells from the left one.
  const MapScore beside = score(map_of({"9...9?"}), truth);
  CHECK(beside.precision == 0.5);
  CHECK(beside.recall == 1.0);
}

TEST_CASE("an empty map, one of which nothing is known, and a truth without matter") {
  const MapTruth truth = truth_of({"..#..", "....."});
  for (const ProbabilityGrid& map : {ProbabilityGrid{}, map_of({"?????", "?????"})}) {
    const MapScore s = score(map, truth);
    CHECK(s.coverage == 0.0);
    CHECK(s.judged == 10);
    CHECK(s.claimed == 0);
    CHECK(std::isnan(s.f1));
    CHECK(std::isnan(s.strict_precision));
    CHECK(std::isnan(s.nll));
  }
  const MapScore open = score(map_of({"19"}), truth_of({".."}));
  CHECK(open.precision == 0.0);
  CHECK(open.f1 == 0.0);
  CHECK(std::isnan(open.edge_error_m));
  CHECK(open.claimed_nll == about(-std::log(0.1)));
}

TEST_CASE("penetrable matter is not judged, and echoes of it are no one's fault") {
  const MapTruth truth = truth_of({"..pp......#"});
  //                                 noise before it, its face, its inside, a claim too far from it, the wall
  const MapScore s = score(map_of({"19921181119"}), truth);
  CHECK(s.judged == 9);
  CHECK(s.claimed == 2);  // columns 6 and 10; 1 and 2 are forgiven
  CHECK(s.precision == 0.5);
  CHECK(s.strict_precision == about(1.0 / 3.0));  // to the cell, column 1 is free
  // A wall right behind it is a surface, and claims of it count.
  const MapScore behind = score(map_of({"?999"}), truth_of({".p##"}));
  CHECK(behind.surface == 1);
  CHECK(behind.claimed == 3);  // all are within 0.2 m of the wall
  CHECK(behind.precision == 1.0);
  CHECK(behind.strict_precision == 1.0);
}

TEST_CASE("maps are laid on the truth where they are; what lies outside is not judged") {
  const MapTruth truth = truth_of({"....", ".#..", "...."}, 0.1, {-0.2, 5.0});
  const MapScore s = score(map_of({"999", "199", "199"}, 0.1, {-0.3, 5.1}), truth, 0.0);
  // Columns 0...1 and rows 1...2 of the truth: of the map the right two columns and the lower two rows.
  CHECK(s.judged == 12);
  CHECK(s.observed == 4);
  CHECK(s.claimed == 4);
  CHECK(s.surface == 1);
  CHECK(s.strict_precision == 0.25);

  MapTruth bounded = truth;
  bounded.bounds = {-0.2, 5.1, 0.0, 5.3};
  CHECK(score(map_of({"999", "199", "199"}, 0.1, {-0.3, 5.1}), bounded).coverage == 1.0);

  const auto size = score_map(map_of({"1"}, 0.2), truth);
  REQUIRE_FALSE(size);
  CHECK(size.error().message.find("0.2 m") != std::string::npos);
  const auto lines = score_map(map_of({"1"}, 0.1, {0.05, 5.0}), truth);
  REQUIRE_FALSE(lines);
  CHECK(lines.error().message.find("whole numbers") != std::string::npos);
}

TEST_CASE("distances are those of brute force") {
  CHECK(rc::check([] {
    const int width = *rc::gen::inRange(1, 24), height = *rc::gen::inRange(1, 24), rarity = *rc::gen::inRange(1, 60);
    std::vector<std::uint8_t> marked(static_cast<std::size_t>(width * height));
    for (auto& cell : marked) cell = *rc::gen::inRange(0, rarity) == 0;
    DistanceRows rows(marked, width, height);
    for (int row = 0; row < height; ++row) {
      const auto squares = rows.squares(row);
      for (int column = 0; column < width; ++column) {
        std::int64_t least = -1;
        for (int y = 0; y < height; ++y)
          for (int x = 0; x < width; ++x)
            if (marked[static_cast<std::size_t>(y * width + x)]) {
              const std::int64_t square = (x - column) * (x - column) + (y - row) * (y - row);
              if (least < 0 || square < least) least = square;
            }
        RC_ASSERT(squares[static_cast<std::size_t>(column)] == least);
      }
    }
  }));
}

TEST_CASE("scores are those of brute force") {
  CHECK(rc::check([] {
    const int width = *rc::gen::inRange(1, 16), height = *rc::gen::inRange(1, 16);
    const double tolerance = 0.1 * *rc::gen::inRange(0, 4);
    std::vector<std::string> truth_rows(static_cast<std::size_t>(height)), map_rows(static_cast<std::size_t>(height));
    for (auto& row : truth_rows) row = *rc::gen::container<std::string>(static_cast<std::size_t>(width), rc::gen::elementOf(std::string("....##")));
    for (auto& row : map_rows) row = *rc::gen::container<std::string>(static_cast<std::size_t>(width), rc::gen::elementOf(std::string("??11248")));
    const MapTruth truth = truth_of(truth_rows);
    const ProbabilityGrid map = map_of(map_rows);
    const auto result = score_map(map, truth, tolerance);
    RC_ASSERT(static_cast<bool>(result));

    const auto blocked = [&](int x, int y) { return x >= 0 && y >= 0 && x < width && y < height ? truth.solid.blocked[map.index(x, y)] : std::uint8_t{1}; };
    struct Cell {
      int x, y;
    };
    std::vector<Cell> claimed, surface;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        bool beside = false;
        for (int b = -1; b <= 1; ++b)
          for (int a = -1; a <= 1; ++a) beside = beside || !blocked(x + a, y + b);
        if (std::isgreater(map.probability[map.index(x, y)], 0.5f)) claimed.push_back({x, y});
        if (blocked(x, y) && beside && map.known(map.index(x, y))) surface.push_back({x, y});
      }
    double sum = 0.0;
    std::vector<double> all;
    const auto near = [&](const std::vector<Cell>& of, const std::vector<Cell>& from) {
      std::size_t within = 0;
      sum = 0.0;
      for (const Cell& c : of) {
        double least = infinity;
        for (const Cell& d : from) least = std::min(least, 0.1 * std::hypot(c.x - d.x, c.y - d.y));
        within += least <= tolerance + 1e-9;
        sum += least;
        all.push_back(least);
      }
      return within;
    };
    RC_ASSERT(result->claimed == claimed.size());
    RC_ASSERT(result->surface == surface.size());
    const auto is = [](double a, double b) { return std::abs(a - b) < 1e-6; };
    if (claimed.empty() || surface.empty()) {
      RC_ASSERT(std::isnan(result->edge_error_m));
      RC_ASSERT(claimed.empty() == std::isnan(result->precision));
      return;
    }
    RC_ASSERT(is(result->precision, static_cast<double>(near(claimed, surface)) / static_cast<double>(claimed.size())));
    double mean = 0.5 * sum / static_cast<double>(claimed.size());
    RC_ASSERT(is(result->recall, static_cast<double>(near(surface, claimed)) / static_cast<double>(surface.size())));
    mean += 0.5 * sum / static_cast<double>(surface.size());
    RC_ASSERT(is(result->edge_error_m, mean));
    std::sort(all.begin(), all.end());
    RC_ASSERT(is(result->edge_error_95_m, all[(95 * all.size() + 99) / 100 - 1]));
  }));
}

}  // namespace thicket
