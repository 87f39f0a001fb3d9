// What matter is made of, as far as rays and robots care.
#pragma once

#include <limits>
#include <string>

namespace thicket {

/// A material. Powers are fractions, dB are of power.
struct Material {
  std::string name;
  double reflectivity = 0.5;  ///< fraction of the power that a surface reflects at normal incidence, 0...1
  double attenuation_db_per_m = std::numeric_limits<double>::infinity();  ///< one way, >= 0; infinite: opaque to radar
  double roughness = 1.0;     ///< 0 mirror ... 1 diffuse
  bool stops_light = true;    ///< a lidar's ray ends at its surface
  bool stops_motion = true;   ///< a robot collides with it

  bool opaque() const { return attenuation_db_per_m == std::numeric_limits<double>::infinity(); }
};

}  // namespace thicket
