// What the window costs, without a screen: how long its frames take, and how much slower a run is that is watched.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "core/desk.hpp"
#include "or_exit.hpp"
#include "platform/platform.hpp"
#include "study_tables.hpp"
#include "thicket/base/files.hpp"

namespace thicket::gui {
namespace {

using Clock = std::chrono::steady_clock;
double milliseconds_since(Clock::time_point then) { return std::chrono::duration<double, std::milli>(Clock::now() - then).count(); }

/// Frames of the whole window while a mission runs.
class Watcher {
 public:
  Watcher() : platform_(or_exit(open_offscreen({1280, 800}))), bench_(runner_, Settings{}) {}

  void open(const char* mission, std::vector<Override> overrides) {
    runner_.post(Open{mission, std::move(overrides)});
    const auto now = runner_.settled();
    if (!now->simulation) fmt::print(stderr, "{}\n", now->message.text), std::exit(1);
  }
  double frame() {
    const auto begin = Clock::now();
    const auto now = runner_.snapshot();
    platform_->begin();
    bench_.draw(*now, *platform_);
    platform_->draw(palette(true).background);
    platform_->pixels();  // waits until it is drawn, as a screen would
    return milliseconds_since(begin);
  }
  Runner& runner() { return runner_; }

 private:
  Runner runner_;
  std::unique_ptr<Platform> platform_;
  Workbench bench_;
};

void frames(std::vector<study::Row>& rows, const char* what, const char* mission, const std::vector<Override>& overrides, double from) {
  Watcher watcher;
  watcher.open(mission, overrides);
  watcher.runner().post(StepBy{static_cast<int>(from / 0.05)});
  const auto at = watcher.runner().settled();
  std::size_t beams = 0;
  for (const Scan& scan : at->simulation->scans()) beams += scan.beams.size();
  for (int i = 0; i < 10; ++i) watcher.frame();
  const auto take = [&](const char* state) {
    std::vector<double> times;
    for (int i = 0; i < 150; ++i) times.push_back(watcher.frame());
    std::sort(times.begin(), times.end());
    rows.push_back({what, state, std::to_string(beams), std::to_string(at->simulation->map().known_cells()), study::fixed(times[times.size() / 2], 1), study::fixed(times[times.size() * 95 / 100], 1), study::fixed(times.back(), 1)});
  };
  take("paused");
  watcher.runner().post(Play{});
  take("playing, 1 x");
  watcher.runner().post(SetSpeed{0.0});
  take("playing, as fast as possible");
}

const std::vector<Override> for_long = {{"planner.explore_m", "100000.0", "study"}, {"limits.time_s", "1000000.0", "study"}};
constexpr double wall_ms = 2000.0;

/// Simulated seconds a second of wall time, in a run that does not end by itself.
double headless(const char* mission) {
  auto simulation = or_exit(Simulation::create(or_exit(read_mission(find_input(mission), for_long))));
  const auto begin = Clock::now();
  while (milliseconds_since(begin) < wall_ms && simulation.step()) {
  }
  return simulation.time() / milliseconds_since(begin) * 1000.0;
}

double watched(const char* mission, bool drawn) {
  Watcher watcher;
  watcher.open(mission, for_long);
  for (int i = 0; i < 5; ++i) watcher.frame();
  watcher.runner().post(SetSpeed{0.0});
  const auto begin = Clock::now();
  watcher.runner().post(Play{});
  while (milliseconds_since(begin) < wall_ms) {
    // As a screen of 60 frames a second has it.
    const double took = drawn ? watcher.frame() : (watcher.runner().snapshot(), 0.0);
    if (took < 16.0) std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(16.0 - took));
  }
  watcher.runner().post(Pause{});
  const double wall = milliseconds_since(begin);
  return watcher.runner().settled()->simulation->time() / wall * 1000.0;
}

int call() {
  std::vector<study::Row> rows, speeds;
  frames(rows, "360 beams, map of 1000 x 1000, trail", "foliage_wall/bug2", {{"map.resolution_m", "0.02", "study"}, {"sensor.step_deg", "1.0", "study"}}, 40.0);
  frames(rows, "13,456 beams", "foliage_wall/bug2", {{"sensor.step_deg", "0.026754", "study"}}, 5.0);
  fmt::print("Frames of the whole window, 1280 x 800, drawn without a graphics card, read back included:\n\n{}\n",
             study::markdown({"what", "", "beams", "known cells", "ms, median", "95 %", "longest"}, rows, 2));
  setenv("LP_NUM_THREADS", "1", 0);  // drawing without a card takes one core, as a window's thread does, and the simulation has the other
  for (const char* mission : {"explorers/bounce"}) {
    std::vector<double> ratios, undrawn;
    double alone = 0.0, seen = 0.0, asked = 0.0;
    constexpr int pairs = 9;
    for (int i = 0; i < pairs; ++i) {
      const double a = headless(mission), b = watched(mission, true), c = watched(mission, false);
      ratios.push_back(b / a);
      undrawn.push_back(c / a);
      asked += c / pairs;
      alone += a / pairs;
      seen += b / pairs;
    }
    std::sort(ratios.begin(), ratios.end());
    std::sort(undrawn.begin(), undrawn.end());
    speeds.push_back({mission, study::fixed(alone, 0), study::fixed(asked, 0), study::fixed(undrawn[pairs / 2], 2), study::fixed(seen, 0), study::fixed(ratios[pairs / 2], 2), fmt::format("{} to {}", study::fixed(ratios.front(), 2), study::fixed(ratios.back(), 2))});
  }
  fmt::print("As fast as possible, alone and watched at 60 frames a second (simulated seconds a second, pairs in turn):\n\n{}", study::markdown({"mission", "alone", "with history and snapshots, nothing drawn", "ratio, median", "drawn", "ratio, median", "range"}, speeds, 1));
  return 0;
}

}  // namespace
}  // namespace thicket::gui

int main() { return thicket::gui::call(); }
