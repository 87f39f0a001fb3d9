#include "thicket/gui/runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "thicket/base/files.hpp"
#include "thicket/gui/history.hpp"
#include "thicket/worlds/world.hpp"

namespace thicket::gui {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point then) { return std::chrono::duration<double>(Clock::now() - then).count(); }

}  // namespace

Result<Mission> mission_in_world(const std::filesystem::path& world_file) {
  auto mission = read_mission({}, {{"world", toml_string(std::filesystem::absolute(world_file).string()), "the world"}, {"planner.goal_m", "[0.0, 0.0]", "the world"}});
  if (!mission) return mission.error();
  mission->name = world_file.stem().string();
  const auto world = read_mission_world(*mission);
  if (!world) return world.error();
  auto scene = Scene::build(*world);
  if (!scene) return scene.error();
  // In the open, as near to the middle as there is room for the hull and a little more.
  const auto all = extent(*world);
  const glm::dvec2 low = world->bounds ? glm::dvec2(world->bounds->x, world->bounds->y) : all ? glm::dvec2(all->low) : glm::dvec2(-5.0);
  const glm::dvec2 high = world->bounds ? glm::dvec2(world->bounds->z, world->bounds->w) : all ? glm::dvec2(all->high) : glm::dvec2(5.0);
  const glm::dvec2 middle = 0.5 * (low + high);
  const Hull hull = mission->vehicle.hull();
  const double step = std::max(0.25, hull.radius), reach = std::max(high.x - low.x, high.y - low.y);
  for (double r = 0.0; r <= reach; r += step)
    for (int i = 0, count = std::max(1, static_cast<int>(2.0 * pi * r / step)); i < count; ++i) {
      const glm::dvec2 at = middle + r * direction(2.0 * pi * i / count);
      if (scene->clearance(hull, glm::dvec3(at, mission->start.z_m), 1.0).distance < 0.3) continue;
      mission->start.x_m = std::round(at.x * 100.0) / 100.0;
      mission->start.y_m = std::round(at.y * 100.0) / 100.0;
      // It needs a goal to be complete: where it is.
      mission->planner.goal_m = glm::dvec2(mission->start.x_m, mission->start.y_m);
      return mission;
    }
  return Error{fmt::format("{}: no place for a robot with a hull of {} m", world_file.string(), hull.radius)};
}

struct Runner::Core {
  std::mutex mutex;
  std::condition_variable wake, done;
  std::deque<Action> queue;
  bool wanted = true, quit = false, busy = false;
  std::shared_ptr<const Snapshot> published = std::make_shared<Snapshot>();
  std::thread thread;

  // Of the simulation's thread alone.
  std::optional<Simulation> simulation;
  History history;
  Samples samples;
  Open opened;
  Mission mission;  ///< as it is now
  std::optional<World> world;  ///< as it was changed; nothing: as the mission's file has it
  bool mission_changed = false, playing = false;
  double speed = 1.0, achieved = 0.0;
  std::uint64_t world_revision = 0, run_revision = 0;
  Message message;
  Clock::time_point paced_from{}, measured_from{};
  double paced_time = 0.0, measured_time = 0.0;

  void say(bool error, std::string text) { message = {message.number + 1, error, std::move(text)}; }

  void begin(Simulation fresh) {
    simulation = std::move(fresh);
    history.begin(*simulation);
    samples = Samples();
    samples.add(sample_of(*simulation));
    playing = false;
    ++run_revision;
    ++world_revision;
  }

  void open(const Open& what) {
    std::filesystem::path file = find_input(what.file.string());
    if (file.empty()) return say(true, fmt::format("there is no file '{}'", what.file.string()));
    auto read = is_mission(file) ? read_mission(file, what.overrides) : mission_in_world(file);
    if (!read) return say(true, read.error().message);
    auto made = Simulation::create(*read);
    if (!made) return say(true, made.error().message);
    opened = {file, what.overrides};
    mission = *read;
    world.reset();
    mission_changed = false;
    begin(std::move(*made));
    say(false, fmt::format("opened {}", file.filename().string()));
  }

  void reset() {
    if (!simulation) return;
    auto made = world ? Simulation::create(mission, *world) : Simulation::create(mission);
    if (!made) return say(true, made.error().message);
    begin(std::move(*made));
  }

  /// A state that a person made.
  void intervene(Simulation state) {
    simulation = std::move(state);
    samples.keep_until(simulation->steps());
    if (!samples.empty() && samples.back().step == simulation->steps()) samples.keep_until(simulation->steps() - 1);
    samples.add(sample_of(*simulation));
    history.intervene(*simulation);
    ++run_revision;
  }
  void change(const Mission& wanted_mission, const std::optional<Pose2>& pose) {
    if (!simulation) return;
    auto made = simulation->changed(wanted_mission, pose);
    if (!made) return say(true, made.error().message);
    mission = wanted_mission;
    intervene(std::move(*made));
  }

  void advance() {
    if (simulation->steps() < history.newest_step()) {
      simulation->step();
      if (const Simulation* made = history.made_at(simulation->steps())) simulation = *made;
      return;
    }
    if (simulation->verdict()) {
      playing = false;
      return;
    }
    simulation->step();
    if (samples.back().step < simulation->steps()) samples.add(sample_of(*simulation));
    else samples.keep_until(simulation->steps());
    history.note(*simulation);
  }

  void seek(std::uint64_t step) {
    if (!simulation) return;
    playing = false;
    simulation = history.at(std::clamp(step, history.first_step(), history.newest_step()));
    ++run_revision;
  }

  void pace() {
    paced_from = measured_from = Clock::now();
    paced_time = measured_time = simulation ? simulation->time() : 0.0;
  }

  void act(Action& action) {
    std::visit(
        [&](auto& a) {
          using A = std::decay_t<decltype(a)>;
          if constexpr (std::is_same_v<A, Open>) open(a);
          else if constexpr (std::is_same_v<A, Reload>) { if (!opened.file.empty()) open(Open(opened)); }
          else if constexpr (std::is_same_v<A, SetSpeed>) speed = std::max(0.0, a.factor), pace();
          else if (!simulation) return;
          else if constexpr (std::is_same_v<A, Play>) playing = true, pace();
          else if constexpr (std::is_same_v<A, Pause>) playing = false;
          else if constexpr (std::is_same_v<A, StepBy>) step_by(a.steps);
          else if constexpr (std::is_same_v<A, SeekTo>) seek(a.step);
          else if constexpr (std::is_same_v<A, Reset>) reset();
          else if constexpr (std::is_same_v<A, ChangeMission>) mission_changed = true, change(a.mission, std::nullopt);
          else if constexpr (std::is_same_v<A, ChangeWorld>) change_world(a.world);
          else if constexpr (std::is_same_v<A, SetGoal>) set_goal(a.goal);
          else if constexpr (std::is_same_v<A, MoveRobot>) change(mission, a.pose);
          else if constexpr (std::is_same_v<A, Drive>) {
            Simulation state = *simulation;
            state.drive(a.command);
            intervene(std::move(state));
          }
        },
        action);
  }

  void step_by(int steps) {
    playing = false;
    const std::uint64_t now = simulation->steps();
    if (steps < 0) return seek(now - std::min(now, static_cast<std::uint64_t>(-static_cast<std::int64_t>(steps))));
    for (int i = 0; i < steps; ++i) advance();
  }

  void change_world(const World& changed_world) {
    auto scene = Scene::build(changed_world);
    if (!scene) return say(true, scene.error().message);
    auto made = simulation->changed(mission, std::move(*scene), std::nullopt);
    if (!made) return say(true, made.error().message);
    world = changed_world;
    ++world_revision;
    intervene(std::move(*made));
  }

  void set_goal(const glm::dvec2& goal) {
    Mission wanted_mission = mission;
    wanted_mission.planner.goal_m = goal;
    if (planner_needs(wanted_mission.planner.name) != PlannerNeeds::goal) {
      wanted_mission.planner.name = "bug2";
      say(false, "the planner is bug2 now: the one before needs no goal");
    }
    mission_changed = true;
    change(wanted_mission, std::nullopt);
  }

  void publish() {
    auto snapshot = std::make_shared<Snapshot>();
    if (simulation) snapshot->simulation = std::make_shared<const Simulation>(*simulation);
    snapshot->samples = samples;
    snapshot->first_step = history.first_step();
    snapshot->newest_step = history.newest_step();
    snapshot->playing = playing;
    snapshot->speed_wanted = speed;
    snapshot->speed_achieved = playing ? achieved : 0.0;
    snapshot->file = opened.file;
    snapshot->mission_changed = mission_changed;
    snapshot->world_changed = world.has_value();
    snapshot->world_revision = world_revision;
    snapshot->run_revision = run_revision;
    snapshot->message = message;
    const std::scoped_lock lock(mutex);
    published = std::move(snapshot);
    wanted = false;
  }

  /// How long there is to wait before the next step, s.
  double ahead() {
    if (speed <= 0.0 || !playing) return 0.0;
    const double lead = (simulation->time() - paced_time) / speed - seconds_since(paced_from);
    if (lead < -0.25) pace();  // too slow for what is wanted: what is lost is lost
    return lead;
  }

  void measure() {
    const double wall = seconds_since(measured_from);
    if (wall < 0.5) return;
    achieved = (simulation->time() - measured_time) / wall;
    measured_from = Clock::now();
    measured_time = simulation->time();
  }

  void work() {
    std::unique_lock lock(mutex);
    while (!quit) {
      while (!queue.empty()) {
        Action action = std::move(queue.front());
        queue.pop_front();
        busy = true;
        lock.unlock();
        act(action);
        lock.lock();
        wanted = true;
      }
      const double wait = ahead();
      const bool step_now = playing && wait <= 0.0;
      if (step_now) {
        lock.unlock();
        advance();
        measure();
        lock.lock();
        if (!playing) wanted = true;
      }
      if (wanted || (busy && queue.empty()) || !playing) {
        const bool was_playing = playing;
        if (wanted || busy) {
          lock.unlock();
          publish();
          lock.lock();
        }
        if (queue.empty()) {
          busy = false;
          done.notify_all();
          if (!was_playing) wake.wait(lock, [&] { return quit || wanted || !queue.empty(); });
        }
      }
      if (playing && !step_now && queue.empty() && !wanted) wake.wait_for(lock, std::chrono::duration<double>(std::min(wait, 0.02)));
    }
  }
};

Runner::Runner() : core_(std::make_unique<Core>()) {
  core_->thread = std::thread([core = core_.get()] { core->work(); });
}

Runner::~Runner() {
  {
    const std::scoped_lock lock(core_->mutex);
    core_->quit = true;
  }
  core_->wake.notify_all();
  core_->thread.join();
}

void Runner::post(Action action) {
  {
    const std::scoped_lock lock(core_->mutex);
    core_->queue.push_back(std::move(action));
    core_->busy = true;
  }
  core_->wake.notify_all();
}

std::shared_ptr<const Snapshot> Runner::snapshot() {
  std::shared_ptr<const Snapshot> newest;
  {
    const std::scoped_lock lock(core_->mutex);
    newest = core_->published;
    if (core_->published->playing) core_->wanted = true;
  }
  return newest;
}

std::shared_ptr<const Snapshot> Runner::settled() {
  std::unique_lock lock(core_->mutex);
  core_->wanted = true;
  core_->wake.notify_all();
  core_->done.wait(lock, [&] { return core_->queue.empty() && !core_->busy && !core_->wanted; });
  return core_->published;
}

std::shared_ptr<const Snapshot> Runner::finished() {
  post(Play{});
  for (;;) {
    auto now = settled();
    if (!now->playing) return now;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace thicket::gui
