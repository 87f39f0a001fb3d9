#include "polar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "waterfall.hpp"

namespace thicket::gui {
namespace {

/// (Linear is by the root: what is weak is seen beside what is strong.)
double brightness(double amplitude, double most, bool decibel) { return decibel ? 1.0 + (decibels(amplitude) - decibels(most)) / 50.0 : std::sqrt(amplitude / most); }

/// The beam of each of these many bearings; those that no beam covers have -1.
std::vector<int> beams_by_bearing(const Scan& scan, std::size_t count) {
  std::vector<int> beams(count, -1);
  const double spacing = scan.beams.size() > 1 ? std::abs(wrap_angle(scan.beams[1].azimuth - scan.beams[0].azimuth)) : 0.0;
  const double half = 0.5 * std::max({spacing, scan.azimuth_opening, 2.0 * pi / static_cast<double>(count)});
  const double unit = 2.0 * pi / static_cast<double>(count);
  for (std::size_t b = 0; b < scan.beams.size(); ++b) {
    const auto first = static_cast<std::int64_t>(std::floor((scan.beams[b].azimuth - half) / unit)), last = static_cast<std::int64_t>(std::ceil((scan.beams[b].azimuth + half) / unit));
    for (std::int64_t k = first; k < last; ++k) {
      const auto n = static_cast<std::int64_t>(count);
      beams[static_cast<std::size_t>(((k % n) + n) % n)] = static_cast<int>(b);
    }
  }
  return beams;
}

}  // namespace

std::size_t nearest_beam(const Scan& scan, double bearing) {
  std::size_t nearest = 0;
  for (std::size_t b = 1; b < scan.beams.size(); ++b)
    if (std::abs(wrap_angle(scan.beams[b].azimuth - bearing)) < std::abs(wrap_angle(scan.beams[nearest].azimuth - bearing))) nearest = b;
  return nearest;
}

void Polar::paint(const Frame& frame, const Scan& scan, double most, bool decibel) {
  bool fresh = false;
  frame.textures.get("polar", side, side, fresh);
  if (!fresh && painted_ == frame.now.simulation.get() && sensor_ == scan.sensor && decibel_ == decibel) return;
  painted_ = frame.now.simulation.get();
  sensor_ = scan.sensor;
  decibel_ = decibel;
  constexpr std::size_t bearings = 1440;
  const std::vector<int> beams = beams_by_bearing(scan, bearings);
  pixels_.assign(static_cast<std::size_t>(side) * side, 0u);
  const Profiles& p = scan.profiles;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const double forward = 1.0 - (row + 0.5) * 2.0 / side, left = 1.0 - (column + 0.5) * 2.0 / side;
      const double range = std::hypot(forward, left) * scan.range_max, bearing = std::atan2(left, forward);
      if (range > scan.range_max) continue;
      const auto at = static_cast<std::size_t>((bearing < 0.0 ? bearing + 2.0 * pi : bearing) / (2.0 * pi) * bearings) % bearings;
      const double bin = std::round((range - p.first_range) / p.bin_size);
      if (beams[at] < 0 || bin < 0.0 || bin >= p.bins) continue;
      const double amplitude = static_cast<double>(p.amplitude_of(static_cast<std::size_t>(beams[at]))[static_cast<std::size_t>(bin)]);
      pixels_[static_cast<std::size_t>(row * side + column)] = heat(brightness(amplitude, most, decibel));
    }
  frame.textures.update("polar", 0, 0, side, side, pixels_.data());
}

void Polar::draw(const Frame& frame, const Scan& scan, double most, bool decibel, std::size_t& beam, ImVec2 size) {
  const float line = ImGui::GetTextLineHeight();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  size = {std::max(size.x, 8.0f * line), std::max(size.y, 8.0f * line)};
  const bool clicked = ImGui::InvisibleButton("polar", size) && !frame.still;
  const bool hovered = ImGui::IsItemHovered() && !frame.still;
  const ImVec2 centre{corner.x + 0.5f * size.x, corner.y + 0.5f * (size.y + line)};
  const float radius = 0.5f * std::min(size.x, size.y - line) - 0.3f * line;
  const double scale = static_cast<double>(radius) / std::max(scan.range_max, 1e-9);
  const auto place = [&](double bearing, double range) {
    return ImVec2{centre.x - static_cast<float>(std::sin(bearing) * range * scale), centre.y - static_cast<float>(std::cos(bearing) * range * scale)};
  };

  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.PushClipRect(corner, {corner.x + size.x, corner.y + size.y}, true);
  draw.AddCircleFilled(centre, radius, frame.colours.dark ? heat(0.0) : frame.colours.background, 96);
  if (scan.profiles.bins > 0) {
    paint(frame, scan, most, decibel);
    bool fresh = false;
    if (const ImTextureID texture = frame.textures.get("polar", side, side, fresh)) draw.AddImage(texture, {centre.x - radius, centre.y - radius}, {centre.x + radius, centre.y + radius});
  }
  // Profiles are on a dark ground whatever the window is.
  const Palette& on = frame.colours;
  const ImU32 ring = scan.profiles.bins > 0 ? IM_COL32(255, 255, 255, 40) : on.grid, ring_text = scan.profiles.bins > 0 ? IM_COL32(255, 255, 255, 140) : on.grid_text;
  const Ticks rings = nice_ticks(0.0, scan.range_max, 5);
  for (const double range : rings.at) {
    if (range <= 0.0) continue;
    draw.AddCircle(centre, static_cast<float>(range * scale), ring, 96);
    draw.AddText({centre.x + 2.0f, centre.y - static_cast<float>(range * scale)}, ring_text, tick_text(range, rings.step).c_str());
  }
  const bool dots = scan.profiles.bins == 0;
  for (const Beam& b : scan.beams)
    for (const Echo& echo : scan.echoes_of(b)) {
      const ImU32 colour = dots && frame.colours.dark ? heat(std::max(0.25, brightness(static_cast<double>(echo.amplitude), most, decibel))) : frame.colours.echo;
      if (dots) draw.AddCircleFilled(place(b.azimuth, echo.range), 2.0f, colour, 6);
      else draw.AddCircleFilled(place(b.azimuth, echo.range), 1.5f, frame.colours.selected, 6);
    }
  draw.AddLine(centre, place(scan.beams[beam].azimuth, scan.range_max), frame.colours.selected);
  draw.AddTriangleFilled({centre.x, centre.y - 5.0f}, {centre.x - 3.5f, centre.y + 4.0f}, {centre.x + 3.5f, centre.y + 4.0f}, frame.colours.robot);
  draw.AddText(corner, frame.colours.text, frame.still ? "about the sensor, forward is up (m)" : "about the sensor, forward is up (m); a click chooses a beam");

  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const double ahead = static_cast<double>(centre.y - mouse.y), left = static_cast<double>(centre.x - mouse.x);
  if (hovered && std::hypot(ahead, left) <= static_cast<double>(radius)) {
    const double bearing = std::atan2(left, ahead), range = std::hypot(ahead, left) / scale;
    const std::size_t there = nearest_beam(scan, bearing);
    if (clicked) beam = there;
    std::string words = fmt::format("{:+.1f} deg, {:.2f} m", degrees(bearing), range);
    if (const auto echoes = scan.echoes_of(scan.beams[there]); !echoes.empty()) words += fmt::format("; beam {}: first echo {:.2f} m, {:.4g}", there, echoes.front().range, echoes.front().amplitude);
    label(frame, {corner.x + 4.0f, corner.y + size.y - 1.4f * line}, words, frame.colours.text);
  }
  draw.PopClipRect();
}

}  // namespace thicket::gui
