// The way that a vehicle went, as recorded.
#pragma once

#include <string>
#include <vector>

#include "thicket/sim/simulation.hpp"

namespace thicket {

/// One moment of a run.
struct TrajectoryPoint {
  double time = 0.0;  ///< s
  Pose2 pose;
  double z = 0.0;
  double speed = 0.0, turn_rate = 0.0;
  std::string state;  ///< of the planner
  glm::dquat attitude{1.0, 0.0, 0.0, 0.0};  ///< in space; only heading if the vehicle does not fly
  Pose2 estimate;     ///< where the robot believed to be; `pose` if its odometry is perfect
};

/// A point per decision of the planner, and the last moment.
class Trajectory {
 public:
  /// To be called before the first step and after every step.
  void note(const Simulation& simulation);

  const std::vector<TrajectoryPoint>& points() const { return points_; }

  /// `time_s,x_m,y_m,z_m,yaw_deg,speed_m_s,turn_rate_deg_s,state`, digits that read back to the same bits. Of a vehicle that flies there are `roll_deg,pitch_deg` after `turn_rate_deg_s`
  /// (turned by roll first, then pitch, then yaw), and its speed is the forward one. Of a robot whose odometry is not perfect there are `estimate_x_m,estimate_y_m,
  /// estimate_yaw_deg` before the state.
  std::string csv() const;
  /// The TUM format: `time x y z qx qy qz qw`.
  std::string tum() const;

 private:
  std::vector<TrajectoryPoint> points_;
  std::uint64_t decisions_ = 0;
  bool with_estimate_ = false, flies_ = false;
};

}  // namespace thicket
