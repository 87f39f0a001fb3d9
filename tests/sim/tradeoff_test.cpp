// `thicket tradeoff`: the front, intervals, knobs, errors, and a short study whose missions read back and end the same.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "program_call.hpp"
#include "thicket/sim/tradeoff.hpp"
#include "tradeoff_parts.hpp"

namespace thicket {
namespace {

const TradePoint* point_of(const Tradeoff& study, const std::string& name) {
  const auto found = std::ranges::find(study.points, name, &TradePoint::name);
  return found == study.points.end() ? nullptr : &*found;
}

/// A scan of one sensor whose beams have at most one echo; a range below 0 is none.
Scan scan_of(const std::vector<std::pair<double, double>>& azimuth_and_range, float amplitude) {
  Scan scan;
  for (const auto& [azimuth, range] : azimuth_and_range) {
    Beam beam;
    beam.azimuth = azimuth;
    beam.first_echo = static_cast<std::uint32_t>(scan.echoes.size());
    beam.echo_count = range >= 0.0;
    scan.beams.push_back(beam);
    if (range < 0.0) continue;
    scan.echoes.emplace_back();
    scan.echoes.back().range = range;
    scan.echoes.back().amplitude = amplitude;
  }
  return scan;
}

}  // namespace

TEST_CASE("the Pareto front holds what nothing beats in both") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  // Cheapest; beaten by it; on the front; equal to that one; most accurate; dearer and no better than that; another verdict.
  const std::vector<bool> front = pareto_front({{0.5, 9.0}, {0.6, 9.0}, {1.0, 3.0}, {1.0, 3.0}, {4.0, 0.0}, {5.0, 0.0}, {0.1, nan}});
  CHECK(front == std::vector<bool>{true, false, true, false, true, false, false});
  CHECK(pareto_front({}).empty());
}

TEST_CASE("a mean of ratios is geometric, and its interval holds it, is repeatable and shrinks with more ratios") {
  CHECK(mean_ratio({2.0, 0.5}, 1).value == doctest::Approx(1.0));
  CHECK(std::isnan(mean_ratio({2.0}, 1).low));
  CHECK(std::isnan(mean_ratio({}, 1).value));
  std::vector<double> few = {1.0, 1.1, 1.2, 1.3}, many;
  for (int i = 0; i < 16; ++i) many.insert(many.end(), few.begin(), few.end());
  const Interval a = mean_ratio(few, 7), b = mean_ratio(many, 7);
  CHECK(a.low >= 1.0);
  CHECK(a.low < a.value);
  CHECK(a.value < a.high);
  CHECK(a.high <= 1.3);
  CHECK(b.high - b.low < 0.5 * (a.high - a.low));
  CHECK(mean_ratio(few, 7).low == a.low);
}

TEST_CASE("a coarse scan loses what lies between its beams") {
  const Scan reference = scan_of({{0.0, 4.0}, {0.1, 4.0}, {0.2, 2.0}, {0.3, -1.0}}, 1.0f), coarse = scan_of({{0.0, 4.0}, {0.21, 2.5}}, 0.5f);
  TradeError error;
  compare_scans({reference}, {coarse}, error);
  // Beams 0 and 1 see beam 0; 2 and 3 see the one at 0.21, which has an echo where the reference's last has none.
  CHECK(error.disagreement == doctest::Approx(0.25));
  CHECK(error.range_rmse_m == doctest::Approx(std::sqrt(0.25 / 3.0)));
  CHECK(error.amplitude_db == doctest::Approx(6.0206));
  CHECK(way_distance({{0.0, 0.0}, {1.0, 0.0}}, {{0.0, 0.3}, {1.0, 0.3}}) == doctest::Approx(0.3));
  CHECK(way_distance({{0.0, 0.0}, {1.0, 0.0}}, {{0.0, 0.0}}) == doctest::Approx(0.5));  // the longer one is far from the shorter, not the other way round
}

TEST_CASE("knobs: unknown ones are told with the nearest, and all settings that fit change the mission") {
  const auto wrong = chosen_knobs("rays,bunces");
  REQUIRE_FALSE(wrong);
  CHECK(has(wrong.error().message, "no knob 'bunces'"));
  CHECK(has(wrong.error().message, "did you mean 'bounces'?"));
  for (const char* file : {"foliage_wall/bug2", "ntnu_room/ntnu_room"}) {
    const auto path = find_input(file);
    const auto mission = read_mission(path, {});
    REQUIRE(mission);
    const std::string own = write_mission(*mission);
    std::size_t count = 0;
    for (const Knob& knob : tradeoff_knobs()) {
      bool was_finer = true;
      for (const KnobSetting& setting : knob.settings(*mission)) {
        CAPTURE(knob.name);
        CAPTURE(setting.label);
        CHECK((was_finer || !setting.finer));  // the finer ones come first
        was_finer = setting.finer;
        const auto turned = read_mission(path, setting.changes);
        if (turned) CHECK(write_mission(*turned) != own);
        else CHECK(has(turned.error().message, "expected"));
        count += static_cast<bool>(turned);
      }
    }
    CHECK(count > 15);
  }
}

TEST_CASE("a study keeps its budget, and its missions read back and end as they did in it") {
  const TemporaryFolder folder;
  TradeoffOptions options;
  options.knobs = "rays,resolution";
  options.budget_s = 6.0;
  options.repeats = 2;
  options.out = folder.path();
  options.overrides = {{"limits.time_s", "3", "test"}};
  const auto start = std::chrono::steady_clock::now();
  const auto study = run_tradeoff(find_input("foliage_wall/map_radar"), options);
  const double spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  REQUIRE_MESSAGE(static_cast<bool>(study), (study ? "" : study.error().message));
  CHECK(spent < 1.3 * options.budget_s);
  REQUIRE(study->points.size() >= 2);
  const TradePoint& own = study->points.front();
  CHECK(own.name == "as it is");
  CHECK(own.error.same_verdict);
  if (const TradePoint* reference = point_of(*study, "reference")) CHECK(reference->error.total() == 0.0);  // the same run twice
  if (const TradePoint* coarse = point_of(*study, "rays x 0.125")) {
    CHECK(coarse->error.range_rmse_m > own.error.range_rmse_m);
    CHECK(coarse->rays_per_s < 0.2 * own.rays_per_s);
  }
  for (const Recommendation& advice : study->recommended) {
    CAPTURE(advice.name);
    const auto mission = read_mission(advice.file, {});
    REQUIRE(mission);
    CHECK(mission->name == "map_radar_" + advice.name);
    if (study->cut_s || !advice.verified) continue;
    auto simulation = Simulation::create(*mission);
    REQUIRE(simulation);
    while (simulation->step()) {
    }
    CHECK(to_string(simulation->verdict()->kind) == advice.verdict);
    CHECK(simulation->totals().rays == static_cast<std::uint64_t>(std::llround(study->points[advice.point].rays_per_s * study->points[advice.point].simulated_s)));
  }
  CHECK(write_tradeoff(folder.path(), *study));
  const auto json = json_of(folder.path() / "tradeoff.json");
  CHECK(json["points"].size() == study->points.size());
  CHECK(json["points"][0]["cpu"]["ratio"] == 1.0);
  const std::string csv = *read_text_file(folder.path() / "tradeoff.csv"), svg = *read_text_file(folder.path() / "tradeoff.svg");
  CHECK(static_cast<std::size_t>(std::ranges::count(csv, '\n')) == study->points.size() + 1);
  CHECK(has(svg, "<svg"));
  CHECK(has(svg, "</svg>"));
}

TEST_CASE("thicket tradeoff cuts runs short as asked, obeys a budget that is too small for all, and says what it left out") {
  const TemporaryFolder folder;
  const Answer answer = call(folder, "tradeoff foliage_wall/map_radar --seconds 1 --budget 0.03 --repeats 50 --out t --quiet");
  CAPTURE(answer.out);
  CAPTURE(answer.err);
  if (answer.code == 2) {
    CHECK(has(answer.err, "do not suffice"));  // on a machine that is very busy
  } else {
    CHECK(has(answer.out, "cut short after"));
    CHECK(has(answer.out, "have fewer than 50 repeats"));
    const auto json = json_of(folder.path() / "t/tradeoff.json");
    CHECK(json["spent_s"].get<double>() < 3.0);
    CHECK(json["simulated_s"].get<double>() <= 1.0001);
  }
  const Answer unknown = call(folder, "tradeoff foliage_wall/map_radar --knobs rais");
  CHECK(unknown.code == 2);
  CHECK(has(unknown.err, "did you mean 'rays'?"));
  CHECK(call(folder, "tradeoff no_such_mission").code == 2);
}

}  // namespace thicket
