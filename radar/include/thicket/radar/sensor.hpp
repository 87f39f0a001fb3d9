// Sensors that look at a scene.
#pragma once

#include <cstdint>
#include <memory>

#include "thicket/base/pose.hpp"
#include "thicket/base/random.hpp"
#include "thicket/radar/sensor_spec.hpp"
#include "thicket/scan/scan.hpp"
#include "thicket/worlds/scene.hpp"

namespace thicket {

/// A sensor: immutable, so that any number of simulations and threads may share it.
class Sensor {
 public:
  virtual ~Sensor() = default;

  /// Measures from a vehicle's pose. The scan is a function of the arguments alone. `scan` is overwritten; its memory is used again.
  virtual void measure(const Scene& scene, const Pose& vehicle, double time, std::uint64_t number, const Random& random, Scan& scan) const = 0;

  /// Whether a surface of this material, met squarely from the open, gives an echo; of a medium that light enters, whether enough of it does.
  virtual bool detects(const Material& material) const = 0;

  const ScannerSpec& spec() const { return spec_; }

 protected:
  explicit Sensor(ScannerSpec spec) : spec_(std::move(spec)) {}

 private:
  ScannerSpec spec_;
};

/// `index` tells the sensors of one vehicle apart (`Scan::sensor`).
std::shared_ptr<const Sensor> make_sensor(const SensorSpec& spec, std::uint16_t index);

}  // namespace thicket
