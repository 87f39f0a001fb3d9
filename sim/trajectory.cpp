#include "thicket/sim/trajectory.hpp"

#include <fmt/format.h>

#include <iterator>

namespace thicket {

void Trajectory::note(const Simulation& simulation) {
  const bool decided = simulation.totals().decisions > decisions_;
  if (!points_.empty() && !decided && !simulation.verdict()) return;
  decisions_ = simulation.totals().decisions;
  const auto& vehicle = simulation.vehicle();
  points_.push_back({simulation.time(), vehicle.pose, vehicle.z, vehicle.speed, vehicle.turn_rate, simulation.decision().state, simulation.vehicle_pose().orientation, simulation.estimate()});
  flies_ = simulation.mission().vehicle.flies();
  with_estimate_ = !simulation.mission().odometry.perfect();
}

std::string Trajectory::csv() const {
  std::string text = fmt::format("time_s,x_m,y_m,z_m,yaw_deg,speed_m_s,turn_rate_deg_s,{}{}state\n", flies_ ? "roll_deg,pitch_deg," : "",
                                 with_estimate_ ? "estimate_x_m,estimate_y_m,estimate_yaw_deg," : "");
  for (const TrajectoryPoint& p : points_) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},", p.time, p.pose.position.x, p.pose.position.y, p.z, degrees(p.pose.yaw), p.speed, degrees(p.turn_rate));
    const glm::dvec3 angles = roll_pitch_yaw(p.attitude);
    if (flies_) fmt::format_to(std::back_inserter(text), "{},{},", degrees(angles.x), degrees(angles.y));
    if (with_estimate_) fmt::format_to(std::back_inserter(text), "{},{},{},", p.estimate.position.x, p.estimate.position.y, degrees(p.estimate.yaw));
    fmt::format_to(std::back_inserter(text), "\"{}\"\n", p.state);
  }
  return text;
}

std::string Trajectory::tum() const {
  std::string text = "# time x y z qx qy qz qw\n";
  for (const TrajectoryPoint& p : points_) {
    const glm::dquat& q = p.attitude;
    fmt::format_to(std::back_inserter(text), "{} {} {} {} {} {} {} {}\n", p.time, p.pose.position.x, p.pose.position.y, p.z, q.x, q.y, q.z, q.w);
  }
  return text;
}

}  // namespace thicket
