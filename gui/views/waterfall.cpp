#include "waterfall.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace thicket::gui {
namespace {

constexpr std::size_t most_columns = 1024, echo_columns = 512;
constexpr double decibels_shown = 50.0;

/// Amplitude over equal columns of the range; where several values fall into one, the greatest.
std::vector<float> columns_of(const Scan& scan, std::size_t beam, std::size_t columns, const Range& range) {
  std::vector<float> row(columns, 0.0f);
  const auto put = [&](double r, float amplitude) {
    const double at = (r - range.low) / (range.high - range.low) * static_cast<double>(columns);
    if (at < 0.0 || at >= static_cast<double>(columns)) return;
    float& there = row[static_cast<std::size_t>(at)];
    there = std::max(there, amplitude);
  };
  if (scan.profiles.bins > 0) {
    const auto amplitude = scan.profiles.amplitude_of(beam);
    for (std::uint32_t bin = 0; bin < scan.profiles.bins; ++bin) put(scan.profiles.range(bin), amplitude[bin]);
  } else {
    for (const Echo& echo : scan.echoes_of(scan.beams[beam])) put(echo.range, echo.amplitude);
  }
  return row;
}

Range range_of(const Scan& scan) {
  const Profiles& p = scan.profiles;
  if (p.bins > 0) return {p.first_range - 0.5 * p.bin_size, p.first_range + (p.bins - 0.5) * p.bin_size};
  return {0.0, scan.range_max > 0.0 ? scan.range_max : 1.0};
}

}  // namespace

double decibels(double amplitude) { return amplitude > 1e-12 ? 20.0 * std::log10(amplitude) : -240.0; }

void Waterfall::clear() {
  rows_.clear();
  all_new_ = true;
  new_rows_ = 0;
}

void Waterfall::take(const Snapshot& now, const Scan& scan, std::size_t beam) {
  const Range range = range_of(scan);
  const std::size_t columns = scan.profiles.bins > 0 ? std::min<std::size_t>(scan.profiles.bins, most_columns) : echo_columns;
  const bool other = scan.sensor != sensor_ || beam != beam_ || columns != columns_ || range.low != range_.low || range.high != range_.high;
  if (other || now.world_revision != world_) clear();
  if (now.run_revision != run_) {
    const std::size_t before = rows_.size();
    while (!rows_.empty() && rows_.front().number >= scan.number) rows_.pop_front();
    if (rows_.size() != before) all_new_ = true;
  }
  range_ = range;
  columns_ = columns;
  sensor_ = scan.sensor;
  beam_ = beam;
  run_ = now.run_revision;
  world_ = now.world_revision;
  if (!rows_.empty() && rows_.front().number == scan.number) return;
  Row row{scan.number, scan.time, columns_of(scan, beam, columns, range), 0.0f, next_slot_};
  row.most = *std::max_element(row.amplitude.begin(), row.amplitude.end());
  next_slot_ = (next_slot_ + 1) % most_rows;
  rows_.push_front(std::move(row));
  if (rows_.size() > most_rows) rows_.pop_back();
  ++new_rows_;
}

double Waterfall::most() const {
  double most = 0.0;
  for (const Row& row : rows_) most = std::max(most, static_cast<double>(row.most));
  return most;
}

std::uint32_t Waterfall::pixel(float amplitude, double top, bool decibel) const {
  const double a = static_cast<double>(amplitude);
  return heat(decibel ? 1.0 + (decibels(a) - decibels(top)) / decibels_shown : a / top);
}

void Waterfall::upload(const Frame& frame, bool decibel) {
  bool fresh = false;
  const int width = static_cast<int>(columns_);
  frame.textures.get("waterfall", width, most_rows, fresh);
  // The brightest colour keeps its meaning until something is brighter, or all has become much darker.
  const double most = std::max(this->most(), 1e-9);
  if (most > top_ || most < 0.25 * top_ || decibel != was_decibel_) {
    top_ = 1.2 * most;
    was_decibel_ = decibel;
    all_new_ = true;
  }
  if (fresh || all_new_) {
    pixels_.assign(columns_ * most_rows, 0u);
    for (const Row& row : rows_)
      std::transform(row.amplitude.begin(), row.amplitude.end(), pixels_.begin() + static_cast<std::ptrdiff_t>(columns_ * static_cast<std::size_t>(row.slot)), [&](float a) { return pixel(a, top_, decibel); });
    frame.textures.update("waterfall", 0, 0, width, most_rows, pixels_.data());
  } else {
    for (int i = 0; i < std::min(new_rows_, static_cast<int>(rows_.size())); ++i) {
      const Row& row = rows_[static_cast<std::size_t>(i)];
      pixels_.resize(columns_);
      std::transform(row.amplitude.begin(), row.amplitude.end(), pixels_.begin(), [&](float a) { return pixel(a, top_, decibel); });
      frame.textures.update("waterfall", 0, row.slot, width, 1, pixels_.data());
    }
  }
  all_new_ = false;
  new_rows_ = 0;
}

void Waterfall::draw(const Frame& frame, ImVec2 size, bool decibel) {
  // Few rows are drawn high.
  int shown = most_rows / 4;
  while (shown < static_cast<int>(rows_.size())) shown *= 2;
  const Chart chart = begin_chart(frame, "waterfall", size, range_, {-static_cast<double>(shown), 0.0}, "range (m)", "scans, the newest on top");
  if (!rows_.empty()) {
    upload(frame, decibel);
    bool fresh = false;
    const ImTextureID texture = frame.textures.get("waterfall", static_cast<int>(columns_), most_rows, fresh);
    const float row_height = (chart.high.y - chart.low.y) / static_cast<float>(shown);
    // The texture is a ring: from the newest row upward to its first, then from its last.
    const int count = static_cast<int>(rows_.size()), newest = rows_.front().slot + 1, before = std::min(count, newest), after = count - before;
    const auto part = [&](int above, int rows, int last) {
      const float top = chart.low.y + static_cast<float>(above) * row_height;
      ImGui::GetWindowDrawList()->AddImage(texture, {chart.low.x, top}, {chart.high.x, top + static_cast<float>(rows) * row_height}, {0.0f, static_cast<float>(last) / most_rows}, {1.0f, static_cast<float>(last - rows) / most_rows});
    };
    if (texture) {
      part(0, before, newest);
      if (after > 0) part(before, after, most_rows);
    }
    read_out(frame, chart, row_height);
  }
  end_chart();
}

void Waterfall::read_out(const Frame& frame, const Chart& chart, float row_height) const {
  if (!chart.hovered) return;
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const auto i = static_cast<std::size_t>((mouse.y - chart.low.y) / row_height);
  if (i >= rows_.size()) return;
  const double range = chart.x_at(mouse.x);
  const auto column = std::min(columns_ - 1, static_cast<std::size_t>((range - range_.low) / (range_.high - range_.low) * static_cast<double>(columns_)));
  const double amplitude = static_cast<double>(rows_[i].amplitude[column]);
  label(frame, {chart.low.x + 6.0f, chart.high.y - 1.5f * ImGui::GetTextLineHeight()}, fmt::format("{:.2f} s, scan {}, {:.2f} m: {:.4g} ({:.1f} dB)", rows_[i].time, rows_[i].number, range, amplitude, decibels(amplitude)), frame.colours.text);
}

}  // namespace thicket::gui
