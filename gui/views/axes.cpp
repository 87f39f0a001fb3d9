#include "axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace thicket::gui {

Ticks nice_ticks(double low, double high, int at_most) {
  Ticks ticks;
  if (!(high > low) || !std::isfinite(high - low) || at_most < 1) return ticks;
  const auto count = [&](double step) { return std::floor(high / step + 1e-9) - std::ceil(low / step - 1e-9) + 1.0; };
  double power = std::pow(10.0, std::floor(std::log10((high - low) / at_most)) - 1.0);
  for (bool found = false; !found; power *= 10.0)
    for (const double factor : {1.0, 2.0, 5.0})
      if (count(factor * power) <= at_most) {
        ticks.step = factor * power;
        found = true;
        break;
      }
  const double first = std::ceil(low / ticks.step - 1e-9);
  for (int i = 0; i < static_cast<int>(count(ticks.step)); ++i) ticks.at.push_back((first + i) * ticks.step + 0.0);
  return ticks;
}

std::string tick_text(double value, double step) {
  if (std::abs(value) < 1e-9 * step) value = 0.0;
  if (step < 1e-5 || step >= 1e7) return fmt::format("{:.3g}", value);
  const int digits = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  return fmt::format("{:.{}f}", value, digits);
}

void Range::hold(double value) {
  if (!std::isfinite(value)) return;
  low = std::min(low, value);
  high = std::max(high, value);
}

Range Range::padded(double share) const {
  if (empty()) return {0.0, 1.0};
  const double more = high > low ? share * (high - low) : std::max(0.5, 0.1 * std::abs(low));
  return {low - more, high + more};
}

Chart begin_chart(const Frame& frame, const char* id, ImVec2 size, Range x, Range y, const char* x_title, const char* y_title) {
  const float line = ImGui::GetTextLineHeight(), gap = 0.3f * line;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  if (size.x <= 0.0f) size.x = ImGui::GetContentRegionAvail().x;
  size = {std::max(size.x, 8.0f * line), std::max(size.y, 5.0f * line)};
  ImGui::InvisibleButton(id, size);

  Chart chart{{corner.x + 4.0f * line, corner.y + line + gap}, {corner.x + size.x - line, corner.y + size.y - (x_title ? 2.0f : 1.0f) * line - 2.0f * gap}, x, y};
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  chart.hovered = !frame.still && ImGui::IsItemHovered() && mouse.x >= chart.low.x && mouse.x < chart.high.x && mouse.y >= chart.low.y && mouse.y < chart.high.y;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(chart.low, chart.high, frame.colours.background);
  const Ticks across = nice_ticks(x.low, x.high, std::max(2, static_cast<int>((chart.high.x - chart.low.x) / (5.0f * line))));
  for (const double at : across.at) {
    const float px = chart.to_x(at);
    draw.AddLine({px, chart.low.y}, {px, chart.high.y}, frame.colours.grid);
    const std::string text = tick_text(at, across.step);
    draw.AddText({px - 0.5f * ImGui::CalcTextSize(text.c_str()).x, chart.high.y + gap}, frame.colours.grid_text, text.c_str());
  }
  const Ticks upward = nice_ticks(y.low, y.high, std::max(2, static_cast<int>((chart.high.y - chart.low.y) / (1.8f * line))));
  for (const double at : upward.at) {
    const float py = chart.to_y(at);
    draw.AddLine({chart.low.x, py}, {chart.high.x, py}, frame.colours.grid);
    const std::string text = tick_text(at, upward.step);
    draw.AddText({chart.low.x - gap - ImGui::CalcTextSize(text.c_str()).x, py - 0.5f * line}, frame.colours.grid_text, text.c_str());
  }
  draw.AddRect(chart.low, chart.high, frame.colours.grid_text);
  draw.AddText({chart.low.x, corner.y}, frame.colours.text, y_title);
  if (x_title) draw.AddText({0.5f * (chart.low.x + chart.high.x - ImGui::CalcTextSize(x_title).x), chart.high.y + line + gap}, frame.colours.grid_text, x_title);
  draw.PushClipRect(chart.low, chart.high, true);
  return chart;
}

void end_chart() { ImGui::GetWindowDrawList()->PopClipRect(); }

void label(const Frame& frame, ImVec2 at, const std::string& words, ImU32 colour) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 size = ImGui::CalcTextSize(words.c_str());
  draw.AddRectFilled({at.x - 3.0f, at.y - 1.0f}, {at.x + size.x + 3.0f, at.y + size.y + 1.0f}, (frame.colours.background & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 200));
  draw.AddText(at, colour, words.c_str());
}

ImU32 heat(double share) {
  static constexpr std::array<std::array<double, 3>, 5> stops{{{8, 8, 28}, {62, 38, 118}, {178, 66, 98}, {242, 148, 46}, {252, 244, 164}}};
  const double at = std::clamp(std::isfinite(share) ? share : 0.0, 0.0, 1.0) * (stops.size() - 1);
  const std::size_t i = std::min(stops.size() - 2, static_cast<std::size_t>(at));
  const auto channel = [&](std::size_t c) { return static_cast<int>(std::lround(stops[i][c] + (at - static_cast<double>(i)) * (stops[i + 1][c] - stops[i][c]))); };
  return IM_COL32(channel(0), channel(1), channel(2), 255);
}

}  // namespace thicket::gui
