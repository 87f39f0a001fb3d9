#include "antenna.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "table.hpp"
#include "thicket/base/pose.hpp"

namespace thicket {
namespace {

/// The border belongs to the opening, and angles that were made of a direction are rounded.
constexpr double border = 1e-12;

/// Turns neighbours on the spiral of a cone, which fills a disc evenly with any number of rays (Vogel 1979).
const double golden_angle = pi * (3.0 - std::sqrt(5.0));

/// Gauss-Legendre over [0, end] in panels of five points: smooth integrands come out to rounding, those with a bend (a gain table) to about 1e-6.
template <class F>
double integral(double end, F&& f) {
  constexpr int panels = 24;
  constexpr std::array<double, 3> nodes = {0.0, 0.5384693101056831, 0.9061798459386640}, weights = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  const double half = 0.5 * end / panels;
  double sum = 0.0;
  for (int p = 0; p < panels; ++p) {
    const double middle = half * (2.0 * p + 1.0);
    sum += weights[0] * f(middle);
    for (std::size_t i = 1; i < nodes.size(); ++i) sum += weights[i] * (f(middle - half * nodes[i]) + f(middle + half * nodes[i]));
  }
  return half * sum;
}

/// Middle of the i-th of n equal parts of an opening about 0.
double middle_of(std::int64_t i, std::int64_t n, double opening) { return opening * ((static_cast<double>(i) + 0.5) / static_cast<double>(n) - 0.5); }

}  // namespace

Antenna::Antenna(const ScanningRadarSpec& spec) : azimuths_(azimuths_of(spec)), rows_opening_(radians(spec.elevation_opening_deg)) {
  const double step = radians(spec.step_deg), cone = radians(spec.cone_opening_deg);
  const bool is_cone = spec.divergence == "cone", has_sides = spec.divergence == "side_rays";
  const double side_angle = has_sides && spec.side_geometry == "diverging" ? std::atan(spec.side_offset_m / spec.range_max_m) : 0.0;
  rows_ = rows_opening_ > 0.0 ? static_cast<std::uint32_t>(spec.elevation_rays) : 1;
  in_row_ = is_cone ? static_cast<std::uint32_t>(spec.cone_rays) : has_sides ? 3 : 1;
  if (is_cone) {
    section_ = Section::drawn_disc;
    half_ = 0.5 * glm::dvec2(cone, rows_opening_ + cone);
    opening_ = 2.0 * half_;
  } else {
    half_ = glm::dvec2(std::max(0.5 * step, side_angle), 0.5 * (rows_opening_ > 0.0 ? rows_opening_ : step));
    opening_ = {0.0, rows_opening_};
  }
  for (std::uint32_t row = 0; row < rows_; ++row) {
    const double elevation = middle_of(row, rows_, rows_opening_);
    SubRay ray;
    ray.elevation = elevation;
    ray.azimuth_cell = is_cone ? cone * std::sqrt(0.25 * pi / in_row_) : step;
    ray.elevation_cell = rows_opening_ > 0.0 ? rows_opening_ / rows_ : ray.azimuth_cell;
    ray.share = std::cos(elevation);
    for (std::uint32_t i = 0; i < in_row_; ++i) {
      ray.index = static_cast<std::uint32_t>(rays_.size());
      if (is_cone) {
        // One ray is the axis; of more, each has a ring of the same area, and is in the middle of that area.
        const double radius = in_row_ == 1 ? 0.0 : half_.x * std::sqrt((i + 0.5) / in_row_);
        ray.azimuth = radius * std::cos(golden_angle * i);
        ray.elevation = elevation + radius * std::sin(golden_angle * i);
      } else {
        ray.side = static_cast<std::int8_t>(i == 0 ? 0 : i == 1 ? 1 : -1);
        ray.azimuth = ray.side * side_angle;
        ray.lateral = has_sides && spec.side_geometry == "parallel" ? ray.side * spec.side_offset_m : 0.0;
      }
      rays_.push_back(ray);
    }
  }
  make_shares_sum_to_one();
  integrate();
}

Antenna::Antenna(const LobeRadarSpec& spec) : azimuths_{0.0}, lobe_(true), section_(spec.section == "elliptic" ? Section::ellipse : Section::rectangle) {
  opening_ = {radians(spec.azimuth_opening_deg), radians(spec.elevation_opening_deg)};
  half_ = 0.5 * opening_;
  if (spec.gain == "gaussian") {
    gain_ = Gain::gaussian;
    half_power_ = spec.gain_width_deg ? 0.5 * glm::dvec2(radians(spec.gain_width_deg->x), radians(spec.gain_width_deg->y)) : half_;
  } else if (spec.gain == "table" && !spec.gain_table_db.empty()) {
    gain_ = Gain::table;
    const double on_axis = value_at(spec.gain_table_db, 0.0);  // sheets print gains against an isotropic antenna, too
    for (const glm::dvec2& point : spec.gain_table_db) table_.emplace_back(radians(point.x), point.y - on_axis);
  }
  integrate();

  const auto rays_over = [&](double opening, std::int64_t rays) { return spec.ray_spacing_m ? rays_for_spacing(opening, *spec.ray_spacing_m, spec.range_max_m) : rays; };
  const std::int64_t columns = rays_over(opening_.x, spec.azimuth_rays), rows = rays_over(opening_.y, spec.elevation_rays);
  in_row_ = static_cast<std::uint32_t>(columns);
  rows_ = static_cast<std::uint32_t>(rows);
  SubRay ray;
  ray.azimuth_cell = opening_.x / static_cast<double>(columns);
  ray.elevation_cell = opening_.y / static_cast<double>(rows);
  for (std::int64_t row = 0; row < rows; ++row) {
    ray.elevation = middle_of(row, rows, opening_.y);
    // The edge of the row that is nearest to the axis: there the section reaches farthest to the sides.
    const double reach = half_width(std::max(0.0, std::abs(ray.elevation) - 0.5 * ray.elevation_cell));
    for (std::int64_t column = 0; column < columns; ++column) {
      ray.azimuth = middle_of(column, columns, opening_.x);
      if (std::abs(ray.azimuth) - 0.5 * ray.azimuth_cell >= reach) continue;
      ray.gain = gain(ray.azimuth, ray.elevation);
      ray.share = ray.gain * ray.gain * std::cos(ray.elevation);
      ray.index = static_cast<std::uint32_t>(rays_.size());
      rays_.push_back(ray);
    }
  }
  make_shares_sum_to_one();
}

void Antenna::make_shares_sum_to_one() {
  double sum = 0.0;
  for (const SubRay& ray : rays_) sum += ray.share;
  // Only a table whose gain is nothing anywhere leaves nothing to share.
  if (sum > 0.0)
    for (SubRay& ray : rays_) ray.share /= sum;
}

SubRay Antenna::jittered(const SubRay& ray, const std::array<double, 2>& u) const {
  if (section_ == Section::drawn_disc) return jittered_in_cone(ray, u);
  SubRay moved = ray;
  moved.azimuth += (u[0] - 0.5) * ray.azimuth_cell;
  if (lobe_) {
    moved.elevation = place_in(ray, u).y;
    moved.gain = gain(moved.azimuth, moved.elevation);
    moved.share = share(ray, moved.gain, std::cos(moved.elevation));
  } else if (rows_opening_ > 0.0) {
    moved.elevation += (u[1] - 0.5) * ray.elevation_cell;
    moved.share = std::cos(moved.elevation) * ray.elevation_cell / (2.0 * std::sin(0.5 * rows_opening_) * in_row_);
  }
  return moved;
}

SubRay Antenna::jittered_in_cone(const SubRay& ray, const std::array<double, 2>& u) const {
  SubRay moved = ray;
  double row = middle_of(ray.index / in_row_, rows_, rows_opening_), turn = u[1];
  if (rows_opening_ > 0.0) {
    // Three numbers out of two: the first 8 bits of the second say where in the row, what follows is as random as before.
    const double place = std::floor(256.0 * u[1]);
    turn = 256.0 * u[1] - place;
    row += ((place + 0.5) / 256.0 - 0.5) * ray.elevation_cell;
    moved.share = std::cos(row) * ray.elevation_cell / (2.0 * std::sin(0.5 * rows_opening_) * in_row_);
  }
  // Anywhere in the ray's own ring: all rings are as large, and together the disc.
  const double radius = half_.x * std::sqrt((ray.index % in_row_ + u[0]) / in_row_);
  moved.azimuth = radius * std::cos(2.0 * pi * turn);
  moved.elevation = row + radius * std::sin(2.0 * pi * turn);
  return moved;
}

double Antenna::half_width(double elevation) const {
  const double height = std::abs(elevation);
  if (height > half_.y * (1.0 + border)) return -1.0;
  if (section_ == Section::rectangle) return half_.x;
  if (section_ == Section::ellipse) return half_.x * std::sqrt(std::max(0.0, 1.0 - height * height / (half_.y * half_.y)));
  const double off = std::max(0.0, height - (half_.y - half_.x));
  return std::sqrt(std::max(0.0, half_.x * half_.x - off * off));
}

double Antenna::gain_within(double azimuth, double elevation) const {
  if (gain_ == Gain::flat) return 1.0;
  if (gain_ == Gain::gaussian) {
    // So far off that nothing is left, in either direction: however narrow the lobe, the squares are numbers.
    const glm::dvec2 off = glm::min(glm::abs(glm::dvec2(azimuth, elevation) / half_power_), 1e3);
    return std::exp(-std::numbers::ln2 * (off.x * off.x + off.y * off.y));
  }
  // (By the tangent: near the axis the cosine alone would lose half the digits of the angle.)
  const glm::dvec3 direction(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
  return std::pow(10.0, 0.1 * value_at(table_, std::atan2(std::hypot(direction.y, direction.z), direction.x)));
}

double Antenna::gain(double azimuth, double elevation) const {
  if (std::abs(azimuth) > half_width(elevation) + border * half_.x) return 0.0;
  return gain_within(azimuth, elevation);
}

double Antenna::gain(const glm::dvec3& direction) const { return gain(std::atan2(direction.y, direction.x), std::atan2(direction.z, std::hypot(direction.x, direction.y))); }

void Antenna::integrate() {
  // Everything is the same on the left as on the right and above as below: four times a quarter. By the sine of t, for the round end of an ellipse.
  const auto over_opening = [&](auto&& f) {
    return 4.0 * integral(0.5 * pi, [&](double t) {
      const double elevation = half_.y * std::sin(t);
      return half_.y * std::cos(t) * std::cos(elevation) * integral(half_width(elevation), [&](double azimuth) { return f(gain_within(azimuth, elevation)); });
    });
  };
  two_way_solid_angle_ = over_opening([](double g) { return g * g; });
  const double one_way = over_opening([](double g) { return g; });
  directivity_ = one_way > 0.0 ? 4.0 * pi / one_way : 0.0;
}

std::vector<double> azimuths_of(const ScannerSpec& spec) {
  const bool full_circle = spec.fov_deg >= 360.0;
  const auto steps = static_cast<long>(std::floor(spec.fov_deg / spec.step_deg + 1e-9));
  const long count = std::max(1L, full_circle ? steps : steps + 1);
  std::vector<double> azimuths;
  for (long i = 0; i < count; ++i) azimuths.push_back(radians(spec.step_deg * static_cast<double>(i) - (full_circle ? 180.0 : 0.5 * spec.step_deg * static_cast<double>(count - 1))));
  return azimuths;
}

std::int64_t rays_for_spacing(double opening, double spacing, double range) {
  constexpr double at_most = 1e9;
  return std::max<std::int64_t>(2, std::llround(std::min(at_most, opening / (2.0 * std::atan(0.5 * spacing / range)) + 1.0)));
}

}  // namespace thicket
