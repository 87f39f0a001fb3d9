// Sensors that look at a scene.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "thicket/base/pose.hpp"
#include "thicket/base/random.hpp"
#include "thicket/radar/sensor_spec.hpp"
#include "thicket/scan/scan.hpp"
#include "thicket/worlds/scene.hpp"

namespace thicket {

/// What carries a sensor: where it is and how it moves, in world coordinates.
struct Platform {
  Pose pose;
  glm::dvec3 velocity{0.0};   ///< m/s
  glm::dvec3 turn_rate{0.0};  ///< rad/s, angular velocity about the pose's position

  Platform() = default;
  Platform(const Pose& standing) : pose(standing) {}  // NOLINT: a pose is a platform at rest
  Platform(const Pose& moving, const glm::dvec3& with, const glm::dvec3& turning) : pose(moving), velocity(with), turn_rate(turning) {}
};

/// A part of the physics that a sensor models in a scene, or leaves out, and why: for a person who asks what a result rests on.
struct PhysicsPart {
  std::string name;  ///< "penetration"
  bool modelled = false;
  std::string why;   ///< "nothing in the world lets the wave through"
};

/// A sensor: immutable, so that any number of simulations and threads may share it.
class Sensor {
 public:
  virtual ~Sensor() = default;

  /// Measures from a platform. The scan is a function of the arguments alone, whatever the number of threads. `scan` is overwritten; its memory is used again.
  virtual void measure(const Scene& scene, const Platform& platform, double time, std::uint64_t number, const Random& random, Scan& scan) const = 0;

  /// Whether a surface of this material that fills a beam, met squarely from the open at the end of the range, gives an echo; of a medium that light enters, whether
  /// enough of it does.
  virtual bool detects(const Material& material) const = 0;

  /// What a scan from this platform models. What is left out is not executed, and would not change the scan.
  virtual std::vector<PhysicsPart> model_of(const Scene& scene, const Platform& platform) const = 0;

  const MountedSpec& spec() const { return spec_; }

 protected:
  explicit Sensor(MountedSpec spec) : spec_(std::move(spec)) {}

 private:
  MountedSpec spec_;
};

/// `index` tells the sensors of one vehicle apart (`Scan::sensor`).
std::shared_ptr<const Sensor> make_sensor(const SensorSpec& spec, std::uint16_t index);

}  // namespace thicket
