// What surfaces do to a wave: Fresnel, scattering lobes, energy, and where a bounce starts.
#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>

#include "lobe.hpp"
#include "wave.hpp"

using namespace thicket;

namespace {

RadarSpec at_7_ghz() {
  RadarSpec radar;
  radar.frequency_ghz = 7.29;
  return radar;
}

Material lossless(double permittivity, double roughness = 0.0) {
  Material material;
  material.name = "lossless";
  material.dielectric = Dielectric{permittivity, 0.0, 0.0, 0.0};
  material.roughness = roughness;
  const Material evaluated = at_frequency(material, 1.0);
  material.reflectivity = evaluated.reflectivity;
  material.attenuation_db_per_m = evaluated.attenuation_db_per_m;
  return material;
}

/// A random material: any reflectivity or permittivity, any roughness.
Material random_material(Dice& dice) {
  Material material = lossless(dice.between(1.0, 30.0), dice.between(0.0, 1.0));
  if (dice.chance(0.5)) {
    material.dielectric.reset();
    material.reflectivity = dice.between(0.0, 1.0);
  }
  return material;
}

/// Part of a wave's power that a surface sends anywhere: the integral of `bistatic` / pi over the half space.
double sent_in_all(const WaveMaterial& surface, const Interface& interface, double incidence, double spread) {
  const glm::dvec3 in(std::sin(incidence), 0.0, -std::cos(incidence)), normal(0.0, 0.0, 1.0);
  // Over the facets' normals rather than the directions, so that a narrow lobe is sampled as well as a wide one: uniform in the slope's exceedance; the diffuse part is exact.
  double sum = 0.0;
  const int steps = 400;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const double elevation = 0.5 * pi * (i + 0.5) / steps, azimuth = 2.0 * pi * (j + 0.5) / steps;
      const glm::dvec3 out(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      sum += bistatic(surface, interface, in, out, normal, spread, true) * std::cos(elevation) * (0.5 * pi / steps) * (2.0 * pi / steps);
    }
  }
  return sum / pi;
}

}  // namespace

TEST_CASE("what a dielectric mirrors goes with the angle as Fresnel tells") {
  const Material glass = lossless(4.0);  // index 2
  const WaveMaterial wave = wave_material(glass, at_7_ghz(), 0.0);
  const auto mirrored = [&](double degrees) { return interface_between(nullptr, &wave, wave, std::cos(radians(degrees)), true).mirrored; };
  CHECK(mirrored(0.0) == doctest::Approx(1.0 / 9.0).epsilon(1e-12));
  // By hand at 60 degrees: sin = sqrt(3)/2, q = sqrt(4 - 3/4) = 1.802776; TE (0.5 - q) / (0.5 + q), TM (4 * 0.5 - q) / (4 * 0.5 + q).
  const double q = std::sqrt(3.25), te = (0.5 - q) / (0.5 + q), tm = (2.0 - q) / (2.0 + q);
  CHECK(mirrored(60.0) == doctest::Approx(0.5 * (te * te + tm * tm)).epsilon(1e-12));
  // At Brewster's angle, atan 2, one polarisation is not mirrored at all: what is left is half of the other's ((n^2 - 1) / (n^2 + 1))^2.
  CHECK(mirrored(degrees(std::atan(2.0))) == doctest::Approx(0.5 * 0.36).epsilon(1e-9));
  CHECK(mirrored(89.99) > 0.99);
  // Into matter and out of it again it is the same, and between two equal dielectrics there is nothing.
  CHECK(interface_between(&wave, nullptr, wave, 0.5, true).mirrored == doctest::Approx(mirrored(60.0)).epsilon(1e-12));
  CHECK(interface_between(&wave, &wave, wave, 0.5, true).mirrored == doctest::Approx(0.0).scale(1.0));
  // From index 2 to index 3, squarely: (1/5)^2.
  const Material dense = lossless(9.0);
  const WaveMaterial denser = wave_material(dense, at_7_ghz(), 0.0);
  CHECK(interface_between(&wave, &denser, denser, 1.0, true).reflectivity == doctest::Approx(0.04).epsilon(1e-12));
  // Left out, the angle does not matter.
  CHECK(interface_between(nullptr, &wave, wave, 0.1, false).mirrored == wave.reflectivity);
}

TEST_CASE("the specular lobe is Barrick's rough surface") {
  Material steel;
  steel.reflectivity = 0.8;
  steel.roughness = 0.4;
  const WaveMaterial wave = wave_material(steel, at_7_ghz(), 0.0);
  const double s2 = 0.5 * wave.slope * wave.slope;  // mean square slope
  for (const double tilt : {0.0, 5.0, 10.0, 20.0}) {
    const double theta = radians(tilt), c = std::cos(theta);
    const double sigma0 = 0.8 * std::exp(-std::pow(std::tan(theta), 2) / (2.0 * s2)) / (2.0 * s2 * std::pow(c, 4));
    const double lobe = 4.0 * c * (backscatter(wave, 0.8, c, 0.0) - wave.diffuse * 0.8 * c) / (1.0 - wave.diffuse);
    CHECK(lobe == doctest::Approx(sigma0).epsilon(2e-3));  // shadows take little so far from grazing
  }
}

TEST_CASE("straight back, the two ways to ask agree") {
  CHECK(rc::check("backscatter is bistatic", [] {
    Dice dice(*rc::gen::arbitrary<std::uint64_t>());
    const Material material = random_material(dice);
    const WaveMaterial wave = wave_material(material, at_7_ghz(), 0.0);
    const double incidence = dice.between(0.0, 1.5), spread = dice.between(0.01, 0.3);
    const glm::dvec3 in(std::sin(incidence), 0.0, -std::cos(incidence));
    const Interface interface = interface_between(nullptr, &wave, wave, std::cos(incidence), true);
    const double straight = backscatter(wave, interface.reflectivity, std::cos(incidence), spread);
    RC_ASSERT(std::abs(straight - bistatic(wave, interface, in, -in, {0.0, 0.0, 1.0}, spread, true)) <= 1e-9 * straight + 1e-300);
  }));
}

TEST_CASE("scattering is reciprocal") {
  CHECK(rc::check("in and out exchanged", [] {
    Dice dice(*rc::gen::arbitrary<std::uint64_t>());
    const Material material = random_material(dice);
    const WaveMaterial wave = wave_material(material, at_7_ghz(), 0.0);
    const double spread = dice.between(0.0, 0.3) + 0.01;
    glm::dvec3 a = dice.direction(), b = dice.direction();
    a.z = std::abs(a.z) + 1e-3;
    b.z = std::abs(b.z) + 1e-3;
    a = glm::normalize(a);
    b = glm::normalize(b);
    const glm::dvec3 normal(0.0, 0.0, 1.0);
    const double there = bistatic(wave, interface_between(nullptr, &wave, wave, a.z, true), -a, b, normal, spread, true) / b.z;
    const double back = bistatic(wave, interface_between(nullptr, &wave, wave, b.z, true), -b, a, normal, spread, true) / a.z;
    RC_ASSERT(std::abs(there - back) <= 1e-9 * std::max(there, back) + 1e-300);
  }));
}

TEST_CASE("no surface sends and passes more than it gets") {
  Dice dice(5);
  for (int i = 0; i < 60; ++i) {
    Material material = random_material(dice);
    material.roughness = dice.between(0.4, 1.0);  // of what is smoother the lobe is too narrow to be integrated like this
    CAPTURE(material.roughness);
    CAPTURE(material.reflectivity);
    const WaveMaterial wave = wave_material(material, at_7_ghz(), 0.0);
    const double incidence = dice.between(0.0, 1.5);
    CAPTURE(incidence);
    const Interface interface = interface_between(nullptr, &wave, wave, std::cos(incidence), true);
    const double sent = sent_in_all(wave, interface, incidence, 0.0);
    CHECK(interface.passed >= 0.0);
    CHECK(sent + interface.passed <= 1.0 + 2e-3);
  }
  // A perfect diffuse reflector sends it all, a perfect mirror nearly so (what two facets exchange is lost).
  Material white;
  white.reflectivity = 1.0;
  const WaveMaterial diffuse = wave_material(white, at_7_ghz(), 0.0);
  CHECK(sent_in_all(diffuse, interface_between(nullptr, &diffuse, diffuse, 0.7, true), 0.8, 0.1) == doctest::Approx(1.0).epsilon(1e-4));
  white.roughness = 0.35;
  const WaveMaterial perfect = wave_material(white, at_7_ghz(), 0.0);
  CHECK(sent_in_all(perfect, interface_between(nullptr, &perfect, perfect, std::cos(0.5), true), 0.5, 0.0) == doctest::Approx(1.0).epsilon(5e-3));
}

TEST_CASE("what is clear is as good as the open") {
  Material smoke;
  smoke.reflectivity = 0.0;
  smoke.attenuation_db_per_m = 0.001;
  const Material glass = lossless(4.0);
  const WaveMaterial haze = wave_material(smoke, at_7_ghz(), 1e-6), pane = wave_material(glass, at_7_ghz(), 1e-6);
  for (const double cosine : {1.0, 0.5, 0.1}) {
    const Interface open = interface_between(nullptr, &pane, pane, cosine, true), hazy = interface_between(&haze, &pane, pane, cosine, true);
    CHECK(open.mirrored == hazy.mirrored);
    CHECK(open.passed == hazy.passed);
    CHECK(open.reflectivity == hazy.reflectivity);
  }
}

TEST_CASE("a slab mirrors what its layer does, not what its face would") {
  const Material glass = lossless(6.31);
  const WaveMaterial wave = wave_material(glass, at_7_ghz(), 0.0);
  const double thickness = 0.0082, angle = 0.5;  // half a wave: next to nothing is mirrored
  const Interface layer = slab_interface(wave, 7.29, thickness, std::cos(angle));
  CHECK(layer.mirrored < 0.2 * interface_between(nullptr, &wave, wave, std::cos(angle), true).mirrored);
  const glm::dvec3 in(std::sin(angle), 0.0, -std::cos(angle)), out(std::sin(angle), 0.0, std::cos(angle)), up(0.0, 0.0, 1.0);
  const double as_layer = bistatic(wave, layer, in, out, up, 0.02, false);
  const double as_mirror = bistatic(wave, {1.0, 1.0, 0.0}, in, out, up, 0.02, false);
  CHECK(as_layer == doctest::Approx(layer.mirrored * as_mirror).epsilon(1e-9));
}

TEST_CASE("a slab passes no more than it leaves") {
  Dice dice(6);
  for (int i = 0; i < 1000; ++i) {
    Material material = random_material(dice);
    if (material.dielectric) material.dielectric->c = dice.between(0.0, 0.1);
    else material.attenuation_db_per_m = dice.between(0.0, 100.0);
    const WaveMaterial wave = wave_material(material, at_7_ghz(), 0.0);
    const Interface slab = slab_interface(wave, 7.29, dice.between(1e-4, 0.2), dice.between(0.01, 1.0));
    CHECK(slab.passed >= 0.0);
    CHECK(slab.passed + wave.diffuse * slab.reflectivity + (1.0 - wave.diffuse) * slab.mirrored <= 1.0 + 1e-12);
  }
}

TEST_CASE("a bounce starts off its surface, however far out") {
  Dice dice(7);
  for (const double far : {0.0, 1.0, 1e3, 1e6, 1e8}) {
    CAPTURE(far);
    HandMadeWorld w;
    rough_metal(w);
    Solid box{"box", 0, {far, -far, 0.5 * far}, 0.3, Box{{2.0, 3.0, 1.0}}, 0.2, -0.4};  // turned: axis-aligned boxes hide what this is about
    w.world.solids.push_back(box);
    const Scene scene = traced(w);
    int found = 0;
    for (int i = 0; i < 300; ++i) {
      const glm::dvec3 middle = box.position, from = middle + 6.0 * dice.direction();
      Hit hit, again;
      const Ray ray{from, glm::normalize(middle + dice.between(0.0, 0.8) * dice.direction() - from), 100.0};
      scene.closest_hits({&ray, 1}, Stops::everything, {&hit, 1});
      if (hit.solid == no_solid) continue;
      ++found;
      const glm::dvec3 out = glm::normalize(ray.direction - 2.0 * glm::dot(ray.direction, hit.normal) * hit.normal);
      const Ray bounce{offset_origin(ray.origin + hit.range * ray.direction, hit.normal), out, 100.0};
      CHECK(glm::distance(bounce.origin, ray.origin + hit.range * ray.direction) < std::max(1e-8, 1e-11 * far));
      scene.closest_hits({&bounce, 1}, Stops::everything, {&again, 1});
      CHECK(again.solid == no_solid);
    }
    CHECK(found > 250);
  }
}
