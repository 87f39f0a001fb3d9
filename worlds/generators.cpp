#include "thicket/worlds/generators.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "thicket/base/random.hpp"

namespace thicket {
namespace {

// What a random number is for; the second number of `Random::uniform`.
enum class Purpose : std::uint64_t { branch, place, normal, heading, stem };

constexpr std::uint32_t max_tries = 64;  // of drawing what has to lie within something; in a ball, half of them succeed

class Dice {
 public:
  explicit Dice(std::int64_t seed) : random_(static_cast<std::uint64_t>(seed), 0) {}

  std::array<double, 4> roll(Purpose purpose, std::uint32_t item, std::uint32_t attempt = 0) const {
    return random_.uniform(static_cast<std::uint64_t>(purpose), item, RandomUse::foliage, attempt);
  }

  /// Uniform in the unit ball.
  glm::dvec3 in_ball(Purpose purpose, std::uint32_t item, std::uint32_t group = 0) const {
    for (std::uint32_t i = 0; i < max_tries; ++i) {
      const auto u = roll(purpose, item, group * max_tries + i);
      const glm::dvec3 p(2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0, 2.0 * u[2] - 1.0);
      const double length = glm::dot(p, p);
      if (length <= 1.0 && length > 1e-12) return p;
    }
    return {0.0, 0.0, 1.0};
  }

  /// Uniform on the unit sphere.
  glm::dvec3 direction(Purpose purpose, std::uint32_t item) const { return glm::normalize(in_ball(purpose, item)); }

 private:
  Random random_;
};

struct Soup {
  std::vector<glm::dvec3> vertices;
  std::vector<glm::uvec3> triangles;

  std::shared_ptr<const Mesh> mesh() { return make_mesh(std::move(vertices), std::move(triangles)); }
};

glm::dvec3 across(const glm::dvec3& axis) {
  return glm::normalize(glm::cross(axis, std::abs(axis.z) < 0.9 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 0.0, 0.0)));
}

/// A closed prism of eight sides, whose corners lie on circles about its ends.
void add_limb(Soup& soup, const glm::dvec3& from, const glm::dvec3& to, double radius_from, double radius_to) {
  constexpr double h = 0.70710678118654752;  // sqrt(1/2)
  constexpr std::array<std::array<double, 2>, 8> circle = {{{1, 0}, {h, h}, {0, 1}, {-h, h}, {-1, 0}, {-h, -h}, {0, -1}, {h, -h}}};
  const glm::dvec3 axis = glm::normalize(to - from), u = across(axis), v = glm::cross(axis, u);
  const auto first = static_cast<std::uint32_t>(soup.vertices.size());
  for (const auto& [x, y] : circle) {
    const glm::dvec3 aside = x * u + y * v;
    soup.vertices.push_back(from + radius_from * aside);
    soup.vertices.push_back(to + radius_to * aside);
  }
  for (std::uint32_t i = 0; i < 8; ++i) {
    const std::uint32_t a = first + 2 * i, b = first + 2 * ((i + 1) % 8);
    soup.triangles.emplace_back(a, b, b + 1);
    soup.triangles.emplace_back(a, b + 1, a + 1);
    if (i == 0 || i == 7) continue;
    soup.triangles.emplace_back(first, b, a);
    soup.triangles.emplace_back(first + 1, a + 1, b + 1);
  }
}

/// A kite from `base`, widest at 0.4 of its length, in the plane of a random normal and in a random heading there.
void add_leaf(Soup& soup, const Dice& dice, std::uint32_t leaf, const glm::dvec3& base, double size, bool about_its_middle) {
  const glm::dvec3 normal = dice.direction(Purpose::normal, leaf);
  // Any direction that is independent of the normal, made perpendicular to it, has a uniform heading about it.
  const glm::dvec3 other = dice.direction(Purpose::heading, leaf);
  const glm::dvec3 sideways = glm::cross(normal, other);
  const glm::dvec3 along = glm::dot(sideways, sideways) > 1e-12 ? glm::cross(glm::normalize(sideways), normal) : across(normal);
  const glm::dvec3 aside = 0.3 * size * glm::cross(normal, along), length = size * along;
  const glm::dvec3 foot = about_its_middle ? base - 0.5 * length : base;
  const auto first = static_cast<std::uint32_t>(soup.vertices.size());
  for (const glm::dvec3& p : {foot, foot + 0.4 * length - aside, foot + length, foot + 0.4 * length + aside}) soup.vertices.push_back(p);
  soup.triangles.emplace_back(first, first + 1, first + 2);
  soup.triangles.emplace_back(first, first + 2, first + 3);
}

struct Branch {
  glm::dvec3 from{0.0}, to{0.0};
};

class Tree {
 public:
  explicit Tree(const TreeSpec& spec)
      : spec_(spec),
        dice_(spec.seed),
        middle_(0.0, 0.0, 0.5 * (spec.crown_base + spec.height)),
        half_(spec.crown_radius, spec.crown_radius, 0.5 * (spec.height - spec.crown_base)) {}

  Foliage grow() {
    place_branches();
    Soup wood, leaves;
    add_limb(wood, glm::dvec3(0.0), {0.0, 0.0, trunk_top()}, spec_.trunk_radius, trunk_radius(trunk_top()));
    for (const Branch& b : branches_) {
      const double radius = 0.5 * trunk_radius(b.from.z);
      add_limb(wood, b.from, b.to, radius, 0.25 * radius);
    }
    for (int i = 0; i < spec_.leaves; ++i) {
      const auto leaf = static_cast<std::uint32_t>(i);
      add_leaf(leaves, dice_, leaf, leaf_place(leaf), spec_.leaf_size, false);
    }
    return {wood.mesh(), leaves.mesh()};
  }

 private:
  double trunk_top() const { return spec_.crown_base + 0.95 * (spec_.height - spec_.crown_base); }
  double trunk_radius(double z) const { return spec_.trunk_radius * (1.0 - 0.9 * z / spec_.height); }
  bool in_crown(const glm::dvec3& p) const {
    const glm::dvec3 q = (p - middle_) / half_;
    return glm::dot(q, q) <= 1.0;
  }

  /// How far it is from a point in the crown to its surface.
  double way_out(const glm::dvec3& from, const glm::dvec3& direction) const {
    const glm::dvec3 p = (from - middle_) / half_, d = direction / half_;
    const double a = glm::dot(d, d), b = glm::dot(p, d), c = glm::dot(p, p) - 1.0;
    return (std::sqrt(std::max(0.0, b * b - a * c)) - b) / a;
  }

  void place_branches() {
    // The golden angle, 137.5 degrees: a rotation that is repeated needs no sine or cosine but these.
    constexpr double cosine = -0.73736887807831985, sine = 0.67549029426152364;
    const auto first = dice_.in_ball(Purpose::branch, 0, 1);
    glm::dvec2 heading = glm::normalize(glm::dvec2(first.x, first.y) + glm::dvec2(1e-9, 0.0));
    for (int i = 0; i < spec_.branches; ++i) {
      const auto u = dice_.roll(Purpose::branch, static_cast<std::uint32_t>(i));
      const double up = (i + u[0]) / spec_.branches;  // 0 at the crown's base, 1 at the top
      const glm::dvec3 from(0.0, 0.0, spec_.crown_base + (0.02 + 0.9 * up) * (spec_.height - spec_.crown_base));
      const double rise = 0.15 + 1.2 * up + 0.3 * (u[1] - 0.5);  // per metre outward
      const glm::dvec3 direction = glm::normalize(glm::dvec3(heading, std::max(0.0, rise)));
      branches_.push_back({from, from + (0.75 + 0.23 * u[2]) * way_out(from, direction) * direction});
      heading = glm::normalize(glm::dvec2(cosine * heading.x - sine * heading.y, sine * heading.x + cosine * heading.y));
    }
  }

  /// About a random place on the outer part of a branch, as far from it as twigs reach; without branches, anywhere in the crown.
  glm::dvec3 leaf_place(std::uint32_t leaf) const {
    if (branches_.empty()) return middle_ + half_ * dice_.in_ball(Purpose::place, leaf);
    const double twig = 0.25 * std::min(half_.x, half_.z);
    glm::dvec3 on_branch(0.0);
    for (std::uint32_t i = 0; i < max_tries; ++i) {
      const auto u = dice_.roll(Purpose::place, leaf, i);
      const Branch& b = branches_[std::min(static_cast<std::size_t>(u[0] * static_cast<double>(branches_.size())), branches_.size() - 1)];
      on_branch = glm::mix(b.from, b.to, 0.35 + 0.65 * u[1]);
      const glm::dvec3 place = on_branch + twig * dice_.in_ball(Purpose::place, leaf, i + 1);
      if (in_crown(place)) return place;
    }
    return on_branch;
  }

  TreeSpec spec_;
  Dice dice_;
  glm::dvec3 middle_, half_;  // of the crown
  std::vector<Branch> branches_;
};

}  // namespace

Foliage grow_tree(const TreeSpec& spec) {
  return Tree(spec).grow();
}

Foliage grow_hedge(const HedgeSpec& spec) {
  const Dice dice(spec.seed);
  Soup wood, leaves;
  for (int i = 0; i < spec.stems; ++i) {
    const auto u = dice.roll(Purpose::stem, static_cast<std::uint32_t>(i));
    const double x = spec.size.x * ((i + 0.2 + 0.6 * u[0]) / spec.stems - 0.5), y = 0.3 * spec.size.y * (u[1] - 0.5);
    const glm::dvec3 lean(0.1 * spec.size.x / spec.stems * (u[2] - 0.5), 0.3 * spec.size.y * (u[3] - 0.5), 0.9 * spec.size.z);
    const glm::dvec3 foot(x, y, 0.0);
    add_limb(wood, foot, foot + lean, spec.stem_radius, 0.3 * spec.stem_radius);
  }
  const glm::dvec3 room = glm::max(spec.size - glm::dvec3(spec.leaf_size), glm::dvec3(0.0));  // for the leaves' middles
  const double count = std::round(spec.leaves_per_m3 * spec.size.x * spec.size.y * spec.size.z);
  for (std::uint32_t leaf = 0; static_cast<double>(leaf) < count; ++leaf) {
    const auto u = dice.roll(Purpose::place, leaf);
    const glm::dvec3 middle = glm::dvec3(0.0, 0.0, 0.5 * spec.size.z) + room * (glm::dvec3(u[0], u[1], u[2]) - 0.5);
    add_leaf(leaves, dice, leaf, middle, spec.leaf_size, true);
  }
  return {wood.mesh(), leaves.mesh()};
}

}  // namespace thicket
