#include "thicket/radar/sensor.hpp"

#include "sensors.hpp"

namespace thicket {

std::shared_ptr<const Sensor> make_sensor(const SensorSpec& spec, std::uint16_t index) {
  if (const auto* lidar = std::get_if<LidarSpec>(&spec)) return make_lidar(*lidar, index);
  if (const auto* lobe = std::get_if<LobeRadarSpec>(&spec)) return make_radar(*lobe, index);
  return make_radar(std::get<ScanningRadarSpec>(spec), index);
}

}  // namespace thicket
