#include "polygon.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace thicket {
namespace {

using Index = std::uint32_t;

/// A sum of doubles without rounding: the parts do not overlap and grow in magnitude (Shewchuk 1997, "Adaptive precision floating-point
/// arithmetic and fast robust geometric predicates", GROW-EXPANSION).
class ExactSum {
 public:
  void add(double value) {
    double carried = value;
    for (std::size_t i = 0; i < count_; ++i) {
      const double sum = carried + parts_[i], taken = sum - carried;
      parts_[i] = (carried - (sum - taken)) + (parts_[i] - taken);
      carried = sum;
    }
    parts_[count_++] = carried;
  }
  void add_product(double a, double b) {
    const double product = a * b;
    add(std::fma(a, b, -product));
    add(product);
  }
  double sign() const {
    for (std::size_t i = count_; i-- > 0;)
      if (parts_[i] != 0.0) return parts_[i];
    return 0.0;
  }

 private:
  std::array<double, 12> parts_{};
  std::size_t count_ = 0;
};

double orientation_exact(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  ExactSum sum;
  sum.add_product(a.x, b.y);
  sum.add_product(-a.x, c.y);
  sum.add_product(-c.x, b.y);
  sum.add_product(-a.y, b.x);
  sum.add_product(a.y, c.x);
  sum.add_product(c.y, b.x);
  return sum.sign();
}

bool in_box(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
  return p.x >= std::min(a.x, b.x) && p.x <= std::max(a.x, b.x) && p.y >= std::min(a.y, b.y) && p.y <= std::max(a.y, b.y);
}

bool boxes_apart(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& d) {
  return std::max(a.x, b.x) < std::min(c.x, d.x) || std::max(c.x, d.x) < std::min(a.x, b.x) || std::max(a.y, b.y) < std::min(c.y, d.y) ||
         std::max(c.y, d.y) < std::min(a.y, b.y);
}

bool on_segment(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
  return in_box(p, a, b) && orientation(a, b, p) == 0.0;
}

bool opposite(double a, double b) {
  return (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0);
}

bool cross_properly(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& d) {
  return opposite(orientation(a, b, c), orientation(a, b, d)) && opposite(orientation(c, d, a), orientation(c, d, b));
}

/// Whether two segments have a point in common.
bool segments_meet(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& d) {
  if (boxes_apart(a, b, c, d)) return false;
  return cross_properly(a, b, c, d) || on_segment(c, a, b) || on_segment(d, a, b) || on_segment(a, c, d) || on_segment(b, c, d);
}

/// Whether a point that is not on the ring lies inside it: by the parity of the edges to its right.
bool inside(const glm::dvec2& p, const Ring& ring) {
  bool odd = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const glm::dvec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
    if ((a.y > p.y) == (b.y > p.y)) continue;
    odd ^= (orientation(a, b, p) > 0.0) == (b.y > a.y);
  }
  return odd;
}

// ---- Faults

std::string in_words(const glm::dvec2& p) {
  return fmt::format("[{}, {}]", p.x, p.y);
}

std::string edge_in_words(const Ring& ring, std::size_t edge) {
  return fmt::format("edge {} ({} to {})", edge + 1, in_words(ring[edge]), in_words(ring[(edge + 1) % ring.size()]));
}

std::optional<std::string> repeated_point(const Ring& ring, const std::string& name) {
  std::vector<std::size_t> order(ring.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    const glm::dvec2 &p = ring[i], &q = ring[j];
    return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : i < j;
  });
  for (std::size_t k = 1; k < order.size(); ++k) {
    const std::size_t i = order[k - 1], j = order[k];
    if (ring[i] == ring[j]) return fmt::format("points {} and {} of {} are the same, {}", i + 1, j + 1, name, in_words(ring[i]));
  }
  return std::nullopt;
}

/// Faults of a ring on its own.
std::optional<std::string> ring_fault(const Ring& ring, const std::string& name) {
  if (ring.size() < 3) return fmt::format("{} has {} point{}, expected 3 or more", name, ring.size(), ring.size() == 1 ? "" : "s");
  for (std::size_t i = 0; i < ring.size(); ++i)
    if (!std::isfinite(ring[i].x) || !std::isfinite(ring[i].y)) return fmt::format("point {} of {} is not finite", i + 1, name);
  if (auto fault = repeated_point(ring, name)) return fault;
  const std::size_t n = ring.size();
  bool flat = true;
  for (std::size_t i = 0; i < n && flat; ++i) flat = orientation(ring[i], ring[(i + 1) % n], ring[(i + 2) % n]) == 0.0;
  if (flat) return fmt::format("{} has no area: all its points lie on a line", name);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) {
      const glm::dvec2 &a = ring[i], &b = ring[(i + 1) % n], &c = ring[j], &d = ring[(j + 1) % n];
      if (boxes_apart(a, b, c, d)) continue;
      // Neighbours share a point, and may share no more.
      const bool meet = j == i + 1             ? on_segment(d, a, b) || on_segment(a, c, d)
                        : i == 0 && j == n - 1 ? on_segment(c, a, b) || on_segment(b, c, d)
                                               : segments_meet(a, b, c, d);
      if (meet) return fmt::format("{} meets itself: {} and {}", name, edge_in_words(ring, i), edge_in_words(ring, j));
    }
  return std::nullopt;
}

std::optional<std::string> rings_meet(const Ring& r, const std::string& r_name, const Ring& s, const std::string& s_name) {
  for (std::size_t i = 0; i < r.size(); ++i)
    for (std::size_t j = 0; j < s.size(); ++j)
      if (segments_meet(r[i], r[(i + 1) % r.size()], s[j], s[(j + 1) % s.size()]))
        return fmt::format("{} meets {}: {} and {}", r_name, s_name, edge_in_words(r, i), edge_in_words(s, j));
  return std::nullopt;
}

// ---- Triangles

/// One closed chain of points, each the index of one; several places in the chain may hold the same point, where a hole has been joined to
/// it.
class EarClipper {
 public:
  EarClipper(const std::vector<glm::dvec2>& points, const std::vector<Index>& chain) : points_(points), point_(chain) {
    const Index n = size();
    next_.resize(n);
    previous_.resize(n);
    for (Index i = 0; i < n; ++i) {
      next_[i] = i + 1 == n ? 0 : i + 1;
      previous_[i] = i == 0 ? n - 1 : i - 1;
    }
    convex_.resize(n);
    ear_.resize(n);
    for (Index i = 0; i < n; ++i) convex_[i] = is_convex(i);
    for (Index i = 0; i < n; ++i) {
      if (!convex_[i]) blunt_.push_back(i);
    }
    for (Index i = 0; i < n; ++i) ear_[i] = is_ear(i);
  }

  std::vector<glm::uvec3> triangles() {
    std::vector<glm::uvec3> result;
    if (size() < 3) return result;
    result.reserve(size() - 2);
    Index at = 0, left = size(), searched = 0;
    bool refreshed = false;
    while (left > 3) {
      if (!ear_[at]) {
        at = next_[at];
        if (++searched < left) continue;
        // Clipping may have freed an ear that was covered. Where that is not so, the polygon is not simple, and any corner is as good as
        // another.
        if (!refreshed) {
          for (Index k = 0; k < left; ++k, at = next_[at]) ear_[at] = is_ear(at);
          refreshed = true;
          searched = 0;
          continue;
        }
        for (Index k = 0; k < left && !convex_[at]; ++k) at = next_[at];
      }
      result.push_back(clip(at));
      --left;
      searched = 0;
      refreshed = false;
      at = next_[next_[at]];  // not the neighbour: fewer slivers
    }
    result.emplace_back(point_[previous_[at]], point_[at], point_[next_[at]]);
    return result;
  }

 private:
  Index size() const { return static_cast<Index>(point_.size()); }
  const glm::dvec2& where(Index i) const { return points_[point_[i]]; }
  bool is_convex(Index i) const { return orientation(where(previous_[i]), where(i), where(next_[i])) > 0.0; }

  /// Whether the triangle of a corner and its neighbours is convex and holds no other corner, inside or on its edge. It is enough to look
  /// at those that are not convex: the one that lies deepest in the triangle is such.
  bool is_ear(Index i) const {
    if (!convex_[i]) return false;
    const glm::dvec2 &a = where(previous_[i]), &b = where(i), &c = where(next_[i]);
    const glm::dvec2 low = glm::min(glm::min(a, b), c), high = glm::max(glm::max(a, b), c);
    return std::none_of(blunt_.begin(), blunt_.end(), [&](Index k) {
      if (convex_[k]) return false;  // has become so
      const glm::dvec2& p = where(k);
      if (p.x < low.x || p.x > high.x || p.y < low.y || p.y > high.y) return false;
      if (p == a || p == b || p == c) return false;
      return orientation(a, b, p) >= 0.0 && orientation(b, c, p) >= 0.0 && orientation(c, a, p) >= 0.0;
    });
  }

  glm::uvec3 clip(Index i) {
    const Index before = previous_[i], after = next_[i];
    const glm::uvec3 triangle(point_[before], point_[i], point_[after]);
    next_[before] = after;
    previous_[after] = before;
    convex_[i] = true;  // out of the way
    ear_[i] = false;
    // (In what is not simple a neighbour may lose its convexity. It is then not among the blunt ones, which costs nothing that was not
    // lost.)
    for (const Index k : {before, after}) convex_[k] = is_convex(k);
    for (const Index k : {before, after}) ear_[k] = is_ear(k);
    if (++clipped_ % 256 == 0) std::erase_if(blunt_, [&](Index k) { return convex_[k]; });
    return triangle;
  }

  const std::vector<glm::dvec2>& points_;
  std::vector<Index> point_, next_, previous_, blunt_;
  std::vector<char> convex_, ear_;
  Index clipped_ = 0;
};

/// Whether the way from corner k of a chain to a point starts into the chain's inside.
bool starts_inside(const std::vector<glm::dvec2>& points, const std::vector<Index>& chain, std::size_t k, const glm::dvec2& to) {
  const glm::dvec2 &before = points[chain[(k + chain.size() - 1) % chain.size()]], &at = points[chain[k]],
                   &after = points[chain[(k + 1) % chain.size()]];
  if (orientation(before, at, after) > 0.0) return orientation(at, to, before) > 0.0 && orientation(to, at, after) > 0.0;
  return !(orientation(at, to, after) >= 0.0 && orientation(to, at, before) >= 0.0);
}

/// Whether a chain hinders the view from one point to another; touching at their own places does not.
bool hinders(const std::vector<glm::dvec2>& points, const std::vector<Index>& chain, const glm::dvec2& from, const glm::dvec2& to) {
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const glm::dvec2 &a = points[chain[i]], &b = points[chain[(i + 1) % chain.size()]];
    if (boxes_apart(a, b, from, to)) continue;
    if (cross_properly(a, b, from, to)) return true;
    if (a != from && a != to && on_segment(a, from, to)) return true;
  }
  return false;
}

/// Joins a hole to the chain around it: from a corner of the chain to the hole's rightmost point, around the hole, and back. Holes are
/// taken from right to left, so that this point always sees a corner of the chain that does not lie to its left (Eberly 2008,
/// "Triangulation by ear clipping", section 3).
void join_hole(const std::vector<glm::dvec2>& points, std::vector<Index>& chain, const std::vector<Index>& hole,
               const std::vector<std::vector<Index>>& later) {
  const std::size_t start = static_cast<std::size_t>(
      std::max_element(hole.begin(), hole.end(), [&](Index i, Index j) { return points[i].x < points[j].x; }) - hole.begin());
  const glm::dvec2& from = points[hole[start]];
  std::vector<std::pair<double, std::size_t>> corners;
  for (std::size_t k = 0; k < chain.size(); ++k)
    if (points[chain[k]].x >= from.x) corners.emplace_back(glm::distance(points[chain[k]], from), k);
  std::sort(corners.begin(), corners.end());
  std::size_t chosen = corners.empty() ? 0 : corners.front().second;
  for (const auto& [distance, k] : corners) {
    const glm::dvec2& to = points[chain[k]];
    if (!starts_inside(points, chain, k, from) || hinders(points, chain, from, to) || hinders(points, hole, from, to)) continue;
    if (std::any_of(later.begin(), later.end(), [&](const auto& other) { return hinders(points, other, from, to); })) continue;
    chosen = k;
    break;
  }
  std::vector<Index> detour;
  for (std::size_t i = 0; i <= hole.size(); ++i) detour.push_back(hole[(start + i) % hole.size()]);
  detour.push_back(chain[chosen]);
  chain.insert(chain.begin() + static_cast<std::ptrdiff_t>(chosen) + 1, detour.begin(), detour.end());
}

}  // namespace

double orientation(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  const double left = (a.x - c.x) * (b.y - c.y), right = (a.y - c.y) * (b.x - c.x);
  const double turn = left - right;
  // Shewchuk 1997, ccwerrboundA
  if (std::abs(turn) > 3.3306690738754716e-16 * (std::abs(left) + std::abs(right))) return turn;
  return orientation_exact(a, b, c);
}

bool counter_clockwise(const Ring& ring) {
  if (ring.empty()) return true;
  // The lowest of the leftmost points is a true corner of any simple ring, however flat.
  const std::size_t n = ring.size();
  std::size_t k = 0;
  for (std::size_t i = 1; i < n; ++i)
    if (ring[i].x < ring[k].x || (ring[i].x == ring[k].x && ring[i].y < ring[k].y)) k = i;
  return orientation(ring[(k + n - 1) % n], ring[k], ring[(k + 1) % n]) >= 0.0;
}

std::optional<std::string> polygon_fault(const Ring& outline, const std::vector<Ring>& holes) {
  const auto hole_name = [](std::size_t i) { return fmt::format("hole {}", i + 1); };
  if (auto fault = ring_fault(outline, "the outline")) return fault;
  for (std::size_t i = 0; i < holes.size(); ++i)
    if (auto fault = ring_fault(holes[i], hole_name(i))) return fault;
  for (std::size_t i = 0; i < holes.size(); ++i) {
    if (auto fault = rings_meet(holes[i], hole_name(i), outline, "the outline")) return fault;
    if (!inside(holes[i].front(), outline)) return hole_name(i) + " lies outside the outline";
    for (std::size_t j = 0; j < i; ++j) {
      if (auto fault = rings_meet(holes[i], hole_name(i), holes[j], hole_name(j))) return fault;
      if (inside(holes[i].front(), holes[j])) return fmt::format("{} lies inside {}", hole_name(i), hole_name(j));
      if (inside(holes[j].front(), holes[i])) return fmt::format("{} lies inside {}", hole_name(j), hole_name(i));
    }
  }
  return std::nullopt;
}

std::vector<glm::uvec3> triangulate(const Ring& outline, const std::vector<Ring>& holes) {
  std::vector<glm::dvec2> points;
  // A ring as a chain of indices, counter-clockwise or clockwise.
  const auto chain_of = [&](const Ring& ring, bool want_counter_clockwise) {
    std::vector<Index> chain(ring.size());
    std::iota(chain.begin(), chain.end(), static_cast<Index>(points.size()));
    points.insert(points.end(), ring.begin(), ring.end());
    if (counter_clockwise(ring) != want_counter_clockwise) std::reverse(chain.begin(), chain.end());
    return chain;
  };
  std::vector<Index> chain = chain_of(outline, true);
  std::vector<std::vector<Index>> rest;
  for (const Ring& hole : holes)
    if (!hole.empty()) rest.push_back(chain_of(hole, false));
  const auto right_end = [&](const std::vector<Index>& hole) {
    double x = points[hole.front()].x;
    for (const Index i : hole) x = std::max(x, points[i].x);
    return x;
  };
  std::stable_sort(rest.begin(), rest.end(), [&](const auto& a, const auto& b) { return right_end(a) < right_end(b); });
  while (!rest.empty()) {
    const std::vector<Index> hole = std::move(rest.back());
    rest.pop_back();
    join_hole(points, chain, hole, rest);
  }
  return EarClipper(points, chain).triangles();
}

std::vector<glm::uvec3> triangulate_counter_clockwise(const Ring& ring) {
  std::vector<Index> chain(ring.size());
  std::iota(chain.begin(), chain.end(), Index{0});
  return EarClipper(ring, chain).triangles();
}

}  // namespace thicket
