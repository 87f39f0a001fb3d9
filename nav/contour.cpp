#include "thicket/nav/contour.hpp"

#include <cmath>

#include <glm/geometric.hpp>

#include "fan.hpp"

namespace thicket {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();

/// Bearing of the point at `range` on a ray that starts off the vehicle's axis. It differs from the ray's own by the parallax, whose tangent is known; where that is small, a few terms of the
/// arc tangent's series are exact to the rounding of doubles and take a fraction of its time.
double bearing_off_axis(const glm::dvec2& mount, const glm::dvec2& at, double ray_bearing, const glm::dvec2& along, double reach) {
  const double ahead = glm::dot(along, mount) + reach, t = (along.x * mount.y - along.y * mount.x) / ahead, tt = t * t;
  if (!(ahead > 0.0 && tt < 0.04)) return bearing(at);
  double series = 1.0 / 21.0;
  for (const double term : {1.0 / 19.0, 1.0 / 17.0, 1.0 / 15.0, 1.0 / 13.0, 1.0 / 11.0, 1.0 / 9.0, 1.0 / 7.0, 1.0 / 5.0, 1.0 / 3.0, 1.0}) series = term - tt * series;
  const double turned = ray_bearing + t * series;
  return turned > pi ? turned - 2.0 * pi : turned < -pi ? turned + 2.0 * pi : turned;
}

}  // namespace

void ContourReader::learn(const Scan& scan) {
  constexpr double spacing = 0.035;  // rad, 2 degrees
  if (scan.mount_orientation != mount_ || scan.azimuth_opening != opening_ || scan.beams.size() != directions_.size()) {
    mount_ = scan.mount_orientation;
    opening_ = scan.azimuth_opening;
    directions_.assign(scan.beams.size(), glm::dvec3(0.0));
    rays_.assign(scan.beams.size() * fan_size(scan, spacing), Ray{});
  }
  for (std::size_t i = 0; i < scan.beams.size(); ++i) {
    if (scan.beams[i].direction == directions_[i]) continue;
    directions_[i] = scan.beams[i].direction;
    std::size_t next = i * fan_size(scan, spacing);
    for_fan(scan, scan.beams[i], spacing, [&](const glm::dvec3& direction) {
      const glm::dvec2 along(scan.mount_orientation * direction);
      rays_[next++] = {along, glm::length(along), bearing(along)};
    });
  }
}

void ContourReader::add(const Scan& scan, Contour& contour) {
  if (scan.beams.empty()) return;
  learn(scan);
  const glm::dvec2 mount(scan.mount_position);
  const bool on_axis = mount == glm::dvec2(0.0);
  const std::size_t per_beam = rays_.size() / scan.beams.size();
  const Ray* ray = rays_.data();
  contour.reserve(contour.size() + rays_.size());
  for (const Beam& beam : scan.beams) {
    const bool sees = beam.starts_inside || beam.echo_count > 0;
    const double range = beam.starts_inside || !sees ? 0.0 : scan.echoes[beam.first_echo].range;
    const std::uint32_t arc = per_beam > 1 ? static_cast<std::uint32_t>(contour.size()) : no_arc;
    for (std::size_t k = 0; k < per_beam; ++k, ++ray) {
      if (!sees) {
        contour.push_back({{0.0, 0.0}, none, ray->bearing, arc});
      } else if (on_axis) {
        contour.push_back({range * ray->along, range * ray->flat, ray->bearing, arc});
      } else {
        const glm::dvec2 position = mount + range * ray->along;
        contour.push_back({position, glm::length(position), bearing_off_axis(mount, position, ray->bearing, ray->along, range * ray->flat * ray->flat), arc});
      }
    }
  }
}

void ContourReader::add(const Scan& scan, const Pose2& then, Contour& contour) {
  const std::size_t first = contour.size();
  add(scan, contour);
  if (then.position == glm::dvec2(0.0) && then.yaw == 0.0) return;
  const glm::dvec2 forward = direction(then.yaw);
  for (std::size_t i = first; i < contour.size(); ++i) {
    ContourPoint& point = contour[i];
    if (point.distance == none) {
      point.bearing = wrap_angle(point.bearing + then.yaw);
      continue;
    }
    const glm::dvec2 p = point.position;
    point.position = then.position + glm::dvec2(forward.x * p.x - forward.y * p.y, forward.y * p.x + forward.x * p.y);
    point.distance = glm::length(point.position);
    point.bearing = bearing(point.position);
  }
}

void read_contour(const Scan& scan, Contour& contour) {
  contour.clear();
  ContourReader().add(scan, contour);
}

}  // namespace thicket
