#include "thicket/base/random.hpp"

#include <Random123/philox.h>

#include <algorithm>
#include <cmath>

namespace thicket {
namespace {

/// From the constant on.
using Coefficients = std::array<double, 8>;

inline double polynomial(const Coefficients& c, double x) {
  return ((((((c[7] * x + c[6]) * x + c[5]) * x + c[4]) * x + c[3]) * x + c[2]) * x + c[1]) * x + c[0];
}

// AS 241, PPND16: a quotient of polynomials for each of three parts, by the distance of the probability from 1/2.
constexpr double middle_end = 0.425, near_tail_end = 5.0;
constexpr Coefficients middle_over = {3.3871328727963666080e0, 1.3314166789178437745e2, 1.9715909503065514427e3, 1.3731693765509461125e4,
                                      4.5921953931549871457e4, 6.7265770927008700853e4, 3.3430575583588128105e4, 2.5090809287301226727e3};
constexpr Coefficients middle_under = {1.0, 4.2313330701600911252e1, 6.8718700749205790830e2, 5.3941960214247511077e3,
                                       2.1213794301586595867e4, 3.9307895800092710610e4, 2.8729085735721942674e4, 5.2264952788528545610e3};
constexpr Coefficients near_over = {1.42343711074968357734e0, 4.63033784615654529590e0, 5.76949722146069140550e0, 3.64784832476320460504e0,
                                    1.27045825245236838258e0, 2.41780725177450611770e-1, 2.27238449892691845833e-2, 7.74545014278341407640e-4};
constexpr Coefficients near_under = {1.0, 2.05319162663775882187e0, 1.67638483018380384940e0, 6.89767334985100004550e-1,
                                     1.48103976427480074590e-1, 1.51986665636164571966e-2, 5.47593808499534494600e-4, 1.05075007164441684324e-9};
constexpr Coefficients far_over = {6.65790464350110377720e0, 5.46378491116411436990e0, 1.78482653991729133580e0, 2.96560571828504891230e-1,
                                   2.65321895265761230930e-2, 1.24266094738807843860e-3, 2.71155556874348757815e-5, 2.01033439929228813265e-7};
constexpr Coefficients far_under = {1.0, 5.99832206555887937690e-1, 1.36929880922735805310e-1, 1.48753612908506148525e-2,
                                    7.86869131145613259100e-4, 1.84631831751005468180e-5, 1.42151175831644588870e-7, 2.04426310338993978564e-15};

inline double middle_quantile(double from_half) {
  const double x = middle_end * middle_end - from_half * from_half;
  return from_half * polynomial(middle_over, x) / polynomial(middle_under, x);
}

double tail_quantile(double probability) {
  const double r = std::sqrt(-std::log(std::min(probability, 1.0 - probability)));
  const bool near = r <= near_tail_end;
  const double x = r - (near ? 1.6 : near_tail_end), size = near ? polynomial(near_over, x) / polynomial(near_under, x) : polynomial(far_over, x) / polynomial(far_under, x);
  return probability < 0.5 ? -size : size;
}

}  // namespace

double normal_quantile(double probability) { return std::abs(probability - 0.5) <= middle_end ? middle_quantile(probability - 0.5) : tail_quantile(probability); }

std::array<double, 4> Random::uniform(std::uint64_t scan, std::uint32_t beam, RandomUse use, std::uint32_t index) const {
  const r123::Philox4x32::ctr_type counter = {
      {(static_cast<std::uint32_t>(use) << 24) | (index & 0xffffffu), beam, static_cast<std::uint32_t>(scan),
       (static_cast<std::uint32_t>(sensor_) << 16) | (static_cast<std::uint32_t>(scan >> 32) & 0xffffu)}};
  const r123::Philox4x32::key_type key = {{static_cast<std::uint32_t>(seed_), static_cast<std::uint32_t>(seed_ >> 32)}};
  const auto words = r123::Philox4x32{}(counter, key);
  std::array<double, 4> numbers{};
  for (std::size_t i = 0; i < 4; ++i) numbers[i] = (static_cast<double>(words[i]) + 0.5) * 0x1p-32;
  return numbers;
}

std::array<double, 4> Random::normal(std::uint64_t scan, std::uint32_t beam, RandomUse use, std::uint32_t index) const {
  const auto u = uniform(scan, beam, use, index);
  std::array<double, 4> numbers;
  // First all as if they were in the middle, as 85 % are: that is done for two at a time.
  for (std::size_t i = 0; i < 4; ++i) numbers[i] = middle_quantile(u[i] - 0.5);
  for (std::size_t i = 0; i < 4; ++i)
    if (std::abs(u[i] - 0.5) > middle_end) numbers[i] = tail_quantile(u[i]);
  return numbers;
}

}  // namespace thicket
