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
  double attenuation_exponent = 0.0;     ///< attenuation_db_per_m grows with (f / 1 GHz)^this
  std::optional<Dielectric> dielectric = std::nullopt;  ///< where there is one, reflectivity and attenuation follow from it
  std::string source = {};               ///< where the numbers come from

  bool opaque() const { return attenuation_db_per_m == std::numeric_limits<double>::infinity(); }
};

}  // namespace thicket
