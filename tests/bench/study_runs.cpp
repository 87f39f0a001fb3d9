#include "study_runs.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <chrono>
#include <mutex>
#include <optional>

#include "thicket/base/files.hpp"

namespace thicket::study {
namespace {

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// One task for each, since some take a thousand times as long as others.
void for_each(std::size_t count, int jobs, const std::function<void(std::size_t)>& work) {
  tbb::task_arena arena(jobs > 0 ? jobs : static_cast<int>(tbb::task_arena::automatic));
  arena.execute([&] { tbb::parallel_for(std::size_t{0}, count, std::size_t{1}, work, tbb::simple_partitioner()); });
}

/// Embree builds in parallel; the thread must not take up another problem meanwhile.
Scene scene_of(const World& world) {
  std::optional<Scene> scene;
  tbb::this_task_arena::isolate([&] { scene.emplace(or_exit(Scene::build(world))); });
  return std::move(*scene);
}

/// As `mission_of`, but a planner without a theorem may drive three times the bound of Bug1 (and 100 m), not of the worst of the others: what goes round for ever takes most of a study's time.
Mission limited(const Variant& variant, const Problem& problem, const Judgement& judgement) {
  Mission lean = variant.lean;
  const std::string& planner = variant.planner;
  if (planner != "bug1" && planner != "bug2" && planner != "tangent_bug" && !lean.limits.distance_m) lean.limits.distance_m = 3.0 * judgement.bug1_bound_m + 100.0;
  return mission_of(lean, problem, judgement, planner, problem.number % 2 ? "right" : "left");
}

}  // namespace

std::vector<Judged> choose(const std::string& family, std::size_t count, const Mission& lean, int jobs, const std::function<bool(Expected)>& wants, std::size_t* looked_at) {
  constexpr std::size_t at_once = 16, most = 20000;
  const Robot robot = robot_of(lean);
  std::vector<Judged> chosen;
  std::size_t first = 0;
  for (; chosen.size() < count && first < most; first += at_once) {
    std::vector<Judged> next(at_once);
    for_each(at_once, jobs, [&](std::size_t i) {
      next[i].problem = or_exit(make_problem(family, first + i, robot));
      next[i].judgement = or_exit(judge(next[i].problem, robot, noise_of(lean)));
    });
    for (Judged& one : next) {
      if (chosen.size() == count) break;
      if (looked_at) *looked_at = one.problem.number + 1;
      if (wants(one.judgement.expected)) chosen.push_back(std::move(one));
    }
  }
  return chosen;
}

std::vector<Judged> choose_of_all(std::size_t count, const Mission& lean, int jobs) {
  std::vector<Judged> all;
  for (const std::string& family : problem_families()) {
    auto own = choose(family, count, lean, jobs, [](Expected expected) { return expected != Expected::ambiguous; });
    std::move(own.begin(), own.end(), std::back_inserter(all));
  }
  return all;
}

std::vector<std::vector<Attempt>> run_variants(const std::vector<Judged>& problems, const std::vector<Variant>& variants, int jobs) {
  std::vector<std::vector<Attempt>> attempts(variants.size(), std::vector<Attempt>(problems.size()));
  Progress progress;
  std::mutex mutex;  // guards what follows
  std::size_t done = 0;
  double simulated = 0.0;
  for_each(problems.size(), jobs, [&](std::size_t i) {
    const auto& [problem, judgement] = problems[i];
    const Scene scene = scene_of(*problem.world);
    for (std::size_t v = 0; v < variants.size(); ++v) {
      attempts[v][i] = or_exit(attempt(limited(variants[v], problem, judgement), problem, judgement, scene));
    }
    const std::lock_guard lock(mutex);
    for (const auto& list : attempts) simulated += list[i].simulated_s;
    progress.show(++done, problems.size(), simulated);
  });
  progress.end(problems.size() * variants.size(), simulated);
  return attempts;
}

Progress::Progress() : start_(now()), shown_(start_) {}

void Progress::show(std::size_t problems, std::size_t of, double simulated_s) {
  constexpr double period = 10.0;  // s
  const double time = now();
  if (time - shown_ < period) return;
  shown_ = time;
  fmt::print(stderr, "{} of {} problems, {:.0f} x real time\n", problems, of, simulated_s / (time - start_));
}

void Progress::end(std::size_t runs, double simulated_s) const {
  const double took = now() - start_;
  fmt::print(stderr, "{} runs, {:.0f} s simulated in {:.1f} s ({:.0f} x real time)\n", runs, simulated_s, took, simulated_s / took);
}

void publish(const Options& options, const std::string& name, const std::string& text) {
  or_exit(write_file(options.into / (name + ".md"), text));
  if (options.page.empty()) return;
  const auto page = or_exit(read_text_file(options.page));
  or_exit(write_file(options.page, or_exit(with_part(page, name, text))));
}

std::string made_by(const Options& options, const std::string& what) { return fmt::format("Made by `{}`: {}\n\n", options.command, what); }

double hours(const std::vector<std::vector<Attempt>>& attempts) {
  double sum = 0.0;
  for (const auto& list : attempts)
    for (const Attempt& a : list) sum += a.simulated_s;
  return sum / 3600.0;
}

}  // namespace thicket::study
