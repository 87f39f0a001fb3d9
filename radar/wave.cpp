#include "wave.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

namespace thicket {
namespace {

using Complex = std::complex<double>;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// Fresnel's power reflectivity between two media, the mean of both polarisations. The angle is that in the open: what runs along the interface is the same on all parallel ones (Snell).
double fresnel_reflectivity(const Complex& eta_before, const Complex& eta_after, double cosine) {
  const double sine_squared = 1.0 - cosine * cosine;
  const Complex q_before = std::sqrt(eta_before - sine_squared), q_after = std::sqrt(eta_after - sine_squared);
  const Complex te = (q_before - q_after) / (q_before + q_after);
  const Complex tm = (eta_after * q_before - eta_before * q_after) / (eta_after * q_before + eta_before * q_after);
  return std::min(1.0, 0.5 * (std::norm(te) + std::norm(tm)));
}

/// Beckmann's distribution of facet normals over the angle off the surface's normal, per sr; slope_squared is twice the mean square slope.
double facets(double cosine, double slope_squared) {
  const double c2 = cosine * cosine;
  if (c2 <= 0.0) return 0.0;
  return std::exp(-(1.0 - c2) / (c2 * slope_squared)) / (std::numbers::pi * slope_squared * c2 * c2);
}

/// Share of the facets that are neither shadowed nor hidden (Smith, in the rational form of Walter et al. 2007).
double unshadowed(double cosine, double slope_squared) {
  const double sine_squared = 1.0 - cosine * cosine;
  if (sine_squared <= 0.0) return 1.0;
  const double a = cosine / std::sqrt(slope_squared * sine_squared);
  return a < 1.6 ? (3.535 * a + 2.181 * a * a) / (1.0 + 2.276 * a + 2.577 * a * a) : 1.0;
}

double split(const WaveMaterial& surface, double square, double mirrored) { return surface.diffuse * square + (1.0 - surface.diffuse) * mirrored; }

}  // namespace

WaveMaterial wave_material(const Material& material, const RadarSpec& radar, double floor_power) {
  WaveMaterial wave;
  wave.material = &material;
  wave.reflectivity = material.reflectivity;
  wave.attenuation_db_per_m = material.attenuation_db_per_m;
  if (material.depends_on_frequency()) {
    const Material there = at_frequency(material, radar.frequency_ghz);
    wave.reflectivity = there.reflectivity;
    wave.attenuation_db_per_m = there.attenuation_db_per_m;
  }
  wave.density = wave.attenuation_db_per_m;
  if (material.dielectric) {
    wave.dielectric = true;
    wave.permittivity = permittivity(*material.dielectric, radar.frequency_ghz);
    if (radar.excess_range) wave.index = std::sqrt(wave.permittivity).real();
  }
  if (radar.scattering == "material") {
    // Squares, so that the middle of the scale looks like the middle (Burley 2012).
    wave.diffuse = wave.slope = material.roughness * material.roughness;
  }
  if (radar.statistical_foliage && material.leaves_per_m > 0.0 && !wave.opaque()) {
    // So that the mean of what gets through is that of even matter: a Poisson number of leaves, each of which takes the part `taken`, passes exp(-leaves taken) on average. Fewer leaves than it takes to get
    // there, each of which would have to take more than all, become as many as it takes.
    const double even = 0.1 * std::numbers::ln10 * wave.attenuation_db_per_m;
    wave.leaves_per_m = std::max(material.leaves_per_m, even);
    const double taken = even / wave.leaves_per_m;
    wave.leaf_loss_db = taken >= 1.0 ? infinite : -10.0 * std::log10(1.0 - taken);
    wave.leaf_reflectivity = std::min(wave.reflectivity, taken);
    wave.attenuation_db_per_m = 0.0;
  }
  wave.visible = wave.reflectivity > 0.0 && wave.reflectivity >= floor_power;
  return wave;
}

std::vector<WaveMaterial> wave_materials(const World& world, const RadarSpec& radar, double floor_power) {
  std::vector<WaveMaterial> list;
  list.reserve(world.materials.size());
  for (const Material& material : world.materials) list.push_back(wave_material(material, radar, floor_power));
  return list;
}

Interface interface_between(const WaveMaterial* before, const WaveMaterial* after, const WaveMaterial& reflector, double cosine, bool fresnel) {
  // (The permittivity of what is clear is 1.)
  const bool known = (!before || before->dielectric || before->clear()) && (!after || after->dielectric || after->clear());
  if (!fresnel || !known) return {reflector.reflectivity, reflector.reflectivity, 1.0 - reflector.reflectivity};
  const Complex eta_before = before ? before->permittivity : Complex(1.0), eta_after = after ? after->permittivity : Complex(1.0);
  // Between one medium and the open the reflectivity at normal incidence is known already.
  const double square = before && after && before->dielectric && after->dielectric ? fresnel_reflectivity(eta_before, eta_after, 1.0) : reflector.reflectivity;
  if (reflector.diffuse >= 1.0) return {square, 0.0, 1.0 - square};
  const double mirrored = fresnel_reflectivity(eta_before, eta_after, cosine);
  return {square, mirrored, 1.0 - split(reflector, square, mirrored)};
}

Interface slab_interface(const WaveMaterial& material, double frequency_ghz, double thickness, double cosine) {
  const Slab square = slab(*material.material, frequency_ghz, thickness), oblique = slab(*material.material, frequency_ghz, thickness, std::acos(std::min(1.0, cosine)));
  // The diffuse share is sent back as if met squarely; what passes cannot be more than what is left.
  const double left = 1.0 - split(material, square.reflected, oblique.reflected);
  return {square.reflected, oblique.reflected, oblique.reflected < 1.0 ? oblique.transmitted * std::min(1.0, left / (1.0 - oblique.reflected)) : 0.0};
}

double backscatter(const WaveMaterial& surface, double reflectivity, double cosine, double spread) {
  double sent = surface.diffuse * cosine;
  if (surface.diffuse < 1.0 && cosine > 0.0) {
    const double slope_squared = surface.slope * surface.slope + spread * spread / (cosine * cosine);
    const double shadow = unshadowed(cosine, slope_squared);
    sent += (1.0 - surface.diffuse) * std::numbers::pi * facets(cosine, slope_squared) * shadow * shadow / (4.0 * cosine);
  }
  return reflectivity * sent;
}

double bistatic(const WaveMaterial& surface, const Interface& interface, const glm::dvec3& in, const glm::dvec3& out, const glm::dvec3& normal, double spread, bool fresnel) {
  const double cosine_in = -glm::dot(in, normal), cosine_out = glm::dot(out, normal);
  if (cosine_in <= 0.0 || cosine_out <= 0.0) return 0.0;
  double sent = surface.diffuse * interface.reflectivity * cosine_out;
  if (surface.diffuse < 1.0) {
    const double slope_squared = surface.slope * surface.slope + spread * spread / (cosine_in * cosine_out);
    const glm::dvec3 half = glm::normalize(out - in);
    const double tilt = std::min(1.0, glm::dot(half, normal)), facing = std::min(1.0, glm::dot(half, out));
    const double mirrored = fresnel && surface.dielectric ? fresnel_reflectivity(1.0, surface.permittivity, facing) : interface.mirrored;
    sent += (1.0 - surface.diffuse) * mirrored * std::numbers::pi * facets(tilt, slope_squared) * unshadowed(cosine_in, slope_squared) * unshadowed(cosine_out, slope_squared) / (4.0 * cosine_in);
  }
  return sent;
}

glm::dvec3 offset_origin(const glm::dvec3& point, const glm::dvec3& normal) {
  // Nearer than `near` a fixed step, beyond it as many units in the last place as make the same step there. The step is more than what a scene takes for touching, 1 nm.
  constexpr double near = 1024.0, step = 4e-9, ulps = 16384.0;
  glm::dvec3 moved;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(point[i]) < near) {
      moved[i] = point[i] + step * normal[i];
    } else {
      const auto units = static_cast<std::int64_t>(ulps * normal[i]);
      const auto bits = std::bit_cast<std::int64_t>(point[i]);
      moved[i] = std::bit_cast<double>(bits + (point[i] < 0.0 ? -units : units));
    }
  }
  return moved;
}

}  // namespace thicket
