#include "thicket/sim/bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "thicket/base/files.hpp"
#include "thicket/base/random.hpp"

namespace thicket {
namespace {

using Json = nlohmann::json;

constexpr const char* format_name = "thicket bench";
constexpr int format_version = 1;
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

double median_of(std::vector<double> values) {
  if (values.empty()) return nothing;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

bool is_rate(const std::string& unit) { return unit.starts_with("s simulated per"); }
bool is_memory(const std::string& unit) { return unit.starts_with("bytes") || unit == "MB"; }
std::string group_of(const std::string& name) { return name.substr(0, name.rfind('/')); }

/// What it takes, of missions against the plain loop beside it: less is better.
std::vector<double> costs(const Measured& measured, bool against_loop) {
  std::vector<double> list = measured.values;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (is_rate(measured.unit)) list[i] = 1.0 / list[i];
    if (against_loop) list[i] /= measured.beside[i];
  }
  return list;
}

Result<Json> read_json(const std::filesystem::path& file) {
  const auto text = read_text_file(file);
  if (!text) return text.error();
  Json json = Json::parse(*text, nullptr, false);
  if (json.is_discarded() || !json.is_object()) return Error{fmt::format("{}: this is no JSON object, expected a file of `thicket bench --json`", file.string())};
  return json;
}

const Measured* find(const BenchReport& report, const std::string& name, const std::string& unit) {
  const auto at = std::find_if(report.list.begin(), report.list.end(), [&](const Measured& m) { return m.name == name && m.unit == unit; });
  return at == report.list.end() ? nullptr : &*at;
}

/// The peer that a kernel is held against, if both reports have it.
struct Yardstick {
  const Measured* before = nullptr;
  const Measured* now = nullptr;
};
Yardstick yardstick_of(const Measured& what, const BenchReport& before, const BenchReport& now) {
  if (is_memory(what.unit) || what.foreign) return {};
  Yardstick any;
  for (const Measured& m : now.list) {
    if (!m.foreign || is_memory(m.unit) || m.name == machine_loop) continue;
    const Measured* old = find(before, m.name, m.unit);
    if (!old) continue;
    if (m.unit == what.unit && group_of(m.name) == group_of(what.name)) return {old, &m};
    if (!any.now) any = {old, &m};
  }
  return any;
}

/// Draws with replacement, each draw a function of its numbers alone.
class Draws {
 public:
  /// The median of as many of the values as there are; `which` tells apart the four lists of one draw.
  double median(const std::vector<double>& values, std::uint64_t draw, std::uint32_t which) {
    drawn_.clear();
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (i % 4 == 0) four_ = random_.uniform(draw, which, RandomUse::sampling, static_cast<std::uint32_t>(i / 4));
      drawn_.push_back(values[static_cast<std::size_t>(four_[i % 4] * static_cast<double>(values.size()))]);
    }
    return median_of(drawn_);
  }

 private:
  Random random_{1, 0};
  std::array<double, 4> four_{};
  std::vector<double> drawn_;
};

void set_interval(BenchChange& change, const Measured& before, const Measured& now, const BenchReport& all_before, const BenchReport& all_now) {
  constexpr std::uint64_t draws = 4000;
  const bool against_loop = !before.beside.empty() && !now.beside.empty();
  const Yardstick yardstick = against_loop ? Yardstick{} : yardstick_of(now, all_before, all_now);
  change.yardstick = against_loop ? machine_loop : yardstick.now ? yardstick.now->name : "";
  const std::vector<double> a = costs(before, against_loop), b = costs(now, against_loop);
  const std::vector<double> by_a = yardstick.before ? costs(*yardstick.before, false) : std::vector<double>{1.0}, by_b = yardstick.now ? costs(*yardstick.now, false) : std::vector<double>{1.0};
  change.related = median_of(b) / median_of(a) * median_of(by_a) / median_of(by_b);
  Draws random;
  std::vector<double> ratios;
  for (std::uint64_t i = 0; i < draws; ++i) ratios.push_back(random.median(b, i, 0) / random.median(a, i, 1) * random.median(by_a, i, 2) / random.median(by_b, i, 3));
  std::sort(ratios.begin(), ratios.end());
  change.low = ratios[draws / 40 - 1];
  change.high = ratios[draws - draws / 40];
}

std::string verdict_of(const BenchChange& change, const Measured& before, const Measured& now) {
  const bool memory = is_memory(now.unit);
  if (std::min(before.values.size(), now.values.size()) < 5 || !std::isfinite(change.low) || !std::isfinite(change.high)) return "too few";
  if (std::abs(change.related - 1.0) < 0.01) return "same";
  if (change.high < 1.0) return memory ? "less" : "faster";
  if (change.low > 1.0) return memory ? "more" : "slower";
  return "same";
}

}  // namespace

double Measured::median() const { return median_of(values); }

std::string bench_json(const BenchReport& report) {
  Json json;
  json["format"] = format_name;
  json["format_version"] = format_version;
  json["version"] = report.version;
  json["short"] = report.brief;
  json["machine"] = {{"processor", report.processor}, {"threads", report.threads}, {"load_before", report.load_before}, {"load_after", report.load_after}};
  json["measurements"] = Json::array();
  for (const Measured& m : report.list) {
    json["measurements"].push_back({{"name", m.name}, {"unit", m.unit}, {"foreign", m.foreign}, {"values", m.values}});
    if (!m.beside.empty()) json["measurements"].back()["plain_loop_ns_per_step"] = m.beside;
  }
  return json.dump(1) + "\n";
}

Result<BenchReport> read_bench(const std::filesystem::path& file) {
  const auto json = read_json(file);
  if (!json) return json.error();
  if (json->value("format", Json()) != format_name)
    return Error{fmt::format("{}: this is JSON, but no file of `thicket bench --json` (\"format\" is not \"{}\")", file.string(), format_name)};
  if (json->value("format_version", Json()) != format_version)
    return Error{fmt::format("{}: its format_version is {}, expected {}: measure again with this version of Thicket", file.string(), json->value("format_version", Json()).dump(), format_version)};
  try {
    BenchReport report;
    report.version = json->at("version");
    report.brief = json->at("short");
    const Json& machine = json->at("machine");
    report.processor = machine.at("processor");
    report.threads = machine.at("threads");
    report.load_before = machine.at("load_before");
    report.load_after = machine.at("load_after");
    for (const Json& m : json->at("measurements")) {
      report.list.push_back({m.at("name"), m.at("unit"), m.at("foreign"), m.at("values"), m.value("plain_loop_ns_per_step", std::vector<double>{})});
      const Measured& read = report.list.back();
      if (!read.beside.empty() && read.beside.size() != read.values.size()) return Error{fmt::format("{}: '{}' has {} values and {} of the plain loop beside them, expected as many", file.string(), read.name, read.values.size(), read.beside.size())};
      for (const double value : report.list.back().values)
        if (!(value > 0.0)) return Error{fmt::format("{}: '{}' has the value {}, expected numbers above 0", file.string(), report.list.back().name, value)};
    }
    return report;
  } catch (const Json::exception& fault) {
    return Error{fmt::format("{}: {}", file.string(), fault.what())};
  }
}

Result<std::vector<Measured>> read_google_benchmark(const std::filesystem::path& file) {
  const auto json = read_json(file);
  if (!json) return json.error();
  // What is none of these is a counter, whose name is its unit.
  static const std::set<std::string> own = {"name", "family_index", "per_family_instance_index", "run_name", "run_type", "repetitions", "repetition_index", "threads", "iterations", "real_time", "cpu_time", "time_unit", "label",
                                            "error_occurred", "error_message", "aggregate_name", "aggregate_unit", "skipped", "skip_message"};
  try {
    std::vector<Measured> list;
    for (const Json& run : json->at("benchmarks")) {
      if (run.at("run_type") != "iteration") continue;
      std::string name = run.at("run_name");
      if (const std::string real = "/real_time"; name.ends_with(real)) name.resize(name.size() - real.size());
      if (run.value("error_occurred", false)) return Error{fmt::format("{}: {}", name, run.value("error_message", "it failed"))};
      for (const auto& [key, value] : run.items()) {
        if (own.contains(key) || !value.is_number()) continue;
        auto at = std::find_if(list.begin(), list.end(), [&](const Measured& m) { return m.name == name && m.unit == key; });
        if (at == list.end()) at = list.insert(list.end(), {name, key, false, {}, {}});
        at->values.push_back(value);
      }
    }
    return list;
  } catch (const Json::exception& fault) {
    return Error{fmt::format("{}: this is no file of Google Benchmark: {}", file.string(), fault.what())};
  }
}

Result<std::vector<BenchChange>> compare_benches(const BenchReport& before, const BenchReport& now) {
  if (before.brief != now.brief)
    return Error{fmt::format("the one that is compared with was measured {} --short, the new one {}: they did other work; measure both alike", before.brief ? "with" : "without", now.brief ? "with" : "without")};
  std::vector<BenchChange> changes;
  for (const Measured& m : now.list) {
    BenchChange change{m.name, m.unit, nothing, m.median(), nothing, "", nothing, nothing, nothing, "only now"};
    if (const Measured* old = find(before, m.name, m.unit); old && !old->values.empty() && !m.values.empty()) {
      change.before = old->median();
      change.cost = median_of(costs(m, false)) / median_of(costs(*old, false));
      set_interval(change, *old, m, before, now);
      change.verdict = verdict_of(change, *old, m);
    }
    changes.push_back(std::move(change));
  }
  for (const Measured& m : before.list)
    if (!find(now, m.name, m.unit)) changes.push_back({m.name, m.unit, m.median(), nothing, nothing, "", nothing, nothing, nothing, "only before"});
  return changes;
}

}  // namespace thicket
