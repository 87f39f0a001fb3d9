#include "rolling.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "thicket/base/pose.hpp"

namespace thicket {
namespace {

constexpr double touching = 1e-9;

double squared(const glm::dvec2& v) { return v.x * v.x + v.y * v.y; }

/// Something that grows with the angle from `from` to `to` (unit vectors), counted in the sense of the turn, from 0 to 4 for a whole turn.
double angle_order(const glm::dvec2& from, const glm::dvec2& to, int turn) {
  const double cosine = glm::dot(from, to), sine = turn * (from.x * to.y - from.y * to.x);
  return sine >= 0.0 ? 1.0 - cosine : 3.0 + cosine;
}

/// Where disc `i`'s circle, walked in the sense of the turn, enters disc `j`: the direction of it from the centre of `i`. Nothing if it does not.
std::optional<glm::dvec2> entry(const GrownDisc& i, const GrownDisc& j, int turn) {
  const glm::dvec2 d = j.centre - i.centre;
  const double square = squared(d), sum = i.radius + j.radius;
  if (square >= sum * sum || square == 0.0) return std::nullopt;
  // Along d, from the centre of i: to the line through both crossings, in units of i's radius; one root and one division for all, as this is asked of every pair.
  const double along = (square + i.radius * i.radius - j.radius * j.radius) / (2.0 * i.radius), rest = square - along * along;
  if (rest <= 0.0) return std::nullopt;  // one holds the other
  const double across = turn * std::sqrt(rest), scale = 1.0 / square;
  // The arc inside j is centred on d; it is entered half of its width before.
  return glm::dvec2(scale * (along * d.x + across * d.y), scale * (along * d.y - across * d.x));
}

/// The straight way to a place leads through matter or through a gate: it is the other side of a thin wall, or of a passage that is shut.
bool is_behind(const std::vector<GrownDisc>& discs, const glm::dvec2& robot, const glm::dvec2& place) {
  const glm::dvec2 way = place - robot;
  return std::any_of(discs.begin(), discs.end(), [&](const GrownDisc& disc) {
    const glm::dvec2 to = disc.centre - robot;
    const double radius = disc.gate ? disc.radius : 0.5 * disc.radius, along = std::clamp(glm::dot(to, way) / std::max(1e-12, squared(way)), 0.0, 1.0);
    return along > 0.0 && squared(to - along * way) < radius * radius && squared(to) >= radius * radius;
  });
}

/// The place on disc `i`'s circle nearest to `robot` that no other disc covers, as a direction from the disc's centre.
std::optional<glm::dvec2> nearest_free(const std::vector<GrownDisc>& discs, std::size_t i, const glm::dvec2& robot, int turn) {
  const glm::dvec2 outward = robot - discs[i].centre;
  const double size = glm::length(outward);
  const glm::dvec2 from = size > 0.0 ? outward / size : glm::dvec2(1.0, 0.0);
  struct Covered {
    double low, high;  // angles from `from`, counter-clockwise
  };
  std::vector<Covered> covered;
  for (std::size_t j = 0; j < discs.size(); ++j) {
    if (j == i) continue;
    const glm::dvec2 d = discs[j].centre - discs[i].centre;
    const double distance = glm::length(d), r = discs[i].radius;
    if (distance >= r + discs[j].radius) continue;
    if (distance + r <= discs[j].radius + touching) return std::nullopt;  // swallowed
    const double cosine = distance > 0.0 ? (distance * distance + r * r - discs[j].radius * discs[j].radius) / (2.0 * distance * r) : 1.0;
    if (cosine >= 1.0) continue;
    const double middle = std::atan2(from.x * d.y - from.y * d.x, glm::dot(from, d)), half = std::acos(std::max(-1.0, cosine));
    covered.push_back({middle - half, middle + half});
  }
  const auto go = [&](double sign) -> double {
    double at = 0.0;
    for (bool moved = true; moved && std::abs(at) < 2.0 * pi;) {
      moved = false;
      for (const Covered& c : covered)
        for (const double shift : {-2.0 * pi, 0.0, 2.0 * pi}) {
          const double low = c.low + shift, high = c.high + shift;
          if (!(low + touching < at && at < high - touching)) continue;
          at = sign > 0.0 ? high : low;
          moved = true;
        }
    }
    return std::abs(at);
  };
  const double forward = go(turn), backward = go(-turn);
  if (std::min(forward, backward) >= 2.0 * pi) return std::nullopt;
  const auto turned = [&from](double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return glm::dvec2(c * from.x - s * from.y, s * from.x + c * from.y);
  };
  const glm::dvec2 back = turned(-turn * backward);
  if (forward == 0.0 && backward == 0.0) return back;
  // Rather back than on: what lies on may be the other side of a passage that will be found shut; of one that is shut already, in no case.
  const glm::dvec2 on = turned(turn * forward);
  const bool back_is_behind = is_behind(discs, robot, discs[i].centre + discs[i].radius * back), on_is_behind = is_behind(discs, robot, discs[i].centre + discs[i].radius * on);
  if (back_is_behind != on_is_behind) return back_is_behind ? on : back;
  return backward <= forward + 0.1 ? back : on;
}

}  // namespace

bool roll(const std::vector<GrownDisc>& discs, const glm::dvec2& contact, const glm::dvec2& robot, int turn, double near, double length, BoundaryPath& path) {
  path.points.clear();
  // Of the discs about the contact, nearest to the robot first: the free place nearest to it. (What lies a little behind its neighbours has none, nor has a place deep in a corner.)
  std::vector<std::pair<double, std::size_t>> near_discs;
  for (std::size_t i = 0; i < discs.size(); ++i)
    if (squared(discs[i].centre - contact) < near * near) near_discs.emplace_back(glm::distance(discs[i].centre, robot) - discs[i].radius, i);
  std::sort(near_discs.begin(), near_discs.end());
  std::size_t pivot = discs.size();
  glm::dvec2 at{0.0, 0.0};
  double least = INFINITY;
  for (const auto& [away, i] : near_discs) {
    if (std::abs(away) >= least) break;
    const auto start = nearest_free(discs, i, robot, turn);
    if (!start) continue;
    const glm::dvec2 place = discs[i].centre + discs[i].radius * *start;
    const double far = glm::distance(place, robot);
    if (far >= least || is_behind(discs, robot, place)) continue;
    least = far;
    pivot = i;
    at = *start;
  }
  if (pivot == discs.size()) return false;
  double along = 0.0;
  std::size_t came_from = discs.size();
  constexpr double step = 0.12;  // rad
  const double c = std::cos(step), s = turn * std::sin(step);
  for (int pieces = 0; pieces < 400 && along < length; ++pieces) {
    const GrownDisc& disc = discs[pivot];
    std::size_t next = discs.size();
    double first = 4.0;
    glm::dvec2 corner{0.0, 0.0};
    for (std::size_t j = 0; j < discs.size(); ++j) {
      if (j == pivot) continue;
      const auto enters = entry(disc, discs[j], turn);
      if (!enters) continue;
      double order = angle_order(at, *enters, turn);
      if (order > 4.0 - 1e-9 && j != came_from) order = 0.0;  // here, to rounding
      if (order < first) {
        first = order;
        next = j;
        corner = *enters;
      }
    }
    path.points.push_back({disc.centre + disc.radius * at, pivot, along, false});
    // The arc in steps of the same angle, so that it costs no sine.
    for (double turned = 0.0; along < length; turned += step) {
      const glm::dvec2 on{c * at.x - s * at.y, s * at.x + c * at.y};
      if (next < discs.size() && (first == 0.0 || angle_order(at, corner, turn) <= angle_order(at, on, turn))) break;
      if (turned > 2.0 * pi) return true;  // all around a post
      at = on;
      along += step * disc.radius;
      path.points.push_back({disc.centre + disc.radius * at, pivot, along, false});
    }
    if (next == discs.size() || along >= length) continue;
    const glm::dvec2 place = disc.centre + disc.radius * corner;
    along += glm::distance(place, path.points.back().position);
    path.points.push_back({place, pivot, along, true});
    came_from = pivot;
    pivot = next;
    at = (place - discs[pivot].centre) / discs[pivot].radius;
  }
  return true;
}

}  // namespace thicket
