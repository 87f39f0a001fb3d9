// What of a solid is seen from above.
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "plan.hpp"

namespace thicket::gui {
namespace {

using Points = std::vector<glm::dvec2>;

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// Andrew's monotone chain; counter-clockwise.
Points hull_of(Points points) {
  std::sort(points.begin(), points.end(), [](const glm::dvec2& a, const glm::dvec2& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  Points hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t start = hull.size();
    for (const glm::dvec2& p : points) {
      while (hull.size() >= start + 2 && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0.0) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

class Maker {
 public:
  Maker(const Solid& solid, Footprint& shape) : solid_(solid), shape_(shape), tilt_(rotation_of(0.0, solid.pitch, solid.roll)) {}

  void operator()(const Box& box) {
    Points corners;
    for (const double x : {-0.5, 0.5})
      for (const double y : {-0.5, 0.5})
        for (const double z : {-0.5, 0.5}) corners.push_back(flat(glm::dvec3(x, y, z) * box.size));
    polygon(hull_of(std::move(corners)));
  }
  void operator()(const Sphere& sphere) { shape_.discs.push_back({glm::dvec2(0.0), sphere.radius}); }
  void operator()(const Cylinder& cylinder) {
    if (solid_.upright()) return shape_.discs.push_back({glm::dvec2(0.0), cylinder.radius});
    Points rims;
    for (int i = 0; i < 48; ++i)
      for (const double z : {-0.5, 0.5}) rims.push_back(flat(glm::dvec3(cylinder.radius * direction(2.0 * pi * i / 48), z * cylinder.height)));
    polygon(hull_of(std::move(rims)));
  }
  void operator()(const Wall& wall) {
    for (std::size_t i = 1; i < wall.points.size(); ++i) {
      const glm::dvec2 a = wall.points[i - 1], b = wall.points[i], along = glm::normalize(b - a), side = 0.5 * wall.thickness * glm::dvec2(-along.y, along.x);
      shape_.fills.push_back({a - side, b - side, b + side, a + side});
      if (i + 1 < wall.points.size() || wall.points.back() == wall.points.front()) shape_.discs.push_back({b, 0.5 * wall.thickness});
    }
  }
  void operator()(const MapSolid& map) {
    const double r = map.grid.resolution;
    for (const CellBlock& b : map.blocks) {
      const glm::dvec2 low = glm::dvec2(b.column, b.row) * r, high = low + glm::dvec2(b.columns, b.rows) * r;
      shape_.fills.push_back({low, {high.x, low.y}, high, {low.x, high.y}});
    }
  }
  void operator()(const Prism& prism) {
    triangles(*prism_mesh(prism.outline, prism.holes, prism.height), 1.0, true);
    if (!solid_.upright()) return;
    shape_.rings.push_back(prism.outline);
    shape_.rings.insert(shape_.rings.end(), prism.holes.begin(), prism.holes.end());
  }
  void operator()(const MeshSolid& solid) { triangles(*solid.mesh, solid.scale, solid.mesh->closed); }

 private:
  glm::dvec2 flat(const glm::dvec3& p) const { return glm::dvec2(tilt_ * p); }
  void polygon(Points points) {
    shape_.rings.push_back(points);
    shape_.fills.push_back(std::move(points));
  }
  /// Of a volume those that face up cover all of it, each place once unless it overhangs.
  void triangles(const Mesh& mesh, double scale, bool only_upward) {
    for (const glm::uvec3& t : mesh.triangles) {
      glm::dvec2 a = flat(scale * mesh.vertices[t.x]), b = flat(scale * mesh.vertices[t.y]), c = flat(scale * mesh.vertices[t.z]);
      const double turn = cross(b - a, c - a);
      if (turn == 0.0 || (only_upward && turn < 0.0)) continue;
      if (turn < 0.0) std::swap(b, c);
      shape_.fills.push_back({a, b, c});
    }
  }

  const Solid& solid_;
  Footprint& shape_;
  glm::dmat3 tilt_;
};

}  // namespace

Footprint footprint_of(const Solid& solid) {
  Footprint shape;
  std::visit(Maker(solid, shape), solid.shape);
  PlanExtent all;
  for (const auto& list : {&shape.fills, &shape.rings})
    for (const Points& points : *list)
      for (const glm::dvec2& p : points) all.hold(p);
  for (const Footprint::Disc& disc : shape.discs) {
    all.hold(disc.centre - disc.radius);
    all.hold(disc.centre + disc.radius);
  }
  if (all.low.x > all.high.x) all.hold(glm::dvec2(0.0));
  shape.low = all.low;
  shape.high = all.high;
  return shape;
}

Footprint rough_footprint_of(const Solid& solid) {
  const auto& mesh = std::get<MeshSolid>(solid.shape);
  const glm::dmat3 tilt = rotation_of(0.0, solid.pitch, solid.roll);
  PlanExtent all;
  for (const auto& v : mesh.mesh->vertices) all.hold(glm::dvec2(tilt * (mesh.scale * glm::dvec3(v))));
  Footprint shape;
  shape.low = all.low;
  shape.high = all.high;
  shape.rings.push_back({all.low, {all.high.x, all.low.y}, all.high, {all.low.x, all.high.y}});
  return shape;
}

bool Footprint::contains(const glm::dvec2& point) const {
  if (point.x < low.x || point.y < low.y || point.x > high.x || point.y > high.y) return false;
  if (!mask.empty() || (fills.empty() && discs.empty())) return true;
  for (const Disc& disc : discs)
    if (glm::distance(disc.centre, point) <= disc.radius) return true;
  return std::any_of(fills.begin(), fills.end(), [&](const Points& polygon) {
    for (std::size_t i = 0; i < polygon.size(); ++i)
      if (cross(polygon[(i + 1) % polygon.size()] - polygon[i], point - polygon[i]) < 0.0) return false;
    return true;
  });
}

}  // namespace thicket::gui
