// Solids that are clicked in the 3D view, and the outline of the one that is selected.
#include <algorithm>

#include <glm/geometric.hpp>

#include "plan.hpp"
#include "space_view.hpp"

namespace thicket::gui {

std::optional<Picked> pick_in_space(const Scene& scene, const PictureView& view, double u, double v) {
  const PictureCamera eye(view);
  const Ray ray{eye.from, glm::normalize(eye.direction(u, v)), infinity};
  CrossingLists lists;
  scene.crossings(std::span(&ray, 1), infinity, lists, true);
  const auto hidden = hidden_solids(scene.world(), view);
  for (const Crossing& crossing : lists[0]) {
    // What the view leaves out is not clicked, and neither is what the camera is in.
    if (crossing.starts_inside || (hidden && (*hidden)[crossing.solid])) continue;
    return Picked{crossing.solid, ray.origin + crossing.enter * ray.direction};
  }
  return std::nullopt;
}

namespace {

/// Edges of what stands upright on a footprint, of an outline of the solid's frame.
class Edges {
 public:
  Edges(const Solid& solid, double time, ImU32 colour, Overlay& overlay) : colour_(colour), overlay_(overlay) {
    const Standing standing = standing_at(solid, time);
    pose_ = {glm::dvec2(standing.position), standing.yaw};
    const Bounds box = extent(solid);
    low_ = box.low.z - solid.position.z + standing.position.z;
    high_ = box.high.z - solid.position.z + standing.position.z;
  }
  void ring(const std::vector<glm::dvec2>& points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const glm::dvec2 a = pose_.to_outer(points[i]), b = pose_.to_outer(points[(i + 1) % points.size()]);
      for (const double z : {low_, high_}) overlay_.line({a, z}, {b, z}, colour_, width);
      if (points.size() <= 32) overlay_.line({a, low_}, {a, high_}, colour_, width);
    }
  }
  void disc(const Footprint::Disc& disc) {
    const glm::dvec2 centre = pose_.to_outer(disc.centre);
    for (const double z : {low_, high_}) overlay_.circle({centre, z}, disc.radius, colour_, width);
    for (int i = 0; i < 8; ++i) {
      const glm::dvec2 rim = centre + disc.radius * direction(2.0 * pi * i / 8.0);
      overlay_.line({rim, low_}, {rim, high_}, colour_, width);
    }
  }
  /// Three great circles.
  void ball(double radius) {
    const glm::dvec3 centre(pose_.position, 0.5 * (low_ + high_));
    overlay_.circle(centre, radius, colour_, width);
    constexpr int sides = 40;
    for (const glm::dvec3& axis : {glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.0, 1.0, 0.0)})
      for (int i = 0; i < sides; ++i) {
        const auto at = [&](int k) {
          const glm::dvec2 d = direction(2.0 * pi * k / sides);
          return centre + radius * (d.x * axis + glm::dvec3(0.0, 0.0, d.y));
        };
        overlay_.line(at(i), at(i + 1), colour_, width);
      }
  }

 private:
  static constexpr float width = 2.0f;
  ImU32 colour_;
  Overlay& overlay_;
  Pose2 pose_;
  double low_ = 0.0, high_ = 0.0;
};

}  // namespace

void draw_outline(const Solid& solid, double time, ImU32 colour, Overlay& overlay) {
  constexpr std::size_t many_parts = 64;
  Edges edges(solid, time, colour, overlay);
  if (const auto* sphere = std::get_if<Sphere>(&solid.shape)) return edges.ball(sphere->radius);
  const Footprint shape = std::holds_alternative<MeshSolid>(solid.shape) ? rough_footprint_of(solid) : footprint_of(solid);
  if (shape.rings.empty() && shape.fills.size() > many_parts) return edges.ring({shape.low, {shape.high.x, shape.low.y}, shape.high, {shape.low.x, shape.high.y}});
  for (const auto& ring : shape.rings.empty() ? shape.fills : shape.rings) edges.ring(ring);
  if (shape.fills.empty())
    for (const Footprint::Disc& disc : shape.discs) edges.disc(disc);
}

}  // namespace thicket::gui
