// What matter does to a radar's wave: how much of it a surface sends where, and how much goes on. Private to the room.
#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "thicket/radar/sensor_spec.hpp"
#include "thicket/worlds/world.hpp"

namespace thicket {

inline constexpr double light_speed = 299792458.0;  // m/s

/// A material as a radar's wave meets it.
struct WaveMaterial {
  const Material* material = nullptr;  ///< of the world
  double reflectivity = 0.0;           ///< power fraction at normal incidence from the open
  double attenuation_db_per_m = 0.0;   ///< one way; infinite: opaque
  double density = 0.0;                ///< where solids overlap the greatest counts: the attenuation, a crown's too
  std::complex<double> permittivity{1.0, 0.0};
  bool dielectric = false;             ///< its permittivity is known, and what it reflects goes with the angle
  double index = 1.0;                  ///< of refraction, for the excess range; 1 where that is left out
  double diffuse = 1.0;                ///< share of what it reflects that is Lambertian
  double slope = 0.0;                  ///< sqrt(2) times the rms slope of the facets that make up the specular rest
  double leaves_per_m = 0.0;           ///< of a crown that is leaves at random places; its attenuation is then 0 and stands in:
  double leaf_loss_db = 0.0;           ///< one way, of one leaf; infinite: a leaf ends the ray
  double leaf_reflectivity = 0.0;      ///< no more than a leaf takes
  bool visible = false;                ///< the receiver sees it, met squarely from the open

  /// Only takes from the wave: its borders are none, and it is as good as the open.
  bool clear() const { return reflectivity == 0.0 && !opaque(); }
  bool opaque() const { return attenuation_db_per_m == std::numeric_limits<double>::infinity(); }
  bool crown() const { return leaves_per_m > 0.0; }
};

/// The materials of a world, in its order.
std::vector<WaveMaterial> wave_materials(const World& world, const RadarSpec& radar, double floor_power);
/// One of them alone.
WaveMaterial wave_material(const Material& material, const RadarSpec& radar, double floor_power);

/// What an interface sends back and lets through, as fractions of power.
struct Interface {
  double reflectivity = 0.0;           ///< at normal incidence: that of the facets that face the radar, and of the diffuse share
  double mirrored = 0.0;               ///< specular reflection at the actual angle
  double passed = 1.0;                 ///< goes on; what it sends everywhere and this sum to 1 at most
};

/// From one side to the other (null: the open), at an angle of incidence whose cosine (in the open) is given, 0...1. `reflector` is the side whose surface it is. Between dielectrics, or a
/// dielectric and the open: Fresnel, the mean of both polarisations; else (or without `fresnel`) the reflectivity of the reflector at any angle.
Interface interface_between(const WaveMaterial* before, const WaveMaterial* after, const WaveMaterial& reflector, double cosine, bool fresnel);
/// A slab in the open, of a thickness in m: both faces and what goes to and fro between them, the mean of both polarisations.
Interface slab_interface(const WaveMaterial& material, double frequency_ghz, double thickness, double cosine);

/// pi f cos(theta) of the surface's BRDF f for a wave that is sent straight back: 1 is a perfect diffuse reflector met squarely. The diffuse share is Lambertian; the rest are facets with Beckmann's distribution
/// of slopes and Smith's shadowing, the geometric-optics limit of a rough surface (Barrick 1968: sigma0 = R(0) exp(-tan^2/2s^2) / (2 s^2 cos^4), s the rms slope). `spread` widens the
/// facets' slope (added in squares, over the cosine: off the plane of incidence a ray's neighbours are that much farther off the mirror's way) to the angle that the ray stands for, so that a mirror is met by a
/// ray of its neighbourhood.
double backscatter(const WaveMaterial& surface, double reflectivity, double cosine, double spread);
/// pi f cos(theta_out), for a wave that comes along `in` (a unit vector towards the surface) and leaves along `out`; `normal` is the unit normal on their side.
/// `fresnel`: what is mirrored goes with the angle at the facets; else (a slab too) it is that of the interface.
double bistatic(const WaveMaterial& surface, const Interface& interface, const glm::dvec3& in, const glm::dvec3& out, const glm::dvec3& normal, double spread, bool fresnel);

/// A bounce starts just off its surface: moved along the normal by more than the rounding of the point, an absolute step near zero and a number of units in the last place far out (after Wächter & Binder,
/// Ray Tracing Gems 2019, chapter 6, here for double precision).
glm::dvec3 offset_origin(const glm::dvec3& point, const glm::dvec3& normal);

}  // namespace thicket
