#include "model_shapes.hpp"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace thicket {

void ModelBuilder::add(const std::string& name, const std::string& material, std::vector<glm::dvec3> vertices, std::vector<glm::uvec3> triangles) {
  model_.parts.push_back({name, material, make_mesh(std::move(vertices), std::move(triangles))});
}

void ModelBuilder::box(const std::string& name, const std::string& material, const glm::dvec3& middle, const glm::dvec3& size, const glm::dmat3& turn) {
  std::vector<glm::dvec3> vertices;
  for (const double z : {-0.5, 0.5})
    for (const glm::dvec2& corner : {glm::dvec2(-0.5, -0.5), glm::dvec2(0.5, -0.5), glm::dvec2(0.5, 0.5), glm::dvec2(-0.5, 0.5)}) vertices.push_back(middle + turn * (glm::dvec3(corner, z) * size));
  add(name, material, std::move(vertices), {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}});
}

void ModelBuilder::limb(const std::string& name, const std::string& material, const glm::dvec3& from, const glm::dvec3& to, double radius_from, double radius_to, int sides) {
  const glm::dvec3 axis = glm::normalize(to - from);
  const glm::dvec3 u = glm::normalize(glm::cross(axis, std::abs(axis.z) < 0.9 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 0.0, 0.0))), v = glm::cross(axis, u);
  const auto n = static_cast<std::uint32_t>(sides);
  std::vector<glm::dvec3> vertices;
  std::vector<glm::uvec3> triangles;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + 0.5) / sides;  // a flat side, not a corner, looks each way
    const glm::dvec3 aside = std::cos(angle) * u + std::sin(angle) * v;
    vertices.push_back(from + radius_from * aside);
    vertices.push_back(to + radius_to * aside);
    const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % n);
    triangles.emplace_back(a, b, b + 1);
    triangles.emplace_back(a, b + 1, a + 1);
    if (i == 0 || i == n - 1) continue;
    triangles.emplace_back(0, b, a);
    triangles.emplace_back(1, a + 1, b + 1);
  }
  add(name, material, std::move(vertices), std::move(triangles));
}

void ModelBuilder::ellipsoid(const std::string& name, const std::string& material, const glm::dvec3& middle, const glm::dvec3& half, int rings, int sides) {
  std::vector<glm::dvec3> vertices = {middle - glm::dvec3(0.0, 0.0, half.z)};
  std::vector<glm::uvec3> triangles;
  for (int ring = 1; ring < rings; ++ring) {
    const double polar = std::numbers::pi * ring / rings;
    for (int side = 0; side < sides; ++side) {
      const double angle = 2.0 * std::numbers::pi * side / sides;
      vertices.push_back(middle + half * glm::dvec3(std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle), -std::cos(polar)));
    }
  }
  vertices.push_back(middle + glm::dvec3(0.0, 0.0, half.z));
  const auto n = static_cast<std::uint32_t>(sides), top = static_cast<std::uint32_t>(vertices.size()) - 1, last = top - n;
  for (std::uint32_t side = 0; side < n; ++side) {
    const std::uint32_t next = (side + 1) % n;
    triangles.emplace_back(0, 1 + next, 1 + side);
    triangles.emplace_back(top, last + side, last + next);
    for (std::uint32_t low = 1; low < last; low += n) {
      triangles.emplace_back(low + side, low + next, low + n + next);
      triangles.emplace_back(low + side, low + n + next, low + n + side);
    }
  }
  add(name, material, std::move(vertices), std::move(triangles));
}

void ModelBuilder::drawn_along_y(const std::string& name, const std::string& material, const std::vector<glm::dvec2>& outline, double y_low, double y_high) {
  const auto prism = prism_mesh(outline, {}, y_high - y_low);
  std::vector<glm::dvec3> vertices;
  for (const glm::dvec3& p : prism->vertices) vertices.emplace_back(p.x, y_high - p.z, p.y);  // a turn, so that it still faces outward
  add(name, material, std::move(vertices), prism->triangles);
}

void ModelBuilder::drawn_along_x(const std::string& name, const std::string& material, const std::vector<glm::dvec2>& outline, double x_low, double x_high) {
  const auto prism = prism_mesh(outline, {}, x_high - x_low);
  std::vector<glm::dvec3> vertices;
  for (const glm::dvec3& p : prism->vertices) vertices.emplace_back(x_low + p.z, p.x, p.y);
  add(name, material, std::move(vertices), prism->triangles);
}

glm::dmat3 pitched(double degrees) {
  const double angle = degrees * std::numbers::pi / 180.0, c = std::cos(angle), s = std::sin(angle);
  return glm::dmat3(glm::dvec3(c, 0.0, -s), glm::dvec3(0.0, 1.0, 0.0), glm::dvec3(s, 0.0, c));
}

}  // namespace thicket
