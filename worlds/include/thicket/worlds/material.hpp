// What matter is made of, as far as rays and robots care.
#pragma once

#include <complex>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "thicket/base/result.hpp"
#include "thicket/base/schema.hpp"

namespace thicket {

/// Electrical properties as ITU-R P.2040-3 tabulates them: relative permittivity a f^b and conductivity c f^d in S/m, f in GHz.
struct Dielectric {
  double a = 1.0, b = 0.0, c = 0.0, d = 0.0;
};

/// A material. Powers are fractions, dB are of power. The numbers hold at 1 GHz where they depend on the frequency; `at_frequency` evaluates them.
struct Material {
  std::string name;
  double reflectivity = 0.5;  ///< fraction of the power that a surface reflects at normal incidence, 0...1
  double attenuation_db_per_m = std::numeric_limits<double>::infinity();  ///< one way, >= 0; infinite: opaque to radar
  double roughness = 1.0;     ///< 0 mirror ... 1 diffuse
  bool stops_light = true;    ///< a lidar's ray ends at its surface, or inside it if light_extinction_per_m is finite
  bool stops_motion = true;   ///< a robot collides with it
  double light_extinction_per_m = std::numeric_limits<double>::infinity();  ///< of a medium that light enters (smoke): 1 / mean free path; infinite: a surface
  double leaves_per_m = 0.0;             ///< of a crown: how many leaves a ray meets per metre, on average; 0: not made of leaves. For radars with `statistical_foliage`
  double attenuation_exponent = 0.0;     ///< attenuation_db_per_m grows with (f / 1 GHz)^this
  std::optional<Dielectric> dielectric = std::nullopt;  ///< where there is one, reflectivity and attenuation follow from it
  std::string source = {};               ///< where the numbers come from

  bool opaque() const { return attenuation_db_per_m == std::numeric_limits<double>::infinity(); }
  bool depends_on_frequency() const { return dielectric.has_value() || (attenuation_exponent != 0.0 && attenuation_db_per_m > 0.0 && !opaque()); }
  /// Light goes into it and fades, where the surface of anything else that stops light ends it.
  bool light_medium() const { return stops_light && light_extinction_per_m < std::numeric_limits<double>::infinity(); }
};

/// A dielectric whose wave fades faster than this is opaque: 20 dB in 0.2 mm. Metal is far above it, sea water (about 10^3) far below.
inline constexpr double opaque_db_per_m = 1e5;

/// Conductivity in S/m, c f^d, at a frequency in GHz, > 0.
double conductivity(const Dielectric& dielectric, double frequency_ghz);
/// Relative permittivity a f^b - j sigma / (omega eps0) for fields that go with e^(j omega t) (ITU-R P.2040-3): the imaginary part is <= 0.
std::complex<double> permittivity(const Dielectric& dielectric, double frequency_ghz);

/// The material as a wave of a frequency in GHz, > 0, meets it; the result depends on the frequency no more. With a dielectric of permittivity eta, its reflectivity is
/// |(1 - sqrt eta) / (1 + sqrt eta)|^2 (Fresnel, normal incidence) and its attenuation 20 log10(e) omega / c |Im sqrt eta|, infinite above `opaque_db_per_m`. Without
/// one, attenuation_db_per_m f^attenuation_exponent.
Material at_frequency(const Material& material, double frequency_ghz);
std::vector<Material> at_frequency(const std::vector<Material>& materials, double frequency_ghz);

/// What a plane slab in air does to a wave: fractions of its power. What is missing to 1 stays inside.
struct Slab {
  double reflected = 0.0, transmitted = 0.0;
};
/// A slab of a thickness in m, > 0, met at an angle of incidence in [0, pi/2), in rad. Of a dielectric: all inner reflections in phase, the mean of both polarisations
/// (ITU-R P.2040-3, single-layer slab). Of any other material, whose phase is not known: inner reflections added by power, along the straight way.
Slab slab(const Material& material, double frequency_ghz, double thickness_m, double incidence = 0.0);

/// The materials that are shipped (worlds/presets/materials.toml), in the order of the file.
Result<std::vector<Material>> material_presets();

}  // namespace thicket
