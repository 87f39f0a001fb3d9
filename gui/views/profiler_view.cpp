#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <deque>

#include "../view.hpp"

namespace thicket::gui {
namespace {

using Clock = std::chrono::steady_clock;

/// What a run had added up at one moment.
struct Account {
  Clock::time_point wall;
  std::uint64_t steps = 0, rays = 0;
  double time = 0.0;
  PhaseTimes phases;
};

struct Share {
  const char* name;
  const char* of;
  double seconds;  ///< a step
  ImU32 colour;
};

class ProfilerView final : public View {
 public:
  const char* name() const override { return "Profiler"; }
  void draw(const Frame& frame) override;

 private:
  void note(const Snapshot& now);
  void draw_steps(const Frame& frame);
  void draw_speed(const Frame& frame);
  void draw_memory(const Frame& frame);

  std::deque<Account> accounts_;  ///< of the last second of a run that plays
  std::uint64_t run_ = 0;
};

Account account_of(const Simulation& s) { return {Clock::now(), s.steps(), s.totals().rays, s.time(), s.phase_times()}; }

double seconds_between(const Account& a, const Account& b) { return std::chrono::duration<double>(b.wall - a.wall).count(); }

void row(const char* what, const std::string& value) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(what);
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(value.c_str());
}

bool begin_rows(const char* id) {
  if (!ImGui::BeginTable(id, 2, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg)) return false;
  ImGui::TableSetupColumn("what", 0, 18.0f * ImGui::GetFontSize());
  ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch);
  return true;
}

std::string bytes_text(std::size_t bytes) {
  const auto b = static_cast<double>(bytes);
  return b < 1e6 ? fmt::format("{:.1f} kB", b / 1e3) : fmt::format("{:.1f} MB", b / 1e6);
}

void ProfilerView::note(const Snapshot& now) {
  const Account account = account_of(*now.simulation);
  const bool other = now.run_revision != run_ || (!accounts_.empty() && account.steps < accounts_.back().steps);
  if (other || !now.playing) accounts_.clear();
  run_ = now.run_revision;
  if (!now.playing) return;
  if (accounts_.empty() || account.steps > accounts_.back().steps) accounts_.push_back(account);
  while (accounts_.size() > 2 && seconds_between(accounts_[1], account) > 1.0) accounts_.pop_front();
}

void ProfilerView::draw(const Frame& frame) {
  if (!frame.now.simulation) return ImGui::TextUnformatted("Nothing is open.");
  note(frame.now);
  draw_steps(frame);
  ImGui::Spacing();
  draw_speed(frame);
  ImGui::Spacing();
  draw_memory(frame);
}

void ProfilerView::draw_steps(const Frame& frame) {
  // The last second while it plays, else the whole run; then nobody knows how long it took beside its phases.
  const bool recent = accounts_.size() > 1;
  const Account from = recent ? accounts_.front() : Account{}, to = recent ? accounts_.back() : account_of(*frame.now.simulation);
  const double steps = static_cast<double>(to.steps - from.steps);
  if (steps <= 0.0) return ImGui::TextUnformatted("No step was made yet.");
  const Palette& c = frame.colours;
  const auto per_step = [&](double PhaseTimes::*phase) { return (to.phases.*phase - from.phases.*phase) / steps; };
  std::array shares{Share{"trace", "sensors look along their rays", per_step(&PhaseTimes::trace), c.ray | IM_COL32_A_MASK},
                    Share{"map", "scans are taken into the map", per_step(&PhaseTimes::map), c.goal | IM_COL32_A_MASK},
                    Share{"plan", "bumpers and planner", per_step(&PhaseTimes::plan), c.estimate | IM_COL32_A_MASK},
                    Share{"contact", "clearance, contact, motion", per_step(&PhaseTimes::contact), c.robot | IM_COL32_A_MASK},
                    Share{"other", frame.now.speed_wanted > 0.0 ? "waiting for the clock, copies for the window, the rest" : "copies for the window, the rest", 0.0, c.unseen | IM_COL32_A_MASK}};
  double sum = 0.0;
  for (const Share& share : shares) sum += share.seconds;
  if (recent) {
    shares.back().seconds = std::max(0.0, seconds_between(from, to) / steps - sum);
    sum += shares.back().seconds;
  }
  ImGui::Text("Where a step's time goes, %s (%.0f steps)", recent ? "over the last second" : "over the whole run", steps);

  const ImVec2 low = ImGui::GetCursorScreenPos();
  const float width = std::max(1.0f, ImGui::GetContentRegionAvail().x), height = 1.6f * ImGui::GetTextLineHeight();
  float x = low.x;
  for (const Share& share : shares) {
    const float next = x + width * static_cast<float>(share.seconds / std::max(sum, 1e-12));
    ImGui::GetWindowDrawList()->AddRectFilled({x, low.y}, {next, low.y + height}, share.colour);
    x = next;
  }
  ImGui::Dummy({width, height});

  if (!ImGui::BeginTable("steps", 4, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg)) return;
  ImGui::TableSetupColumn("phase", 0, 8.0f * ImGui::GetFontSize());
  ImGui::TableSetupColumn("ms a step", 0, 6.0f * ImGui::GetFontSize());
  ImGui::TableSetupColumn("share", 0, 5.0f * ImGui::GetFontSize());
  ImGui::TableSetupColumn("what", ImGuiTableColumnFlags_WidthStretch);
  ImGui::TableHeadersRow();
  for (const Share& share : shares) {
    if (!recent && &share == &shares.back()) continue;
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float side = 0.7f * ImGui::GetTextLineHeight();
    ImGui::GetWindowDrawList()->AddRectFilled({at.x, at.y + 0.2f * side}, {at.x + side, at.y + 1.2f * side}, share.colour);
    ImGui::Indent(1.4f * side);
    ImGui::TextUnformatted(share.name);
    ImGui::Unindent(1.4f * side);
    ImGui::TableNextColumn();
    ImGui::Text("%.4f", share.seconds * 1e3);
    ImGui::TableNextColumn();
    ImGui::Text("%.1f %%", 100.0 * share.seconds / std::max(sum, 1e-12));
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(share.of);
  }
  ImGui::EndTable();
}

void ProfilerView::draw_speed(const Frame& frame) {
  const Simulation& s = *frame.now.simulation;
  if (!begin_rows("speed")) return;
  const Snapshot& now = frame.now;
  row("real-time factor wanted", now.speed_wanted > 0.0 ? fmt::format("{:.2f}", now.speed_wanted) : "as fast as possible");
  row("real-time factor achieved", now.playing ? fmt::format("{:.2f}", now.speed_achieved) : "paused");
  if (accounts_.size() > 1) {
    const double wall = seconds_between(accounts_.front(), accounts_.back());
    row("steps a second", fmt::format("{:.0f}", static_cast<double>(accounts_.back().steps - accounts_.front().steps) / wall));
    row("rays a second of wall time", fmt::format("{:.0f}", static_cast<double>(accounts_.back().rays - accounts_.front().rays) / wall));
  }
  if (const double trace = s.phase_times().trace; trace > 0.0)
    row("rays a second of tracing", fmt::format("{:.3g}", static_cast<double>(s.totals().rays) / trace));
  row("rays, scans, decisions", fmt::format("{}, {}, {}", s.totals().rays, s.totals().scans, s.totals().decisions));
  const double rate = static_cast<double>(ImGui::GetIO().Framerate);
  if (!frame.still && rate > 0.0) row("the window: ms a frame", fmt::format("{:.1f} ({:.0f} frames a second)", 1e3 / rate, rate));
  ImGui::EndTable();
}

void ProfilerView::draw_memory(const Frame& frame) {
  const Simulation& s = *frame.now.simulation;
  if (!begin_rows("memory")) return;
  row("map: known cells", fmt::format("{} of {} m", s.map().known_cells(), s.map().resolution()));
  row("map: cells updated so far", fmt::format("{}", s.map().cells_updated()));
  row("map: memory", bytes_text(s.map().memory_bytes()));
  const SceneFigures figures = s.scene().figures();
  row("scene: parts, triangles, instances", fmt::format("{}, {}, {}", figures.parts, figures.triangles, figures.instances));
  row("scene: memory, time to build", fmt::format("{}, {:.1f} ms", bytes_text(figures.memory_bytes), 1e3 * figures.build_s));
  row("samples of this run", fmt::format("{} ({})", frame.now.samples.size(), bytes_text(frame.now.samples.size() * sizeof(Sample))));
  ImGui::EndTable();
}

}  // namespace

std::unique_ptr<View> make_profiler_view() { return std::make_unique<ProfilerView>(); }

}  // namespace thicket::gui
