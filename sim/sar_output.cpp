// The files of an image of synthetic aperture.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include <nlohmann/json.hpp>

#include "plot.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/probability_file.hpp"
#include "thicket/sim/sar.hpp"
#include "thicket/sim/simulation.hpp"

namespace thicket {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

const char* in_words(const std::string& method) { return method == "back_projection" ? "back-projection" : "simple sum"; }

/// NumPy's format 1.0, as write_npy has it, but of any numbers: float32, (height, width), row 0 at the bottom.
std::string npy(const SarGrid& grid) {
  std::string header = fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, {}), }}", grid.height, grid.width);
  header.resize((10 + header.size() + 1 + 63) / 64 * 64 - 11, ' ');
  header += '\n';
  std::string bytes("\x93NUMPY\x01\x00", 8);
  bytes += static_cast<char>(header.size() & 0xff);
  bytes += static_cast<char>(header.size() >> 8);
  bytes += header;
  static_assert(std::endian::native == std::endian::little);
  const std::size_t at = bytes.size();
  bytes.resize(at + grid.amplitude.size() * sizeof(float));
  if (!grid.amplitude.empty()) std::memcpy(bytes.data() + at, grid.amplitude.data(), grid.amplitude.size() * sizeof(float));
  return bytes;
}

Result<Done> write_picture(const std::filesystem::path& file, const Simulation& simulation, const SarReport& report) {
  const SarImage& image = *simulation.sar();
  const SarGrid& grid = report.grid;
  const double brightest = static_cast<double>(grid.brightest()), floor_db = image.spec().floor_db;
  ImagePlot plot;
  const bool line = image.spec().frame == "line";
  plot.x.label = line ? "along the line, m" : "x, m";
  plot.y.label = line ? "away from the line, m" : "y, m";
  plot.value = {"dB", floor_db, 0.0, 0.0};
  plot.first = grid.origin.y + 0.5 * grid.resolution;
  plot.step = grid.resolution;
  plot.rows = static_cast<std::size_t>(grid.height);
  for (int column = 0; column < grid.width; ++column) {
    plot.columns.push_back(grid.centre(column, 0).x);
    for (int row = 0; row < grid.height; ++row) {
      const double a = static_cast<double>(grid.amplitude[grid.index(column, row)]);
      plot.values.push_back(static_cast<float>(a > 0.0 && brightest > 0.0 ? std::max(floor_db, 20.0 * std::log10(a / brightest)) : floor_db));
    }
  }
  plot.series.push_back({"way of the sensor", Series::Kind::line, {0.835, 0.369, 0.0}, image.track()});
  // The axes as long as what they measure: what is left and right of them, and above and below, is about as wide as this.
  const double across = grid.width, upward = grid.height, scale = std::min(760.0 / across, 900.0 / upward);
  Sheet sheet;
  sheet.width = std::max(420, static_cast<int>(scale * across) + 226);
  sheet.title = fmt::format("{}: {} of '{}'", simulation.mission().name, in_words(image.method()), simulation.stage().sensors[*sar_sensor(simulation.mission())]->spec().name);
  sheet.subtitles = {fmt::format("{} scans, 0 dB is {:.4g}", image.scans(), brightest)};
  sheet.rows.push_back({std::max(120.0, scale * upward) + 76.0, {plot}});
  return sheet.write(file);
}

Json score_of(const MapScore& score) { return {{"f1", number(score.f1)}, {"precision", number(score.precision)}, {"recall", number(score.recall)}, {"claimed", score.claimed}}; }

}  // namespace

Result<SarReport> report_sar(const Simulation& simulation) {
  if (!simulation.sar()) return Error{"the run makes no image: set sar.enabled = true"};
  const SarImage& image = *simulation.sar();
  SarReport report;
  report.grid = image.grid();
  if (report.grid.amplitude.empty()) return Error{"no scan has come into the image: the run is too short, or sar.bounds_m lies where the lobe never looks"};
  report.peaks = sar_peaks(report.grid, image.spec().floor_db);
  if (!image.spec().fuse || simulation.map().known_cells() == 0) return report;
  const ProbabilityGrid map = simulation.map().to_probabilities();
  report.fusion = fuse_sar(map, image);
  // What cannot be judged is fused all the same.
  const auto truth = map_truth(simulation, map, Convention::cell_centre);
  if (!truth) return report;
  const auto before = score_map(map, *truth), after = score_map(report.fusion->map, *truth);
  if (before && after) {
    report.before = *before;
    report.after = *after;
  }
  return report;
}

const std::vector<std::string>& sar_files() {
  static const std::vector<std::string> names = {"sar.png", "sar.npy", "sar.json", "map_fused.pgm", "map_fused.yaml"};
  return names;
}

Result<Done> write_sar(const std::filesystem::path& folder, const Simulation& simulation, const SarReport& report) {
  std::vector<Result<Done>> written;
  written.push_back(write_picture(folder / "sar.png", simulation, report));
  written.push_back(write_file(folder / "sar.npy", npy(report.grid)));
  if (report.fusion) written.push_back(write_map_server(folder / "map_fused", report.fusion->map, MapMode::trinary));
  written.push_back(write_file(folder / "sar.json", sar_json(simulation, report)));
  for (const auto& one : written)
    if (!one) return one.error();
  return Done{};
}

std::string sar_json(const Simulation& simulation, const SarReport& report) {
  const SarImage& image = *simulation.sar();
  const SarGrid& grid = report.grid;
  Json json;
  json["mission"] = simulation.mission().name;
  json["sensor"] = simulation.stage().sensors[*sar_sensor(simulation.mission())]->spec().name;
  json["method"] = image.method();
  json["frame"] = image.spec().frame;
  const glm::dvec2 corner = image.to_world({0.0, 0.0}), ahead = image.to_world({1.0, 0.0}) - corner;
  json["frame_in_world"] = {{"x_m", corner.x}, {"y_m", corner.y}, {"yaw_deg", degrees(bearing(ahead))}};
  json["frequency_ghz"] = image.frequency_ghz();
  json["scans"] = image.scans();
  json["resolution_m"] = grid.resolution;
  json["width"] = grid.width;
  json["height"] = grid.height;
  json["origin_m"] = {grid.origin.x, grid.origin.y};
  json["plane_z_m"] = image.height();
  json["brightest"] = grid.brightest();
  Json peaks = Json::array();
  for (const SarPeak& peak : report.peaks)
    peaks.push_back({{"x_m", peak.position.x}, {"y_m", peak.position.y}, {"db", peak.db}, {"range_width_m", number(peak.range_width)}, {"azimuth_width_m", number(peak.azimuth_width)}});
  json["peaks"] = peaks;
  if (const auto& fusion = report.fusion) {
    json["fusion"] = {{"threshold_db", image.spec().fuse_threshold_db}, {"radius_m", image.spec().fuse_radius_m}, {"aperture_deg", image.spec().fuse_aperture_deg},
                      {"claimed", fusion->claimed}, {"judged", fusion->judged}, {"removed", fusion->removed}};
    if (report.before && report.after) {
      json["fusion"]["before"] = score_of(*report.before);
      json["fusion"]["after"] = score_of(*report.after);
    }
  }
  return json.dump(2) + "\n";
}

std::string sar_text(const Simulation& simulation, const SarReport& report) {
  const SarImage& image = *simulation.sar();
  const SarGrid& grid = report.grid;
  std::string text = fmt::format("sar     {} of {} scans, {} x {} pixels of {:g} m, {} peaks\n", in_words(image.method()), image.scans(), grid.width, grid.height, grid.resolution, report.peaks.size());
  const auto width = [](double m) { return std::isfinite(m) ? fmt::format("{:.3f} m", m) : std::string("-"); };
  for (std::size_t i = 0; i < std::min<std::size_t>(5, report.peaks.size()); ++i) {
    const SarPeak& peak = report.peaks[i];
    text += fmt::format("  peak  ({:.3f}, {:.3f}) {:6.1f} dB, width in range {}, across {}\n", peak.position.x, peak.position.y, peak.db, width(peak.range_width), width(peak.azimuth_width));
  }
  if (const auto& fusion = report.fusion) {
    text += fmt::format("fusion  {} of {} claimed cells taken off ({} that the image has a say in)\n", fusion->removed, fusion->claimed, fusion->judged);
    if (report.before && report.after)
      text += fmt::format("  map: F1 {:.3f} -> {:.3f}, precision {:.3f} -> {:.3f}, recall {:.3f} -> {:.3f} within {:g} m\n", report.before->f1, report.after->f1, report.before->precision, report.after->precision,
                          report.before->recall, report.after->recall, report.before->tolerance_m);
  }
  return text;
}

}  // namespace thicket
