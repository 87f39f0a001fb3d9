// Planners: from what the robot senses to what it does next, and why.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "thicket/base/pose.hpp"
#include "thicket/base/schema.hpp"
#include "thicket/nav/bumper.hpp"
#include "thicket/nav/contour.hpp"

namespace thicket {

/// The keys of [planner].
struct PlannerSpec {
  std::string name = "bug2";
  std::optional<glm::dvec2> goal_m;
  std::vector<glm::dvec2> waypoints_m;  ///< for the planner "waypoints"
  std::string hand = "left";            ///< which hand touches the wall while following it
  double clearance_m = 1.0;             ///< between hull and matter: two lengths of a P3-AT (2012: two to three)
  bool clearance_auto = false;          ///< clearance_m is yet to be computed from the world, before the run
  bool clearance_privileged = false;    ///< clearance_m was computed from the world, which a robot could not know
  double goal_tolerance_m = 0.1;
  std::optional<double> speed_m_s;      ///< cruising speed; not given: the vehicle's
  std::string follower = "contour";     ///< how a boundary is followed: "contour": as a disc rolls along the matter | "rules2012": by the rules of the text, on bumpers alone
  double explore_m = 100.0;             ///< explorers: the distance to drive
};
const Section& planner_section();
/// Names that `make_planner` knows.
const std::vector<std::string>& planner_names();
/// What a planner cannot do without.
enum class PlannerNeeds { goal, waypoints, nothing };
/// Of one of `planner_names()`; a name that is none of them needs nothing.
PlannerNeeds planner_needs(const std::string& name);

/// What a planner knows of the vehicle that it drives. SI units and radians.
struct VehicleLimits {
  double hull_radius = 0.3;
  double speed = 0.5;              ///< m/s
  double turn_rate = 1.0;          ///< rad/s
  double deceleration = 0.3;       ///< m/s^2
  double turn_acceleration = 1.7;  ///< rad/s^2
  double decision_period = 0.1;    ///< s between decisions
};

/// What the planner gets to decide on. Pose and speeds are the robot's own estimates.
struct Senses {
  double time = 0.0;
  Pose2 pose;
  double speed = 0.0;      ///< m/s
  double turn_rate = 0.0;  ///< rad/s
  const Contour& contour;
  const BumperRing& bumpers;
};

struct Command {
  double speed = 0.0;      ///< m/s, forward
  double turn_rate = 0.0;  ///< rad/s, counter-clockwise
};

enum class Outcome { running, reached, unreachable, stuck };

struct Decision {
  Command command;
  Outcome outcome = Outcome::running;
  std::string state;   ///< in words: "following the boundary, wall on the left hand"
  std::string reason;  ///< of an outcome that ends the run, with its evidence
};

/// Something that the planner wants a person to see. World coordinates.
struct Mark {
  enum class Kind { point, segment } kind = Kind::point;
  std::string label;  ///< "hit", "leave", "closest", "M-line"
  glm::dvec2 from{0.0, 0.0}, to{0.0, 0.0};
};

class Planner {
 public:
  virtual ~Planner() = default;
  virtual Decision decide(const Senses& senses) = 0;
  virtual std::vector<Mark> marks() const = 0;
  virtual std::unique_ptr<Planner> clone() const = 0;
};

/// The planner that `spec` names, for a robot that starts at `start`. Errors say what the planner lacks (a goal, way-points).
Result<std::unique_ptr<Planner>> make_planner(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start);

/// How far from the hull a bumper is pressed: clearance plus the margin of `bumpers` (by default what braking from full speed takes, at least 0.5 m).
double press_distance(const BumperSpec& bumpers, const PlannerSpec& planner, const VehicleLimits& vehicle);

}  // namespace thicket
