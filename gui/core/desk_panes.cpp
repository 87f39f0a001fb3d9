// The panes with the views, the splitters between them, and the status line.
#include <fmt/format.h>

#include <algorithm>

#include "desk.hpp"

namespace thicket::gui {
namespace {

constexpr double thick = 6.0;  ///< of a splitter

/// A bar between two panes; dragging it changes the first one's share of the whole.
void splitter(const char* id, bool upright, const ImVec2& size, double whole, double& share) {
  ImGui::InvisibleButton(id, size);
  if (ImGui::IsItemHovered() || ImGui::IsItemActive()) {
    ImGui::SetMouseCursor(upright ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
    ImGui::GetWindowDrawList()->AddRectFilled(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(), ImGui::GetColorU32(ImGuiCol_SeparatorHovered));
  }
  if (ImGui::IsItemActive() && whole > 0.0) {
    const ImVec2 moved = ImGui::GetIO().MouseDelta;
    share = std::clamp(share + static_cast<double>(upright ? moved.x : moved.y) / whole, 0.1, 0.9);
  }
}

}  // namespace

void Workbench::draw_pane(Pane& pane, const char* id, const ImVec2& size, const Frame& frame) {
  ImGui::BeginChild(id, size, false, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  if (ImGui::BeginTabBar("views", ImGuiTabBarFlags_FittingPolicyScroll)) {
    for (View* view : pane.views) {
      const bool select = pane.select && *pane.shown == view->name();
      if (!ImGui::BeginTabItem(view->name(), nullptr, select ? ImGuiTabItemFlags_SetSelected : ImGuiTabItemFlags_None)) continue;
      if (!pane.select) *pane.shown = view->name();
      else if (select) pane.select = false;
      ImGui::BeginChild(view->name());
      if (&pane == &left_) left_pane_ = {ImGui::GetWindowPos(), ImGui::GetWindowSize()};
      view->draw(frame);
      ImGui::EndChild();
      ImGui::EndTabItem();
    }
    ImGui::EndTabBar();
  }
  ImGui::EndChild();
}

void Workbench::draw_panes(const Frame& frame, double height) {
  const double bar = thick * frame.scale, width = static_cast<double>(ImGui::GetContentRegionAvail().x);
  height = std::max(height, 40.0);
  const auto size = [](double x, double y) { return ImVec2(static_cast<float>(std::max(x, 4.0)), static_cast<float>(std::max(y, 4.0))); };
  const double left = settings_.left_share * (width - bar), upper = settings_.upper_share * (height - bar);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(0.0f, 0.0f));
  const ImGuiStyle own = ImGui::GetStyle();
  // (The views have their own spacing.)
  const auto pane = [&](Pane& p, const char* id, const ImVec2& s) {
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(own.ItemInnerSpacing.x * 2.0f, own.ItemInnerSpacing.x));
    draw_pane(p, id, s, frame);
    ImGui::PopStyleVar();
  };
  pane(left_, "left", size(left, height));
  ImGui::SameLine();
  splitter("between", true, size(bar, height), width - bar, settings_.left_share);
  ImGui::SameLine();
  ImGui::BeginChild("right", size(width - left - bar, height), false, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  pane(upper_, "upper", size(width - left - bar, upper));
  splitter("under", false, size(width - left - bar, bar), height - bar, settings_.upper_share);
  pane(lower_, "lower", size(width - left - bar, height - upper - bar));
  ImGui::EndChild();
  ImGui::PopStyleVar();
}

double Workbench::status_height() const {
  // As high as what there is to read, up to a third of the window.
  double lines = 1.0;
  for (const Note& note : notes_)
    if (note.error) lines += 1.0 + static_cast<double>(std::count(note.text.begin(), note.text.end(), '\n'));
  const double line = static_cast<double>(ImGui::GetTextLineHeightWithSpacing());
  return std::min(lines * line, std::max(line, static_cast<double>(ImGui::GetIO().DisplaySize.y) / 3.0));
}

void Workbench::draw_status(const Frame& frame, double height) {
  ImGui::BeginChild("status", {0.0f, static_cast<float>(height)});
  std::size_t dismissed = notes_.size();
  const Note* newest = nullptr;
  for (std::size_t i = 0; i < notes_.size(); ++i) {
    if (!notes_[i].error) {
      newest = &notes_[i];
      continue;
    }
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::SmallButton("x")) dismissed = i;
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("I have read it");
    ImGui::SameLine();
    ImGui::PushStyleColor(ImGuiCol_Text, frame.colours.warning);
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextUnformatted(notes_[i].text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
    ImGui::PopID();
  }
  if (newest) ImGui::TextUnformatted(newest->text.c_str());
  else if (desk_.tool) ImGui::TextDisabled("%s", desk_.tool->help());
  else ImGui::TextDisabled("%s", fmt::format("{}{} shows every key", frame.now.mission_changed || frame.now.world_changed ? "changed since it was opened; " : "", key_of(Deed::help)).c_str());
  ImGui::EndChild();
  if (dismissed < notes_.size()) notes_.erase(notes_.begin() + static_cast<std::ptrdiff_t>(dismissed));
}

}  // namespace thicket::gui
