// What families of problems are made with: random numbers, solids, distances. Private to the room.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "thicket/base/random.hpp"
#include "thicket/sim/problem.hpp"

namespace thicket {

/// A problem under construction. Lengths are metres; `length` scales them with the robot.
class ProblemMaker {
 public:
  ProblemMaker(const Robot& robot, std::uint16_t family, std::uint64_t number);

  /// Forgets what is built and draws other numbers.
  void begin(std::uint64_t attempt);

  // Random numbers; ends included as far as rounding goes. (One call, one number: never two calls as arguments of one function, whose order a compiler may choose.
  // In braces it is from left to right.)
  double uniform(double low, double high);
  double length(double low, double high) { return unit * uniform(low, high); }
  int whole(int low, int high);  ///< low ... high
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  double angle() { return uniform(-pi, pi); }
  /// In the rectangle of these half sizes about the origin.
  glm::dvec2 within(const glm::dvec2& half) { return {uniform(-half.x, half.x), uniform(-half.y, half.y)}; }
  /// At a random bearing.
  glm::dvec2 away(double distance) { return distance * direction(angle()); }

  // Matter.
  void box(const glm::dvec2& centre, const glm::dvec2& size, double yaw = 0.0);
  void post(const glm::dvec2& centre, double radius);
  void wall(std::vector<glm::dvec2> points, double thickness);
  void polygon(std::vector<glm::dvec2> corners);
  /// An outer wall: a square about the origin, its inner faces `half` from it.
  void arena(double half);
  /// A convex solid of a random kind in the circle about `centre`.
  void convex(const glm::dvec2& centre, double radius);
  /// A wall that surrounds the rectangle of `inner` (half sizes) about `centre`, turned by `yaw`, but for a gap of a width in the middle of its east side.
  void pen(const glm::dvec2& centre, const glm::dvec2& inner, double yaw, double gap, double thickness);

  // The whole, with start and goal.
  void rotate(double yaw);             ///< about the origin
  void mirror();                       ///< y becomes -y
  void translate(const glm::dvec2& by);

  /// From a point to the nearest matter, exactly; 0 inside it, infinite in an empty world.
  double distance(const glm::dvec2& point) const;
  bool is_free(const glm::dvec2& point) const { return distance(point) >= keep + doubt; }

  const Robot& robot;
  const std::uint64_t number;
  const double keep;    ///< Robot::keep
  const double doubt;   ///< somewhat more than `problem_doubt`
  const double unit;    ///< the scale of lengths: by how much matter grows, over what that is for a robot of radius 0.25 m and clearance 0.4 m
  const double open;    ///< the least width of a passage that is open without a doubt
  const double closed;  ///< the greatest width of one that is closed without a doubt
  bool start_is_free = true, goal_is_free = true;  ///< whether they have to be; a family that is about just that says no

  World world;
  Pose2 start;
  glm::dvec2 goal{0.0, 0.0};

 private:
  void add(const char* name, const glm::dvec2& position, double z, double yaw, Shape shape);

  Random random_;
  double height_;
  std::uint64_t attempt_ = 0;
  std::uint32_t drawn_ = 0;
};

/// Distance of a point in the plane to a solid's plan; 0 inside. For boxes, cylinders, walls and prisms without holes, upright.
double plan_distance(const Solid& solid, const glm::dvec2& point);

// The families. Each builds `maker.world`, start and goal; it may do so in vain: then it is called with other random numbers.
using MakeFamily = void (*)(ProblemMaker& maker);
void make_convex(ProblemMaker& maker);
void make_spiral(ProblemMaker& maker);
void make_maze(ProblemMaker& maker);
void make_comb(ProblemMaker& maker);
void make_enclosed(ProblemMaker& maker);
void make_goal(ProblemMaker& maker);
void make_m_line(ProblemMaker& maker);
void make_thin(ProblemMaker& maker);
void make_random(ProblemMaker& maker);
void make_rooms2019(ProblemMaker& maker);

}  // namespace thicket
