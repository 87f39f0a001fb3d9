#include "problem_maker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace thicket {
namespace {

/// An oracle judges cells by their centres: a place is free for it only if the centre of its cell is.
constexpr double half_cell_diagonal = 0.036;  // m, of cells of 0.05 m

glm::dvec2 mirrored(const glm::dvec2& p) { return {p.x, -p.y}; }

double segment_distance(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p) {
  const glm::dvec2 along = b - a;
  const double squared = glm::dot(along, along);
  const double t = squared > 0.0 ? std::clamp(glm::dot(p - a, along) / squared, 0.0, 1.0) : 0.0;
  return glm::length(p - (a + t * along));
}

/// To a rectangle about the origin.
double rectangle_distance(const glm::dvec2& half, const glm::dvec2& p) {
  return glm::length(glm::dvec2(std::max(std::abs(p.x) - half.x, 0.0), std::max(std::abs(p.y) - half.y, 0.0)));
}

double wall_distance(const Wall& wall, const glm::dvec2& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < wall.points.size(); ++i) {
    const glm::dvec2 a = wall.points[i - 1], b = wall.points[i], along = b - a;
    const Pose2 frame{0.5 * (a + b), bearing(along)};
    least = std::min(least, rectangle_distance({0.5 * glm::length(along), 0.5 * wall.thickness}, frame.to_inner(p)));
    if (i > 1) least = std::min(least, std::max(glm::length(p - a) - 0.5 * wall.thickness, 0.0));  // its corners are round
  }
  return least;
}

double polygon_distance(const std::vector<glm::dvec2>& corners, const glm::dvec2& p) {
  double least = std::numeric_limits<double>::infinity();
  bool inside = false;
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const glm::dvec2 a = corners[j], b = corners[i];
    least = std::min(least, segment_distance(a, b, p));
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)) inside = !inside;
  }
  return inside ? 0.0 : least;
}

}  // namespace

double plan_distance(const Solid& solid, const glm::dvec2& point) {
  const glm::dvec2 p = Pose2{glm::dvec2(solid.position), solid.yaw}.to_inner(point);
  if (const auto* box = std::get_if<Box>(&solid.shape)) return rectangle_distance(0.5 * glm::dvec2(box->size), p);
  if (const auto* cylinder = std::get_if<Cylinder>(&solid.shape)) return std::max(glm::length(p) - cylinder->radius, 0.0);
  if (const auto* wall = std::get_if<Wall>(&solid.shape)) return wall_distance(*wall, p);
  if (const auto* prism = std::get_if<Prism>(&solid.shape)) return polygon_distance(prism->outline, p);
  return 0.0;
}

ProblemMaker::ProblemMaker(const Robot& whose, std::uint16_t family, std::uint64_t which)
    : robot(whose),
      number(which),
      keep(whose.keep()),
      doubt(problem_doubt(whose) + half_cell_diagonal),
      unit((keep + doubt) / 0.866),
      open(2.0 * (keep + doubt) + 0.01),
      closed(std::max(2.0 * (keep - doubt) - 0.01, 0.5 * keep)),
      random_(which, family),
      height_(std::max(1.0, 2.0 * whose.vehicle.hull().z_high)) {
  begin(0);
}

void ProblemMaker::begin(std::uint64_t attempt) {
  attempt_ = attempt;
  drawn_ = 0;
  world = World{};
  Material matter;
  matter.name = "wall";
  world.materials.push_back(matter);
  start = Pose2{};
  goal = glm::dvec2(0.0);
  start_is_free = goal_is_free = true;
}

double ProblemMaker::uniform(double low, double high) {
  const std::uint32_t at = drawn_++;
  return low + (high - low) * random_.uniform(attempt_, at / 4, RandomUse::sampling, 0)[at % 4];
}

int ProblemMaker::whole(int low, int high) { return std::min(high, low + static_cast<int>(uniform(0.0, high - low + 1.0))); }

void ProblemMaker::add(const char* name, const glm::dvec2& position, double z, double yaw, Shape shape) {
  Solid& solid = world.solids.emplace_back();
  solid.name = name + (" " + std::to_string(world.solids.size()));
  solid.position = {position.x, position.y, z};
  solid.yaw = yaw;
  solid.shape = std::move(shape);
}

void ProblemMaker::box(const glm::dvec2& centre, const glm::dvec2& size, double yaw) { add("box", centre, 0.5 * height_, yaw, Box{{size.x, size.y, height_}}); }
void ProblemMaker::post(const glm::dvec2& centre, double radius) { add("post", centre, 0.5 * height_, 0.0, Cylinder{radius, height_}); }
void ProblemMaker::wall(std::vector<glm::dvec2> points, double thickness) { add("wall", {0.0, 0.0}, 0.0, 0.0, Wall{std::move(points), thickness, height_}); }
void ProblemMaker::polygon(std::vector<glm::dvec2> corners) { add("prism", {0.0, 0.0}, 0.0, 0.0, Prism{std::move(corners), {}, height_}); }

void ProblemMaker::arena(double half) {
  const double thickness = 0.2 * unit, h = half + 0.5 * thickness;
  wall({{-h, 0.0}, {-h, -h}, {h, -h}, {h, h}, {-h, h}, {-h, 0.0}}, thickness);
}

void ProblemMaker::convex(const glm::dvec2& centre, double radius) {
  const int kind = whole(0, 3);
  if (kind == 0) return post(centre, radius);
  if (kind == 1) {
    const double turn = uniform(0.1, 0.5 * pi - 0.1);  // of its diagonal: from long and thin to square
    return box(centre, 2.0 * radius * glm::dvec2(std::cos(turn), std::sin(turn)), angle());
  }
  // Corners on a circle make a convex polygon, however they lie.
  const int corners = kind == 2 ? 3 : whole(4, 8);
  std::vector<glm::dvec2> outline;
  const double first = angle();
  for (int i = 0; i < corners; ++i) outline.push_back(centre + radius * direction(first + (i + uniform(-0.3, 0.3)) * 2.0 * pi / corners));
  polygon(std::move(outline));
}

void ProblemMaker::pen(const glm::dvec2& centre, const glm::dvec2& inner, double yaw, double gap, double thickness) {
  const glm::dvec2 h = inner + 0.5 * thickness;
  const Pose2 frame{centre, yaw};
  std::vector<glm::dvec2> points = {{h.x, 0.5 * gap}, {h.x, h.y}, {-h.x, h.y}, {-h.x, -h.y}, {h.x, -h.y}, {h.x, -0.5 * gap}};
  for (glm::dvec2& p : points) p = frame.to_outer(p);
  if (gap == 0.0) points.back() = points.front();
  wall(std::move(points), thickness);
}

void ProblemMaker::rotate(double yaw) {
  const Pose2 turn{{0.0, 0.0}, yaw};
  for (Solid& solid : world.solids) {
    const glm::dvec2 p = turn.to_outer(glm::dvec2(solid.position));
    solid.position = {p.x, p.y, solid.position.z};
    solid.yaw = wrap_angle(solid.yaw + yaw);
  }
  start = {turn.to_outer(start.position), wrap_angle(start.yaw + yaw)};
  goal = turn.to_outer(goal);
}

void ProblemMaker::mirror() {
  for (Solid& solid : world.solids) {
    solid.position.y = -solid.position.y;
    solid.yaw = -solid.yaw;
    if (auto* wall = std::get_if<Wall>(&solid.shape))
      for (glm::dvec2& p : wall->points) p = mirrored(p);
    if (auto* prism = std::get_if<Prism>(&solid.shape))
      for (glm::dvec2& p : prism->outline) p = mirrored(p);
  }
  start = {mirrored(start.position), -start.yaw};
  goal = mirrored(goal);
}

void ProblemMaker::translate(const glm::dvec2& by) {
  for (Solid& solid : world.solids) solid.position += glm::dvec3(by, 0.0);
  start.position += by;
  goal += by;
}

double ProblemMaker::distance(const glm::dvec2& point) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Solid& solid : world.solids) least = std::min(least, plan_distance(solid, point));
  return least;
}

}  // namespace thicket
