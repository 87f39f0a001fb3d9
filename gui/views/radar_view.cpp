#include "radar_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace thicket::gui {
namespace {

const char* to_words(BeamEnd end) {
  switch (end) {
    case BeamEnd::open: return "open";
    case BeamEnd::stopped: return "stopped";
    case BeamEnd::exhausted: return "exhausted";
  }
  return "";
}

}  // namespace

void RadarView::choose_sensor(const Simulation& simulation) {
  const auto& sensors = simulation.mission().sensors;
  sensor_ = std::min(sensor_, sensors.size() - 1);
  const float right = ImGui::GetWindowPos().x + ImGui::GetContentRegionMax().x;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const std::string text = fmt::format("{} ({})", mounted(sensors[i]).name, sensor_type(sensors[i]));
    ImGui::PushID(static_cast<int>(i));
    // In one line as far as there is room.
    if (i > 0 && ImGui::GetItemRectMax().x + ImGui::CalcTextSize(text.c_str()).x + 3.0f * ImGui::GetFrameHeight() < right) ImGui::SameLine();
    if (ImGui::RadioButton(text.c_str(), sensor_ == i)) sensor_ = i;
    ImGui::PopID();
  }
}

void RadarView::choose_beam(const Frame& frame, const Scan& scan) {
  // Another sensor begins with the beam that looks ahead.
  if (beam_of_ != sensor_) beam_ = nearest_beam(scan, 0.0);
  beam_of_ = sensor_;
  beam_ = std::min(beam_, scan.beams.size() - 1);
  if (scan.beams.size() > 1) {
    int chosen = static_cast<int>(beam_);
    ImGui::SetNextItemWidth(14.0f * ImGui::GetFontSize());
    const std::string text = fmt::format("beam %d, {:+.1f} deg", degrees(scan.beams[beam_].azimuth));
    if (ImGui::SliderInt("##beam", &chosen, 0, static_cast<int>(scan.beams.size()) - 1, text.c_str()) && !frame.still) beam_ = static_cast<std::size_t>(std::clamp(chosen, 0, static_cast<int>(scan.beams.size()) - 1));
    ImGui::SameLine();
  }
  if (ImGui::RadioButton("linear", !decibel_)) decibel_ = false;
  ImGui::SameLine();
  if (ImGui::RadioButton("dB", decibel_)) decibel_ = true;
  const Beam& beam = scan.beams[beam_];
  ImGui::SameLine();
  ImGui::Text("scan %llu at %.2f s: %u echoes, %s at %.2f m%s", static_cast<unsigned long long>(scan.number), scan.time, beam.echo_count, to_words(beam.end), beam.sensed_range, beam.starts_inside ? ", starts inside matter" : "");
}

void RadarView::draw(const Frame& frame) {
  if (!frame.now.simulation) return ImGui::TextUnformatted("Nothing is open.");
  const Simulation& s = *frame.now.simulation;
  choose_sensor(s);
  const Scan& scan = s.scans()[sensor_];
  if (scan.beams.empty()) {
    waterfall_.clear();
    return ImGui::TextUnformatted("It has not scanned yet.");
  }
  choose_beam(frame, scan);
  waterfall_.take(frame.now, scan, beam_);

  const ImVec2 room = ImGui::GetContentRegionAvail();
  const float gap = ImGui::GetStyle().ItemSpacing.y, upper = 0.45f * room.y - gap, lower = room.y - upper - 2.0f * gap;
  const bool polar = scan.beams.size() > 1;
  draw_profile(frame, scan, {0.0f, upper});
  waterfall_.draw(frame, {polar ? 0.58f * room.x : 0.0f, lower}, decibel_);
  if (!polar) return;
  ImGui::SameLine();
  double most = waterfall_.most();
  for (const float amplitude : scan.profiles.amplitude) most = std::max(most, static_cast<double>(amplitude));
  for (const Echo& echo : scan.echoes) most = std::max(most, static_cast<double>(echo.amplitude));
  polar_.draw(frame, scan, std::max(most, 1e-9), decibel_, beam_, {ImGui::GetContentRegionAvail().x, lower});
}

void RadarView::draw_profile(const Frame& frame, const Scan& scan, ImVec2 size) {
  const Profiles& p = scan.profiles;
  const auto shown = [&](float amplitude) { return decibel_ ? decibels(static_cast<double>(amplitude)) : static_cast<double>(amplitude); };
  // All of the waterfall counts, so that the axis stands still while the profile moves.
  double most = waterfall_.most();
  const auto hold = [&](float amplitude) { most = std::max(most, std::isfinite(amplitude) ? static_cast<double>(amplitude) : 0.0); };
  for (const Echo& echo : scan.echoes_of(scan.beams[beam_])) hold(echo.amplitude);
  if (p.bins > 0) hold(*std::min_element(p.threshold_of(beam_).begin(), p.threshold_of(beam_).end()));
  if (!(most > 0.0)) most = 1.0;
  const Range y = decibel_ ? Range{decibels(most) - 60.0, decibels(most) + 5.0} : Range{0.0, 1.1 * most};
  const Chart chart = begin_chart(frame, "profile", size, waterfall_.range(), y, "range (m)", decibel_ ? "amplitude (dB)" : "amplitude");
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const auto curve = [&](std::span<const float> values, ImU32 colour) {
    points_.clear();
    for (std::uint32_t bin = 0; bin < p.bins; ++bin)
      if (std::isfinite(values[bin])) points_.push_back({chart.to_x(p.range(bin)), chart.to_y(shown(values[bin]))});
    draw.AddPolyline(points_.data(), static_cast<int>(points_.size()), colour, ImDrawFlags_None, 1.5f);
  };
  if (p.bins > 0) {
    curve(p.threshold_of(beam_), frame.colours.warning);
    curve(p.amplitude_of(beam_), frame.colours.robot);
    draw.AddText({chart.low.x + 6.0f, chart.low.y + 3.0f}, frame.colours.robot, "amplitude");
    draw.AddText({chart.low.x + 6.0f, chart.low.y + 3.0f + ImGui::GetTextLineHeight()}, frame.colours.warning, "threshold");
  }
  for (const Echo& echo : scan.echoes_of(scan.beams[beam_])) {
    const ImVec2 top{chart.to_x(echo.range), chart.to_y(shown(echo.amplitude))};
    if (p.bins == 0) draw.AddLine({top.x, chart.high.y}, top, frame.colours.echo, 1.5f);
    draw.AddCircleFilled(top, 3.5f, frame.colours.echo);
  }
  draw.AddText({chart.low.x + 6.0f, chart.low.y + 3.0f + (p.bins > 0 ? 2.0f : 0.0f) * ImGui::GetTextLineHeight()}, frame.colours.echo, "echoes");
  const float end = chart.to_x(scan.beams[beam_].sensed_range);
  draw.AddLine({end, chart.low.y}, {end, chart.high.y}, frame.colours.faint);
  read_out(frame, scan, chart);
  end_chart();
}

void RadarView::read_out(const Frame& frame, const Scan& scan, const Chart& chart) const {
  if (!chart.hovered) return;
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const double range = chart.x_at(mouse.x);
  ImGui::GetWindowDrawList()->AddLine({mouse.x, chart.low.y}, {mouse.x, chart.high.y}, frame.colours.faint);
  std::string words = fmt::format("{:.3f} m", range);
  const Profiles& p = scan.profiles;
  if (p.bins > 0) {
    const auto bin = static_cast<std::size_t>(std::clamp(std::round((range - p.first_range) / p.bin_size), 0.0, p.bins - 1.0));
    const double amplitude = static_cast<double>(p.amplitude_of(beam_)[bin]), threshold = static_cast<double>(p.threshold_of(beam_)[bin]);
    words += fmt::format(", bin {}: {:.4g} ({:.1f} dB), threshold {:.4g} ({:.1f} dB)", bin, amplitude, decibels(amplitude), threshold, decibels(threshold));
  }
  const Echo* nearest = nullptr;
  for (const Echo& echo : scan.echoes_of(scan.beams[beam_]))
    if (!nearest || std::abs(echo.range - range) < std::abs(nearest->range - range)) nearest = &echo;
  if (nearest && std::abs(chart.to_x(nearest->range) - mouse.x) < 8.0f) {
    words += fmt::format("; echo {:.3f} m, {:.4g}", nearest->range, nearest->amplitude);
    if (nearest->radial_velocity != 0.0f) words += fmt::format(", {:+.2f} m/s", nearest->radial_velocity);
  }
  label(frame, {chart.high.x - ImGui::CalcTextSize(words.c_str()).x - 6.0f, chart.low.y + 3.0f}, words, frame.colours.text);
}

std::unique_ptr<View> make_radar_view() { return std::make_unique<RadarView>(); }

}  // namespace thicket::gui
