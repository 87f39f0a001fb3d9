// Scan reports as text: a table for a person, CSV for everything else.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

#include "scan_figures.hpp"

namespace thicket {
namespace {

constexpr std::size_t few_beams = 8;  ///< profiles of so many are told top by top
constexpr std::size_t most_in_a_row = 8, most_in_a_column = 40;  ///< echoes of a beam

template <class... Values>
void append(std::string& text, fmt::format_string<Values...> format, Values&&... values) {
  fmt::format_to(std::back_inserter(text), format, std::forward<Values>(values)...);
}

std::string pose_in_words(const ScanPose& pose) {
  return fmt::format("x {:.2f} m, y {:.2f} m, z {:.2f} m, yaw {:.1f} deg, pitch {:.1f} deg", pose.position.x, pose.position.y, pose.position.z, pose.yaw_deg, pose.pitch_deg);
}

std::string echo_in_words(const Echo& echo, bool velocity) {
  std::string text = fmt::format("{:8.3f} m {:7.1f} dB {:<5}", echo.range, to_db(echo.amplitude), to_string(echo.edge));
  if (echo.bounces > 1) append(text, " x{}", echo.bounces);
  if (velocity) append(text, " {:+.2f} m/s", echo.radial_velocity);
  return text;
}

/// The strongest echoes of a beam by range, and how many are left out.
std::pair<std::vector<Echo>, std::size_t> strongest_echoes(std::span<const Echo> echoes, std::size_t most) {
  std::vector<Echo> list(echoes.begin(), echoes.end());
  if (list.size() <= most) return {std::move(list), 0};
  std::stable_sort(list.begin(), list.end(), [](const Echo& a, const Echo& b) { return a.amplitude > b.amplitude; });
  list.resize(most);
  std::stable_sort(list.begin(), list.end(), [](const Echo& a, const Echo& b) { return a.range < b.range; });
  return {std::move(list), echoes.size() - most};
}

void add_profile(std::string& text, const Scan& scan, std::size_t beam, bool velocity) {
  const Beam& b = scan.beams[beam];
  append(text, "\nbeam {}, azimuth {:.1f} deg, elevation {:.1f} deg: {} detection{}\n", beam, degrees(b.azimuth), degrees(b.elevation), b.echo_count, b.echo_count == 1 ? "" : "s");
  for (const Echo& echo : scan.echoes_of(b)) {  // (a receiver cannot tell which side of matter it is)
    append(text, "  detected {:8.3f} m {:7.1f} dB", echo.range, to_db(echo.amplitude));
    if (velocity) append(text, " {:+.2f} m/s", echo.radial_velocity);
    text += '\n';
  }
  const auto tops = strongest_tops(scan.profiles, beam, 5);
  if (!tops.empty()) append(text, "  strongest tops of the profile\n       range m   amplitude        dB   threshold\n");
  for (const Top& top : tops)
    append(text, "    {:10.3f}  {:10.4g}  {:8.1f}  {:10.4g}{}\n", top.range, top.amplitude, to_db(top.amplitude), top.threshold, top.amplitude >= top.threshold ? "  above it" : "");
}

void add_beams(std::string& text, const Scan& scan, bool velocity) {
  const bool elevated = std::any_of(scan.beams.begin(), scan.beams.end(), [](const Beam& beam) { return beam.elevation != 0.0; });
  append(text, "\n    azimuth{}  how it ends              echoes: range, power, side{}{}\n", elevated ? "  elevation" : "",
         std::any_of(scan.echoes.begin(), scan.echoes.end(), [](const Echo& e) { return e.bounces > 1; }) ? ", surfaces met on the way out" : "", velocity ? ", radial velocity" : "");
  // A beam of many echoes, a lobe, has a line for each.
  const bool lobes = scan.beams.size() <= few_beams && std::any_of(scan.beams.begin(), scan.beams.end(), [](const Beam& beam) { return beam.echo_count > most_in_a_row; });
  for (const Beam& beam : scan.beams) {
    std::string line = fmt::format("{:7.2f} deg", degrees(beam.azimuth));
    if (elevated) append(line, " {:6.2f} deg", degrees(beam.elevation));
    append(line, "  {:<9} at {:8.3f} m", to_string(beam.end), beam.sensed_range);
    if (beam.starts_inside) line += "  inside matter";
    const auto [echoes, weaker] = strongest_echoes(scan.echoes_of(beam), lobes ? most_in_a_column : most_in_a_row);
    for (const Echo& echo : echoes) line += (lobes ? "\n    " : "  ") + echo_in_words(echo, velocity);
    if (weaker > 0) append(line, "{}and {} weaker ones, which --csv tells", lobes ? "\n    " : "  ", weaker);
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
}

std::string table_of_one_pose(const ScanReport& report) {
  std::string text = fmt::format("pose       {}\n", pose_in_words(report.poses[0]));
  for (const SensorScans& one : report.sensors) {
    const Scan& scan = one.scans[0];
    const bool velocity = measures_velocity(one.spec);
    append(text, "\nsensor     {}: {}\n", one.name, describe_sensor(one.spec));
    append(text, "scan       number {}, at {:g} s: {} echo{} in {} beam{}, {} rays\n", scan.number, scan.time, scan.echoes.size(), scan.echoes.size() == 1 ? "" : "es", scan.beams.size(),
           scan.beams.size() == 1 ? "" : "s", scan.rays);
    if (scan.profiles.bins > 0 && scan.beams.size() <= few_beams) {
      for (std::size_t beam = 0; beam < scan.beams.size(); ++beam) add_profile(text, scan, beam, velocity);
    } else {
      add_beams(text, scan, velocity);
    }
  }
  return text;
}

std::string echo_columns(const Echo* echo) { return echo ? fmt::format("{:>10.3f}  {:>8.1f}", echo->range, to_db(echo->amplitude)) : fmt::format("{:>10}  {:>8}", "-", "-"); }

std::string table_of_way(const ScanReport& report) {
  const WayAxis way = way_axis(report);
  std::string text = fmt::format("from       {}\nto         {}\n", pose_in_words(report.poses.front()), pose_in_words(report.poses.back()));
  for (const SensorScans& one : report.sensors) {
    const bool profiles = std::any_of(one.scans.begin(), one.scans.end(), [](const Scan& scan) { return scan.profiles.bins > 0; });
    append(text, "\nsensor     {}: {}\n\n", one.name, describe_sensor(one.spec));
    append(text, "{:>10}  {:>20}  {:>20}  {:>6}  {:>8}{}\n", "", "first echo", "strongest echo", "", "all", profiles ? "      top of profile" : "");
    append(text, "{:>10}  {:>10}  {:>8}  {:>10}  {:>8}  {:>6}  {:>8}{}\n", way.label, "range, m", "dB", "range, m", "dB", "echoes", "dB", profiles ? "    range, m        dB" : "");
    for (std::size_t i = 0; i < one.scans.size(); ++i) {
      const ScanFigures figures = figures_of(one.scans[i]);
      append(text, "{:>10.3f}  {}  {}  {:>6}  {:>8}", way.values[i], echo_columns(figures.first), echo_columns(figures.strongest), figures.echoes,
             figures.power > 0.0 ? fmt::format("{:.1f}", 10.0 * std::log10(figures.power)) : "-");
      if (figures.top_range) append(text, "  {:>10.3f}  {:>8.1f}", *figures.top_range, to_db(*figures.top_amplitude));
      text += "\n";
    }
  }
  return text;
}

/// A field of CSV; quoted where it must be.
std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string first_column(const ScanReport& report, const std::string& what) { return report.sensors.size() > 1 ? what + "," : ""; }

std::string csv_of_echoes(const ScanReport& report) {
  std::string text = first_column(report, "sensor") + "beam,azimuth_deg,elevation_deg,echo,range_m,amplitude,power_db,incidence_deg,edge,bounces,radial_velocity_m_s\n";
  for (const SensorScans& one : report.sensors) {
    const Scan& scan = one.scans[0];
    const std::string first = first_column(report, csv_text(one.name));
    for (std::size_t b = 0; b < scan.beams.size(); ++b) {
      const auto echoes = scan.echoes_of(scan.beams[b]);
      for (std::size_t e = 0; e < echoes.size(); ++e) {
        const Echo& echo = echoes[e];
        append(text, "{}{},{},{},{},{},{},{},{},{},{},{}\n", first, b, degrees(scan.beams[b].azimuth), degrees(scan.beams[b].elevation), e, echo.range, echo.amplitude, to_db(echo.amplitude),
               degrees(std::acos(std::clamp(static_cast<double>(echo.incidence_cosine), 0.0, 1.0))), to_string(echo.edge), echo.bounces,
               measures_velocity(one.spec) ? fmt::format("{}", echo.radial_velocity) : "");
      }
    }
  }
  return text;
}

std::string csv_of_way(const ScanReport& report) {
  const auto ways = way_lengths(report.poses);
  const bool labelled = std::any_of(report.poses.begin(), report.poses.end(), [](const ScanPose& pose) { return pose.label.has_value(); });
  std::string text = first_column(report, "sensor") + fmt::format("scan,way_m,{}x_m,y_m,z_m,yaw_deg,pitch_deg,echoes,first_range_m,first_amplitude,first_power_db,strongest_range_m,strongest_amplitude,"
                                                                  "strongest_power_db,sum_power_db,top_range_m,top_amplitude\n", labelled ? "label," : "");
  const auto echo = [](const Echo* e) { return e ? fmt::format("{},{},{}", e->range, e->amplitude, to_db(e->amplitude)) : std::string(",,"); };
  for (const SensorScans& one : report.sensors) {
    for (std::size_t i = 0; i < one.scans.size(); ++i) {
      const ScanPose& pose = report.poses[i];
      const ScanFigures figures = figures_of(one.scans[i]);
      const std::string label = !labelled ? "" : pose.label ? fmt::format("{},", *pose.label) : ",";
      append(text, "{}{},{},{}{},{},{},{},{},{},{},{},{},{}\n", first_column(report, csv_text(one.name)), report.number + i, ways[i], label, pose.position.x, pose.position.y, pose.position.z, pose.yaw_deg,
             pose.pitch_deg, figures.echoes, echo(figures.first), echo(figures.strongest), figures.power > 0.0 ? fmt::format("{}", 10.0 * std::log10(figures.power)) : "",
             figures.top_range ? fmt::format("{},{}", *figures.top_range, *figures.top_amplitude) : ",");
    }
  }
  return text;
}

}  // namespace

std::string scan_table(const ScanReport& report) {
  return fmt::format("world      {}\n{}", report.world, report.poses.size() > 1 ? table_of_way(report) : table_of_one_pose(report));
}

std::string scan_csv(const ScanReport& report) { return report.poses.size() > 1 ? csv_of_way(report) : csv_of_echoes(report); }

std::string profile_csv(const ScanReport& report) {
  const bool way = report.poses.size() > 1;
  std::string rows;
  for (const SensorScans& one : report.sensors) {
    for (const Scan& scan : one.scans) {
      const Profiles& p = scan.profiles;
      for (std::size_t b = 0; p.bins > 0 && b < scan.beams.size(); ++b) {
        for (std::uint32_t i = 0; i < p.bins; ++i) {
          const std::size_t at = b * p.bins + i;
          append(rows, "{}{}{},{},{},{}", first_column(report, csv_text(one.name)), way ? fmt::format("{},", scan.number) : "", b, p.range(i), p.amplitude[at],
                 p.threshold.empty() ? "" : fmt::format("{}", p.threshold[at]));
          rows += p.iq.empty() ? ",,\n" : fmt::format(",{},{}\n", p.iq[at].real(), p.iq[at].imag());
        }
      }
    }
  }
  return rows.empty() ? rows : first_column(report, "sensor") + (way ? "scan," : "") + "beam,range_m,amplitude,threshold,i,q\n" + rows;
}

}  // namespace thicket
