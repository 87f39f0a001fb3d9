#include "thicket/sim/odometry.hpp"

#include <cmath>

#include "thicket/base/random.hpp"

namespace thicket {

const Section& odometry_section() {
  using S = OdometrySpec;
  static const Section section = SectionOf<S>("[odometry]", "how wrong the robot is about its own motion; its planner and its map get the pose that it believes. Perfect by default")
                                     .key("speed_scale", &S::speed_scale, "", above_up_to(0.0, 10.0), "measured over true speed")
                                     .key("turn_scale", &S::turn_scale, "", above_up_to(0.0, 10.0), "measured over true turn rate")
                                     .key("speed_noise_m_s", &S::speed_noise_m_s, "m/s", between(0.0, 100.0),
                                          "standard deviation of white noise on the speed at ten measurements a second (McGuire et al. 2019: 0 to 0.25); the drift does not depend on step_s")
                                     .key("turn_noise_rad_s", &S::turn_noise_rad_s, "rad/s", between(0.0, 100.0), "likewise on the turn rate");
  return section;
}

void Odometry::advance(const Arc& arc, double dt, std::uint64_t step) {
  if (perfect()) return;
  const auto noise = Random(seed_, 0).normal(step, 0, RandomUse::odometry, 0);
  const double larger = std::sqrt(0.1 / dt);
  const Arc believed{pose_, spec_.speed_scale * arc.speed + spec_.speed_noise_m_s * larger * noise[0], spec_.turn_scale * arc.turn_rate + spec_.turn_noise_rad_s * larger * noise[1]};
  pose_ = believed.at(dt);
}

void Odometry::advance(const Pose2& from, const Pose2& to, double dt, std::uint64_t step) {
  if (perfect()) return;
  const auto noise = Random(seed_, 0).normal(step, 0, RandomUse::odometry, 0);
  const double larger = std::sqrt(0.1 / dt), turn = wrap_angle(to.yaw - from.yaw);
  // Ways are measured along the heading in the middle of the step.
  const glm::dvec2 measured = spec_.speed_scale * Pose2{from.position, from.yaw + 0.5 * turn}.to_inner(to.position) + spec_.speed_noise_m_s * larger * dt * glm::dvec2(noise[0], noise[2]);
  const double turned = spec_.turn_scale * turn + spec_.turn_noise_rad_s * larger * dt * noise[1];
  pose_ = {Pose2{pose_.position, pose_.yaw + 0.5 * turned}.to_outer(measured), wrap_angle(pose_.yaw + turned)};
}

}  // namespace thicket
