#include "editor_shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "thicket/base/pose.hpp"
#include "thicket/worlds/truth.hpp"

namespace thicket::gui {
namespace {

/// A vertical line in the frame of a solid: origin + t * along.
struct Line {
  glm::dvec3 origin, along;
};

struct Span {
  double low = -INFINITY, high = INFINITY;
  bool empty() const { return low > high; }
  /// Where a coordinate of the line is between two values.
  void cut(double origin, double along, double from, double to) {
    if (along == 0.0) {
      if (origin < from || origin > to) high = -INFINITY, low = INFINITY;
      return;
    }
    const double a = (from - origin) / along, b = (to - origin) / along;
    low = std::max(low, std::min(a, b));
    high = std::min(high, std::max(a, b));
  }
};

bool crosses(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& d) {
  const auto side = [](const glm::dvec2& p, const glm::dvec2& q, const glm::dvec2& r) { return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x); };
  return side(a, b, c) * side(a, b, d) <= 0.0 && side(c, d, a) * side(c, d, b) <= 0.0;
}

/// Whether a tilted solid is met by the line: inside() answers for a point, and a tilted one has no height at which its section is its plan.
struct Meets {
  const Line& line;
  const Solid& solid;
  bool operator()(const Box& box) const {
    Span span;
    for (int i = 0; i < 3; ++i) span.cut(line.origin[i], line.along[i], -0.5 * box.size[i], 0.5 * box.size[i]);
    return !span.empty();
  }
  bool operator()(const Cylinder& c) const {
    Span span;
    span.cut(line.origin.z, line.along.z, -0.5 * c.height, 0.5 * c.height);
    const glm::dvec2 o(line.origin), d(line.along);
    const double a = glm::dot(d, d), nearest = a > 0.0 ? std::clamp(-glm::dot(o, d) / a, span.low, span.high) : 0.0;
    return !span.empty() && glm::length(o + nearest * d) <= c.radius;
  }
  bool operator()(const Prism& prism) const {
    Span span;
    span.cut(line.origin.z, line.along.z, 0.0, prism.height);
    if (span.empty() || !std::isfinite(span.low) || !std::isfinite(span.high)) return false;
    const glm::dvec2 from(line.origin + span.low * line.along), to(line.origin + span.high * line.along);
    Solid upright;
    upright.shape = prism;
    if (inside(upright, {from, 0.5 * prism.height})) return true;
    const auto meets_ring = [&](const std::vector<glm::dvec2>& ring) {
      for (std::size_t i = 0; i < ring.size(); ++i)
        if (crosses(from, to, ring[i], ring[(i + 1) % ring.size()])) return true;
      return false;
    };
    return meets_ring(prism.outline) || std::ranges::any_of(prism.holes, meets_ring);
  }
  template <class Other>
  bool operator()(const Other&) const {
    return false;
  }
};

/// A height in the frame of an upright solid at which its section is its plan.
double middle_of(const Shape& shape) {
  if (const auto* wall = std::get_if<Wall>(&shape)) return 0.5 * wall->height;
  if (const auto* map = std::get_if<MapSolid>(&shape)) return 0.5 * map->height;
  if (const auto* prism = std::get_if<Prism>(&shape)) return 0.5 * prism->height;
  return 0.0;
}

Pose2 frame_at(const Solid& solid, double time) {
  const Standing standing = standing_at(solid, time);
  return {glm::dvec2(standing.position), standing.yaw};
}

std::vector<glm::dvec2> rectangle(const glm::dvec2& low, const glm::dvec2& high) { return {low, {high.x, low.y}, high, {low.x, high.y}}; }

std::vector<glm::dvec2> circle(double radius) {
  std::vector<glm::dvec2> ring;
  for (int i = 0; i < 48; ++i) ring.push_back(radius * direction(2.0 * pi * i / 48));
  return ring;
}

/// In the frame of an upright solid.
struct LocalRings {
  using Rings = std::vector<std::vector<glm::dvec2>>;
  Rings operator()(const Box& b) const { return {rectangle(-0.5 * glm::dvec2(b.size), 0.5 * glm::dvec2(b.size))}; }
  Rings operator()(const Sphere& s) const { return {circle(s.radius)}; }
  Rings operator()(const Cylinder& c) const { return {circle(c.radius)}; }
  Rings operator()(const Wall& w) const {
    Rings legs;
    for (std::size_t i = 1; i < w.points.size(); ++i) {
      const glm::dvec2 leg = w.points[i] - w.points[i - 1];
      if (leg == glm::dvec2(0.0)) continue;
      const glm::dvec2 aside = 0.5 * w.thickness * glm::normalize(glm::dvec2(-leg.y, leg.x));
      legs.push_back({w.points[i - 1] + aside, w.points[i - 1] - aside, w.points[i] - aside, w.points[i] + aside});
    }
    return legs;
  }
  Rings operator()(const MapSolid& m) const { return {rectangle(glm::dvec2(0.0), glm::dvec2(m.grid.width, m.grid.height) * m.grid.resolution)}; }
  Rings operator()(const Prism& p) const {
    Rings all = {p.outline};
    all.insert(all.end(), p.holes.begin(), p.holes.end());
    return all;
  }
  Rings operator()(const MeshSolid& m) const { return {rectangle(m.scale * glm::dvec2(m.mesh->low), m.scale * glm::dvec2(m.mesh->high))}; }
};

/// Its ends are one corner.
bool closed(const Wall& wall) { return wall.points.size() > 2 && wall.points.front() == wall.points.back(); }

double millimetres(double x) { return std::round(x * 1000.0) / 1000.0; }
glm::dvec2 millimetres(const glm::dvec2& p) { return {millimetres(p.x), millimetres(p.y)}; }

}  // namespace

bool covers(const Solid& solid, const glm::dvec2& point, double time) {
  const Pose2 now = frame_at(solid, time);
  const glm::dvec2 local = now.to_inner(point);
  if (std::holds_alternative<MeshSolid>(solid.shape)) {
    if (solid.upright()) {
      const auto ring = LocalRings()(std::get<MeshSolid>(solid.shape)).front();
      return local.x >= ring[0].x && local.x <= ring[2].x && local.y >= ring[0].y && local.y <= ring[2].y;
    }
    // As it is tilted: in the box about it where it began, turned back to there.
    const Bounds box = extent(solid);
    const glm::dvec2 there = Pose2{glm::dvec2(standing_at(solid, 0.0).position), solid.yaw}.to_outer(local);
    return there.x >= box.low.x && there.x <= box.high.x && there.y >= box.low.y && there.y <= box.high.y;
  }
  if (!solid.upright()) {
    const glm::dmat3 turn = glm::transpose(rotation_of(0.0, solid.pitch, solid.roll));
    const Line line{turn * glm::dvec3(local, 0.0), turn * glm::dvec3(0.0, 0.0, 1.0)};
    return std::visit(Meets{line, solid}, solid.shape);
  }
  // Asked where the solid's data has it, whatever the time.
  return inside(solid, {Pose2{glm::dvec2(solid.position), solid.yaw}.to_outer(local), solid.position.z + middle_of(solid.shape)});
}

std::optional<std::uint32_t> solid_at(const World& world, const glm::dvec2& point, double time, double ground) {
  std::optional<std::uint32_t> best;
  double best_area = INFINITY;
  const auto all = extent(world);
  for (std::uint32_t i = 0; i < world.solids.size(); ++i) {
    const Solid& solid = world.solids[i];
    if (!covers(solid, point, time)) continue;
    const Bounds box = extent(solid);
    const bool as_large = world.solids.size() > 1 && box.low.x <= all->low.x && box.low.y <= all->low.y && box.high.x >= all->high.x && box.high.y >= all->high.y;
    if (as_large && std::holds_alternative<Box>(solid.shape) && (box.high.z <= ground + 1e-6 || box.low.z >= ground + 2.0)) continue;
    const double area = (box.high.x - box.low.x) * (box.high.y - box.low.y);
    if (area >= best_area) continue;
    best = i;
    best_area = area;
  }
  return best;
}

std::vector<std::vector<glm::dvec2>> rings(const Solid& solid, double time) {
  auto all = std::visit(LocalRings(), solid.shape);
  const Pose2 frame = frame_at(solid, time);
  const double c = std::cos(solid.pitch), s = std::sin(solid.pitch), r = std::cos(solid.roll);
  if (!solid.upright() && !std::holds_alternative<Prism>(solid.shape)) {
    // The box about it, as wide as its tilt makes it.
    Solid still = solid;
    still.motion = nullptr;
    still.yaw = 0.0;
    still.position = {0.0, 0.0, 0.0};
    const Bounds box = extent(still);
    all = {rectangle(glm::dvec2(box.low), glm::dvec2(box.high))};
  } else if (!solid.upright()) {
    for (auto& ring : all)
      for (glm::dvec2& p : ring) p = {c * p.x + s * std::sin(solid.roll) * p.y, r * p.y};
  }
  for (auto& ring : all)
    for (glm::dvec2& p : ring) p = frame.to_outer(p);
  return all;
}

std::vector<Grip> grips(const Solid& solid, double time, double reach) {
  std::vector<Grip> list;
  const Pose2 frame = frame_at(solid, time);
  if (const auto* box = std::get_if<Box>(&solid.shape); box && solid.upright()) {
    const auto corners = LocalRings()(*box).front();
    for (std::size_t i = 0; i < corners.size(); ++i) list.push_back({Grip::Kind::corner, i, frame.to_outer(corners[i])});
  }
  if (const auto* sphere = std::get_if<Sphere>(&solid.shape)) list.push_back({Grip::Kind::radius, 0, frame.to_outer({sphere->radius, 0.0})});
  if (const auto* cylinder = std::get_if<Cylinder>(&solid.shape); cylinder && solid.upright()) list.push_back({Grip::Kind::radius, 0, frame.to_outer({cylinder->radius, 0.0})});
  const std::vector<glm::dvec2>* points = nullptr;
  const auto* wall = std::get_if<Wall>(&solid.shape);
  if (wall) points = &wall->points;
  if (const auto* prism = std::get_if<Prism>(&solid.shape); prism && solid.upright()) points = &prism->outline;
  if (points)
    for (std::size_t i = 0; i < points->size() - (wall && closed(*wall)); ++i) list.push_back({Grip::Kind::point, i, frame.to_outer((*points)[i])});
  const bool round = solid.upright() && (std::holds_alternative<Sphere>(solid.shape) || std::holds_alternative<Cylinder>(solid.shape));
  if (!round) {
    double far = 0.0;
    for (const auto& ring : rings(solid, time))
      for (const glm::dvec2& p : ring) far = std::max(far, frame.to_inner(p).x);
    list.push_back({Grip::Kind::turn, 0, frame.to_outer({far + reach, 0.0})});
  }
  return list;
}

Solid moved(Solid solid, const glm::dvec2& by) {
  solid.position += glm::dvec3(by, 0.0);
  if (solid.motion) {
    auto motion = std::make_shared<Motion>(*solid.motion);
    for (glm::dvec3& p : motion->points) p += glm::dvec3(by, 0.0);
    solid.motion = std::move(motion);
  }
  return solid;
}

Solid dragged(const Solid& solid, const Grip& grip, const glm::dvec2& to, double time, double least) {
  const Pose2 frame = frame_at(solid, time);
  const glm::dvec2 local = frame.to_inner(to);
  Solid result = solid;
  switch (grip.kind) {
    case Grip::Kind::body:
      return moved(solid, to - grip.at);
    case Grip::Kind::turn:
      // In whole hundredths of a degree, so that files stay legible.
      if (local != glm::dvec2(0.0)) result.yaw = radians(std::round(degrees(wrap_angle(solid.yaw + bearing(local))) * 100.0) / 100.0);
      return result;
    case Grip::Kind::radius: {
      const double radius = std::max(least, millimetres(glm::length(local)));
      if (auto* sphere = std::get_if<Sphere>(&result.shape)) sphere->radius = radius;
      if (auto* cylinder = std::get_if<Cylinder>(&result.shape)) cylinder->radius = radius;
      return result;
    }
    case Grip::Kind::point:
      if (auto* wall = std::get_if<Wall>(&result.shape)) {
        const bool both = grip.index == 0 && closed(*wall);
        wall->points[grip.index] = millimetres(local);
        if (both) wall->points.back() = wall->points.front();
      }
      if (auto* prism = std::get_if<Prism>(&result.shape)) prism->outline[grip.index] = millimetres(local);
      return result;
    case Grip::Kind::corner: {
      // The opposite corner stays.
      auto& size = std::get<Box>(result.shape).size;
      const glm::dvec2 sign((grip.index == 1 || grip.index == 2) ? 1.0 : -1.0, grip.index >= 2 ? 1.0 : -1.0), half = 0.5 * glm::dvec2(size);
      const glm::dvec2 wide = glm::max(millimetres((local + sign * half) * sign), glm::dvec2(least));
      const glm::dvec2 middle = -sign * half + 0.5 * sign * wide;
      size.x = wide.x;
      size.y = wide.y;
      const glm::dvec2 by = frame.to_outer(middle) - frame.position;
      return moved(result, by);
    }
  }
  return result;
}

glm::dvec2 snapped(const glm::dvec2& point, double grid) {
  if (grid <= 0.0) return point;
  return {std::round(point.x / grid) * grid, std::round(point.y / grid) * grid};
}

Solid new_box(const glm::dvec2& a, const glm::dvec2& b, double ground, double height) {
  const glm::dvec2 low = millimetres(glm::min(a, b)), high = millimetres(glm::max(a, b));
  Solid solid;
  solid.position = {millimetres(0.5 * (low + high)), ground + 0.5 * height};
  solid.shape = Box{{glm::max(millimetres(high - low), glm::dvec2(0.01)), height}};
  return solid;
}

Solid new_sphere(const glm::dvec2& centre, const glm::dvec2& rim, double ground) {
  const double radius = std::max(0.01, millimetres(glm::distance(centre, rim)));
  Solid solid;
  solid.position = {millimetres(centre), ground + radius};
  solid.shape = Sphere{radius};
  return solid;
}

Solid new_cylinder(const glm::dvec2& centre, const glm::dvec2& rim, double ground, double height) {
  Solid solid;
  solid.position = {millimetres(centre), ground + 0.5 * height};
  solid.shape = Cylinder{std::max(0.01, millimetres(glm::distance(centre, rim))), height};
  return solid;
}

Solid new_wall(const std::vector<glm::dvec2>& points, double ground, double thickness, double height) {
  Wall wall{{}, thickness, height};
  const glm::dvec2 first = millimetres(points.front());
  for (const glm::dvec2& p : points) wall.points.push_back(millimetres(millimetres(p) - first));
  Solid solid;
  solid.position = {first, ground};
  solid.shape = std::move(wall);
  return solid;
}

Solid new_prism(const std::vector<glm::dvec2>& points, double ground, double height) {
  Prism prism{{}, {}, height};
  const glm::dvec2 first = millimetres(points.front());
  for (const glm::dvec2& p : points) prism.outline.push_back(millimetres(millimetres(p) - first));
  Solid solid;
  solid.position = {first, ground};
  solid.shape = std::move(prism);
  return solid;
}

}  // namespace thicket::gui
