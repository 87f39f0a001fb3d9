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

/// A place to come by, and at which altitude if that is told.
struct Waypoint {
  Waypoint(double x, double y) : position(x, y) {}
  Waypoint(double x, double y, double z) : position(x, y), altitude(z) {}
  Waypoint(const glm::dvec2& at) : position(at) {}  // NOLINT: a way-point of a ground robot is a place in the plane
  operator const glm::dvec2&() const { return position; }

  glm::dvec2 position{0.0, 0.0};   ///< m
  std::optional<double> altitude;  ///< m; not given: as before

  static constexpr std::size_t length_min = 2, length_max = 3;
  static Waypoint of(const std::vector<double>& list) { return list.size() > 2 ? Waypoint(list[0], list[1], list[2]) : Waypoint(list[0], list[1]); }
  std::vector<double> coordinates() const { return altitude ? std::vector<double>{position.x, position.y, *altitude} : std::vector<double>{position.x, position.y}; }
};

/// The keys of [planner].
struct PlannerSpec {
  std::string name = "bug2";
  std::optional<glm::dvec2> goal_m;
  std::vector<Waypoint> waypoints_m;    ///< for the planner "waypoints"
  std::vector<double> waypoint_speeds_m_s;  ///< of the legs to them; empty: the cruising speed
  double hover_s = 0.0;                 ///< time to stand at each way-point
  std::optional<double> heading_deg;    ///< held while it moves, be it sideways; vehicles that fly only
  std::optional<double> altitude_m;     ///< flight altitude; not given: the start's
  bool land = false;                    ///< down to the floor at the end
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

/// What a planner knows of a vehicle that flies. SI units.
struct FlightLimits {
  double start_altitude = 0.0;   ///< m above the floor, which is at z = 0
  double climb_rate = 1.0;       ///< m/s, up and down
  double landing_speed = 0.5;    ///< m/s, the hardest landing that is none too hard
  double velocity_time = 0.3;    ///< s that its speed takes to follow a command (63 % of it)
};

/// What a planner knows of the vehicle that it drives. SI units and radians.
struct VehicleLimits {
  double hull_radius = 0.3;
  double speed = 0.5;              ///< m/s
  double turn_rate = 1.0;          ///< rad/s
  double deceleration = 0.3;       ///< m/s^2
  double turn_acceleration = 1.7;  ///< rad/s^2
  double decision_period = 0.1;    ///< s between decisions
  std::optional<FlightLimits> flight = std::nullopt;  ///< of one that flies
};

/// What the planner gets to decide on. Pose and speeds are the robot's own estimates.
struct Senses {
  double time = 0.0;
  Pose2 pose;
  double speed = 0.0;      ///< m/s
  double turn_rate = 0.0;  ///< rad/s
  const Contour& contour;
  const BumperRing& bumpers;
  double lateral = 0.0;    ///< m/s, leftward; what follows is of vehicles that fly
  double altitude = 0.0;   ///< m
  double climb = 0.0;      ///< m/s, upward
};

struct Command {
  double speed = 0.0;      ///< m/s, forward
  double turn_rate = 0.0;  ///< rad/s, counter-clockwise
  // Of vehicles that fly; others take no notice.
  double lateral = 0.0;    ///< m/s, leftward
  double climb = 0.0;      ///< m/s, upward
  std::optional<double> altitude = std::nullopt;  ///< m, to be held: then `climb` does not count
};

enum class Outcome { running, reached, unreachable, stuck };

struct Decision {
  Command command;
  Outcome outcome = Outcome::running;
  std::string state;   ///< in words: "following the boundary, wall on the left hand"
  std::string reason;  ///< of an outcome that ends the run, with its evidence
  bool waiting = false;  ///< it stands where it is on purpose
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

/// What is wrong with the keys of [planner] for a vehicle that flies or does not, in words that tell what to do; empty: nothing. `start_altitude` is z at the start, m.
std::string flight_fault(const PlannerSpec& spec, bool flies, double start_altitude);

/// The planner that `spec` names, for a robot that starts at `start`. Errors say what the planner lacks (a goal, way-points).
Result<std::unique_ptr<Planner>> make_planner(const PlannerSpec& spec, const VehicleLimits& vehicle, const Pose2& start);

/// How far from the hull a bumper is pressed: clearance plus the margin of `bumpers` (by default what braking from full speed takes, at least 0.5 m).
double press_distance(const BumperSpec& bumpers, const PlannerSpec& planner, const VehicleLimits& vehicle);

}  // namespace thicket
