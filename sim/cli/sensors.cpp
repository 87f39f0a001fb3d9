// `thicket sensors`: the shipped sensor presets, and the keys of one.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "program.hpp"
#include "thicket/base/files.hpp"
#include "thicket/sim/scan_report.hpp"

namespace thicket::cli {
namespace {

std::int64_t beams_of(const ScannerSpec& spec) {
  const auto steps = static_cast<std::int64_t>(std::floor(spec.fov_deg / spec.step_deg + 1e-9));
  return std::max<std::int64_t>(1, spec.fov_deg >= 360.0 ? steps : steps + 1);
}

std::string bins_of(const ReceiverSpec& receiver, double range_max) {
  if (receiver.echoes == "traced") return "-";
  const double count = receiver.bin_count > 0 ? static_cast<double>(receiver.bin_count) : std::floor((range_max - receiver.bin_offset_m) / receiver.bin_size_m) + 1.0;
  return fmt::format("{:.0f} of {:g} m", count, receiver.bin_size_m);
}

Row row_of(const std::string& name, const SensorSpec& spec) {
  std::string frequency = "-", looks, rays, bins = "-";
  const MountedSpec& common = mounted(spec);
  if (const ScannerSpec* scan = scanner(spec)) {
    looks = fmt::format("{:g} deg by {:.3g}", scan->fov_deg, scan->step_deg);
    rays = fmt::format("{}", beams_of(*scan));
  }
  if (const auto* radar = std::get_if<ScanningRadarSpec>(&spec)) {
    frequency = fmt::format("{:g}", radar->frequency_ghz);
    rays = fmt::format("{}", beams_of(*radar) * (radar->elevation_opening_deg > 0.0 ? radar->elevation_rays : 1) * (radar->divergence == "cone" ? radar->cone_rays : 1));
    bins = bins_of(*radar, common.range_max_m);
  }
  if (const auto* lobe = std::get_if<LobeRadarSpec>(&spec)) {
    frequency = fmt::format("{:g}", lobe->frequency_ghz);
    looks = fmt::format("{:g} x {:g} deg", lobe->azimuth_opening_deg, lobe->elevation_opening_deg);
    rays = lobe->ray_spacing_m ? fmt::format("each {:g} m", *lobe->ray_spacing_m) : fmt::format("{} x {}", lobe->azimuth_rays, lobe->elevation_rays);
    bins = bins_of(*lobe, common.range_max_m);
  }
  return {name, sensor_type(spec), frequency, looks, rays, fmt::format("{:g} to {:g}", common.range_min_m, common.range_max_m), fmt::format("{:g}", common.rate_hz), bins};
}

/// The comment that a file begins with.
std::string head_of(const std::filesystem::path& file) {
  const auto text = read_text_file(file);
  std::string head;
  for (std::size_t at = 0; text && at < text->size() && (*text)[at] == '#';) {
    const std::size_t end = std::min(text->find('\n', at), text->size() - 1) + 1;
    head += text->substr(at, end - at);
    at = end;
  }
  return head;
}

int print_sensor(const std::string& name) {
  const auto spec = find_sensor(name, "thicket sensors");
  if (!spec) return complain(spec.error());
  const auto shipped = shipped_root() / "radar" / "presets" / (name + ".toml");
  fmt::print("{}type = {}\n{}", head_of(std::filesystem::exists(shipped) ? shipped : std::filesystem::path(name)), toml_string(sensor_type(*spec)), write_section(sensor_section(*spec), sensor_object(*spec)));
  return done;
}

}  // namespace

int list_sensors(const std::string& name) {
  if (!name.empty()) return print_sensor(name);
  std::vector<Row> rows = {{"preset", "type", "GHz", "looks", "rays", "range m", "Hz", "bins"}};
  for (const std::string& preset : sensor_presets()) {
    const auto spec = find_sensor(preset, preset);
    if (!spec) return complain(spec.error());
    rows.push_back(row_of(preset, *spec));
  }
  if (rows.size() == 1) return complain({fmt::format("no shipped sensors were found in {}: set THICKET_DATA to the folder that holds radar/presets", shipped_root().string())});
  fmt::print("{}\nall keys of one: thicket sensors NAME; what one sees: thicket scan WORLD --pose X,Y,Z,YAW_DEG --sensor NAME\n", aligned(rows, {"type", "looks"}));
  return done;
}

}  // namespace thicket::cli
