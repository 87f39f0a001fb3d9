#include "desk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace thicket::gui {
namespace {

constexpr std::array speeds{0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 0.0};

View* find(const std::vector<std::unique_ptr<View>>& views, const char* name) {
  const auto found = std::find_if(views.begin(), views.end(), [&](const auto& view) { return small_name(*view) == name; });
  return found == views.end() ? nullptr : found->get();
}

}  // namespace

std::vector<std::unique_ptr<View>> make_views() {
  std::vector<std::unique_ptr<View>> views;
  for (auto* make : {make_world_view, make_space_view, make_map_view, make_radar_view, make_sar_view, make_mission_view, make_edit_view, make_planner_view, make_plots_view, make_profiler_view}) views.push_back(make());
  return views;
}

std::string small_name(const View& view) {
  std::string name = view.name();
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name;
}

Workbench::Workbench(Runner& runner, Settings settings, bool still) : runner_(runner), settings_(std::move(settings)), still_(still), views_(make_views()) {
  const auto pane = [&](std::initializer_list<const char*> names, std::string& shown) {
    Pane p;
    for (const char* name : names)
      if (View* view = find(views_, name)) p.views.push_back(view);
    p.shown = &shown;
    return p;
  };
  left_ = pane({"world", "3d"}, settings_.left_view);
  upper_ = pane({"map", "radar", "sar", "mission", "edit"}, settings_.upper_view);
  lower_ = pane({"planner", "plots", "profiler"}, settings_.lower_view);
}

void Workbench::say(bool error, std::string text) {
  if (!error) std::erase_if(notes_, [](const Note& note) { return !note.error; });
  // Who tries a broken file again has one message of it, not two.
  std::erase_if(notes_, [&](const Note& note) { return note.text == text; });
  notes_.push_back({error, std::move(text), ImGui::GetTime() + 8.0});
}

void Workbench::watch(const Snapshot& now) {
  if (now.message.number > last_message_) {
    last_message_ = now.message.number;
    say(now.message.error, now.message.text);
  }
  if (now.file != last_file_ && !now.file.empty()) {
    last_file_ = now.file;
    saved_as_.clear();
    settings_.used(now.file);
  }
  if (!still_) std::erase_if(notes_, [](const Note& note) { return !note.error && ImGui::GetTime() > note.until; });
}

void Workbench::drive(const Snapshot& now, const Stick& stick) {
  if (!now.simulation) return;
  by_hand_ = now.simulation->driven_by_hand() && (by_hand_ || !driving_);
  const VehicleSpec& vehicle = now.simulation->mission().vehicle;
  // What flies is flown by hand at a speed that a room has space for, and down so gently that the floor is a landing.
  const double fast = vehicle.flies() ? std::min(vehicle.speed_max_m_s, 1.0) : vehicle.speed_max_m_s;
  const double climb = vehicle.flies() ? std::min(vehicle.climb_rate_max_m_s, 0.9 * vehicle.landing_speed_max_m_s) : 0.0;
  const Command command = hand_command(stick, fast, radians(vehicle.turn_rate_max_deg_s), chords_, climb);
  const auto same = [](const Command& a, const Command& b) { return a.speed == b.speed && a.turn_rate == b.turn_rate && a.lateral == b.lateral && a.climb == b.climb; };
  if (!same(command, Command{})) {
    // Each change is a thing that the person did, and kept as such: not one a frame.
    if (!driving_ || !same(command, last_command_)) runner_.post(Drive{command});
    if (!driving_ && !now.playing) say(false, fmt::format("time stands still: {} plays", key_of(Deed::play)));
    driving_ = true;
    last_command_ = command;
  } else if (driving_) {
    driving_ = false;
    runner_.post(Drive{by_hand_ ? std::optional(Command{}) : std::nullopt});
  }
}

void Workbench::change_speed(const Snapshot& now, int by) {
  std::size_t at = speeds.size() - 1;
  for (std::size_t i = 0; i + 1 < speeds.size(); ++i)
    if (std::abs(std::log(now.speed_wanted > 0.0 ? now.speed_wanted / speeds[i] : 1e9)) < 0.3) at = i;
  const auto next = std::clamp(static_cast<int>(at) + by, 0, static_cast<int>(speeds.size()) - 1);
  runner_.post(SetSpeed{speeds[static_cast<std::size_t>(next)]});
}

void Workbench::act(Deed deed, const Snapshot& now) {
  switch (deed) {
    case Deed::play: return now.playing ? runner_.post(Pause{}) : runner_.post(Play{});
    case Deed::back: return runner_.post(StepBy{-1});
    case Deed::forward: return runner_.post(StepBy{1});
    case Deed::back_ten: return runner_.post(StepBy{-10});
    case Deed::forward_ten: return runner_.post(StepBy{10});
    case Deed::reset: return runner_.post(Reset{});
    case Deed::reload: return runner_.post(Reload{});
    case Deed::faster: return change_speed(now, 1);
    case Deed::slower: return change_speed(now, -1);
    case Deed::by_hand:
      if (!now.simulation) return;
      by_hand_ = !now.simulation->driven_by_hand();
      runner_.post(Drive{by_hand_ ? std::optional(Command{}) : std::nullopt});
      return say(false, by_hand_ ? now.simulation->mission().vehicle.flies() ? "flown by hand: W A S D, Q and E sideways, R up, F down" : "driven by hand: W A S D or the left stick of a gamepad" : "the planner drives");
    case Deed::next_view: {
      const auto shown = std::find_if(upper_.views.begin(), upper_.views.end(), [&](const View* view) { return view->name() == *upper_.shown; });
      if (upper_.views.empty()) return;
      const std::size_t next = shown == upper_.views.end() ? 0 : static_cast<std::size_t>(shown - upper_.views.begin()) + 1;
      *upper_.shown = upper_.views[next % upper_.views.size()]->name();
      upper_.select = true;
      return;
    }
    case Deed::open: return open_dialog_.show();
    case Deed::save_mission: return save_mission(now, false);
    case Deed::save_mission_as: return save_mission(now, true);
    case Deed::export_map: return export_map(now);
    case Deed::screenshot: wants_picture_ = true; return;
    case Deed::record: wants_record_ = true; return;
    case Deed::light: settings_.dark = !settings_.dark; return;
    case Deed::help: help_ = !help_; return;
    case Deed::quit: quits_ = true; return;
    case Deed::drive_forward:
    case Deed::drive_back:
    case Deed::drive_left:
    case Deed::drive_right:
    case Deed::fly_up:
    case Deed::fly_down:
    case Deed::fly_left:
    case Deed::fly_right: return;
  }
}

void Workbench::draw(const Snapshot& now, Platform& platform) {
  watch(now);
  use_look(settings_.dark, platform.scale());
  if (!still_) {
    const bool asked = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
    const std::vector<KeyPress> pressed = platform.pressed();
    for (const KeyPress& press : pressed)
      if (const auto deed = deed_of(press, ImGui::GetIO().WantTextInput); deed && (!asked || deed == Deed::quit || deed == Deed::screenshot)) act(*deed, now);
    follow(chords_, pressed);
    drive(now, platform.stick());
    for (const auto& file : platform.dropped()) open(file);
  }
  const Palette colours = palette(settings_.dark);
  const Frame frame{now, colours, platform.textures(), desk_, [this](Action action) { runner_.post(std::move(action)); }, platform.scale(), still_};
  const ImGuiIO& io = ImGui::GetIO();
  ImGui::SetNextWindowPos({0.0f, 0.0f});
  ImGui::SetNextWindowSize(io.DisplaySize);
  ImGui::Begin("Thicket", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_MenuBar);
  draw_menu(now);
  draw_transport(now);
  const double status = status_height();
  draw_panes(frame, static_cast<double>(ImGui::GetContentRegionAvail().y) - status - static_cast<double>(ImGui::GetStyle().ItemSpacing.y));
  draw_status(frame, status);
  if (const auto file = open_dialog_.draw(platform.scale())) open(*file);
  ask_dialog_.draw(platform.scale());
  ImGui::End();
  draw_help();
}

void Workbench::draw_help() {
  if (!help_) return;
  ImGui::SetNextWindowPos({0.5f * ImGui::GetIO().DisplaySize.x, 0.5f * ImGui::GetIO().DisplaySize.y}, ImGuiCond_Appearing, {0.5f, 0.5f});
  if (ImGui::Begin("Keys", &help_, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings)) {
    const auto row = [](const char* keys, const char* help) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(keys);
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(help);
    };
    constexpr auto look = ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingFixedFit;
    ImGui::BeginGroup();
    if (ImGui::BeginTable("keys", 2, look)) {
      for (const KeyBinding& binding : key_table())
        if (*binding.keys) row(binding.keys, binding.help);
      ImGui::EndTable();
    }
    ImGui::EndGroup();
    ImGui::SameLine(0.0f, 2.0f * ImGui::GetFontSize());
    ImGui::BeginGroup();
    for (const auto& view : views_) {
      if (view->own_keys().empty()) continue;
      ImGui::TextDisabled("%s, with the mouse over it", view->name());
      if (ImGui::BeginTable(view->name(), 2, look)) {
        for (const ViewKey& key : view->own_keys()) row(key.key, key.help);
        ImGui::EndTable();
      }
    }
    ImGui::EndGroup();
    ImGui::TextDisabled("A gamepad's left stick drives as W A S D do.");
  }
  ImGui::End();
}

}  // namespace thicket::gui
