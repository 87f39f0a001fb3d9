#include "plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "thicket/base/pose.hpp"

namespace thicket::plan {
namespace {

constexpr int circle_sides = 2304;  // inscribed: 1 - cos(pi / 2304) < 1e-6

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// Andrew's monotone chain (1979): the corners of the convex hull, counter-clockwise.
std::vector<glm::dvec2> hull_of(std::vector<glm::dvec2> points) {
  std::sort(points.begin(), points.end(), [](const glm::dvec2& a, const glm::dvec2& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<glm::dvec2> hull;
  const auto chain = [&hull](auto begin, auto end) {
    const std::size_t base = hull.size();
    for (auto p = begin; p != end; ++p) {
      while (hull.size() >= base + 2 && cross(hull.back() - hull[hull.size() - 2], *p - hull.back()) <= 0.0) hull.pop_back();
      hull.push_back(*p);
    }
    hull.pop_back();  // the other chain begins with it
  };
  chain(points.begin(), points.end());
  chain(points.rbegin(), points.rend());
  return hull;
}

/// The polygon's x where its edge a-b passes a height y between theirs.
double x_at(const glm::dvec2& a, const glm::dvec2& b, double y) {
  if (y == a.y) return a.x;
  if (y == b.y) return b.x;
  return a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
}

class Cutter {
 public:
  Cutter(const Solid& solid, double z_low, double z_high, const Visitor& visitor)
      : solid_(solid), turn_(turn_of(solid)), z_low_(z_low), z_high_(z_high), visitor_(visitor) {}

  void operator()(const Box& b) {
    const glm::dvec3 h = 0.5 * b.size;
    block({{-h.x, -h.y}, {h.x, -h.y}, {h.x, h.y}, {-h.x, h.y}}, -h.z, h.z);
  }
  void operator()(const Sphere& s) {
    const double dz = std::max({0.0, z_low_ - solid_.position.z, solid_.position.z - z_high_});
    if (dz < s.radius) visitor_.piece({{glm::dvec2(solid_.position)}, std::sqrt((s.radius - dz) * (s.radius + dz))});
  }
  void operator()(const Cylinder& c) { pillar({0.0, 0.0}, c.radius, -0.5 * c.height, 0.5 * c.height); }
  void operator()(const Wall& w) {
    for (std::size_t i = 1; i < w.points.size(); ++i) {
      const glm::dvec2 a = w.points[i - 1], b = w.points[i];
      const glm::dvec2 along = glm::normalize(b - a), side = 0.5 * w.thickness * glm::dvec2(-along.y, along.x);
      block({a - side, b - side, b + side, a + side}, 0.0, w.height);
      const bool joint = i + 1 < w.points.size() || w.points.back() == w.points.front();
      if (joint) pillar(b, 0.5 * w.thickness, 0.0, w.height);
    }
  }
  /// By the cells themselves, run by run, not by their merged blocks.
  void operator()(const MapSolid& m) {
    const double r = m.grid.resolution;
    for (int row = 0; row < m.grid.height; ++row) {
      for (int column = 0; column < m.grid.width; ++column) {
        if (!m.matter(column, row)) continue;
        const int first = column;
        while (column < m.grid.width && m.matter(column, row)) ++column;
        block({{first * r, row * r}, {column * r, row * r}, {column * r, (row + 1) * r}, {first * r, (row + 1) * r}}, 0.0, m.height);
      }
    }
  }
  void operator()(const Prism& p);
  void operator()(const MeshSolid& m);

 private:
  glm::dvec3 placed(const glm::dvec3& p) const { return solid_.position + turn_ * p; }
  bool reaches(double low, double high) const { return low < z_high_ && high > z_low_; }

  /// A convex polygon of the solid's frame, counter-clockwise, from one height of it to another.
  void block(const std::vector<glm::dvec2>& polygon, double low, double high) {
    if (solid_.upright()) {
      if (!reaches(solid_.position.z + low, solid_.position.z + high)) return;
      piece_.corners.clear();
      for (const glm::dvec2& p : polygon) piece_.corners.emplace_back(placed({p, 0.0}));
      piece_.radius = 0.0;
      return visitor_.piece(piece_);
    }
    // The part in the slab is convex: its corners are the corners in the slab, and where edges pass the slab's faces.
    std::vector<glm::dvec3> bottom, top;
    double least = INFINITY, most = -INFINITY;
    for (const glm::dvec2& p : polygon) {
      bottom.push_back(placed({p, low}));
      top.push_back(placed({p, high}));
      least = std::min({least, bottom.back().z, top.back().z});
      most = std::max({most, bottom.back().z, top.back().z});
    }
    if (!reaches(least, most)) return;
    std::vector<glm::dvec2> points;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const std::size_t next = (i + 1) % polygon.size();
      cut_edge(bottom[i], bottom[next], points);
      cut_edge(top[i], top[next], points);
      cut_edge(bottom[i], top[i], points);
    }
    if (!points.empty()) visitor_.piece({hull_of(std::move(points)), 0.0});
  }

  /// The ends of the part of an edge between the slab's faces.
  void cut_edge(const glm::dvec3& a, const glm::dvec3& b, std::vector<glm::dvec2>& points) const { cut_edge(a, b, z_low_, z_high_, points); }
  static void cut_edge(const glm::dvec3& a, const glm::dvec3& b, double low, double high, std::vector<glm::dvec2>& points) {
    if (std::max(a.z, b.z) < low || std::min(a.z, b.z) > high) return;
    const auto at = [&](double z) { return z == a.z ? glm::dvec2(a) : z == b.z ? glm::dvec2(b) : glm::dvec2(a + (b - a) * ((z - a.z) / (b.z - a.z))); };
    points.push_back(at(std::clamp(a.z, low, high)));
    points.push_back(at(std::clamp(b.z, low, high)));
  }

  void pillar(const glm::dvec2& centre, double radius, double low, double high) {
    if (solid_.upright()) {
      if (reaches(solid_.position.z + low, solid_.position.z + high)) visitor_.piece({{glm::dvec2(placed({centre, 0.0}))}, radius});
      return;
    }
    std::vector<glm::dvec2> polygon;
    for (int i = 0; i < circle_sides; ++i) polygon.push_back(centre + radius * direction(2.0 * pi * i / circle_sides));
    block(polygon, low, high);
  }

  void section(const MeshSolid& m, const std::vector<glm::dvec3>& placed_vertices);

  const Solid& solid_;
  const glm::dmat3 turn_;
  const double z_low_, z_high_;
  const Visitor& visitor_;
  Piece piece_;
};

/// Trapezoids between the heights (here: the y) of neighbouring corners. Even-odd, so that holes may run either way.
void Cutter::operator()(const Prism& p) {
  std::vector<std::array<glm::dvec2, 2>> edges;
  std::vector<double> levels;
  const auto take_ring = [&](const std::vector<glm::dvec2>& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const glm::dvec2 a = ring[i], b = ring[(i + 1) % ring.size()];
      levels.push_back(a.y);
      if (a.y < b.y) edges.push_back({a, b});
      if (b.y < a.y) edges.push_back({b, a});
    }
  };
  take_ring(p.outline);
  for (const auto& hole : p.holes) take_ring(hole);
  std::sort(levels.begin(), levels.end());
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  std::sort(edges.begin(), edges.end(), [](const auto& e, const auto& f) { return e[0].y < f[0].y; });

  struct Side {
    double low, high;  ///< x at the lower and upper level
  };
  std::vector<std::array<glm::dvec2, 2>> passing;  // of the edges that begin at or below a level, those that end above it
  std::vector<Side> sides;
  std::size_t next = 0;
  for (std::size_t i = 1; i < levels.size(); ++i) {
    const double low = levels[i - 1], high = levels[i];
    std::erase_if(passing, [low](const auto& e) { return e[1].y <= low; });
    while (next < edges.size() && edges[next][0].y <= low) passing.push_back(edges[next++]);
    sides.clear();
    for (const auto& e : passing) sides.push_back({x_at(e[0], e[1], low), x_at(e[0], e[1], high)});
    std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& t) { return s.low + s.high < t.low + t.high; });
    for (std::size_t k = 0; k + 1 < sides.size(); k += 2)
      block({{sides[k].low, low}, {sides[k + 1].low, low}, {sides[k + 1].high, high}, {sides[k].high, high}}, 0.0, p.height);
  }
}

void Cutter::operator()(const MeshSolid& m) {
  std::vector<glm::dvec3> at;
  at.reserve(m.mesh->vertices.size());
  for (const glm::dvec3& v : m.mesh->vertices) at.push_back(placed(m.scale * v));
  const double radius = m.mesh->closed ? 0.0 : 0.5 * m.sheet_thickness;
  const double low = z_low_ - radius, high = z_high_ + radius;
  std::vector<glm::dvec2> points;
  for (const glm::uvec3& t : m.mesh->triangles) {
    const glm::dvec3 &a = at[t.x], &b = at[t.y], &c = at[t.z];
    if (!(std::min({a.z, b.z, c.z}) < high && std::max({a.z, b.z, c.z}) > low)) continue;
    points.clear();
    cut_edge(a, b, low, high, points);
    cut_edge(b, c, low, high, points);
    cut_edge(c, a, low, high, points);
    if (!points.empty()) visitor_.piece({hull_of(points), radius});
  }
  if (m.mesh->closed) section(m, at);
}

void Cutter::section(const MeshSolid& m, const std::vector<glm::dvec3>& at) {
  const double z = 0.5 * (z_low_ + z_high_);
  // From the lower index to the higher, so that both triangles at an edge tell the same point, and the section is closed bit for bit.
  const auto passes = [&](std::uint32_t i, std::uint32_t j) {
    const glm::dvec3 &a = at[std::min(i, j)], &b = at[std::max(i, j)];
    return glm::dvec2(a + (b - a) * ((z - a.z) / (b.z - a.z)));
  };
  for (const glm::uvec3& t : m.mesh->triangles) {
    glm::dvec2 up{}, down{};
    bool crossed = false;
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t from = t[i], to = t[(i + 1) % 3];
      const bool from_above = at[from].z >= z, to_above = at[to].z >= z;
      if (from_above == to_above) continue;
      crossed = true;
      (to_above ? up : down) = passes(from, to);
    }
    if (crossed) visitor_.section_edge(up, down);
  }
}

}  // namespace

glm::dmat3 turn_of(const Solid& solid) {
  const auto turned = [&](glm::dvec3 v) {
    if (solid.roll != 0.0) v = {v.x, Pose2{{}, solid.roll}.to_outer({v.y, v.z})};
    if (solid.pitch != 0.0) {
      const glm::dvec2 zx = Pose2{{}, solid.pitch}.to_outer({v.z, v.x});
      v = {zx.y, v.y, zx.x};
    }
    return glm::dvec3(Pose2{{}, solid.yaw}.to_outer(glm::dvec2(v)), v.z);
  };
  return {turned({1.0, 0.0, 0.0}), turned({0.0, 1.0, 0.0}), turned({0.0, 0.0, 1.0})};
}

void visit(const Solid& solid, double z_low, double z_high, const Visitor& visitor) {
  std::visit(Cutter(solid, z_low, z_high, visitor), solid.shape);
}

}  // namespace thicket::plan
