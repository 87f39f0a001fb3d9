// The study of the trade: which runs, in which order, as long as the budget lasts.
#include "thicket/sim/tradeoff.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "thicket/base/files.hpp"
#include "thicket/base/random.hpp"
#include "thicket/base/schema.hpp"
#include "tradeoff_parts.hpp"

namespace thicket {
namespace {

namespace fs = std::filesystem;

/// Shares of the budget: the first run of the mission, the run of the reference, and one round of all settings (two runs each) may take so much, or all are cut short.
constexpr double first_run_share = 0.06, reference_share = 0.12, round_share = 0.4;
/// What is kept for verifying, in pairs of the mission's own cost; once more the time of the reference comes on top.
constexpr double verifying_pairs = 5.0;
/// Poses of the reference run at which sensors are held against each other.
constexpr std::size_t most_moments = 32;

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::ranges::sort(values);
  return values[values.size() / 2];
}

/// What the runs of one point came to, repeat by repeat.
struct Costs {
  std::vector<double> cpu, wall, cpu_ratios, wall_ratios;
  double pair_s = 0.0;  ///< wall time of the last pair, files and scores included
};

class Study {
 public:
  Study(fs::path file, const TradeoffOptions& options, Mission own, Scene scene, std::vector<const Knob*> knobs)
      : file_(std::move(file)), options_(options), own_(std::move(own)), scene_(std::move(scene)), knobs_(std::move(knobs)), start_(Clock::now()) {}

  Result<Tradeoff> make();

 private:
  using Clock = std::chrono::steady_clock;

  double elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  bool interrupted() const { return options_.interrupted && options_.interrupted(); }
  void tell(const std::string& line) const {
    if (options_.progress) options_.progress(line);
  }
  double draw() { return Random(options_.seed, 1).uniform(draws_++, 0, RandomUse::sampling, 0)[0]; }
  void shuffle(std::vector<std::size_t>& order);

  Result<Mission> mission_with(const std::vector<Override>& changes, bool cut = true) const;
  void add_point(std::string name, std::vector<std::string> knobs, std::vector<Override> changes);
  void choose_reference();
  Result<Done> begin();
  void add_settings();
  bool run_pair(std::size_t point, double until);
  void run_all(std::vector<std::size_t> order, double until, std::vector<std::size_t>& left);
  void add_pairs();
  void repeat(double until);
  void sum_up();
  void tell_left_out(const std::vector<std::size_t>& settings, const std::vector<std::size_t>& pairs);
  void recommend();
  std::vector<std::size_t> candidates(const std::string& name) const;
  std::optional<Recommendation> verified(const std::string& name, std::size_t point);

  fs::path file_;
  const TradeoffOptions& options_;
  Mission own_;
  Scene scene_;
  std::vector<const Knob*> knobs_;
  Clock::time_point start_;
  std::uint64_t draws_ = 0;

  Tradeoff study_;
  std::vector<Costs> costs_;  ///< as study_.points
  TradeRun reference_;
  std::vector<TradeMoment> moments_;
  std::vector<Scan> reference_scans_;
  std::vector<Override> reference_changes_;
  double own_wall_s_ = 0.0;
};

void Study::shuffle(std::vector<std::size_t>& order) {
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[std::min(i - 1, static_cast<std::size_t>(draw() * static_cast<double>(i)))]);
}

/// The mission with knobs turned, and cut short if all are.
Result<Mission> Study::mission_with(const std::vector<Override>& changes, bool cut) const {
  std::vector<Override> all = options_.overrides;
  all.insert(all.end(), changes.begin(), changes.end());
  if (cut && study_.cut_s) all.push_back({"limits.time_s", to_toml(std::min(*study_.cut_s, own_.limits.time_s)), "tradeoff"});
  return read_mission(file_, all);
}

void Study::add_point(std::string name, std::vector<std::string> knobs, std::vector<Override> changes) {
  TradePoint point;
  point.name = std::move(name);
  point.knobs = std::move(knobs);
  point.changes = std::move(changes);
  study_.points.push_back(std::move(point));
  costs_.emplace_back();
}

void Study::choose_reference() {
  std::vector<std::string> words;
  for (const Knob& knob : tradeoff_knobs()) {
    if (!knob.accuracy) continue;
    const auto settings = knob.settings(own_);
    if (settings.empty() || !settings.front().finer) continue;
    std::vector<Override> with = reference_changes_;
    with.insert(with.end(), settings.front().changes.begin(), settings.front().changes.end());
    if (!mission_with(with)) {
      study_.left_out.push_back(fmt::format("the reference leaves '{}' as the mission has it: {} is out of range", knob.name, settings.front().label));
      continue;
    }
    reference_changes_ = std::move(with);
    words.push_back(fmt::format("{} {}", knob.name, settings.front().label));
  }
  study_.reference = words.empty() ? "the mission as it is" : fmt::format("{}", fmt::join(words, ", "));
}

/// The first run of the mission, how far runs may go, and the reference run.
Result<Done> Study::begin() {
  study_.cut_s = options_.seconds;
  const auto own = mission_with({});
  if (!own) return own.error();
  const double begun = elapsed(), until = begun + first_run_share * options_.budget_s;
  auto first = trade_run(*own, scene_, true, [&] { return interrupted() || elapsed() > until; });
  if (!first) return first.error();
  const double settings = static_cast<double>(study_.points.size() - 2), round_s = settings * (first->wall_s + elapsed() - begun);  // one of the two is judged
  const bool whole = first->verdict.reason != "interrupted";
  const double share = std::min(1.0, round_share * options_.budget_s / std::max(round_s, 1e-9));
  // To whole tenths, so that the number can be given again by hand.
  if (!whole || share < 1.0) study_.cut_s = std::max(0.1, std::floor(10.0 * share * first->simulated_s) / 10.0);
  choose_reference();
  auto reference = mission_with(reference_changes_);
  if (!reference) return reference.error();
  const double late = elapsed() + reference_share * options_.budget_s;
  tell(fmt::format("reference: {}", study_.reference));
  auto run = trade_run(*reference, scene_, true, [&] { return interrupted() || elapsed() > late; });
  if (!run) return run.error();
  if (run->verdict.reason == "interrupted") study_.cut_s = run->simulated_s;
  reference_ = std::move(*run);
  study_.reference_verdict = fmt::format("{}: {}", to_string(reference_.verdict.kind), reference_.verdict.reason == "interrupted" ? "cut short" : reference_.verdict.reason);
  own_wall_s_ = first->wall_s * std::min(1.0, study_.cut_s.value_or(first->simulated_s) / std::max(first->simulated_s, 1e-9));
  study_.simulated_s = reference_.simulated_s;
  moments_ = thinned(reference_.moments, most_moments);
  const auto seed = static_cast<std::uint64_t>(reference->seed);
  reference_scans_ = measured(*reference, scene_, moments_, seed);
  compare_scans(reference_scans_, measured(*reference, scene_, moments_, seed + 1), study_.floor);
  study_.points[1].changes = reference_changes_;
  return Done{};
}

void Study::add_settings() {
  add_point("as it is", {}, {});
  add_point("reference", {}, {});
  for (const Knob* knob : knobs_)
    for (KnobSetting& setting : knob->settings(own_)) {
      if (const auto fits = mission_with(setting.changes); !fits) {
        study_.left_out.push_back(fmt::format("{} {}: {}", knob->name, setting.label, fits.error().message));
        continue;
      }
      add_point(fmt::format("{} {}", knob->name, setting.label), {knob->name}, std::move(setting.changes));
    }
}

/// One run of a point beside one of the mission as it is, in random order. Nothing is noted, and false returned, if that does not end before `until`.
bool Study::run_pair(std::size_t index, double until) {
  TradePoint& point = study_.points[index];
  Costs& costs = costs_[index];
  const double begun = elapsed(), expected = costs.pair_s > 0.0 ? costs.pair_s : 2.0 * own_wall_s_;
  if (interrupted() || begun + expected > until) return false;
  const auto own = mission_with({}), other = mission_with(point.changes);
  if (!own || !other) return false;
  const bool first = draw() < 0.5;
  const auto late = [&] { return interrupted() || elapsed() > until; };
  auto a = trade_run(first ? *own : *other, scene_, study_.points[first ? 0 : index].repeats == 0, late);
  if (!a || a->verdict.reason == "interrupted") return false;
  auto b = trade_run(first ? *other : *own, scene_, study_.points[first ? index : 0].repeats == 0, late);
  if (!b || b->verdict.reason == "interrupted") return false;
  const TradeRun &mine = first ? *a : *b, &its = first ? *b : *a;
  const auto cpu = [](const TradeRun& run) { return std::max(run.cpu_s, 1e-6) / std::max(run.simulated_s, 1e-9); };
  const auto wall = [](const TradeRun& run) { return std::max(run.wall_s, 1e-6) / std::max(run.simulated_s, 1e-9); };
  costs_[0].cpu.push_back(cpu(mine));
  costs_[0].wall.push_back(wall(mine));
  own_wall_s_ = mine.wall_s;
  costs.cpu.push_back(cpu(its));
  costs.wall.push_back(wall(its));
  costs.cpu_ratios.push_back(cpu(its) / cpu(mine));
  costs.wall_ratios.push_back(wall(its) / wall(mine));
  const auto fill = [&](TradePoint& p, const Mission& mission, const TradeRun& run) {
    if (p.repeats++ > 0) return;  // the same run gives the same figures
    p.simulated_s = run.simulated_s;
    p.rays_per_s = static_cast<double>(run.rays) / std::max(run.simulated_s, 1e-9);
    p.map_bytes = run.map_bytes;
    p.peak_mb = run.peak_mb;
    p.verdict = to_string(run.verdict.kind);
    p.error = trade_error(reference_, run, reference_scans_, measured(mission, scene_, moments_, static_cast<std::uint64_t>(mission.seed)));
  };
  fill(study_.points[0], *own, mine);
  if (index != 0) fill(point, *other, its);
  costs.pair_s = elapsed() - begun;
  tell(fmt::format("{:5.0f} s  {}: CPU x {:.2f}, error {:.2f}{}", elapsed(), point.name, costs.cpu_ratios.back(), point.error.total(), point.error.same_verdict ? "" : ", another verdict"));
  return true;
}

void Study::run_all(std::vector<std::size_t> order, double until, std::vector<std::size_t>& left) {
  shuffle(order);
  for (const std::size_t i : order)
    if (!run_pair(i, until)) left.push_back(i);
}

/// Pairs of the settings that save most, and of those that gain most; and all together that cost nothing of accuracy.
void Study::add_pairs() {
  const double own_error = study_.points[0].error.total();
  const auto best = [&](const auto& worth) {
    std::vector<std::pair<double, std::size_t>> list;  // the best setting of each knob, by how much it is worth
    for (const Knob* knob : knobs_) {
      std::pair<double, std::size_t> most{0.0, 0};
      for (std::size_t i = 2; i < study_.points.size(); ++i) {
        const TradePoint& p = study_.points[i];
        if (p.repeats == 0 || !p.error.same_verdict || p.knobs.size() != 1 || p.knobs.front() != knob->name) continue;
        if (const double value = worth(i); value > most.first) most = {value, i};
      }
      if (most.second != 0) list.push_back(most);
    }
    std::ranges::stable_sort(list, [](const auto& a, const auto& b) { return a.first > b.first; });
    return list;
  };
  const auto add = [&](const std::vector<std::size_t>& parts) {
    std::string name;
    std::vector<std::string> knobs;
    std::vector<Override> changes;
    for (const std::size_t i : parts) {
      const TradePoint& p = study_.points[i];
      name += (name.empty() ? "" : ", ") + p.name;
      knobs.push_back(p.knobs.front());
      changes.insert(changes.end(), p.changes.begin(), p.changes.end());
    }
    if (std::ranges::any_of(study_.points, [&](const TradePoint& p) { return p.name == name; }) || !mission_with(changes)) return;
    add_point(std::move(name), std::move(knobs), std::move(changes));
  };
  const auto saving = [&](std::size_t i) { return -std::log(costs_[i].cpu_ratios.front()) - 0.03; };
  const auto gain = [&](std::size_t i) { return own_error - study_.points[i].error.total() - 0.05 * own_error; };
  const auto free = [&](std::size_t i) { return study_.points[i].error.total() <= 1.05 * own_error ? saving(i) : 0.0; };
  const auto savers = best(saving), gainers = best(gain), all_free = best(free);
  const auto pairs_of = [&](const auto& list, std::size_t most) {
    for (std::size_t i = 0; i < std::min(most, list.size()); ++i)
      for (std::size_t j = 0; j < i; ++j) add({list[j].second, list[i].second});
  };
  pairs_of(savers, 4);
  pairs_of(gainers, 3);
  std::vector<std::size_t> parts;
  for (const auto& [value, i] : all_free) parts.push_back(i);
  if (parts.size() > 1) add(parts);
  // What is most accurate, made cheaper by what costs nothing of accuracy.
  if (gainers.empty() || all_free.empty()) return;
  parts = {gainers.front().second};
  for (const auto& [value, i] : all_free)
    if (study_.points[i].knobs != study_.points[parts.front()].knobs) parts.push_back(i);
  if (parts.size() > 1) add(parts);
}

void Study::repeat(double until) {
  for (std::size_t round = 1; round < options_.repeats; ++round) {
    std::vector<std::size_t> order, ignored;
    for (std::size_t i = 1; i < study_.points.size(); ++i)
      if (study_.points[i].repeats == round) order.push_back(i);
    if (order.empty()) return;
    run_all(std::move(order), until, ignored);
  }
}

void Study::sum_up() {
  std::vector<glm::dvec2> places;
  for (std::size_t i = 0; i < study_.points.size(); ++i) {
    TradePoint& p = study_.points[i];
    p.cpu = mean_ratio(costs_[i].cpu_ratios, options_.seed);
    p.wall = mean_ratio(costs_[i].wall_ratios, options_.seed);
    if (i == 0) p.cpu = p.wall = {1.0, 1.0, 1.0};
    p.cpu_s = median(costs_[i].cpu);
    p.wall_s = median(costs_[i].wall);
    places.emplace_back(p.repeats > 0 ? p.cpu.value : TradeError::none, p.error.same_verdict ? p.error.total() : TradeError::none);
  }
  const auto front = pareto_front(places);
  for (std::size_t i = 0; i < front.size(); ++i) study_.points[i].on_front = front[i];
}

void Study::tell_left_out(const std::vector<std::size_t>& settings, const std::vector<std::size_t>& pairs) {
  const auto names = [&](const std::vector<std::size_t>& list) {
    std::vector<std::string> words;
    for (const std::size_t i : list) words.push_back("'" + study_.points[i].name + "'");
    return fmt::format("{}", fmt::join(words, ", "));
  };
  if (study_.cut_s) study_.left_out.push_back(fmt::format("all runs are cut short after {:g} simulated seconds{}", *study_.cut_s, options_.seconds == study_.cut_s ? ", as asked" : ", for the budget"));
  std::size_t fewer = 0, most = 0;
  for (std::size_t i = 1; i < study_.points.size(); ++i) {
    fewer += study_.points[i].repeats > 0 && study_.points[i].repeats < options_.repeats;
    most = std::max(most, study_.points[i].repeats);
  }
  if (fewer > 0) study_.left_out.push_back(fmt::format("{} points have fewer than {} repeats; the most is {}", fewer, options_.repeats, most));
  if (!settings.empty()) study_.left_out.push_back("settings for which the budget did not suffice: " + names(settings));
  if (!pairs.empty()) study_.left_out.push_back("pairs for which the budget did not suffice: " + names(pairs));
  std::erase_if(study_.points, [](const TradePoint& p) { return p.repeats == 0; });  // (the mission as it is has run if anything has)
}

/// Points for a name, the best first.
std::vector<std::size_t> Study::candidates(const std::string& name) const {
  const auto& points = study_.points;
  std::vector<std::size_t> list;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].on_front) list.push_back(i);
  const double own = points[0].error.total(), bearable = std::max(10.0, std::isfinite(own) ? 3.0 * own : 0.0);
  const auto worth = [&](std::size_t i) {
    const double cost = points[i].cpu.value, error = points[i].error.total();
    if (name == "balanced") return cost * std::max(1.0, error);
    // What is not good enough comes after all that is, the nearest to it first.
    const double bound = name == "fast" ? bearable : 1.0;
    return error <= bound ? cost : 1e9 * (1.0 + error);
  };
  std::ranges::stable_sort(list, [&](std::size_t a, std::size_t b) { return worth(a) < worth(b); });
  return list;
}

/// Writes a point's mission, reads it back and runs it. Nothing if the time is over.
std::optional<Recommendation> Study::verified(const std::string& name, std::size_t point) {
  if (interrupted() || elapsed() + 2.0 * own_wall_s_ > options_.budget_s) return std::nullopt;
  auto mission = mission_with(study_.points[point].changes, false);
  if (!mission) return std::nullopt;
  mission->name += "_" + name;
  mission->description = fmt::format("{} ({}): {}", own_.name, name, study_.points[point].name);
  Recommendation advice{name, point, options_.out / (name + ".toml"), false, "", 0.0, {}};
  if (!write_file(advice.file, write_mission(*mission))) return std::nullopt;
  std::vector<Override> cut;
  if (study_.cut_s) cut.push_back({"limits.time_s", to_toml(std::min(*study_.cut_s, own_.limits.time_s)), "tradeoff"});
  const auto own = mission_with({}), read = read_mission(advice.file, cut);
  if (!own || !read) return advice;
  const auto late = [&] { return interrupted() || elapsed() > options_.budget_s; };
  const auto its = trade_run(*read, scene_, true, late), mine = trade_run(*own, scene_, false, late);
  if (!its || !mine || its->verdict.reason == "interrupted" || mine->verdict.reason == "interrupted") return advice;
  advice.verdict = to_string(its->verdict.kind);
  advice.cpu_ratio = its->cpu_s / its->simulated_s / (mine->cpu_s / mine->simulated_s);
  advice.error = trade_error(reference_, *its, reference_scans_, measured(*read, scene_, moments_, static_cast<std::uint64_t>(read->seed)));
  advice.verified = advice.error.same_verdict;
  return advice;
}

void Study::recommend() {
  for (const char* name : {"fast", "balanced", "exact"}) {
    std::optional<Recommendation> advice;
    for (const std::size_t point : candidates(name)) {
      auto next = verified(name, point);
      if (!next) break;
      advice = std::move(next);
      if (advice->verified || advice->verdict.empty()) break;
    }
    if (advice) study_.recommended.push_back(std::move(*advice));
    if (!advice || !study_.recommended.back().verified) study_.left_out.push_back(fmt::format("'{}' is not verified: {}", name, advice && !advice->verdict.empty() ? "its verdict differs" : "the budget was over"));
  }
}

Result<Tradeoff> Study::make() {
  study_.mission = own_.name;
  study_.budget_s = options_.budget_s;
  add_settings();
  if (auto begun = begin(); !begun) return begun.error();
  const double until = options_.budget_s - verifying_pairs * 2.0 * own_wall_s_ - 1.2 * reference_.wall_s - 0.02 * options_.budget_s;
  std::vector<std::size_t> order, settings, pairs;
  for (std::size_t i = 1; i < study_.points.size(); ++i) order.push_back(i);
  run_all(std::move(order), until, settings);
  const std::size_t before = study_.points.size();
  if (study_.points[0].repeats == 0)
    return Error{interrupted() ? "interrupted before the first pair of runs was done"
                               : fmt::format("--budget: {:g} minutes do not suffice for one run beside another of this mission, expected more, or fewer simulated --seconds", options_.budget_s / 60.0)};
  add_pairs();
  order.clear();
  for (std::size_t i = before; i < study_.points.size(); ++i) order.push_back(i);
  run_all(std::move(order), until, pairs);
  repeat(until);
  sum_up();
  tell_left_out(settings, pairs);
  recommend();
  study_.spent_s = elapsed();
  return std::move(study_);
}

}  // namespace

Result<Tradeoff> run_tradeoff(const fs::path& file, const TradeoffOptions& options) {
  auto knobs = chosen_knobs(options.knobs);
  if (!knobs) return knobs.error();
  auto mission = read_mission(file, options.overrides);
  if (!mission) return mission.error();
  std::error_code fault;
  fs::create_directories(options.out, fault);
  if (fault) return Error{fmt::format("--out: the folder '{}' cannot be made, expected one that can be written to", options.out.string())};
  auto world = read_mission_world(*mission);
  if (!world) return world.error();
  auto scene = Scene::build(std::move(*world));
  if (!scene) return scene.error();
  return Study(file, options, std::move(*mission), std::move(*scene), std::move(*knobs)).make();
}

}  // namespace thicket
