// The kinds of sensors, each in its file. Private to the room.
#pragma once

#include <memory>

#include "thicket/radar/sensor.hpp"

namespace thicket {

std::shared_ptr<const Sensor> make_radar(const ScanningRadarSpec& spec, std::uint16_t index);
std::shared_ptr<const Sensor> make_radar(const LobeRadarSpec& spec, std::uint16_t index);
std::shared_ptr<const Sensor> make_lidar(const LidarSpec& spec, std::uint16_t index);

}  // namespace thicket
