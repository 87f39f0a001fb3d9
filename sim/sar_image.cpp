// Which of a mission's sensors makes an image, and how.
#include <fmt/format.h>

#include <algorithm>

#include "thicket/base/text.hpp"
#include "thicket/sim/mission.hpp"
#include "thicket/sim/sar.hpp"

namespace thicket {
namespace {

/// Pixels an image may have beforehand.
constexpr double most_pixels = 16e6;

const LobeRadarSpec* imaging(const SensorSpec& sensor) {
  const auto* lobe = std::get_if<LobeRadarSpec>(&sensor);
  return lobe && lobe->echoes == "receiver" ? lobe : nullptr;
}

bool coherent(const Mission& mission, const LobeRadarSpec& lobe) { return mission.sar.method == "back_projection" || (mission.sar.method == "auto" && lobe.signal == "iq"); }

}  // namespace

std::optional<std::size_t> sar_sensor(const Mission& mission) {
  for (std::size_t i = 0; i < mission.sensors.size(); ++i)
    if (imaging(mission.sensors[i]) && (mission.sar.sensor.empty() || mission.sar.sensor == mounted(mission.sensors[i]).name)) return i;
  return std::nullopt;
}

std::optional<std::string> sar_fault(const Mission& mission) {
  const SarSpec& sar = mission.sar;
  if (!sar.enabled) return std::nullopt;
  const auto sensor = sar_sensor(mission);
  if (!sensor) {
    if (sar.sensor.empty()) return "sar.enabled is true, but no sensor is a lobe radar with echoes = \"receiver\", expected one (preset = \"x4m05\")";
    std::vector<std::string> names;
    for (const SensorSpec& s : mission.sensors)
      if (imaging(s)) names.push_back(mounted(s).name);
    return fmt::format("sar.sensor is '{}', expected the name of a lobe radar with echoes = \"receiver\", of '{}'{}", sar.sensor, fmt::join(names, "', '"), did_you_mean(sar.sensor, names));
  }
  const LobeRadarSpec& lobe = *imaging(mission.sensors[*sensor]);
  if (sar.method == "back_projection" && lobe.signal != "iq")
    return fmt::format("sar.method is 'back_projection', but sensor '{}' has signal = \"{}\", expected signal = \"iq\" (--set 'sensor.{}.signal=\"iq\"'), or method = \"simple_sum\"", lobe.name, lobe.signal, lobe.name);
  if (sar.fuse && !coherent(mission, lobe)) return fmt::format("sar.fuse is true, but the image is a simple sum, expected back-projection: signal = \"iq\" of sensor '{}'", lobe.name);
  if (sar.fuse && !mission.map.enabled) return "sar.fuse is true, but map.enabled is false, expected a map to take cells off";
  if (const auto& b = sar.bounds_m) {
    if (!(b->x < b->z && b->y < b->w)) return "sar.bounds_m is empty, expected x_min < x_max and y_min < y_max";
    if (const double pixels = (b->z - b->x) * (b->w - b->y) / (sar.resolution_m * sar.resolution_m); pixels > most_pixels)
      return fmt::format("sar.bounds_m has {:.0f} pixels of {} m, expected at most {:.0f}: make it smaller or sar.resolution_m coarser", pixels, sar.resolution_m, most_pixels);
  }
  return std::nullopt;
}

std::optional<SarImage> begin_sar(const Mission& mission) {
  const auto sensor = sar_sensor(mission);
  if (!mission.sar.enabled || !sensor) return std::nullopt;
  const LobeRadarSpec& lobe = *imaging(mission.sensors[*sensor]);
  return SarImage(mission.sar, coherent(mission, lobe) ? "back_projection" : "simple_sum", lobe.frequency_ghz);
}

}  // namespace thicket
