#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>

#include "axes.hpp"
#include "extremes.hpp"

namespace thicket::gui {
namespace {

/// One channel's plot.
struct Plot {
  explicit Plot(const Channel& c, bool is_shown) : channel(&c), shown(is_shown), extremes(c.of) {}
  const Channel* channel;
  bool shown, fixed = false;
  float low = 0.0f, high = 1.0f;  ///< of a fixed axis
  Extremes extremes;
};

class PlotsView final : public View {
 public:
  PlotsView() {
    for (const Channel& channel : channels()) {
      const std::string name = channel.name;
      plots_.emplace_back(channel, name == "speed" || name == "clearance" || name == "nearest bumper" || name == "distance to goal");
    }
  }
  const char* name() const override { return "Plots"; }
  void draw(const Frame& frame) override;

 private:
  void choose();
  Range times(const Samples& samples) const;
  void draw_plot(const Frame& frame, Plot& plot, const Range& time, float height, bool last);
  void draw_line(const Samples& samples, Plot& plot, const Chart& chart, ImU32 colour);
  void read_out(const Frame& frame, const Plot& plot, const Chart& chart, ImU32 colour);
  void move_in_time(const Chart& chart, const Samples& samples);

  std::deque<Plot> plots_;
  double last_seconds_ = 0.0;       ///< how much of the past is shown; 0: all of it
  std::optional<Range> chosen_;     ///< by wheel and mouse, instead
  std::optional<double> cursor_, next_cursor_;  ///< the time under the mouse, in all plots
  std::vector<ImVec2> points_;
};

void PlotsView::choose() {
  if (ImGui::Button("Channels...")) ImGui::OpenPopup("channels");
  if (ImGui::BeginPopup("channels")) {
    for (Plot& plot : plots_) {
      ImGui::PushID(plot.channel->name);
      ImGui::Checkbox(fmt::format("{} ({})", plot.channel->name, plot.channel->unit).c_str(), &plot.shown);
      ImGui::SameLine(18.0f * ImGui::GetFontSize());
      ImGui::Checkbox("fixed", &plot.fixed);
      if (plot.fixed) {
        ImGui::SameLine();
        ImGui::SetNextItemWidth(10.0f * ImGui::GetFontSize());
        ImGui::DragFloatRange2("##axis", &plot.low, &plot.high, 0.01f);
      }
      ImGui::PopID();
    }
    ImGui::EndPopup();
  }
  for (const auto& [text, seconds] : {std::pair{"all", 0.0}, {"last 60 s", 60.0}, {"last 10 s", 10.0}}) {
    ImGui::SameLine();
    if (ImGui::RadioButton(text, !chosen_ && last_seconds_ == seconds)) {
      last_seconds_ = seconds;
      chosen_.reset();
    }
  }
  if (chosen_) {
    ImGui::SameLine();
    ImGui::TextDisabled("%s", "chosen by wheel and mouse; double click: all");
  }
}

Range PlotsView::times(const Samples& samples) const {
  if (chosen_) return *chosen_;
  Range time{samples[0].time, samples.back().time};
  if (last_seconds_ > 0.0) time.low = std::max(time.low, time.high - last_seconds_);
  if (!(time.high > time.low)) time.high = time.low + 1.0;
  return time;
}

void PlotsView::draw(const Frame& frame) {
  if (!frame.now.simulation || frame.now.samples.empty()) return ImGui::TextUnformatted("Nothing is open.");
  choose();
  const Range time = times(frame.now.samples);
  cursor_ = std::exchange(next_cursor_, std::nullopt);
  const auto shown = static_cast<int>(std::count_if(plots_.begin(), plots_.end(), [](const Plot& plot) { return plot.shown; }));
  if (shown == 0) return ImGui::TextUnformatted("No channel is chosen.");
  const float room = ImGui::GetContentRegionAvail().y - static_cast<float>(shown) * ImGui::GetStyle().ItemSpacing.y;
  const float height = std::max(room / static_cast<float>(shown), 7.0f * ImGui::GetTextLineHeight());
  int left = shown;
  for (Plot& plot : plots_)
    if (plot.shown) draw_plot(frame, plot, time, height, --left == 0);
}

void PlotsView::draw_plot(const Frame& frame, Plot& plot, const Range& time, float height, bool last) {
  const Samples& samples = frame.now.samples;
  Range y{plot.low, plot.high};
  if (!plot.fixed || !(y.high > y.low)) {
    const Range seen = plot.extremes.between(samples, first_at(samples, time.low), first_at(samples, time.high) + 1);
    y = seen.padded();
    if (!plot.fixed && !seen.empty()) plot.low = static_cast<float>(seen.low), plot.high = static_cast<float>(seen.high);
  }
  const std::string title = fmt::format("{} ({})", plot.channel->name, plot.channel->unit);
  const Chart chart = begin_chart(frame, plot.channel->name, {0.0f, height}, time, y, last ? "time (s)" : nullptr, title.c_str());
  const ImU32 colour = frame.colours.trail | IM_COL32_A_MASK;
  draw_line(samples, plot, chart, colour);
  const double now = frame.now.simulation->time();
  if (frame.now.simulation->steps() < frame.now.newest_step) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddLine({chart.to_x(now), chart.low.y}, {chart.to_x(now), chart.high.y}, frame.colours.warning, 1.5f);
    draw.AddText({chart.to_x(now) + 3.0f, chart.low.y}, frame.colours.warning, "now");
  }
  read_out(frame, plot, chart, colour);
  end_chart();
  if (!frame.still) move_in_time(chart, samples);
}

void PlotsView::draw_line(const Samples& samples, Plot& plot, const Chart& chart, ImU32 colour) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  points_.clear();
  const auto flush = [&] {
    if (points_.size() == 1) draw.AddCircleFilled(points_[0], 1.5f, colour);
    else draw.AddPolyline(points_.data(), static_cast<int>(points_.size()), colour, ImDrawFlags_None, 1.5f);
    points_.clear();
  };
  const std::size_t first = first_at(samples, chart.x.low), last = std::min(samples.size(), first_at(samples, chart.x.high) + 1);
  const int columns = std::max(1, chart.columns());
  if (last - first <= static_cast<std::size_t>(columns)) {
    for (std::size_t i = first > 0 ? first - 1 : 0; i < last; ++i) {
      const double value = plot.channel->of(samples[i]);
      if (std::isfinite(value)) points_.push_back({chart.to_x(samples[i].time), chart.to_y(value)});
      else flush();
    }
  } else {
    // Least and most of every column of pixels: a spike of one step stays.
    std::size_t from = first;
    for (int column = 0; column < columns && from < last; ++column) {
      const std::size_t to = column + 1 == columns ? last : std::min(last, first_at(samples, chart.x_at(chart.low.x + static_cast<float>(column) + 1.0f), from));
      const Range seen = plot.extremes.between(samples, from, to);
      const float x = chart.low.x + static_cast<float>(column) + 0.5f;
      if (!seen.empty()) {
        const float low = chart.to_y(seen.low), high = chart.to_y(seen.high);
        // From the end that is nearer to where the line is.
        const bool upward = points_.empty() || std::abs(points_.back().y - low) <= std::abs(points_.back().y - high);
        points_.push_back({x, upward ? low : high});
        if (low - high > 0.5f) points_.push_back({x, upward ? high : low});
      } else if (to > from) {
        flush();
      }
      from = to;
    }
  }
  flush();
}

void PlotsView::read_out(const Frame& frame, const Plot& plot, const Chart& chart, ImU32 colour) {
  const Samples& samples = frame.now.samples;
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  if (chart.hovered) next_cursor_ = chart.x_at(mouse.x);
  // Without a cursor, the value that is now.
  std::size_t i = samples.count_until(frame.now.simulation->steps());
  i = i > 0 ? i - 1 : 0;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  if (cursor_) {
    i = std::min(first_at(samples, *cursor_), samples.size() - 1);
    if (i > 0 && *cursor_ - samples[i - 1].time < samples[i].time - *cursor_) --i;
    const float x = chart.to_x(samples[i].time);
    draw.AddLine({x, chart.low.y}, {x, chart.high.y}, frame.colours.faint);
  }
  const double value = plot.channel->of(samples[i]);
  if (cursor_ && std::isfinite(value)) draw.AddCircleFilled({chart.to_x(samples[i].time), chart.to_y(value)}, 3.0f, colour);
  const std::string words = std::isnan(value) ? fmt::format("{:.2f} s: none", samples[i].time) : fmt::format("{:.2f} s: {:.4g} {}", samples[i].time, value, plot.channel->unit);
  label(frame, {chart.high.x - ImGui::CalcTextSize(words.c_str()).x - 6.0f, chart.low.y + 3.0f}, words, frame.colours.text);
}

void PlotsView::move_in_time(const Chart& chart, const Samples& samples) {
  const ImGuiIO& io = ImGui::GetIO();
  const double length = chart.x.high - chart.x.low;
  if (chart.hovered && ImGui::IsMouseDoubleClicked(0)) {
    chosen_.reset();
    last_seconds_ = 0.0;
  } else if (chart.hovered && io.MouseWheel != 0.0f) {
    const double factor = std::pow(0.8, io.MouseWheel), at = chart.x_at(io.MousePos.x);
    if (length * factor > 1e-3 && length * factor < 2.0 * (samples.back().time - samples[0].time) + 10.0) chosen_ = Range{at - (at - chart.x.low) * factor, at + (chart.x.high - at) * factor};
  } else if (ImGui::IsItemActive() && ImGui::IsMouseDragging(0) && io.MouseDelta.x != 0.0f) {
    const double by = -static_cast<double>(io.MouseDelta.x) / static_cast<double>(chart.high.x - chart.low.x) * length;
    chosen_ = Range{chart.x.low + by, chart.x.high + by};
  }
}

}  // namespace

std::unique_ptr<View> make_plots_view() { return std::make_unique<PlotsView>(); }

}  // namespace thicket::gui
