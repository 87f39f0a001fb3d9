#include "mesh_inside.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "polygon.hpp"

namespace thicket {

std::size_t MeshInside::cell(double value, int axis) const {
  if (!(size_[axis] > 0.0)) return 0;
  const double at = (value - low_[axis]) / size_[axis] * static_cast<double>(side_);
  return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(side_ - 1)));
}

MeshInside::Cells MeshInside::cells_of(const glm::uvec3& t) const {
  const glm::dvec3 &a = (*vertices_)[t.x], &b = (*vertices_)[t.y], &c = (*vertices_)[t.z];
  const glm::dvec3 low = glm::min(glm::min(a, b), c), high = glm::max(glm::max(a, b), c);
  return {cell(low.x, 0), cell(low.y, 1), cell(high.x, 0), cell(high.y, 1)};
}

void MeshInside::sort_into_cells() {
  glm::dvec2 high = low_ = glm::dvec2((*vertices_)[triangles_->front().x]);
  for (const glm::uvec3& t : *triangles_)
    for (int i = 0; i < 3; ++i) {
      low_ = glm::min(low_, glm::dvec2((*vertices_)[t[i]]));
      high = glm::max(high, glm::dvec2((*vertices_)[t[i]]));
    }
  size_ = high - low_;
  // About a cell for each triangle, fewer where long triangles would fill too many.
  const auto entries = [&] {
    std::size_t sum = 0;
    for (const glm::uvec3& t : *triangles_) {
      const Cells c = cells_of(t);
      sum += (c.x1 - c.x0 + 1) * (c.y1 - c.y0 + 1);
    }
    return sum;
  };
  side_ = std::clamp<std::size_t>(static_cast<std::size_t>(std::sqrt(static_cast<double>(triangles_->size()))), 1, 2048);
  while (side_ > 1 && entries() > 8 * triangles_->size()) side_ /= 2;

  begin_.assign(side_ * side_ + 1, 0);
  const auto for_each_entry = [&](auto&& visit) {
    for (std::uint32_t t = 0; t < triangles_->size(); ++t) {
      const Cells c = cells_of((*triangles_)[t]);
      for (std::size_t y = c.y0; y <= c.y1; ++y)
        for (std::size_t x = c.x0; x <= c.x1; ++x) visit(y * side_ + x, t);
    }
  };
  for_each_entry([&](std::size_t at, std::uint32_t) { ++begin_[at + 1]; });
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  members_.resize(begin_.back());
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for_each_entry([&](std::size_t at, std::uint32_t t) { members_[next[at]++] = t; });
}

bool MeshInside::holds(const glm::dvec3& p) {
  if (side_ == 0) sort_into_cells();
  if (p.x < low_.x || p.y < low_.y || p.x > low_.x + size_.x || p.y > low_.y + size_.y) return false;
  const std::size_t at = cell(p.y, 1) * side_ + cell(p.x, 0);
  const glm::dvec2 flat(p);
  bool odd = false;
  for (std::size_t m = begin_[at]; m < begin_[at + 1]; ++m) {
    const glm::uvec3& t = (*triangles_)[members_[m]];
    // Seen from above, the point lies in the triangle if an odd number of its edges lie to the right: neighbours agree on the edge that
    // they share.
    bool above = false;
    for (int i = 0; i < 3; ++i) {
      const glm::dvec2 a((*vertices_)[t[i]]), b((*vertices_)[t[(i + 1) % 3]]);
      if ((a.y > flat.y) != (b.y > flat.y)) above ^= (orientation(a, b, flat) > 0.0) == (b.y > a.y);
    }
    if (!above) continue;
    const glm::dvec3 &a = (*vertices_)[t.x], &b = (*vertices_)[t.y], &c = (*vertices_)[t.z];
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    odd ^= glm::dot(p - a, normal) * normal.z < 0.0;
  }
  return odd;
}

bool MeshInside::holds(const std::vector<glm::uvec3>& others) {
  constexpr std::size_t wanted = 7;
  const std::size_t count = std::min(wanted, others.size());
  std::size_t held = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const glm::uvec3& t = others[k * others.size() / count];
    // Not the middle, which tends to lie right under a corner or an edge of something.
    held += holds(0.41 * (*vertices_)[t.x] + 0.36 * (*vertices_)[t.y] + 0.23 * (*vertices_)[t.z]);
  }
  return 2 * held > count;
}

}  // namespace thicket
