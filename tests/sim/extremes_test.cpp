// Runs at the ends of what the keys allow, and whether they are the same again. Bounds and results: docs/extremes.md.
#include <doctest/doctest.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <cmath>
#include <thread>

#include "finished.hpp"
#include "scan_clock.hpp"
#include "temporary_folder.hpp"
#include "thicket/base/document.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/float_traps.hpp"
#include "thicket/sim/mission_parts.hpp"
#include "thicket/sim/simulation.hpp"

namespace thicket {
namespace {

Mission shipped(const char* name, const std::vector<Override>& overrides = {}) {
  auto mission = read_mission(find_input(name), overrides);
  if (!mission) FAIL(mission.error().message);
  return *mission;
}

/// A robot that drives along x for as long as it takes, with a sensor of two beams.
Mission cheap(double step_s, double rate_hz) {
  Mission mission;
  mission.planner.name = "waypoints";
  mission.planner.waypoints_m = {{1e8, 0.0}};
  mission.planner.clearance_m = 0.3;
  ScanningRadarSpec radar;
  radar.step_deg = 180.0;
  radar.rate_hz = rate_hz;
  mission.sensors = {radar};
  mission.map.enabled = false;
  mission.limits.time_s = 1e9;
  mission.limits.stuck_s = 1e9;
  mission.step_s = step_s;
  return mission;
}

/// Every number of a value.
std::vector<double> numbers_in(const Value& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return {static_cast<double>(*integer)};
  if (const auto* number = std::get_if<double>(&value)) return {*number};
  if (const auto* list = std::get_if<std::vector<double>>(&value)) return *list;
  std::vector<double> all;
  if (const auto* points = std::get_if<std::vector<std::vector<double>>>(&value))
    for (const auto& point : *points) all.insert(all.end(), point.begin(), point.end());
  return all;
}

std::string in_lists(const std::string& number, const Key& key) {
  const auto list = [&](std::size_t length) {
    std::string text = "[" + number;
    for (std::size_t i = 1; i < length; ++i) text += ", " + number;
    return text + "]";
  };
  if (key.kind == KeyKind::numbers) return list(key.length_min);
  if (key.kind == KeyKind::points) return "[" + list(key.length_min) + "]";
  return number;
}

}  // namespace

TEST_CASE("extremes: time: of 10^7 steps each is at step x dt, and scans are due when their number over the rate is, whatever the step") {
  struct Case {
    double step_s;
    std::uint64_t per_step_up, per_step_down;  ///< scans a step, as a fraction
    double rate_hz;
  };
  // Rates that divide the step, that do not, that are above it; the smallest and the largest step.
  for (const Case& c : {Case{0.05, 1, 2, 10.0}, {0.05, 7, 20, 7.0}, {0.02, 3, 5, 30.0}, {1e-5, 1, 10, 1e4}, {1e-5, 1, 14286, 1.0 / 0.14286}, {0.2, 1, 2, 2.5}, {0.2, 1, 1, 1e4}, {0.001, 333, 1000, 333.0}}) {
    CAPTURE(c.step_s);
    CAPTURE(c.rate_hz);
    std::uint64_t count = 0, wrong = 0;
    long double worst = 0.0L;
    std::uint64_t phase = c.per_step_down;  // the first is due at 0
    for (std::uint64_t step = 0; step < 1250000; ++step) {  // eight times: 10^7
      const double time = static_cast<double>(step) * c.step_s;
      const std::uint64_t before = count;
      const bool due = scan_due(time, c.rate_hz, count);
      // Number n is due at the first step that is not before n / rate: in whole numbers, n * down <= step * up.
      const bool expected = phase >= c.per_step_down;
      phase = (expected ? phase - c.per_step_down : phase) + c.per_step_up;
      wrong += due != expected;
      if (due && c.rate_hz * c.step_s <= 1.0) wrong += count != before + 1;
      worst = std::max(worst, std::abs(static_cast<long double>(time) - static_cast<long double>(step) * static_cast<long double>(c.step_s)));
    }
    CHECK(wrong == 0);
    CHECK(static_cast<double>(worst) <= 0.5 * (std::nextafter(1250000.0 * c.step_s, infinity) - 1250000.0 * c.step_s));  // rounded once
  }
  // Thirty years on the clock still keeps its rate.
  std::uint64_t count = 0;
  const std::uint64_t late = 20000000000;
  scan_due(static_cast<double>(late) * 0.05, 10.0, count);
  std::uint64_t scans = 0, wrong = 0;
  for (std::uint64_t step = late + 1; step <= late + 1000; ++step) {
    const bool due = scan_due(static_cast<double>(step) * 0.05, 10.0, count);
    scans += due;
    wrong += due != (step % 2 == 0);
  }
  CHECK(scans == 500);
  CHECK(wrong == 0);
}

TEST_CASE("extremes: time: 10^5 steps of 10 us, of 0.2 s, and with rates that do not divide them: time is step x dt, scans keep their rate") {
  for (const auto& [step_s, rate, steps] : {std::tuple{1e-5, 100.0, 40000}, {0.2, 2.5, 20000}, {0.05, 7.0, 20000}, {0.01, 30.0, 20000}}) {
    CAPTURE(step_s);
    auto simulation = Simulation::create(cheap(step_s, rate), World{});
    REQUIRE(simulation);
    int ended = 0;
    for (int i = 0; i < steps; ++i) ended += !simulation->step();
    REQUIRE(ended == 0);
    CHECK(simulation->steps() == static_cast<std::uint64_t>(steps));
    CHECK(simulation->time() == static_cast<double>(steps) * step_s);
    // The last sensing was at the step before.
    CHECK(std::abs(static_cast<double>(simulation->totals().scans) - (static_cast<double>(steps - 1) * step_s * rate + 1.0)) <= 1.0);
    // It drove as fast as it may, but for the start.
    const double speed = simulation->mission().vehicle.speed_max_m_s;
    CHECK(simulation->totals().path_length <= simulation->time() * speed * (1.0 + 1e-9));
    if (simulation->time() > 100.0) CHECK(simulation->totals().path_length >= 0.98 * simulation->time() * speed);
  }
}

TEST_CASE("extremes: place: a mission 2^14, 2^20 and 2^27 m away has the same verdict, its way to 0.5 %, its map to 0.5 % of the cells") {
  // Not more: a step moves the robot from where rounding put it, and where the follower chooses between two headings that are as good, the last place decides (docs/extremes.md).
  for (const std::string name : {"rooms/u"}) {
    CAPTURE(name);
    Mission mission = shipped(name.c_str(), {{"map.resolution_m", "0.125", "--set"}});
    const auto world = read_mission_world(mission);
    REQUIRE(world);
    const auto run_at = [&](double far) {
      World there = *world;
      for (Solid& solid : there.solids) solid.position += glm::dvec3(far, -far, 0.0);
      there.bounds.reset();
      Mission moved = mission;
      moved.start.x_m += far;
      moved.start.y_m -= far;
      if (moved.planner.goal_m) *moved.planner.goal_m += glm::dvec2(far, -far);
      auto simulation = Simulation::create(moved, std::move(there));
      REQUIRE(simulation);
      while (simulation->step()) {
      }
      return *simulation;
    };
    const Simulation home = run_at(0.0);
    const auto extent = home.map().extent();
    REQUIRE(extent);
    for (const double far : {0x1p14, 0x1p20, 0x1p27}) {
      CAPTURE(far);
      const Simulation away = run_at(far);
      CHECK(away.verdict()->kind == home.verdict()->kind);
      const double longer = std::abs(away.totals().path_length - home.totals().path_length);
      const auto shift = static_cast<std::int64_t>(far * 8.0);
      std::size_t differ = 0;
      for (std::int64_t row = extent->first.row; row < extent->second.row; ++row)
        for (std::int64_t column = extent->first.column; column < extent->second.column; ++column)
          differ += (home.map().view({column, row}).probability > 0.5) != (away.map().view({column + shift, row - shift}).probability > 0.5);
      MESSAGE(name, " at ", far, ": way differs by ", longer, " m, ", differ, " of ", home.map().known_cells(), " cells");
      CHECK(longer <= 0.005 * home.totals().path_length);
      CHECK(static_cast<double>(differ) <= 0.005 * static_cast<double>(home.map().known_cells()));
    }
  }
}

TEST_CASE("extremes: numbers: what is no number that a key takes is told with its line; what is taken is in range and written back the same") {
  Mission mission;
  mission.sensors = {ScanningRadarSpec{}, LobeRadarSpec{}, LidarSpec{}};
  std::size_t keys = 0, refused = 0, taken = 0;
  for (const MissionPart& part : mission_parts(mission)) {
    for (const Key& key : part.section->keys) {
      if (key.kind == KeyKind::flag || key.kind == KeyKind::text) continue;
      ++keys;
      for (const char* number : {"nan", "-nan", "inf", "-inf", "-0.0", "1e400", "-1e400", "5e-324", "-5e-324", "1e308", "-1e308", "-1", "0", "9223372036854775807", "99999999999999999999", "EMPTY"}) {
        const std::string value = number == std::string("EMPTY") ? "[]" : in_lists(number, key), text = "# one\n# two\n" + key.name + " = " + value + "\n";
        CAPTURE(part.title);
        CAPTURE(text);
        Mission changed = mission;
        void* object = nullptr;
        for (const MissionPart& same : mission_parts(changed))
          if (same.title == part.title && same.section == part.section) object = same.object;
        REQUIRE(object);
        Faults faults;
        const auto document = parse_document(text, "f");
        if (document) read_section(*document, *part.section, object, faults, {"name"});
        if (!document || (!faults.none() && faults.error().message.find("lacks the key") == std::string::npos)) {
          ++refused;
          const std::string error = document ? faults.error().message : document.error().message;
          CHECK(error.find("f:3:") != std::string::npos);
          continue;
        }
        ++taken;
        const Value got = key.get(object);
        for (const double n : numbers_in(got)) {
          CHECK_FALSE(std::isnan(n));
          CHECK((std::isfinite(n) || key.range.infinite));
          CHECK(((key.range.above_minimum ? n > key.range.minimum : n >= key.range.minimum) && n <= key.range.maximum));
        }
        if (std::holds_alternative<std::monostate>(got)) continue;
        const auto again = parse_document(key.name + " = " + to_toml(got), "f");
        REQUIRE(again);
        Faults none;
        read_section(*again, *part.section, object, none, {"name"});
        CHECK(to_toml(key.get(object)) == to_toml(got));
      }
    }
  }
  MESSAGE(keys, " keys: ", refused, " values refused, ", taken, " taken");
  CHECK(keys > 100);
  CHECK(refused > 1000);
}

TEST_CASE("extremes: determinism: 1, 2 and 8 threads, and the resolved mission, have the same state hash") {
  const std::vector<Override> noisy = {{"sensor.range_noise_m", "0.03", "--set"}, {"sensor.divergence", "side_rays", "--set"}, {"limits.time_s", "10.0", "--set"}};
  const std::vector<Override> lobes = {{"limits.time_s", "0.5", "--set"}};
  for (const auto& [name, overrides] : {std::pair{"foliage_wall/bug2", noisy}, {"quadrotor/waypoints", lobes}}) {
    CAPTURE(name);
    const Mission mission = shipped(name, overrides);
    const auto hash_with = [](const Mission& of, int threads) {
      // As many as that, on any machine.
      const tbb::global_control control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
      tbb::task_arena arena(threads);
      return arena.execute([&] { return state_hash(finished(of)); });
    };
    const std::uint64_t one = hash_with(mission, 1);
    CHECK(hash_with(mission, 2) == one);
    CHECK(hash_with(mission, 8) == one);
    const TemporaryFolder folder;
    const auto resolved = read_mission(folder.write("mission.toml", write_mission(mission)), {});
    REQUIRE_MESSAGE(static_cast<bool>(resolved), (resolved ? "" : resolved.error().message));
    CHECK(hash_with(*resolved, 2) == one);
    Mission other = mission;
    other.seed += 1;
    if (std::string(name) == "foliage_wall/bug2") CHECK(hash_with(other, 2) != one);
  }
}

}  // namespace thicket
