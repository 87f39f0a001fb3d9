#include "thicket/gui/window.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "desk.hpp"
#include "thicket/base/files.hpp"

namespace thicket::gui {
namespace {

using Clock = std::chrono::steady_clock;
double seconds(Clock::time_point from, Clock::time_point to) { return std::chrono::duration<double>(to - from).count(); }

/// Frames' times, bounded: the newest 10,000 for the median, and the longest of all.
struct FrameTimes {
  std::vector<double> newest;
  std::uint64_t count = 0;
  double first = 0.0, longest = 0.0;  ///< the first, in which OpenGL gets ready, is told apart

  void add(double s) {
    if (count == 0) {
      first = s;
      ++count;
      return;
    }
    if (newest.size() < 10000) newest.push_back(s);
    else newest[count % newest.size()] = s;
    ++count;
    longest = std::max(longest, s);
  }
  double median() const {
    if (newest.empty()) return 0.0;
    std::vector<double> sorted = newest;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
    return sorted[sorted.size() / 2];
  }
};

Report report_of(const Snapshot& now, const Workbench& bench, const FrameTimes& times, std::uint64_t gl_errors) {
  Report r;
  r.file = now.file.string();
  r.newest_step = now.newest_step;
  r.frames = times.count;
  r.gl_errors = gl_errors;
  r.median_frame_ms = 1e3 * times.median();
  r.first_frame_ms = 1e3 * times.first;
  r.longest_frame_ms = 1e3 * times.longest;
  const auto& pane = bench.left_pane();
  r.left = static_cast<double>(pane.low.x), r.top = static_cast<double>(pane.low.y);
  r.width = static_cast<double>(pane.size.x), r.height = static_cast<double>(pane.size.y);
  if (!now.simulation) return r;
  const Simulation& s = *now.simulation;
  r.mission = s.mission().name;
  r.planner = s.mission().planner.name;
  r.steps = s.steps();
  r.time = s.time();
  r.x = s.vehicle().pose.position.x, r.y = s.vehicle().pose.position.y;
  if (const auto& goal = s.mission().planner.goal_m) r.goal = {goal->x, goal->y};
  if (s.verdict()) r.verdict = to_string(s.verdict()->kind);
  return r;
}

std::string title_of(const Snapshot& now) {
  if (!now.simulation) return "Thicket";
  return fmt::format("{}{} - Thicket", now.simulation->mission().name, now.mission_changed || now.world_changed ? " (changed)" : "");
}

struct Session {
  Runner& runner;
  Platform& platform;
  Workbench& bench;
  FrameTimes times;
  std::uint64_t gl_errors = 0;

  void run() {
    constexpr double rate = 60.0, rest = 0.25, lively = 0.5;  // Hz, s, s
    const Clock::time_point start = Clock::now();
    Clock::time_point last_event = start;
    std::shared_ptr<const Snapshot> shown;
    while (!platform.closing() && !bench.quits()) {
      auto now = runner.snapshot();
      // Nothing moves: wait for the person. What they do may take a while to show.
      const bool idle = shown && !now->playing && !shown->playing && now == shown && !bench.moves() && seconds(last_event, Clock::now()) > lively;
      const bool happened = platform.poll(idle ? rest : 0.0);
      const Clock::time_point begun = Clock::now();
      if (happened) last_event = begun;
      now = runner.snapshot();
      if (now != shown && !now->playing) last_event = begun;
      if (idle && !happened && now == shown && platform.stick().forward == 0.0 && platform.stick().left == 0.0) continue;
      platform.begin();
      bench.draw(*now, platform);
      platform.draw(palette(bench.settings().dark).background);
      bench.take_pictures(platform, seconds(start, Clock::now()));
      times.add(seconds(begun, Clock::now()));
      platform.title(title_of(*now));
      platform.show();
      gl_errors += platform.faults();
      shown = std::move(now);
      // Where showing does not wait for the screen, the simulation shall have the processor.
      const double left = 1.0 / rate - seconds(begun, Clock::now());
      if (left > 0.0) std::this_thread::sleep_for(std::chrono::duration<double>(left));
    }
  }
};

}  // namespace

Result<Done> show_window(const WindowOptions& options) {
  if (const std::string why = no_screen(); !why.empty()) return Error{why};
  // What the command line names must be there; what is opened later may be wrong, and leaves what was open.
  Runner runner;
  if (!options.file.empty()) {
    runner.post(Open{options.file, options.overrides});
    if (const auto now = runner.settled(); !now->simulation) return Error{now->message.text};
  }
  const std::filesystem::path remembered = settings_file();
  const Settings settings = remembered.empty() ? Settings{} : read_settings(remembered);
  auto platform = open_screen("Thicket", {settings.width, settings.height});
  if (!platform) return platform.error();
  if (!settings.imgui.empty()) ImGui::LoadIniSettingsFromMemory(settings.imgui.c_str(), settings.imgui.size());
  Workbench bench(runner, settings);
  if (options.file.empty()) bench.ask_for_a_file();
  Session session{runner, **platform, bench, {}, 0};
  session.run();

  Settings& kept = bench.settings();
  kept.width = static_cast<int>(ImGui::GetIO().DisplaySize.x);
  kept.height = static_cast<int>(ImGui::GetIO().DisplaySize.y);
  kept.imgui = ImGui::SaveIniSettingsToMemory();
  // (A folder that cannot be written to is no reason to fail.)
  if (!remembered.empty()) (void)write_settings(remembered, kept);
  runner.post(Pause{});
  const Report report = report_of(*runner.settled(), bench, session.times, session.gl_errors);
  if (options.report.empty()) return Done{};
  return write_file(options.report, report_json(report));
}

}  // namespace thicket::gui
