// Scan reports as pictures: which plots tell what a sensor saw.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "plot.hpp"
#include "scan_figures.hpp"

namespace thicket {
namespace {

constexpr std::size_t few_beams = 4;  ///< profiles of so many are drawn as curves
constexpr double dynamic_range_db = 60.0;

bool has_profiles(const SensorScans& one) {
  return std::any_of(one.scans.begin(), one.scans.end(), [](const Scan& scan) { return scan.profiles.bins > 0; });
}

bool is_polar(const SensorScans& one) { return one.scans[0].beams.size() > few_beams; }

std::string pose_in_words(const ScanReport& report) {
  const ScanPose& pose = report.poses[0];
  std::string text = fmt::format("sensor at x {:.2f} m, y {:.2f} m, z {:.2f} m, yaw {:.1f}°", pose.position.x, pose.position.y, pose.position.z, pose.yaw_deg);
  if (pose.pitch_deg != 0.0) text += fmt::format(", pitch {:.1f}°", pose.pitch_deg);
  return text + fmt::format("; scan {}, at {:g} s", report.number, report.time);
}

/// A round number at or above: the outer ring.
double ring_above(double range) {
  const double power = std::pow(10.0, std::floor(std::log10(range)));
  for (const double digit : {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0})
    if (digit * power >= range * (1.0 - 1e-9)) return digit * power;
  return 10.0 * power;
}

/// From the strongest down to the weakest, or as far down as is worth telling apart.
Axis decibels(const std::vector<double>& values, std::string label, double lowest_share = 0.0) {
  Axis axis{std::move(label), {}, {}};
  std::vector<double> sorted;
  for (const double value : values)
    if (std::isfinite(value)) sorted.push_back(value);
  if (sorted.empty()) return {axis.label, -dynamic_range_db, 0.0};
  std::sort(sorted.begin(), sorted.end());
  const double low = sorted[static_cast<std::size_t>(lowest_share * static_cast<double>(sorted.size() - 1))];
  axis.high = std::ceil(sorted.back());
  axis.low = std::min(*axis.high - 10.0, std::max(std::floor(low), *axis.high - dynamic_range_db));
  return axis;
}

/// A round step of angles, in degrees: 0 where numbers of any kind do.
double angle_ticks(double span) {
  const double wide = std::abs(span);
  return wide > 1440.0 || wide <= 60.0 ? 0.0 : wide > 720.0 ? 90.0 : wide > 240.0 ? 45.0 : wide > 120.0 ? 30.0 : 15.0;
}

// --- scanning sensors

PolarPlot::Shape shape_of(const Echo& echo) {
  using Shape = PolarPlot::Shape;
  if (echo.bounces > 1) return Shape::cross;
  switch (echo.edge) {
    case Edge::front: return Shape::disc;
    case Edge::inner: return Shape::square;
    case Edge::back: return Shape::ring;
    case Edge::thin: return Shape::diamond;
  }
  return Shape::disc;
}

PolarPlot polar_plot(const SensorScans& one, double range, const Axis& power) {
  using Shape = PolarPlot::Shape;
  const Scan& scan = one.scans[0];
  PolarPlot plot;
  plot.title = one.name;
  plot.range = range;
  plot.value = power;
  const ScannerSpec* spec = scanner(one.spec);
  double widest = 0.0;
  for (const Beam& beam : scan.beams) widest = std::max(widest, std::abs(beam.azimuth));
  plot.sector = spec ? radians(spec->fov_deg) : std::max(2.0 * widest, radians(10.0));
  // Every beam is as wide as the step between two.
  const double half = 0.5 * (spec ? radians(spec->step_deg) : plot.sector / static_cast<double>(scan.beams.size()));
  if (plot.sector < 2.0 * pi - 1e-9) plot.sensed.emplace_back(0.0, 0.0);
  for (const Beam& beam : scan.beams) {
    plot.sensed.emplace_back(beam.azimuth - half, beam.sensed_range);
    plot.sensed.emplace_back(beam.azimuth + half, beam.sensed_range);
    for (const Echo& echo : scan.echoes_of(beam)) plot.points.push_back({beam.azimuth, echo.range, to_db(echo.amplitude), shape_of(echo)});
  }
  constexpr std::array<std::pair<Shape, const char*>, 5> meanings = {
      {{Shape::disc, "front"}, {Shape::square, "inner"}, {Shape::ring, "back"}, {Shape::diamond, "thin"}, {Shape::cross, "over other surfaces"}}};
  for (const auto& [shape, words] : meanings)
    if (std::any_of(plot.points.begin(), plot.points.end(), [s = shape](const auto& p) { return p.shape == s; })) plot.legend.emplace_back(shape, words);
  return plot;
}

/// Range over azimuth of a scanning receiver.
ImagePlot azimuth_image(const SensorScans& one) {
  const Scan& scan = one.scans[0];
  ImagePlot plot;
  plot.title = one.name + ": what the receiver has in its range bins";
  plot.x = {"azimuth, deg", {}, {}, angle_ticks(degrees(scan.beams.back().azimuth - scan.beams.front().azimuth))};
  plot.y.label = "range, m";
  plot.first = scan.profiles.first_range;
  plot.step = scan.profiles.bin_size;
  plot.rows = scan.profiles.bins;
  plot.y.low = std::max(0.0, scan.profiles.first_range - 0.5 * scan.profiles.bin_size);
  std::vector<double> values;
  for (const Beam& beam : scan.beams) plot.columns.push_back(degrees(beam.azimuth));
  for (const float amplitude : scan.profiles.amplitude) values.push_back(to_db(amplitude));
  plot.value = decibels(values, "amplitude, dB", 0.05);
  plot.values.assign(values.begin(), values.end());
  return plot;
}

/// Images of sensors of one kind have one scale of colours, so that they can be held against each other.
void share_scale(Sheet& sheet) {
  std::vector<ImagePlot*> images;
  for (Sheet::Row& row : sheet.rows)
    for (Panel& panel : row.panels)
      if (auto* image = std::get_if<ImagePlot>(&panel)) images.push_back(image);
  if (images.size() < 2) return;
  double low = INFINITY, high = -INFINITY;
  for (const ImagePlot* image : images) {
    low = std::min(low, *image->value.low);
    high = std::max(high, *image->value.high);
  }
  for (ImagePlot* image : images) {
    image->value.low = std::max(low, high - dynamic_range_db);
    image->value.high = high;
  }
}

bool of_one_kind(const ScanReport& report) {
  return std::all_of(report.sensors.begin(), report.sensors.end(), [&](const SensorScans& one) { return one.spec.index() == report.sensors[0].spec.index(); });
}

// --- few beams

/// Amplitude over range with the threshold and what was detected.
Plot profile_plot(const SensorScans& one, std::size_t beam) {
  const Scan& scan = one.scans[0];
  const Profiles& p = scan.profiles;
  Plot plot;
  plot.title = scan.beams.size() > 1 ? fmt::format("{}, beam at {:.0f}°", one.name, degrees(scan.beams[beam].azimuth)) : one.name;
  plot.x.label = "range, m";
  plot.y = {"amplitude", 0.0, {}};
  Series amplitude{"amplitude", p.bins < 120 ? Series::Kind::step : Series::Kind::line, plot_colour(0), {}};
  Series threshold{"threshold", Series::Kind::dashed, plot_colour(1), {}};
  Series detected{"detected", Series::Kind::rings, {0.1, 0.1, 0.12}, {}};
  double highest = 0.0;
  for (std::uint32_t i = 0; i < p.bins; ++i) {
    amplitude.points.emplace_back(p.range(i), p.amplitude_of(beam)[i]);
    highest = std::max(highest, static_cast<double>(p.amplitude_of(beam)[i]));
    if (!p.threshold.empty()) threshold.points.emplace_back(p.range(i), p.threshold_of(beam)[i]);
  }
  for (const Echo& echo : scan.echoes_of(scan.beams[beam])) {
    detected.points.emplace_back(echo.range, echo.amplitude);
    highest = std::max(highest, static_cast<double>(echo.amplitude));
  }
  // A threshold that nothing comes near to would flatten all.
  for (const glm::dvec2& t : threshold.points)
    if (t.y < 4.0 * highest) highest = std::max(highest, t.y);
  plot.y.high = highest > 0.0 ? 1.1 * highest : 1.0;
  plot.series.push_back(std::move(amplitude));
  for (Series* series : {&threshold, &detected})
    if (!series->points.empty()) plot.series.push_back(std::move(*series));
  return plot;
}

/// Echoes of a sensor without a receiver, by range.
Plot stem_plot(const SensorScans& one) {
  const Scan& scan = one.scans[0];
  Plot plot;
  plot.title = one.name;
  plot.x = {"range, m", 0.0, {}};
  std::vector<double> values;
  double farthest = 0.0;
  for (const Echo& echo : scan.echoes) {
    values.push_back(to_db(echo.amplitude));
    farthest = std::max(farthest, echo.range);
  }
  plot.x.high = farthest > 0.0 ? 1.06 * farthest : scan.range_max;
  plot.y = decibels(values, "power of an echo, dB");
  *plot.y.high += 3.0;
  *plot.y.low -= 3.0;
  for (std::size_t i = 0; i < 5; ++i) {
    Series series{i == 4 ? "over other surfaces" : to_string(static_cast<Edge>(i)), Series::Kind::stems, plot_colour(i), {}};
    for (const Echo& echo : scan.echoes)
      if (i == 4 ? echo.bounces > 1 : echo.bounces <= 1 && static_cast<std::size_t>(echo.edge) == i) series.points.emplace_back(echo.range, to_db(echo.amplitude));
    if (!series.points.empty()) plot.series.push_back(std::move(series));
  }
  return plot;
}

/// The same for curves, one above the other.
void share_axes(Sheet& sheet) {
  std::vector<Plot*> plots;
  for (Sheet::Row& row : sheet.rows)
    if (auto* plot = std::get_if<Plot>(&row.panels[0])) plots.push_back(plot);
  if (plots.size() < 2 || std::any_of(plots.begin(), plots.end(), [&](const Plot* plot) { return plot->y.label != plots[0]->y.label; })) return;
  double left = INFINITY, right = -INFINITY, low = INFINITY, high = -INFINITY;
  for (const Plot* plot : plots) {
    low = std::min(low, plot->y.low.value_or(0.0));
    high = std::max(high, plot->y.high.value_or(0.0));
    for (const Series& series : plot->series) {
      for (const glm::dvec2& p : series.points) {
        left = std::min(left, p.x);
        right = std::max(right, p.x);
      }
    }
  }
  for (Plot* plot : plots) {
    if (left < right) plot->x = {plot->x.label, std::min(left, plot->x.low.value_or(left)), right};
    plot->y = {plot->y.label, low, high};
  }
}

Sheet sheet_of_one_pose(const ScanReport& report) {
  Sheet sheet;
  sheet.subtitles = {pose_in_words(report)};
  double farthest = 0.0;
  std::vector<double> powers;
  std::vector<const SensorScans*> polar;
  bool alike = true;
  for (const SensorScans& one : report.sensors) {
    if (!is_polar(one)) continue;
    polar.push_back(&one);
    alike &= one.spec.index() == polar[0]->spec.index();
    for (const Echo& echo : one.scans[0].echoes) {
      farthest = std::max(farthest, echo.range);
      powers.push_back(to_db(echo.amplitude));
    }
  }
  const auto axis_of = [&](const SensorScans& one) {
    if (alike) return decibels(powers, "power of an echo, dB");
    std::vector<double> own;
    for (const Echo& echo : one.scans[0].echoes) own.push_back(to_db(echo.amplitude));
    return decibels(own, "power of an echo, dB");
  };
  const double range = ring_above(farthest > 0.0 ? 1.02 * farthest : polar.empty() ? 1.0 : polar[0]->scans[0].range_max);
  sheet.width = polar.size() > 1 ? 1160 : 940;
  // Two dials side by side.
  for (std::size_t i = 0; i < polar.size(); i += 2) {
    double widest = 0.0;
    Sheet::Row row;
    for (std::size_t j = i; j < std::min(polar.size(), i + 2); ++j) {
      row.panels.emplace_back(polar_plot(*polar[j], range, axis_of(*polar[j])));
      widest = std::max(widest, std::get<PolarPlot>(row.panels.back()).sector);
    }
    row.height = widest > pi + 1e-9 ? (polar.size() > 1 ? 690.0 : 800.0) : 560.0;
    sheet.rows.push_back(std::move(row));
  }
  for (const SensorScans& one : report.sensors) {
    if (is_polar(one)) {
      if (has_profiles(one)) sheet.rows.push_back({380.0, {azimuth_image(one)}});
    } else if (has_profiles(one)) {
      for (std::size_t beam = 0; beam < one.scans[0].beams.size(); ++beam) sheet.rows.push_back({report.sensors.size() * one.scans[0].beams.size() > 1 ? 330.0 : 460.0, {profile_plot(one, beam)}});
    } else {
      sheet.rows.push_back({report.sensors.size() > 1 ? 330.0 : 460.0, {stem_plot(one)}});
    }
  }
  if (of_one_kind(report)) {
    share_scale(sheet);
    share_axes(sheet);
  }
  return sheet;
}

// --- a way

ImagePlot waterfall(const SensorScans& one, const WayAxis& way) {
  const Profiles& first = one.scans[0].profiles;
  ImagePlot plot;
  plot.title = one.name;
  plot.x = {way.label, {}, {}, 0.0};
  plot.y.label = "range, m";
  plot.first = first.first_range;
  plot.step = first.bin_size;
  plot.rows = first.bins;
  plot.y.low = std::max(0.0, first.first_range - 0.5 * first.bin_size);
  plot.columns = way.values;
  std::vector<double> values;
  for (const Scan& scan : one.scans) {
    for (std::uint32_t i = 0; i < first.bins; ++i) {
      // Of several beams the strongest.
      float largest = 0.0f;
      for (std::size_t beam = 0; beam < scan.beams.size(); ++beam) largest = std::max(largest, scan.profiles.amplitude_of(beam)[i]);
      values.push_back(to_db(largest));
    }
  }
  plot.value = decibels(values, "amplitude, dB", 0.05);
  plot.values.assign(values.begin(), values.end());
  return plot;
}

Sheet sheet_of_way(const ScanReport& report) {
  const WayAxis way = way_axis(report);
  Sheet sheet;
  sheet.width = 1000;
  const glm::dvec3 from = report.poses.front().position, to = report.poses.back().position;
  sheet.subtitles = {fmt::format("{} scans from x {:.2f}, y {:.2f}, z {:.2f} m, yaw {:.1f}°, pitch {:.1f}° to x {:.2f}, y {:.2f}, z {:.2f} m, yaw {:.1f}°, pitch {:.1f}°", report.poses.size(), from.x, from.y, from.z,
                                 report.poses.front().yaw_deg, report.poses.front().pitch_deg, to.x, to.y, to.z, report.poses.back().yaw_deg, report.poses.back().pitch_deg)};
  sheet.subtitles.push_back(fmt::format("scans {} to {}, at {:g} s", report.number, report.number + report.poses.size() - 1, report.time));
  const auto [low, high] = std::minmax_element(way.values.begin(), way.values.end());
  const Axis x{way.label, *low, *high, way.label.ends_with("deg") ? angle_ticks(*high - *low) : 0.0};
  Plot ranges{"", x, {"range, m", 0.0, {}}, {}};
  Plot powers{"", x, {"largest amplitude, dB", {}, {}}, {}};
  // A curve goes from left to right, whatever the order of labels.
  std::vector<std::size_t> order(way.values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return way.values[a] < way.values[b]; });
  double farthest = 0.0;
  std::size_t colour = 0;
  for (const SensorScans& one : report.sensors) {
    const bool profiles = has_profiles(one);
    const std::string whose = report.sensors.size() > 1 ? one.name + ", " : "";
    Series strongest_range{whose + "strongest echo", Series::Kind::points, plot_colour(colour), {}}, first_range{whose + "first echo", Series::Kind::line, plot_colour(colour), {}};
    Series power{whose + (profiles ? "top of the profile" : "strongest echo"), Series::Kind::line, plot_colour(colour++), {}};
    for (const std::size_t i : order) {
      const ScanFigures figures = figures_of(one.scans[i]);
      const double none = std::nan("");
      const double top = profiles ? figures.top_amplitude.value_or(0.0) : figures.strongest ? figures.strongest->amplitude : 0.0;
      power.points.emplace_back(way.values[i], to_db(top));
      strongest_range.points.emplace_back(way.values[i], figures.strongest ? figures.strongest->range : none);
      first_range.points.emplace_back(way.values[i], figures.first ? figures.first->range : none);
      if (figures.strongest) farthest = std::max(farthest, figures.strongest->range);
    }
    powers.series.push_back(std::move(power));
    if (profiles) {
      sheet.rows.push_back({report.sensors.size() > 1 ? 340.0 : 420.0, {waterfall(one, way)}});
    } else {
      ranges.series.push_back(std::move(first_range));
      ranges.series.push_back(std::move(strongest_range));
    }
  }
  ranges.y.high = farthest > 0.0 ? 1.06 * farthest : 1.0;
  if (!ranges.series.empty()) sheet.rows.push_back({380.0, {std::move(ranges)}});
  sheet.rows.push_back({300.0, {std::move(powers)}});
  if (of_one_kind(report)) share_scale(sheet);
  // A curve stands exactly below the image that it belongs to, whose columns are half a step wider on either side.
  const bool images = std::any_of(sheet.rows.begin(), sheet.rows.end(), [](const Sheet::Row& row) { return std::holds_alternative<ImagePlot>(row.panels[0]); });
  std::vector<double> sorted = way.values;
  std::sort(sorted.begin(), sorted.end());
  const double margin = 0.012 * (sorted.back() - sorted[0]);  // for whole points at the ends
  const double before = images ? 0.5 * (sorted[1] - sorted[0]) : margin, after = images ? 0.5 * (sorted.back() - sorted[sorted.size() - 2]) : margin;
  for (Sheet::Row& row : sheet.rows)
    for (Panel& panel : row.panels)
      if (auto* image = std::get_if<ImagePlot>(&panel)) image->x.tick = x.tick;
      else if (auto* plot = std::get_if<Plot>(&panel)) plot->x = {x.label, *x.low - before, *x.high + after, x.tick};
  return sheet;
}

}  // namespace

Result<Done> draw_scans(const ScanReport& report, const std::filesystem::path& file) {
  Sheet sheet = report.poses.size() > 1 ? sheet_of_way(report) : sheet_of_one_pose(report);
  sheet.title = report.world + ": ";
  for (std::size_t i = 0; i < report.sensors.size(); ++i) sheet.title += (i == 0 ? "" : i + 1 == report.sensors.size() ? " and " : ", ") + report.sensors[i].name;
  if (report.sensors.size() == 1) {
    // One sensor is told in the title alone.
    sheet.subtitles.insert(sheet.subtitles.begin(), describe_sensor(report.sensors[0].spec));
    for (Sheet::Row& row : sheet.rows)
      for (Panel& panel : row.panels) std::visit([&](auto& plot) { if (plot.title == report.sensors[0].name) plot.title.clear(); }, panel);
  }
  return sheet.write(file);
}

}  // namespace thicket
