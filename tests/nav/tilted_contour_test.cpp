// The contour of a vehicle that flies: of the level frame, without the floor.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "thicket/nav/aloft.hpp"
#include "thicket/nav/contour.hpp"

namespace thicket {
namespace {

/// One beam ahead that has an echo.
Scan ahead(double range, double azimuth_opening_deg = 0.0, double elevation_opening_deg = 0.0) {
  Scan scan;
  scan.azimuth_opening = radians(azimuth_opening_deg);
  scan.elevation_opening = radians(elevation_opening_deg);
  Beam beam;
  beam.echo_count = 1;
  scan.beams = {beam};
  scan.echoes = {{range}};
  return scan;
}

/// With the nose down by this.
Aloft nose_down(double degrees_down, double altitude) {
  Aloft aloft;
  aloft.tilt = glm::angleAxis(radians(degrees_down), glm::dvec3(0.0, 1.0, 0.0));
  aloft.altitude = altitude;
  return aloft;
}

Contour seen(const Scan& scan, const Aloft& aloft) {
  Scan level;
  make_level(scan, aloft, level);
  Contour contour;
  read_contour(level, contour);
  return contour;
}

}  // namespace

TEST_CASE("a tilted beam tells the distance in the level plane, from a mount that tilts with the vehicle") {
  Scan scan = ahead(2.0 / std::cos(radians(10.0)));
  CHECK(seen(scan, nose_down(10.0, 5.0))[0].distance == doctest::Approx(2.0).epsilon(1e-12));
  CHECK(seen(scan, nose_down(-10.0, 5.0))[0].distance == doctest::Approx(2.0).epsilon(1e-12));
  // What is mounted half a metre high comes forward by half a metre times the sine.
  scan.mount_position = {0.0, 0.0, 0.5};
  CHECK(seen(scan, nose_down(10.0, 5.0))[0].distance == doctest::Approx(2.0 + 0.5 * std::sin(radians(10.0))).epsilon(1e-12));
  // A beam to the side is turned by the roll alone, and keeps its bearing.
  scan = ahead(3.0);
  scan.beams[0].direction = {0.0, 1.0, 0.0};
  Aloft rolled;
  rolled.altitude = 5.0;
  rolled.tilt = glm::angleAxis(radians(20.0), glm::dvec3(1.0, 0.0, 0.0));
  CHECK(seen(scan, rolled)[0].distance == doctest::Approx(3.0 * std::cos(radians(20.0))).epsilon(1e-12));
  CHECK(seen(scan, rolled)[0].bearing == doctest::Approx(0.5 * pi).epsilon(1e-12));
  // All points of a lobe's arc.
  for (const ContourPoint& point : seen(ahead(2.0, 65.0, 65.0), nose_down(10.0, 5.0))) {
    const double azimuth = std::atan2(point.position.y, point.position.x / std::cos(radians(10.0)));
    CHECK(point.distance == doctest::Approx(2.0 * std::hypot(std::cos(azimuth) * std::cos(radians(10.0)), std::sin(azimuth))).epsilon(1e-9));
  }
}

TEST_CASE("an echo that can only be from the floor is no obstacle, one from a wall stays") {
  constexpr double none = std::numeric_limits<double>::infinity();
  const double to_floor = 1.0 / std::sin(radians(10.0));
  CHECK(seen(ahead(to_floor), nose_down(10.0, 1.0))[0].distance == none);
  CHECK(seen(ahead(to_floor), nose_down(10.0, 1.0))[0].bearing == 0.0);
  // A wall in front of it, 9 cm above the floor.
  CHECK(seen(ahead(to_floor - 0.5), nose_down(10.0, 1.0))[0].distance < none);
  // The same range without a tilt, and from higher up.
  CHECK(seen(ahead(to_floor), nose_down(0.0, 1.0))[0].distance < none);
  CHECK(seen(ahead(to_floor), nose_down(10.0, 1.2))[0].distance < none);
  // Upward it is an obstacle: nobody knows of a ceiling.
  CHECK(seen(ahead(to_floor), nose_down(-10.0, 1.0))[0].distance < none);
  // A lobe that also looks level may have met a wall at that range.
  CHECK(seen(ahead(to_floor, 65.0, 65.0), nose_down(10.0, 1.0))[0].distance < none);
  // One that only looks down has not, if all of it looks as low: to the sides a beam with its nose down looks less far down than ahead.
  CHECK(seen(ahead(to_floor, 0.0, 10.0), nose_down(16.0, 1.0))[0].distance == none);
  CHECK(seen(ahead(to_floor, 65.0, 10.0), nose_down(16.0, 1.0))[17].distance < none);
}

TEST_CASE("level and high, or read as it is, the contour has the same bits; an older scan keeps its own tilt") {
  Scan scan = ahead(2.0, 65.0, 65.0);
  scan.mount_position = {0.1, 0.2, 0.3};
  scan.mount_orientation = Pose::planar(0.0, 0.0, 0.0, 0.7).orientation;
  Contour ground;
  ContourReader().add(scan, ground);
  const Contour level = seen(scan, nose_down(0.0, 5.0));
  REQUIRE(level.size() == ground.size());
  for (std::size_t i = 0; i < level.size(); ++i) {
    CHECK(level[i].position == ground[i].position);
    CHECK(level[i].bearing == ground[i].bearing);
  }
  // One reader and one scan's memory, first level, then tilted: nothing of the other tilt is left.
  ContourReader reader;
  Scan made;
  Contour first, then;
  make_level(ahead(2.0), nose_down(0.0, 5.0), made);
  reader.add(made, first);
  make_level(ahead(2.0), nose_down(10.0, 5.0), made);
  reader.add(made, Pose2{{-0.5, 0.0}, 0.0}, then);
  CHECK(first[0].distance == 2.0);
  CHECK(then[0].distance == doctest::Approx(2.0 * std::cos(radians(10.0)) - 0.5).epsilon(1e-12));
}

}  // namespace thicket
