// A scan of many beams as it lies about the sensor. Private to the room.
#pragma once

#include <vector>

#include "axes.hpp"

namespace thicket::gui {

class Polar {
 public:
  /// Forward is up. Amplitude by colour, brightest at `most`; a click chooses a beam.
  void draw(const Frame& frame, const Scan& scan, double most, bool decibel, std::size_t& beam, ImVec2 size);

 private:
  void paint(const Frame& frame, const Scan& scan, double most, bool decibel);

  static constexpr int side = 360;  ///< of the texture, pixels
  std::vector<std::uint32_t> pixels_;
  const void* painted_ = nullptr;  ///< the simulation of the scan in the texture
  std::uint16_t sensor_ = 0;
  bool decibel_ = false;
};

/// The beam that is nearest to a bearing of the sensor's frame, rad.
std::size_t nearest_beam(const Scan& scan, double bearing);

}  // namespace thicket::gui
