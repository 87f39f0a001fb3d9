// Lobes against the closed forms of radar cross-section.
#include <doctest/doctest.h>

#include <cmath>

#include "lobe.hpp"

using namespace thicket;

namespace {

/// A square plate, 1 mm thick, whose middle is `range` ahead, turned by yaw.
Solid plate(double size, double range, double tilt, std::uint32_t material = 0) {
  Solid solid;
  solid.name = "plate";
  solid.material = material;
  solid.position = {range, 0.0, 0.0};
  solid.yaw = tilt;
  solid.shape = Box{{1e-3, size, size}};
  return solid;
}

Scene scene_of(Solid solid) {
  HandMadeWorld w;
  rough_metal(w);
  w.world.solids.push_back(std::move(solid));
  return traced(w);
}

/// The integral over a facet grid: what a Lambertian surface of reflectivity 1 returns, near field included; `at(u, v)` gives point, unit normal and area element.
template <class At>
double lambert_power(const LobeRadarSpec& spec, int steps, At&& at) {
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const auto [point, normal, area] = at((i + 0.5) / steps, (j + 0.5) / steps);
      const double r = glm::length(point), cosine = -glm::dot(point, normal) / r;
      if (cosine > 0.0) sum += 4.0 * cosine * cosine * area / std::pow(r, 4);
    }
  }
  return sum * std::pow(spec.range_max_m, 2) / (4.0 * solid_angle(spec.azimuth_opening_deg, spec.elevation_opening_deg));
}
struct Facet {
  glm::dvec3 point, normal;
  double area;
};

}  // namespace

TEST_CASE("a Lambert plate returns 4 A cos^2 at five tilts") {
  const LobeRadarSpec spec = bare_lobe(20.0);
  for (const double degrees : {0.0, 20.0, 40.0, 60.0, 75.0}) {
    CAPTURE(degrees);
    const double tilt = radians(degrees), size = 0.6, range = 8.0;
    const Estimate power = mean_power(spec, scene_of(plate(size, range, tilt)), 200);
    const double expected = power_of(4.0 * size * size * std::pow(std::cos(tilt), 2), range, spec);
    CHECK(power.error < 0.02 * expected);
    // The plate is 1 mm thick, which shows when it is tilted; and at 8 m it is not quite in the far field (0.3 %).
    const double edge = power_of(4.0 * 1e-3 * size * std::pow(std::sin(tilt), 2), range, spec);
    CHECK(std::abs(power.mean - expected - edge) < 3.0 * power.error + 0.006 * expected);
  }
}

TEST_CASE("a Lambert sphere returns 8/3 pi a^2, and less where it is near") {
  for (const auto& [radius, range] : {std::pair{0.5, 9.5}, std::pair{0.1, 9.5}, std::pair{0.5, 2.0}}) {
    CAPTURE(radius);
    CAPTURE(range);
    const LobeRadarSpec spec = bare_lobe(range > 5.0 ? 12.0 : 40.0);
    HandMadeWorld w;
    rough_metal(w);
    w.add(Sphere{radius}, {range, 0.0, 0.0});
    const Estimate power = mean_power(spec, traced(w), 300);
    const double near_field = lambert_power(spec, 600, [r = radius, R = range](double u, double v) {
      const double z = 2.0 * u - 1.0, bearing = 2.0 * pi * v, s = std::sqrt(1.0 - z * z);
      const glm::dvec3 normal(s * std::cos(bearing), s * std::sin(bearing), z);
      return Facet{glm::dvec3(R, 0.0, 0.0) + r * normal, normal, 4.0 * pi * r * r / (600.0 * 600.0)};
    });
    CHECK(std::abs(power.mean - near_field) < 3.0 * power.error + 1e-3 * near_field);
    CHECK(power.error < 0.03 * near_field);
    const double far_field = power_of(8.0 / 3.0 * pi * radius * radius, range, spec);
    CHECK(near_field / far_field == doctest::Approx(range == 2.0 ? 1.593 : 1.0).epsilon(range == 2.0 ? 1e-3 : 0.1));
  }
}

TEST_CASE("an infinite mirror returns pi R^2, so that its echo falls with the square of the range") {
  double before = 0.0;
  for (const double range : {1.0, 2.0, 4.0, 8.0}) {
    CAPTURE(range);
    HandMadeWorld w;
    mirror(w);
    w.add(Box{{1.0, 100.0, 100.0}}, {range + 0.5, 0.0, 0.0});
    const LobeRadarSpec spec = bare_lobe();
    const double power = received_power(spec, traced(w));
    CHECK(10.0 * std::log10(power / power_of(pi * range * range, range, spec)) == doctest::Approx(0.0).scale(1.0).epsilon(0.05));
    if (before > 0.0) CHECK(before / power == doctest::Approx(4.0).epsilon(1e-6));
    before = power;
  }
}

TEST_CASE("a mirror sphere returns pi a^2, seen from near pi a^2 d^2 / R^2") {
  // The middle of the sphere is at R, its surface at d: a wave from a point comes back spread as from a mirror point in the sphere (geometric optics).
  const double a = 2.0, R = 5.0, d = R - a;
  HandMadeWorld w;
  mirror(w);
  w.add(Sphere{a}, {R, 0.0, 0.0});
  const LobeRadarSpec spec = bare_lobe(30.0);
  const Estimate power = mean_power(spec, traced(w), 3000);
  const double expected = power_of(pi * a * a * d * d / (R * R), d, spec);
  CHECK(power.error < 0.03 * expected);
  CHECK(std::abs(power.mean - expected) < 3.0 * power.error);
}

TEST_CASE("a mirror ball is seen in every scan, however narrow its flash") {
  HandMadeWorld w;
  mirror(w);
  w.add(Sphere{0.3}, {6.0, 0.0, 0.0});
  const LobeRadarSpec spec = bare_lobe();
  const Estimate power = mean_power(spec, traced(w), 300);
  const double d = 5.7, expected = power_of(pi * 0.09 * d * d / 36.0, d, spec);
  CHECK(power.error * std::sqrt(300.0) < 1.0 * power.mean);  // a scan's own deviation
  CHECK(std::abs(power.mean - expected) < 3.0 * power.error + 0.06 * expected);  // widened to 0.25 rad, the lobe is shadowed a little
}

TEST_CASE("what fills the lobe falls with 1/R^2, what is alone with 1/R^4") {
  const LobeRadarSpec spec = bare_lobe(20.0, 58, 40.0);
  const auto wall_at = [&](double range) { return received_power(spec, scene_of(plate(400.0, range, 0.0))); };
  CHECK(wall_at(2.0) / wall_at(8.0) == doctest::Approx(16.0).epsilon(1e-3));  // its front is half a millimetre nearer
  const auto plate_at = [&](double range) { return mean_power(spec, scene_of(plate(0.6, range, 0.0)), 400); };
  const Estimate near = plate_at(5.0), far = plate_at(10.0);
  const double ratio = near.mean / far.mean, error = ratio * std::hypot(near.error / near.mean, far.error / far.mean);
  CHECK(error < 0.05 * ratio);
  CHECK(std::abs(ratio - 16.0) < 3.0 * error + 0.01 * ratio);
  // Compensated, a wall is as strong at any range.
  LobeRadarSpec compensated = spec;
  compensated.range_compensation = true;
  CHECK(received_power(compensated, scene_of(plate(400.0, 3.0, 0.0))) == doctest::Approx(received_power(compensated, scene_of(plate(400.0, 30.0, 0.0)))).epsilon(1e-6));
}

TEST_CASE("a wire and a small sphere return the share of their area at 30 and at 58 rays a side") {
  const double range = 5.0, radius = 0.002, length = 2.0;
  HandMadeWorld wire;
  rough_metal(wire);
  wire.add(Cylinder{radius, length}, {range, 0.0, 0.0});
  HandMadeWorld ball;
  rough_metal(ball);
  ball.add(Sphere{0.1}, {range, 0.0, 0.0});
  const Scene wire_scene = traced(wire), ball_scene = traced(ball);
  for (const int rays : {30, 58}) {
    CAPTURE(rays);
    const LobeRadarSpec spec = bare_lobe(65.0, rays);
    const double strip = lambert_power(spec, 800, [=](double u, double v) {
      const double bearing = pi * (u - 0.5) + pi, z = length * (v - 0.5);
      const glm::dvec3 normal(std::cos(bearing), std::sin(bearing), 0.0);
      return Facet{glm::dvec3(range, 0.0, z) + radius * normal, normal, pi * radius * length / (800.0 * 800.0)};
    });
    const Estimate seen = mean_power(spec, wire_scene, 1500);
    CHECK(std::abs(seen.mean - strip) < 3.0 * seen.error);
    CHECK(seen.error < 0.1 * strip);
    const double disc = lambert_power(spec, 400, [=](double u, double v) {
      const double z = 2.0 * u - 1.0, bearing = 2.0 * pi * v, s = std::sqrt(1.0 - z * z);
      const glm::dvec3 normal(s * std::cos(bearing), s * std::sin(bearing), z);
      return Facet{glm::dvec3(range, 0.0, 0.0) + 0.1 * normal, normal, 4.0 * pi * 0.01 / (400.0 * 400.0)};
    });
    const Estimate sphere = mean_power(spec, ball_scene, 1500);
    CHECK(std::abs(sphere.mean - disc) < 3.0 * sphere.error);
    CHECK(sphere.error < 0.1 * disc);
  }
}

TEST_CASE("a wave behind a slab is down by twice what ITU-R P.2040-3 tells of it") {
  struct Row {
    const char* material;
    double thickness, passed_db;  // one way, at 7.29 GHz, normal incidence (FACTS: computed from the Recommendation)
  };
  const auto presets = material_presets();
  REQUIRE(presets);
  for (const Row& row : {Row{"plasterboard", 0.0125, -0.76}, Row{"wood", 0.020, -1.33}, Row{"glass", 0.006, -2.24}, Row{"chipboard", 0.018, -2.64}, Row{"brick", 0.1, -4.06},
                         Row{"concrete", 0.1, -17.0}, Row{"concrete", 0.2, -32.7}}) {
    CAPTURE(row.material);
    CAPTURE(row.thickness);
    HandMadeWorld w;
    rough_metal(w);
    for (const Material& material : *presets)
      if (material.name == row.material) w.world.materials.push_back(material);
    REQUIRE(w.world.materials.size() == 2);
    w.add(Box{{1.0, 50.0, 50.0}}, {8.0, 0.0, 0.0});
    w.add(Box{{row.thickness, 50.0, 50.0}}, {4.0, 0.0, 0.0}, 0.0, 1);
    ScanningRadarSpec spec = one_beam_radar();
    spec.frequency_ghz = 7.29;
    spec.slab_max_m = 0.25;
    const OneBeam beam = looked(spec, traced(w));
    REQUIRE(beam.echoes.size() == 2);
    CHECK(beam.echoes[0].edge == Edge::thin);
    CHECK(beam.echoes[1].range == doctest::Approx(7.5).epsilon(1e-12));
    CHECK(std::abs(5.0 * std::log10(beam.power(1)) - row.passed_db) < 0.1);
  }
}
