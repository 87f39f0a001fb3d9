// Closed meshes of simple forms, to build models of. All face outward.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "thicket/worlds/models.hpp"

namespace thicket {

/// Collects the parts of a model. Lengths in metres.
class ModelBuilder {
 public:
  ModelBuilder(std::string name, std::string description) : model_{std::move(name), std::move(description), {}} {}

  /// Turned by `turn` about its middle.
  void box(const std::string& name, const std::string& material, const glm::dvec3& middle, const glm::dvec3& size, const glm::dmat3& turn = glm::dmat3(1.0));
  /// Between two heights, corner to corner.
  void block(const std::string& name, const std::string& material, const glm::dvec3& low, const glm::dvec3& high) { box(name, material, 0.5 * (low + high), high - low); }
  /// A frustum with `sides` flat sides (>= 3) whose corners lie on circles about its ends.
  void limb(const std::string& name, const std::string& material, const glm::dvec3& from, const glm::dvec3& to, double radius_from, double radius_to, int sides = 16);
  void cylinder(const std::string& name, const std::string& material, const glm::dvec3& from, const glm::dvec3& to, double radius, int sides = 16) { limb(name, material, from, to, radius, radius, sides); }
  /// A sphere of rings and sides, stretched by `half`.
  void ellipsoid(const std::string& name, const std::string& material, const glm::dvec3& middle, const glm::dvec3& half, int rings = 6, int sides = 10);
  /// An outline in x and z, seen from -y, drawn out over y from `y_low` to `y_high`.
  void drawn_along_y(const std::string& name, const std::string& material, const std::vector<glm::dvec2>& outline, double y_low, double y_high);
  /// An outline in y and z, seen from +x, drawn out over x.
  void drawn_along_x(const std::string& name, const std::string& material, const std::vector<glm::dvec2>& outline, double x_low, double x_high);

  Model take() { return std::move(model_); }

 private:
  void add(const std::string& name, const std::string& material, std::vector<glm::dvec3> vertices, std::vector<glm::uvec3> triangles);

  Model model_;
};

/// A turn about y by degrees, nose down, as a pitch is.
glm::dmat3 pitched(double degrees);

Model make_car();
Model make_control_panel();
Model make_dumpster();
Model make_human();
Model make_postbox();
Model make_robot();
Model make_stop_sign();

}  // namespace thicket
