#include "thicket/sim/reachability.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <list>
#include <mutex>
#include <optional>

#include <glm/geometric.hpp>

#include "reachability_failures.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/text.hpp"

namespace thicket {
namespace {

constexpr double no_time_limit = 1e9;  // the greatest that the key takes: not given

/// What all runs in one world share.
struct Place {
  Scene scene;
  Oracle oracle;
};

/// Places of worlds that many problems share, the last few of them: an oracle of a large map takes some hundred megabytes.
class Places {
 public:
  Places(const Mission& lean, double cell) : robot_(robot_of(lean)), noise_(noise_of(lean)), cell_(cell) {}

  Result<std::shared_ptr<const Place>> of(const Problem& problem) {
    if (problem.world_file.empty()) return make(problem, {problem.start.position, problem.goal});
    const std::lock_guard lock(mutex_);
    for (auto known = places_.begin(); known != places_.end(); ++known) {
      if (known->first != problem.world) continue;
      places_.splice(places_.begin(), places_, known);
      return known->second;
    }
    auto place = make(problem, {});
    if (!place) return place;
    places_.emplace_front(problem.world, *place);
    if (places_.size() > most) places_.pop_back();
    return place;
  }

 private:
  static constexpr std::size_t most = 3;

  Result<std::shared_ptr<const Place>> make(const Problem& problem, const std::vector<glm::dvec2>& points) const {
    auto oracle = Oracle::create(*problem.world, points, robot_, noise_, cell_);
    if (!oracle) return oracle.error();
    // Embree builds in parallel; the thread must not take up another problem meanwhile, which might wait for this one.
    std::optional<Result<Scene>> scene;
    tbb::this_task_arena::isolate([&] { scene.emplace(Scene::build(*problem.world)); });
    if (!*scene) return scene->error();
    return std::make_shared<const Place>(Place{**scene, *oracle});
  }

  const Robot robot_;
  const double noise_, cell_;
  std::mutex mutex_;
  std::list<std::pair<std::shared_ptr<const World>, std::shared_ptr<const Place>>> places_;  ///< the last used first
};

double bound_of(const std::string& planner, const Judgement& judgement) {
  if (planner == "bug1") return judgement.bug1_bound_m;
  if (planner == "bug2") return judgement.bug2_bound_m;
  if (planner == "tangent_bug") return judgement.tangent_bound_m;
  return infinity;
}

std::vector<std::string> hands_of(const std::string& hand, std::uint64_t number) {
  if (hand == "both") return {"left", "right"};
  if (hand == "alternate") return {number % 2 ? "right" : "left"};
  return {hand};
}

}  // namespace

Result<Attempt> attempt(const Mission& mission, const Problem& problem, const Judgement& judgement, const Scene& scene) {
  auto simulation = Simulation::create(mission, scene);
  if (!simulation) return simulation.error();
  while (simulation->step()) {
  }
  Attempt a;
  a.family = problem.family;
  a.number = problem.number;
  a.planner = mission.planner.name;
  a.hand = mission.planner.hand;
  a.expected = judgement.expected;
  a.verdict = simulation->verdict()->kind;
  a.reason = simulation->verdict()->reason;
  a.path_m = simulation->totals().path_length;
  a.straight_m = judgement.straight_m;
  a.shortest_m = judgement.shortest_m;
  a.bound_m = bound_of(a.planner, judgement);
  a.least_clearance_m = simulation->totals().least_clearance;
  a.goal_distance_m = glm::distance(simulation->vehicle().pose.position, problem.goal);
  a.simulated_s = simulation->time();
  a.cell_m = judgement.cell_m;
  a.doubt_m = judgement.doubt_m;
  a.decisions = simulation->totals().decisions;
  a.times = simulation->phase_times();
  a.score = score_of(a.expected, a.verdict, a.goal_distance_m, mission.planner.goal_tolerance_m);
  return a;
}

namespace {

/// All attempts at one problem.
Result<std::vector<Attempt>> attempts_at(const Problem& problem, const Mission& lean, const ReachabilityOptions& options, Places& places) {
  const auto place = places.of(problem);
  if (!place) return place.error();
  const Judgement judgement = (*place)->oracle.judge(problem.start.position, problem.goal);
  std::vector<Attempt> attempts;
  for (const std::string& planner : options.planners) {
    for (const std::string& hand : hands_of(options.hand, problem.number)) {
      Mission mission = mission_of(lean, problem, judgement, planner, hand);
      if (options.finer_for_narrow) see_what_is_narrow(mission, *problem.world);
      auto one = attempt(mission, problem, judgement, (*place)->scene);
      if (!one) return one.error();
      if ((one->score == Score::wrong || one->over_bound()) && !options.keep_failures.empty())
        if (const auto kept = keep_failure(options.keep_failures, mission, problem); !kept) return kept.error();
      attempts.push_back(std::move(*one));
    }
  }
  return attempts;
}

std::optional<Error> fault_of(const ReachabilityOptions& options) {
  for (const std::string& planner : options.planners)
    if (const auto& names = planner_names(); std::find(names.begin(), names.end(), planner) == names.end())
      return Error{fmt::format("there is no planner '{}', expected one of {}{}", planner, fmt::join(names, ", "), did_you_mean(planner, names))};
  const std::vector<std::string> hands = {"left", "right", "both", "alternate"};
  if (std::find(hands.begin(), hands.end(), options.hand) == hands.end())
    return Error{fmt::format("there is no hand '{}', expected one of {}{}", options.hand, fmt::join(hands, ", "), did_you_mean(options.hand, hands))};
  if (options.planners.empty()) return Error{"no planner to run, expected one or more"};
  return std::nullopt;
}

}  // namespace

const char* to_string(Score score) {
  switch (score) {
    case Score::right: return "right";
    case Score::wrong: return "wrong";
    case Score::ambiguous: return "ambiguous";
  }
  return "";
}

Score score_of(Expected expected, Verdict::Kind verdict, double goal_distance_m, double goal_tolerance_m) {
  constexpr double rounding = 1e-6;
  if (verdict == Verdict::Kind::collided) return Score::wrong;
  if (expected == Expected::ambiguous) return Score::ambiguous;
  const bool there = verdict == Verdict::Kind::reached && goal_distance_m <= goal_tolerance_m + rounding;
  const bool right = expected == Expected::reachable ? there : verdict == Verdict::Kind::unreachable;
  return right ? Score::right : Score::wrong;
}

ProblemList generated_problems(const std::vector<std::string>& families, std::uint64_t first, std::size_t count, const Robot& robot) {
  return {families.size() * count, [=](std::size_t i) { return make_problem(families[i / count], first + i % count, robot); }};
}

ProblemList listed_problems(std::vector<Problem> problems) {
  const std::size_t count = problems.size();
  return {count, [list = std::move(problems)](std::size_t i) -> Result<Problem> { return list[i]; }};
}

Result<Mission> lean_mission(const std::vector<Override>& changes) {
  // World and goal are any, so that the mission is whole: `mission_of` gives the problem's.
  std::vector<Override> list = {{"world", "\"foliage_wall/room_with_way_round.toml\"", ""},
                                {"planner.goal_m", "[0.0, 0.0]", ""},
                                {"step_s", "0.1", ""},
                                {"vehicle.radius_m", "0.25", ""},
                                {"planner.clearance_m", "0.4", ""},
                                {"map.enabled", "false", ""},
                                {"output.trajectory", "false", ""},
                                {"output.map", "false", ""},
                                {"output.picture", "false", ""},
                                {"limits.time_s", to_toml(no_time_limit), ""},
                                {"sensor.preset", "\"bumpers\"", ""}};
  list.insert(list.end(), changes.begin(), changes.end());
  auto mission = read_mission({}, list);
  if (!mission) return mission;
  mission->world.clear();
  mission->world_file.clear();
  // With another step or range, still a third of a step (radar/presets/bumpers.toml says why).
  const bool given = std::any_of(changes.begin(), changes.end(), [](const Override& change) { return change.key == "sensor.side_offset_m" || change.key == "sensor.preset"; });
  if (auto* radar = std::get_if<ScanningRadarSpec>(&mission->sensors.front()); radar && !given)
    radar->side_offset_m = radar->range_max_m * std::tan(radians(radar->step_deg / 3.0));
  return mission;
}

Robot robot_of(const Mission& mission) { return {mission.vehicle, mission.planner.clearance_m, mission.planner.goal_tolerance_m}; }

double noise_of(const Mission& mission) { return mounted(mission.sensors.front()).range_noise_m; }

namespace {

/// The width of the narrowest solid, m.
double narrowest(const World& world) {
  double least = infinity;
  for (const Solid& solid : world.solids) {
    if (const auto* box = std::get_if<Box>(&solid.shape)) least = std::min({least, box->size.x, box->size.y});
    if (const auto* wall = std::get_if<Wall>(&solid.shape)) least = std::min(least, wall->thickness);
    if (const auto* cylinder = std::get_if<Cylinder>(&solid.shape)) least = std::min(least, 2.0 * cylinder->radius);
    if (const auto* sphere = std::get_if<Sphere>(&solid.shape)) least = std::min(least, 2.0 * sphere->radius);
  }
  return least;
}

}  // namespace

void see_what_is_narrow(Mission& mission, const World& world) {
  auto* radar = std::get_if<ScanningRadarSpec>(&mission.sensors.front());
  if (!radar) return;
  // Two metres off, where there is room to brake, the side rays, a third of a step apart, leave nothing out; down to 480 rays.
  radar->step_deg = std::min(radar->step_deg, std::max(0.75, degrees(3.0 * narrowest(world) / 2.0)));
  radar->side_offset_m = radar->range_max_m * std::tan(radians(radar->step_deg / 3.0));
}

Mission mission_of(const Mission& lean, const Problem& problem, const Judgement& judgement, const std::string& planner, const std::string& hand) {
  Mission mission = lean;
  mission.name = fmt::format("{}-{}-{}-{}", problem.family, problem.number, planner, hand);
  mission.world_file = problem.world_file;
  mission.world = problem.world_file.string();
  mission.world_cell_size_m.reset();
  if (problem.cell_size_m > 0.0) mission.world_cell_size_m = problem.cell_size_m;
  mission.start.x_m = problem.start.position.x;
  mission.start.y_m = problem.start.position.y;
  mission.start.yaw_deg = degrees(problem.start.yaw);
  mission.planner.name = planner;
  mission.planner.hand = hand;
  mission.planner.goal_m = problem.goal;
  const double bound = bound_of(planner, judgement);
  const double greatest = std::max({judgement.bug1_bound_m, judgement.bug2_bound_m, judgement.tangent_bound_m});
  if (!mission.limits.distance_m) mission.limits.distance_m = 3.0 * (bound < infinity ? bound : greatest) + 100.0;
  if (mission.limits.time_s >= no_time_limit)
    mission.limits.time_s = std::min(no_time_limit, 2.0 * *mission.limits.distance_m / mission.planner.speed_m_s.value_or(mission.vehicle.speed_max_m_s) + 600.0);
  return mission;
}

Result<std::vector<Attempt>> run_reachability(const ProblemList& problems, const Mission& lean, const ReachabilityOptions& options) {
  if (const auto fault = fault_of(options)) return *fault;
  Places places(lean, options.cell_m);
  std::vector<std::vector<Attempt>> rows(problems.count);
  std::mutex mutex;  // guards what follows
  ReachabilityProgress progress{0, problems.count, 0, 0, 0.0};
  std::optional<std::pair<std::size_t, Error>> fault;  // of the first problem that has one, whoever comes first
  std::atomic<bool> stop{false};
  const auto one = [&](std::size_t i) {
    if (stop || (options.interrupted && options.interrupted())) return;
    const auto problem = problems.at(i);
    auto attempts = problem ? attempts_at(*problem, lean, options, places) : Result<std::vector<Attempt>>(problem.error());
    const std::lock_guard lock(mutex);
    if (!attempts) {
      stop = true;
      if (!fault || i < fault->first) fault = {i, attempts.error()};
      return;
    }
    ++progress.problems;
    for (const Attempt& a : *attempts) {
      ++progress.attempts;
      progress.wrong += a.score == Score::wrong;
      progress.simulated_s += a.simulated_s;
    }
    if (options.progress) options.progress(progress);
    rows[i] = std::move(*attempts);
  };
  tbb::task_arena arena(options.jobs > 0 ? options.jobs : static_cast<int>(tbb::task_arena::automatic));
  // One problem a task: some take a thousand times as long as others.
  arena.execute([&] { tbb::parallel_for(std::size_t{0}, problems.count, std::size_t{1}, one, tbb::simple_partitioner()); });
  if (fault) return fault->second;
  std::vector<Attempt> attempts;
  for (auto& row : rows) std::move(row.begin(), row.end(), std::back_inserter(attempts));
  return attempts;
}

}  // namespace thicket
