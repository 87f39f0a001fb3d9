#include "plot.hpp"

#include <fmt/format.h>

#include <array>

#include "plot_parts.hpp"

namespace thicket {
namespace {

double right_room(const Panel& panel) { return std::holds_alternative<ImagePlot>(panel) ? bar_room : plain_room; }

}  // namespace

void draw(Canvas& canvas, const Plot& plot, Box box, double right) {
  Box heading{{box.corner.x + axis_left, box.corner.y}, {box.size.x - axis_left - right, box.size.y}};
  take_heading(canvas, heading, plot.title, entries_of(plot.series));
  box.size.y -= heading.corner.y - box.corner.y;
  box.corner.y = heading.corner.y;
  const auto each = [&plot](bool x) {
    return [&plot, x](const auto& tell) {
      for (const Series& series : plot.series)
        for (const glm::dvec2& p : series.points)
          if (std::isfinite(p.x) && std::isfinite(p.y)) tell(x ? p.x : p.y);
    };
  };
  const Frame frame{within_axes(box, right), limits_of(plot.x, 0.0, each(true)), limits_of(plot.y, 0.06, each(false)), plot.x.logarithmic, plot.y.logarithmic};
  const double numbers = draw_grid(canvas, frame, plot.x.tick, true);
  canvas.clip(frame.box.corner - glm::dvec2(1.0), frame.box.size + glm::dvec2(2.0));
  for (const Series& series : plot.series) draw_series(canvas, frame, series);
  canvas.unclip();
  draw_point_labels(canvas, frame, plot.series);
  draw_labels(canvas, frame, plot.x, plot.y, numbers);
}

Colour plot_colour(std::size_t index) {
  constexpr std::array<Colour, 7> colours = {{{0.0, 0.447, 0.698}, {0.835, 0.369, 0.0}, {0.0, 0.620, 0.451}, {0.800, 0.475, 0.655}, {0.902, 0.624, 0.0}, {0.337, 0.706, 0.914}, {0.2, 0.2, 0.2}}};
  return colours[index % colours.size()];
}

Colour heat_colour(double share) {
  constexpr std::array<std::uint32_t, 10> viridis = {0x440154, 0x482878, 0x3e4a89, 0x31688e, 0x26828e, 0x1f9e89, 0x35b779, 0x6dcd59, 0xb4de2c, 0xfde725};
  const double place = std::clamp(std::isfinite(share) ? share : 0.0, 0.0, 1.0) * (viridis.size() - 1);
  const auto before = std::min(static_cast<std::size_t>(place), viridis.size() - 2);
  const double t = place - static_cast<double>(before);
  const auto channel = [&](int shift) { return ((1.0 - t) * (viridis[before] >> shift & 255u) + t * (viridis[before + 1] >> shift & 255u)) / 255.0; };
  return {channel(16), channel(8), channel(0)};
}

std::vector<double> nice_ticks(double low, double high, int most) {
  if (!(low < high) || !std::isfinite(high - low) || most < 1) return {};
  const double slack = 1e-9 * (high - low);
  for (double power = std::pow(10.0, std::floor(std::log10((high - low) / most)));; power *= 10.0) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double step = digit * power, first = std::ceil((low - slack) / step), last = std::floor((high + slack) / step);
      if (last - first + 1.0 > most) continue;
      return even_ticks(low, high, step);
    }
  }
}

std::vector<double> even_ticks(double low, double high, double step) {
  const double slack = 1e-9 * (high - low);
  std::vector<double> ticks;
  for (double i = std::ceil((low - slack) / step); i <= std::floor((high + slack) / step); ++i) ticks.push_back(i * step + 0.0);
  return ticks;
}

std::vector<double> log_ticks(double low, double high, int most) {
  for (const std::vector<double>& digits : {std::vector{1.0, 2.0, 5.0}, std::vector{1.0}}) {
    std::vector<double> ticks;
    for (double power = std::floor(low); power <= std::ceil(high); ++power)
      for (const double digit : digits)
        if (const double tick = power + std::log10(digit); tick >= low - 1e-9 && tick <= high + 1e-9) ticks.push_back(tick);
    if (static_cast<int>(ticks.size()) <= most) return ticks;
  }
  return nice_ticks(low, high, most);
}

std::vector<std::string> tick_labels(const std::vector<double>& ticks) {
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : std::abs(ticks.empty() ? 1.0 : ticks[0]);
  const int decimals = step > 0.0 ? std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9) : 0;
  std::vector<std::string> labels;
  for (const double tick : ticks) labels.push_back(fmt::format("{}{:.{}f}", tick < 0.0 ? "−" : "", std::abs(tick), decimals));
  return labels;
}

std::vector<double> decade_ticks(double low, double high) {
  constexpr double slack = 1e-9;
  std::vector<double> ticks;
  const bool few = high - low < 3.0;
  for (double power = std::floor(low); power <= high + slack; ++power)
    for (const double digit : {1.0, 2.0, 5.0})
      if (const double tick = power + std::log10(digit); (few || digit == 1.0) && tick >= low - slack && tick <= high + slack) ticks.push_back(tick);
  return ticks;
}

std::vector<std::string> decade_labels(const std::vector<double>& ticks) {
  constexpr std::array<const char*, 10> raised = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::vector<std::string> labels;
  for (const double tick : ticks) {
    const double power = std::floor(tick + 1e-6);
    if (power < 5.0 && power > -4.0) {
      labels.push_back(fmt::format("{:g}", std::round(std::pow(10.0, tick - power)) * std::pow(10.0, power)));
      continue;
    }
    std::string exponent = power < 0.0 ? "⁻" : "";
    for (const char digit : fmt::format("{:.0f}", std::abs(power))) exponent += raised[static_cast<std::size_t>(digit - '0')];
    const double factor = std::round(std::pow(10.0, tick - power));
    labels.push_back((factor > 1.0 ? fmt::format("{:g} × 10", factor) : std::string("10")) + exponent);
  }
  return labels;
}

Result<Done> Sheet::write(const std::filesystem::path& file) const {
  double height = sheet_margin + 14.0 + 20.0 * static_cast<double>(subtitles.size()) + 12.0;
  const double head = height;
  for (const Row& row : rows) height += row.height + panel_gap;
  Canvas canvas(width, static_cast<int>(std::ceil(height)), white, file.extension() == ".svg" ? Canvas::Format::svg : Canvas::Format::png);
  const double inside = width - 2.0 * sheet_margin;
  canvas.text(fitting(canvas, title, title_size, inside), {sheet_margin, sheet_margin + 12.0}, title_size, ink);
  for (std::size_t i = 0; i < subtitles.size(); ++i)
    canvas.text(fitting(canvas, subtitles[i], subtitle_size, inside), {sheet_margin, sheet_margin + 34.0 + 20.0 * static_cast<double>(i)}, subtitle_size, pale_ink);
  double top = head + 6.0;
  for (const Row& row : rows) {
    const double count = static_cast<double>(row.panels.size());
    const double wide = (width - 2.0 * sheet_margin - (count - 1.0) * panel_gap) / count;
    for (std::size_t i = 0; i < row.panels.size(); ++i) {
      double room = plain_room;
      for (const Row& other : rows)
        if (other.panels.size() == row.panels.size()) room = std::max(room, right_room(other.panels[i]));
      const Box box{{sheet_margin + static_cast<double>(i) * (wide + panel_gap), top}, {wide, row.height}};
      std::visit([&](const auto& panel) { draw(canvas, panel, box, room); }, row.panels[i]);
    }
    top += row.height + panel_gap;
  }
  return canvas.write(file);
}

}  // namespace thicket
