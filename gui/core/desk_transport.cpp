// Menu bar and transport bar.
#include <fmt/format.h>

#include <algorithm>

#include "desk.hpp"

namespace thicket::gui {
namespace {

/// A button with what it does, and its key, under the mouse.
bool button(const char* text, Deed deed) {
  const bool pressed = ImGui::Button(text);
  if (ImGui::IsItemHovered())
    for (const KeyBinding& binding : key_table())
      if (binding.deed == deed) {
        ImGui::SetTooltip("%s (%s)", binding.help, binding.keys);
        break;
      }
  ImGui::SameLine();
  return pressed;
}

std::string speed_text(double factor) { return factor > 0.0 ? fmt::format("{:g} x", factor) : "as fast as possible"; }

std::string verdict_text(const Simulation& simulation) {
  const auto& verdict = simulation.verdict();
  if (!verdict) return simulation.decision().state;
  return fmt::format("{}: {}", to_string(verdict->kind), verdict->reason);
}

}  // namespace

void Workbench::draw_recent() {
  if (!ImGui::BeginMenu("Recent files", !settings_.recent.empty())) return;
  std::string chosen;
  for (const std::string& file : settings_.recent)
    if (ImGui::MenuItem(file.c_str())) chosen = file;
  if (!chosen.empty()) open(chosen);
  ImGui::EndMenu();
}

void Workbench::draw_menu(const Snapshot& now) {
  if (!ImGui::BeginMenuBar()) return;
  const auto item = [&](const char* text, Deed deed, bool enabled = true) {
    if (ImGui::MenuItem(text, key_of(deed), false, enabled)) act(deed, now);
  };
  const auto end_menu = [] {
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) ImGui::CloseCurrentPopup();
    ImGui::EndMenu();
  };
  const bool there = now.simulation != nullptr;
  if (ImGui::BeginMenu("File")) {
    item("Open ...", Deed::open);
    draw_recent();
    item("Reload", Deed::reload, there);
    ImGui::Separator();
    item("Save mission", Deed::save_mission, there);
    item("Save mission as ...", Deed::save_mission_as, there);
    item("Export map ...", Deed::export_map, there);
    ImGui::Separator();
    item("Screenshot", Deed::screenshot);
    item(recorder_.running() ? "End video" : "Record video", Deed::record);
    ImGui::Separator();
    item("Quit", Deed::quit);
    end_menu();
  }
  if (ImGui::BeginMenu("View")) {
    for (Pane* pane : {&left_, &upper_, &lower_}) {
      for (const View* view : pane->views)
        if (ImGui::MenuItem(view->name(), nullptr, *pane->shown == view->name())) {
          *pane->shown = view->name();
          pane->select = true;
        }
      ImGui::Separator();
    }
    item(settings_.dark ? "Light" : "Dark", Deed::light);
    end_menu();
  }
  if (ImGui::BeginMenu("Run")) {
    item(now.playing ? "Pause" : "Play", Deed::play, there);
    for (const auto& [text, deed] : {std::pair{"Step forward", Deed::forward}, {"Step back", Deed::back}, {"Ten steps forward", Deed::forward_ten}, {"Ten steps back", Deed::back_ten}, {"Back to the start", Deed::reset}}) item(text, deed, there);
    ImGui::Separator();
    item("Faster", Deed::faster);
    item("Slower", Deed::slower);
    item(there && now.simulation->driven_by_hand() ? "Let the planner drive" : "Drive by hand", Deed::by_hand, there);
    end_menu();
  }
  if (ImGui::BeginMenu("Help")) {
    item("Keys", Deed::help);
    end_menu();
  }
  if (recorder_.running()) ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(palette(settings_.dark).warning), "recording %s", recorder_.file().filename().c_str());
  ImGui::EndMenuBar();
}

void Workbench::draw_speed(const Snapshot& now) {
  ImGui::SetNextItemWidth(9.0f * ImGui::GetFontSize());
  if (ImGui::BeginCombo("##speed", speed_text(now.speed_wanted).c_str())) {
    for (const double factor : {0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 0.0})
      if (ImGui::Selectable(speed_text(factor).c_str(), factor == now.speed_wanted)) runner_.post(SetSpeed{factor});
    ImGui::EndCombo();
  }
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("simulated over real seconds (%s, %s)", key_of(Deed::faster), key_of(Deed::slower));
  ImGui::SameLine();
}

void Workbench::draw_transport(const Snapshot& now) {
  const bool there = now.simulation != nullptr;
  ImGui::BeginDisabled(!there);
  if (button("|<", Deed::reset)) act(Deed::reset, now);
  if (button("<", Deed::back)) act(Deed::back, now);
  if (button(now.playing ? "Pause" : "Play", Deed::play)) act(Deed::play, now);
  if (button(">", Deed::forward)) act(Deed::forward, now);
  draw_speed(now);
  std::uint64_t step = there ? now.simulation->steps() : 0;
  // Before the first step there is nowhere to go, and a grip of half the slider would say otherwise.
  const bool nowhere = now.newest_step <= now.first_step;
  const std::uint64_t first = now.first_step, last = nowhere ? first + 100 : now.newest_step;
  const std::string time = there ? fmt::format("{:.2f} s", now.simulation->time()) : "";
  ImGui::SetNextItemWidth(std::max(120.0f, 0.3f * ImGui::GetContentRegionAvail().x));
  ImGui::BeginDisabled(nowhere && there);
  if (ImGui::SliderScalar("##scrubber", ImGuiDataType_U64, &step, &first, &last, time.c_str(), ImGuiSliderFlags_NoInput | ImGuiSliderFlags_AlwaysClamp) && there && step != now.simulation->steps()) runner_.post(SeekTo{step});
  ImGui::EndDisabled();
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("any step that was, up to the newest");
  ImGui::SameLine();
  ImGui::EndDisabled();
  if (now.playing) ImGui::Text("%.1f x real time", now.speed_achieved);
  else ImGui::TextDisabled("%s", there ? fmt::format("step {} of {}", now.simulation->steps(), now.newest_step).c_str() : "");
  if (!there) return;
  ImGui::SameLine();
  const bool ended = now.simulation->verdict().has_value();
  const Palette colours = palette(settings_.dark);
  const bool good = ended && now.simulation->verdict()->kind == Verdict::Kind::reached;
  ImGui::PushStyleColor(ImGuiCol_Text, good ? colours.goal : ended ? colours.warning : colours.text);
  ImGui::TextUnformatted(verdict_text(*now.simulation).c_str());
  ImGui::PopStyleColor();
}

}  // namespace thicket::gui
