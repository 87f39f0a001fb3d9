#include "key_widget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace thicket::gui {
namespace {

constexpr std::size_t longest_text = 4096;
constexpr std::size_t most_rows = 200;  // of points that are shown one by one

std::string number_text(double number) { return fmt::format("{}", number); }

/// Numbers beside each other; when one was committed all of them, as a TOML array.
std::optional<std::string> numbers_row(const std::vector<double>& numbers, float width, Typing& typing) {
  std::optional<std::string> committed;
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
  const float each = std::max(20.0f, (width - gap * static_cast<float>(numbers.size() - 1)) / static_cast<float>(std::max<std::size_t>(1, numbers.size())));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    if (i > 0) ImGui::SameLine(0.0f, gap);
    ImGui::SetNextItemWidth(each);
    std::string text = number_text(numbers[i]);
    if (text_field("##n", text, typing)) {
      std::string all;
      for (std::size_t j = 0; j < numbers.size(); ++j) all += (j > 0 ? ", " : "") + (j == i ? text : to_toml(Value(numbers[j])));
      committed = "[" + all + "]";
    }
    ImGui::PopID();
  }
  return committed;
}

std::optional<std::string> points_list(const Key& key, std::vector<std::vector<double>> points, Typing& typing) {
  std::optional<std::string> committed;
  const float button = ImGui::GetFrameHeight(), width = ImGui::GetContentRegionAvail().x - button - ImGui::GetStyle().ItemSpacing.x;
  std::optional<std::size_t> dropped;
  for (std::size_t i = 0; i < std::min(points.size(), most_rows); ++i) {
    ImGui::PushID(static_cast<int>(i));
    ImGui::BeginGroup();
    if (const auto row = numbers_row(points[i], width, typing)) {
      std::string all;
      for (std::size_t j = 0; j < points.size(); ++j) all += (j > 0 ? ", " : "") + (j == i ? *row : to_toml(Value(points[j])));
      committed = "[" + all + "]";
    }
    ImGui::EndGroup();
    ImGui::SameLine();
    if (ImGui::Button("x", {button, 0.0f})) dropped = i;
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("drop this point");
    ImGui::PopID();
  }
  if (points.size() > most_rows) ImGui::TextDisabled("and %d more", static_cast<int>(points.size() - most_rows));
  if (ImGui::Button("+ point")) {
    points.push_back(points.empty() ? std::vector<double>(std::max<std::size_t>(2, key.length_min), 0.0) : points.back());
    // Two points at one place would be refused for a wall.
    if (points.size() > 1) points.back()[0] += 1.0;
    committed = to_toml(Value(points));
  }
  if (dropped) {
    points.erase(points.begin() + static_cast<std::ptrdiff_t>(*dropped));
    committed = to_toml(Value(points));
  }
  return committed;
}

}  // namespace

bool text_field(const char* label, std::string& text, Typing& typing) {
  const ImGuiID id = ImGui::GetID(label);
  // Left while it was not drawn: what was typed is dropped.
  if (typing.field == id && typing.frame + 1 < ImGui::GetFrameCount()) typing.field = 0;
  const std::string& shown = typing.field == id ? typing.text : text;
  std::array<char, longest_text> buffer{};
  std::memcpy(buffer.data(), shown.data(), std::min(shown.size(), buffer.size() - 1));
  ImGui::InputText(label, buffer.data(), buffer.size(), ImGuiInputTextFlags_AutoSelectAll);
  if (ImGui::IsItemActive()) {
    typing = {id, ImGui::GetFrameCount(), buffer.data()};
    return false;
  }
  if (typing.field != id) return false;
  typing.field = 0;
  if (text == buffer.data()) return false;
  text = buffer.data();
  return true;
}

bool choice_field(const char* label, std::string& chosen, const std::vector<std::string>& choices) {
  bool changed = false;
  if (!ImGui::BeginCombo(label, chosen.c_str())) return false;
  for (const std::string& choice : choices) {
    const bool is = choice == chosen;
    if (ImGui::Selectable(choice.c_str(), is) && !is) {
      chosen = choice;
      changed = true;
    }
    if (is) ImGui::SetItemDefaultFocus();
  }
  ImGui::EndCombo();
  return changed;
}

std::optional<std::string> key_widget(const Key& key, const Value& now, Typing& typing) {
  const float width = ImGui::GetContentRegionAvail().x;
  ImGui::SetNextItemWidth(width);
  if (const bool* flag = std::get_if<bool>(&now)) {
    bool on = *flag;
    if (ImGui::Checkbox("##flag", &on)) return on ? "true" : "false";
    return std::nullopt;
  }
  if (const auto* words = std::get_if<std::string>(&now)) {
    std::string text = *words;
    if (!key.choices.empty()) return choice_field("##choice", text, key.choices) ? std::optional(toml_string(text)) : std::nullopt;
    if (!text_field("##text", text, typing)) return std::nullopt;
    return key.kind == KeyKind::text ? toml_string(text) : text;  // a number's word, or a number in its place
  }
  if (const auto* numbers = std::get_if<std::vector<double>>(&now); numbers && key.length_min == key.length_max) return numbers_row(*numbers, width, typing);
  if (const auto* points = std::get_if<std::vector<std::vector<double>>>(&now)) return points_list(key, *points, typing);
  // Numbers, integers, and lists of numbers of any length.
  std::string text = std::holds_alternative<double>(now) ? number_text(std::get<double>(now)) : to_toml(now);
  if (text_field("##value", text, typing)) return text;
  return std::nullopt;
}

void key_tooltip(const Key& key, const Value& usual) {
  if (!ImGui::IsItemHovered()) return;
  std::string limits;
  if (key.kind != KeyKind::flag && key.kind != KeyKind::text) {
    if (std::isfinite(key.range.minimum)) limits += fmt::format("{} {}", key.range.above_minimum ? "above" : "at least", key.range.minimum);
    if (std::isfinite(key.range.maximum)) limits += fmt::format("{}at most {}", limits.empty() ? "" : ", ", key.range.maximum);
    if (!key.unit.empty() && !limits.empty()) limits += " " + key.unit;
    if (!key.word.empty()) limits += fmt::format("{}or '{}'", limits.empty() ? "" : ", ", key.word);
  }
  const std::string standard = std::holds_alternative<std::monostate>(usual) ? "not given" : to_toml(usual);
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 28.0f);
  ImGui::TextUnformatted(key.help.c_str());
  if (!limits.empty()) ImGui::TextDisabled("%s", limits.c_str());
  ImGui::TextDisabled("default %s", standard.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

}  // namespace thicket::gui
