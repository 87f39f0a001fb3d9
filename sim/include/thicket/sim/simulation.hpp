// A run as a value: it can be stepped, copied, driven by the window or by a test.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "thicket/base/result.hpp"
#include "thicket/nav/bumper.hpp"
#include "thicket/nav/occupancy_map.hpp"
#include "thicket/nav/planner.hpp"
#include "thicket/radar/sensor.hpp"
#include "thicket/sim/mission.hpp"
#include "thicket/sim/odometry.hpp"
#include "thicket/sim/sar.hpp"
#include "thicket/sim/vehicle.hpp"
#include "thicket/worlds/scene.hpp"

namespace thicket {

/// How a run ended.
struct Verdict {
  enum class Kind { reached, unreachable, stopped, collided };
  Kind kind = Kind::stopped;
  std::string reason;
  /// Where the robot really is when the run ends: a planner whose pose estimate is off may believe that it has reached the goal. Nothing without a goal.
  std::optional<double> true_distance_to_goal_m;
};
const char* to_string(Verdict::Kind kind);

/// Wall time spent in the parts of a run, s.
struct PhaseTimes {
  double trace = 0.0, map = 0.0, plan = 0.0, contact = 0.0, sar = 0.0;
};

/// What a run adds up.
struct RunTotals {
  double path_length = 0.0;                  ///< m
  double least_clearance = infinity;         ///< m, between hull and matter that stops motion
  std::uint64_t scans = 0, rays = 0, decisions = 0;
};

/// What does not change during a run, shared by all copies of its simulation.
struct Stage {
  Mission mission;
  Scene scene;  ///< as it is at time 0; each simulation has its own, whose solids move
  std::vector<std::shared_ptr<const Sensor>> sensors;
  std::vector<std::size_t> bumper_sensors;  ///< places in `sensors`; the planner decides when the first of them has scanned
  std::optional<std::size_t> sar_sensor;    ///< place in `sensors` of the one whose scans make the image, if there is to be one
  FlightModel flight;  ///< of a vehicle that flies
};

class Simulation {
 public:
  /// Reads the mission's world and makes everything ready; nothing has happened yet.
  static Result<Simulation> create(const Mission& mission);
  /// The same in a world that is at hand already, whatever world the mission names.
  static Result<Simulation> create(const Mission& mission, World world);
  /// The same in a scene that many runs share.
  static Result<Simulation> create(const Mission& mission, Scene scene);

  Simulation(const Simulation& other);
  Simulation& operator=(const Simulation& other);
  Simulation(Simulation&&) = default;
  Simulation& operator=(Simulation&&) = default;
  ~Simulation() = default;

  /// One step of `mission.step_s`: sensors that are due, map, planner, motion, contact, limits. Does nothing after the verdict. Returns whether the run goes on.
  bool step();
  /// Ends the run with the verdict stopped, if it has none yet.
  void stop(const std::string& reason);

  // What a person may do to a run. Each leaves a run that goes on like any other; a verdict is taken back unless the hull touches something.

  /// Drives by hand: the planner is not asked until nothing gives the wheel back to it; then it begins anew from where the robot is.
  void drive(const std::optional<Command>& command);
  bool driven_by_hand() const { return manual_.has_value(); }
  /// This run under a changed mission, in the same world or (as it is at time 0) another one, and, if told so, with the robot put somewhere else. Time, pose, map and totals go on; whatever the changed keys concern begins
  /// anew: the planner (from where the robot believes to be), bumpers, sensors, odometry, or the map. Errors as in `create`.
  Result<Simulation> changed(const Mission& mission, const std::optional<Pose2>& pose = std::nullopt) const;
  Result<Simulation> changed(const Mission& mission, Scene scene, const std::optional<Pose2>& pose) const;

  const Stage& stage() const { return *stage_; }
  const Mission& mission() const { return stage_->mission; }
  const Scene& scene() const { return scene_; }  ///< with moving solids where they are now
  /// Time is steps times the step: it does not drift.
  double time() const { return static_cast<double>(steps_) * stage_->mission.step_s; }
  std::uint64_t steps() const { return steps_; }
  const Vehicle& vehicle() const { return vehicle_; }
  /// The vehicle's pose as the robot believes it: the truth if its odometry is perfect.
  const Pose2& estimate() const { return odometry_.perfect() ? vehicle_.pose : odometry_.pose(); }
  Pose vehicle_pose() const { return in_space(vehicle_.pose); }  ///< in space, with altitude and tilt; on the start's height if it does not fly
  Pose estimated_pose() const { return in_space(estimate()); }   ///< the same as the robot believes it: it knows its altitude and its tilt
  Platform platform() const;  ///< the same with how it moves, for sensors
  const Clearance& clearance() const { return clearance_; }  ///< as last looked for: not while nothing can be nearer than the least so far, and not much farther than that
  const RunTotals& totals() const { return totals_; }
  const PhaseTimes& phase_times() const { return times_; }
  const std::optional<Verdict>& verdict() const { return verdict_; }

  const std::vector<Scan>& scans() const { return scans_; }  ///< the last scan of each sensor; without beams before the first
  const BumperRing& bumpers() const { return bumpers_; }
  const OccupancyMap& map() const { return map_; }
  const SarImage* sar() const { return sar_ ? &*sar_ : nullptr; }  ///< null unless [sar] is enabled
  const Decision& decision() const { return decision_; }  ///< the planner's last
  std::vector<Mark> marks() const { return planner_->marks(); }

 private:
  Simulation(std::shared_ptr<const Stage> stage, std::unique_ptr<Planner> planner);

  Pose in_space(const Pose2& pose) const;
  void sense();
  void measure(const std::vector<std::size_t>& due);
  void decide();
  void move();
  void drive_on();
  void fly_on();
  /// Sweeps the hull along a flight's path. Returns the time of contact within it, s, or +inf.
  double flight_contact(const FlightPath& path, double began);
  void check_limits();
  void check_progress();
  void end(Verdict::Kind kind, const std::string& reason);

  std::shared_ptr<const Stage> stage_;
  std::uint64_t steps_ = 0;
  Vehicle vehicle_;
  Odometry odometry_;
  std::unique_ptr<Planner> planner_;
  BumperRing bumpers_;
  Contour contour_;
  std::vector<ContourReader> readers_;      ///< one per sensor
  OccupancyMap map_;
  std::optional<SarImage> sar_;
  std::vector<Scan> scans_;
  std::vector<std::uint64_t> scan_counts_;
  std::vector<Pose2> scan_estimates_;       ///< where the robot believed to be at each sensor's last scan
  Decision decision_;
  std::optional<Command> manual_;
  Scene scene_;
  Clearance clearance_;
  double clear_of_ = 0.0;  ///< what the clearance now is at least, m
  RunTotals totals_;
  PhaseTimes times_;
  std::optional<Verdict> verdict_;
  Pose2 stuck_pose_;           ///< where the vehicle was when it last got away
  double stuck_z_ = 0.0;
  std::uint64_t stuck_step_ = 0;
  glm::dvec2 place_{0.0, 0.0};  ///< the last new place that it came to
  std::uint64_t place_step_ = 0;
};

/// A number of all that a run has come to: pose, estimate, decision, scans, bumpers, map, totals and verdict, but not of wall times. Two runs of the same number are, but for bad luck of 1 in 2^64, in the same state.
std::uint64_t state_hash(const Simulation& simulation);

}  // namespace thicket
