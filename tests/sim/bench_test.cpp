// `thicket bench`: what is measured as a file, and whether two files differ.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "program_call.hpp"
#include "thicket/base/files.hpp"
#include "thicket/sim/bench.hpp"

namespace thicket {
namespace {

/// Values about a middle, none of them alike.
std::vector<double> about(double middle, double spread) {
  std::vector<double> values;
  for (const double off : {0.0, -1.0, 0.8, -0.5, 0.4, 1.0, -0.2}) values.push_back(middle * (1.0 + spread * off));
  return values;
}

/// A report of a machine that needs `slow` times as long for everything.
BenchReport report_of(double slow, double thicket, double mission, double bytes) {
  BenchReport report;
  report.version = "0.1.0";
  report.processor = "a machine";
  report.threads = 2;
  report.list = {{machine_loop, "ns per step", true, about(5.0 * slow, 0.01)},
                 {"closest/boxes/Embree triangles", "ns per ray", true, about(100.0 * slow, 0.01)},
                 {"closest/boxes/Thicket", "ns per ray", false, about(thicket * slow, 0.01)},
                 {"whole mission/bug2/as shipped", "s simulated per CPU s", false, about(mission / slow, 0.01), std::vector<double>(7, 5.0 * slow)},
                 {"memory/bug2/map", "bytes per known cell", false, std::vector<double>(7, bytes)}};
  return report;
}

const BenchChange& change_of(const std::vector<BenchChange>& changes, const std::string& name) {
  const auto at = std::find_if(changes.begin(), changes.end(), [&](const BenchChange& c) { return c.name == name; });
  REQUIRE(at != changes.end());
  return *at;
}

}  // namespace

TEST_CASE("two reports of bench: faster, slower and the same, whatever the machine as a whole did") {
  // Half as fast a machine; the rays became cheaper by a fifth, the missions by nothing, the map larger by half.
  const auto changes = compare_benches(report_of(1.0, 80.0, 500.0, 2.0), report_of(2.0, 64.0, 500.0, 3.0));
  REQUIRE(changes);
  REQUIRE(changes->size() == 5);
  const BenchChange& rays = change_of(*changes, "closest/boxes/Thicket");
  CHECK(rays.before == doctest::Approx(80.0));
  CHECK(rays.now == doctest::Approx(128.0));
  CHECK(rays.cost == doctest::Approx(1.6));
  CHECK(rays.yardstick == "closest/boxes/Embree triangles");
  CHECK(rays.related == doctest::Approx(0.8));
  CHECK(rays.low < 0.8);
  CHECK(rays.high > 0.8);
  CHECK(rays.high - rays.low < 0.05);
  CHECK(rays.verdict == "faster");
  const BenchChange& mission = change_of(*changes, "whole mission/bug2/as shipped");
  CHECK(mission.cost == doctest::Approx(2.0));  // of a rate, its inverse
  CHECK(mission.yardstick == machine_loop);
  CHECK(mission.related == doctest::Approx(1.0));
  CHECK(mission.verdict == "same");
  const BenchChange& memory = change_of(*changes, "memory/bug2/map");
  CHECK(memory.yardstick.empty());
  CHECK(memory.related == 1.5);
  CHECK(memory.verdict == "more");
  // The yardsticks have none: they say what the machine did.
  CHECK(change_of(*changes, machine_loop).verdict == "slower");
  CHECK(change_of(*changes, machine_loop).yardstick.empty());
  // The other way round.
  const auto back = compare_benches(report_of(2.0, 64.0, 500.0, 3.0), report_of(1.0, 80.0, 500.0, 2.0));
  REQUIRE(back);
  CHECK(change_of(*back, "closest/boxes/Thicket").verdict == "slower");
  CHECK(change_of(*back, "memory/bug2/map").verdict == "less");
  CHECK(change_of(*back, machine_loop).verdict == "faster");
  // The same numbers each time.
  const auto again = compare_benches(report_of(1.0, 80.0, 500.0, 2.0), report_of(2.0, 64.0, 500.0, 3.0));
  CHECK(change_of(*again, "closest/boxes/Thicket").low == rays.low);
}

TEST_CASE("a mission is held against the plain loop beside each of its repetitions, not against that of another moment") {
  // Twice as slow a machine during four of seven repetitions: medians alone would not tell.
  BenchReport before = report_of(1.0, 80.0, 500.0, 2.0), now = before;
  for (const std::size_t i : {0, 2, 3, 5}) {
    now.list[3].values[i] /= 2.0;
    now.list[3].beside[i] *= 2.0;
  }
  const auto changes = compare_benches(before, now);
  REQUIRE(changes);
  const BenchChange& mission = change_of(*changes, "whole mission/bug2/as shipped");
  CHECK(mission.cost > 1.9);
  CHECK(mission.related == doctest::Approx(1.0));
  CHECK(mission.verdict == "same");
}

TEST_CASE("bench says nothing of few repetitions, of noise, and of what only one report has") {
  BenchReport before = report_of(1.0, 80.0, 500.0, 2.0), now = report_of(1.0, 82.0, 500.0, 2.0);
  for (BenchReport* report : {&before, &now}) report->list[2].values = about(report == &before ? 80.0 : 82.0, 0.3);
  now.list[3].values.resize(4);
  now.list[3].beside.resize(4);
  now.list[4].name = "memory/bug2/another";
  const auto changes = compare_benches(before, now);
  REQUIRE(changes);
  CHECK(change_of(*changes, "closest/boxes/Thicket").verdict == "same");
  CHECK(change_of(*changes, "whole mission/bug2/as shipped").verdict == "too few");
  CHECK(change_of(*changes, "memory/bug2/another").verdict == "only now");
  CHECK(change_of(*changes, "memory/bug2/map").verdict == "only before");
  now.brief = true;
  const auto refused = compare_benches(before, now);
  REQUIRE_FALSE(refused);
  CHECK(has(refused.error().message, "--short"));
}

TEST_CASE("a report of bench survives its file, and other files are told apart") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "report.json";
  const BenchReport report = report_of(1.0, 80.0, 500.0, 2.0);
  REQUIRE(write_file(file, bench_json(report)));
  const auto read = read_bench(file);
  REQUIRE(read);
  CHECK(bench_json(*read) == bench_json(report));
  const auto message_of = [&](const std::string& text) {
    REQUIRE(write_file(file, text));
    const auto bad = read_bench(file);
    REQUIRE_FALSE(bad);
    CHECK(has(bad.error().message, "report.json"));
    return bad.error().message;
  };
  CHECK(has(message_of("measured,median\n"), "no JSON object"));
  CHECK(has(message_of(R"({"benchmarks": []})"), "thicket bench --json"));
  CHECK(has(message_of(R"({"format": "thicket bench", "format_version": 9})"), "format_version is 9"));
  CHECK(has(message_of(R"({"format": "thicket bench", "format_version": 1})"), "version"));
  auto zero = nlohmann::json::parse(bench_json(report));
  zero["measurements"][0]["values"][3] = 0.0;
  CHECK(has(message_of(zero.dump()), "'machine/plain loop' has the value 0"));
  auto short_of_loops = nlohmann::json::parse(bench_json(report));
  short_of_loops["measurements"][3]["plain_loop_ns_per_step"] = {5.0};
  CHECK(has(message_of(short_of_loops.dump()), "7 values and 1 of the plain loop"));
}

TEST_CASE("what Google Benchmark wrote: every repetition, by its counter, without medians") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "google.json";
  REQUIRE(write_file(file, R"({"benchmarks": [
    {"name": "a/b", "run_name": "a/b", "run_type": "iteration", "iterations": 9, "real_time": 1.0, "cpu_time": 1.0, "time_unit": "ns", "ns per ray": 4.5},
    {"name": "a/b", "run_name": "a/b", "run_type": "iteration", "iterations": 9, "real_time": 1.0, "cpu_time": 1.0, "time_unit": "ns", "ns per ray": 5.5},
    {"name": "a/c/real_time", "run_name": "a/c/real_time", "run_type": "iteration", "iterations": 9, "real_time": 1.0, "cpu_time": 1.0, "time_unit": "ns", "ns per ray": 2.0},
    {"name": "a/b_median", "run_name": "a/b", "run_type": "aggregate", "aggregate_name": "median", "ns per ray": 5.0}]})"));
  const auto read = read_google_benchmark(file);
  REQUIRE(read);
  REQUIRE(read->size() == 2);
  CHECK((*read)[0].name == "a/b");
  CHECK((*read)[0].unit == "ns per ray");
  CHECK((*read)[0].values == std::vector<double>{4.5, 5.5});
  CHECK((*read)[0].median() == 5.0);
  CHECK((*read)[1].name == "a/c");
  REQUIRE(write_file(file, R"({"benchmarks": [{"run_name": "a/b", "run_type": "iteration", "error_occurred": true, "error_message": "the peers see different things"}]})"));
  const auto failed = read_google_benchmark(file);
  REQUIRE_FALSE(failed);
  CHECK(failed.error().message == "a/b: the peers see different things");
}

TEST_CASE("every name of the standard set is told once, and its groups stand together") {
  std::set<std::string> names, groups;
  std::string last;
  for (const BenchEntry& entry : standard_bench()) {
    CHECK(names.insert(entry.name).second);
    const std::string group = entry.name.substr(0, entry.name.rfind('/'));
    if (group != last) CHECK(groups.insert(group).second);
    last = group;
  }
}

TEST_CASE("thicket bench measures a mission in short, writes it, and compares it with itself") {
  const TemporaryFolder folder;
  const Answer answer = call(folder, "bench --short --repetitions 5 --filter '^whole mission/rooms/u/' --json now.json --quiet");
  CAPTURE(answer.out);
  CAPTURE(answer.err);
  CHECK(answer.code == 0);
  CHECK(has(answer.out, "machine/plain loop"));
  CHECK(has(answer.out, "whole mission/rooms/u/as shipped"));
  CHECK(has(answer.out, "5 repetitions, the short version"));
  const auto read = read_bench(folder.path() / "now.json");
  REQUIRE(read);
  REQUIRE(read->list.size() == 3);
  CHECK(read->brief);
  CHECK(read->list[2].name == "whole mission/rooms/u/no map");
  CHECK(read->list[2].unit == "s simulated per CPU s");
  CHECK(read->list[2].values.size() == 5);
  CHECK(read->list[2].median() > read->list[1].median());  // a map costs something
  const Answer same = call(folder, "bench --compare now.json --with now.json");
  CAPTURE(same.out);
  CHECK(same.code == 0);
  CHECK(has(same.out, "0 of 3 differ"));
}

TEST_CASE("thicket bench refuses what it cannot do, in words") {
  const TemporaryFolder folder;
  REQUIRE(write_file(folder.path() / "other.json", R"({"verdict": "reached"})"));
  REQUIRE(write_file(folder.path() / "long.json", bench_json(report_of(1.0, 80.0, 500.0, 2.0))));
  const auto refused = [&](const std::string& arguments, const std::string& words) {
    const Answer answer = call(folder, "bench " + arguments);
    CAPTURE(arguments);
    CAPTURE(answer.err);
    CHECK(answer.code == 2);
    CHECK(has(answer.err, words));
  };
  refused("--compare nowhere.json", "nowhere.json");
  refused("--compare other.json", "no file of `thicket bench --json`");
  refused("--compare long.json --with other.json", "other.json");
  refused("--compare long.json --short", "without --short");
  refused("--with long.json", "--compare");
  refused("--filter '('", "no regular expression");
  refused("--filter closes_t", "`thicket bench --list`");
  refused("--repetitions 0", "--repetitions");
  // A program that stands alone has nothing beside it to measure kernels with.
  const auto alone = folder.path() / "thicket";
  std::filesystem::copy_file(THICKET_PROGRAM, alone);
  const std::string err = (folder.path() / "err").string();
  const int status = std::system(("'" + alone.string() + "' bench --short --filter '^closest/' >/dev/null 2>'" + err + "'").c_str());
  CHECK(WEXITSTATUS(status) == 2);
  CHECK(has(*read_text_file(err), "cmake --build --preset release --target bench"));
}

}  // namespace thicket
