// What the robot believes about its own pose: the truth, or dead reckoning that drifts.
#pragma once

#include <cstdint>

#include "thicket/base/pose.hpp"
#include "thicket/base/schema.hpp"
#include "thicket/sim/vehicle.hpp"

namespace thicket {

/// The keys of [odometry]: how wrong measured speed and turn rate are. Noise as in McGuire, de Croon and Tuyls ("A comparative study of bug algorithms for robot navigation", 2019): white, sigma 0 ... 0.25 at
/// ten updates a second. Here a step of dt has sigma sqrt(0.1 s / dt), so that the drift does not depend on the step.
struct OdometrySpec {
  double speed_scale = 1.0;           ///< measured over true speed
  double turn_scale = 1.0;            ///< measured over true turn rate
  double speed_noise_m_s = 0.0;       ///< standard deviation at ten updates a second
  double turn_noise_rad_s = 0.0;      ///< likewise

  bool perfect() const { return speed_scale == 1.0 && turn_scale == 1.0 && speed_noise_m_s == 0.0 && turn_noise_rad_s == 0.0; }
};
const Section& odometry_section();

/// Dead reckoning from the true start. The noise is there while the robot stands, too, as in the study.
class Odometry {
 public:
  Odometry(const OdometrySpec& spec, const Pose2& start, std::uint64_t seed) : spec_(spec), seed_(seed), pose_(start) {}

  /// The robot drove `arc` for `dt` seconds, its step number `step` (< 2^48). Perfect odometry is not advanced: whoever has it takes the truth.
  void advance(const Arc& arc, double dt, std::uint64_t step);

  /// The same of a way in any direction, from one pose to another: what it measures forward and sideways is scaled by `speed_scale`, with noise on each.
  void advance(const Pose2& from, const Pose2& to, double dt, std::uint64_t step);

  bool perfect() const { return spec_.perfect(); }
  /// The estimate.
  const Pose2& pose() const { return pose_; }

 private:
  OdometrySpec spec_;
  std::uint64_t seed_;
  Pose2 pose_;
};

}  // namespace thicket
