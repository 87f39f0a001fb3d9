#include "thicket/radar/sar.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include <glm/geometric.hpp>

#include "turns.hpp"
#include "wave.hpp"

namespace thicket {
namespace {

/// Pixels along the edge of a tile, and in a tile.
constexpr int edge = 32, area = edge * edge;
/// Bins of nothing before and behind a profile, so that four neighbours can be read anywhere.
constexpr int padding = 2;

/// m: bins longer than this are made finer before they are read between.
constexpr double fine_bin = 0.01;
/// Bins on either side that a finer bin is made of.
constexpr int sinc_reach = 8;

std::complex<float> bin_of(std::span<const std::complex<float>> profile, std::ptrdiff_t i) { return i >= 0 && i < std::ssize(profile) ? profile[static_cast<std::size_t>(i)] : std::complex<float>(); }

/// A receiver shares a return between the two bins next to it, by where it lies, which over all places is a convolution with a triangle: sinc^2 in frequency. Its inverse, to the fourth order in differences.
std::vector<std::complex<float>> without_sharing(std::span<const std::complex<float>> from) {
  std::vector<std::complex<float>> to(from.size());
  for (std::ptrdiff_t i = 0; i < std::ssize(from); ++i) {
    const auto at = [&](std::ptrdiff_t off) { return bin_of(from, i + off); };
    const std::complex<float> second = at(-1) - 2.0f * at(0) + at(1), fourth = at(-2) - 4.0f * at(-1) + 6.0f * at(0) - 4.0f * at(1) + at(2);
    to[static_cast<std::size_t>(i)] = at(0) - second / 12.0f + fourth / 90.0f;
  }
  return to;
}

/// I and Q of a beam with so many bins for one, and padding: Hann's window over a sinc.
void refine(std::span<const std::complex<float>> from, int times, std::vector<std::complex<float>>& to) {
  to.assign((from.size() - 1) * static_cast<std::size_t>(times) + 1 + 2 * padding, {});
  if (times == 1) {
    std::copy(from.begin(), from.end(), to.begin() + padding);
    return;
  }
  const auto sharp = without_sharing(from);
  for (int part = 0; part < times; ++part) {
    const double t = static_cast<double>(part) / times;
    std::array<float, 2 * sinc_reach + 1> weights{};
    for (int n = -sinc_reach; n <= sinc_reach; ++n) {
      const double x = t - n, c = std::cos(0.5 * pi * x / sinc_reach);
      weights[static_cast<std::size_t>(n + sinc_reach)] = std::abs(x) >= sinc_reach ? 0.0f : static_cast<float>(x == 0.0 ? 1.0 : c * c * std::sin(pi * x) / (pi * x));
    }
    for (std::ptrdiff_t i = 0; i < std::ssize(from) && i * times + part < std::ssize(to) - 2 * padding; ++i) {
      std::complex<float> sum;
      for (int n = -sinc_reach; n <= sinc_reach; ++n) sum += weights[static_cast<std::size_t>(n + sinc_reach)] * bin_of(sharp, i + n);
      to[static_cast<std::size_t>(i * times + part + padding)] = sum;
    }
  }
}

}  // namespace

struct SarImage::Tile {
  std::array<double, area> re{}, im{};
  std::array<float, area> looks{}, east{}, north{};  ///< sums of weights, and of the directions in which the pixel was seen by their weights
};

/// A scan as the image's frame sees it.
struct SarImage::View {
  glm::dvec3 at{0.0};                ///< the sensor, m; z above the image's plane
  glm::dvec3 ahead, left, up;        ///< its axes
  double range_min = 0.0, range_max = 0.0, first_range = 0.0, bin_size = 1.0;
  int bins = 0;
  double cosine_azimuth = -1.0, sine_azimuth = 0.0, sine_elevation = 1.0;  ///< of half the opening
  double azimuth_opening = 0.0;
  bool hann = false;
  double turns_per_m = 0.0;
  std::vector<std::complex<float>> iq;  ///< with its padding
  std::span<const float> amplitude;
  double line_width = 0.0;
  // Pixels that there may be: first and last column and row.
  std::array<std::int64_t, 4> pixels{};

  bool may_see(const glm::dvec3& from_sensor, double radius) const;
  std::uint64_t back_project(Tile& tile, const Place& place, double resolution) const;
  std::uint64_t lay_along_line(Tile& tile, const Place& place, double resolution) const;
};

const Section& sar_section() {
  using S = SarSpec;
  static const Section section =
      SectionOf<S>("[sar]", "an image of synthetic aperture: what one lobe saw along its way, laid together (docs/sar.md)")
          .key("enabled", &S::enabled, "make the image: sar.png, sar.npy and sar.json")
          .key("sensor", &S::sensor, "name of a lobe radar with echoes = \"receiver\"; empty: the first one")
          .choice("method", &S::method, {"auto", "simple_sum", "back_projection"}, "simple_sum: amplitude profiles along the lobe's axis (Billdal 2018) | back_projection: coherent, needs signal = \"iq\" | auto: back_projection if the sensor has I and Q")
          .choice("frame", &S::frame, {"world", "line"}, "world: x east, y north | line: y as the lobe looks at its first scan, x to the right of that, from where the sensor then is")
          .key("bounds_m", &S::bounds_m, "m", between(-1e9, 1e9), "x_min, y_min, x_max, y_max of the image, in its frame; not given: all that comes into the lobe")
          .key("resolution_m", &S::resolution_m, "m", above_up_to(0.0, 10.0), "edge of a pixel; what back_projection resolves is about 8 cm by 2 cm with an X4M05")
          .key("height_m", &S::height_m, "m", between(-1e9, 1e9), "height of the image's plane in the world; not given: that of the sensor at its first scan")
          .key("spacing_m", &S::spacing_m, "m", between(0.0, 1e3), "a scan counts if the sensor (or its axis, at range_max_m) has moved as far since the last that did; 0: every scan")
          .choice("window", &S::window, {"none", "hann"}, "hann: of back_projection, weights over the lobe's azimuth opening, for lower side lobes and wider points")
          .key("floor_db", &S::floor_db, "dB", between(-200.0, -1.0), "what the picture and the list of peaks go down to, against the brightest pixel")
          .key("fuse", &S::fuse, "take cells off the map where the image has no return: map_fused.pgm and map_fused.yaml")
          .key("fuse_threshold_db", &S::fuse_threshold_db, "dB", between(-200.0, 0.0), "a cell is false whose return is weaker, against the strongest within fuse_radius_m")
          .key("fuse_radius_m", &S::fuse_radius_m, "m", above_up_to(0.0, 1e3), "where the strongest return around a cell is looked for")
          .key("fuse_aperture_deg", &S::fuse_aperture_deg, "deg", between(0.0, 360.0), "the image has a say where it saw a cell over as wide an angle at least");
  return section;
}

SarImage::SarImage(const SarSpec& spec, const std::string& method, double frequency_ghz) : spec_(spec), method_(method), frequency_ghz_(frequency_ghz) {}

double sar_azimuth_width(double frequency_ghz, double angle) { return 0.886 * light_speed / (frequency_ghz * 1e9) / (4.0 * std::sin(0.5 * angle)); }

bool SarImage::counts(const Scan& scan, const Pose& sensor) {
  if (scan.profiles.bins == 0 || (method_ == "back_projection" && scan.profiles.iq.empty())) return false;
  const glm::dvec3 ahead = sensor.orientation * glm::dvec3(1.0, 0.0, 0.0);
  if (scans_ == 0) {
    height_ = spec_.height_m.value_or(sensor.position.z);
    if (spec_.frame == "line") frame_ = {{sensor.position.x, sensor.position.y}, bearing({ahead.x, ahead.y}) - 0.5 * pi};
  } else {
    const double moved = glm::distance(sensor.position, last_.position);
    const glm::dvec3 end = sensor.position + scan.range_max * ahead, last_end = last_.position + last_.orientation * glm::dvec3(scan.range_max, 0.0, 0.0);
    if (std::max(moved, glm::distance(end, last_end)) < spec_.spacing_m) return false;
    line_width_ = std::max(spec_.resolution_m, moved);
  }
  if (scans_ == 0) line_width_ = spec_.resolution_m;
  last_ = sensor;
  ++scans_;
  const glm::dvec2 at = frame_.to_inner({sensor.position.x, sensor.position.y});
  if (track_.empty() || glm::distance(track_.back(), at) >= spec_.resolution_m) track_.push_back(at);
  return true;
}

SarImage::View SarImage::view_of(const Scan& scan, const Pose& sensor) const {
  View view;
  const auto turned = [&](const glm::dvec3& axis) {
    const glm::dvec3 world = sensor.orientation * axis;
    const glm::dvec2 inner = Pose2{{0.0, 0.0}, frame_.yaw}.to_inner({world.x, world.y});
    return glm::dvec3(inner, world.z);
  };
  view.at = {frame_.to_inner({sensor.position.x, sensor.position.y}), sensor.position.z - height_};
  view.ahead = turned({1.0, 0.0, 0.0});
  view.left = turned({0.0, 1.0, 0.0});
  view.up = turned({0.0, 0.0, 1.0});
  const Profiles& p = scan.profiles;
  view.bins = static_cast<int>(p.bins);
  view.first_range = p.first_range;
  view.bin_size = p.bin_size;
  view.range_min = std::max(scan.range_min, p.first_range);
  view.range_max = std::min(scan.range_max, p.range(p.bins - 1));
  view.azimuth_opening = scan.azimuth_opening;
  view.cosine_azimuth = std::cos(std::min(pi, 0.5 * scan.azimuth_opening));
  view.sine_azimuth = std::sin(std::min(pi, 0.5 * scan.azimuth_opening));
  view.sine_elevation = std::sin(std::min(0.5 * pi, 0.5 * scan.elevation_opening));
  view.hann = spec_.window == "hann";
  view.turns_per_m = 2.0 * frequency_ghz_ * 1e9 / light_speed;
  view.line_width = line_width_;
  if (method_ == "back_projection") {
    const int times = std::max(1, static_cast<int>(std::ceil(p.bin_size / fine_bin)));
    refine(std::span(p.iq).first(p.bins), times, view.iq);
    view.bin_size /= times;
  } else view.amplitude = p.amplitude_of(0);
  // (A billionth of a pixel: bounds that lie on edges of pixels.)
  const double all = 0x1p50, fine = 1e-9;
  const glm::dvec4 b = spec_.bounds_m.value_or(glm::dvec4(-all, -all, all, all) * spec_.resolution_m) / spec_.resolution_m;
  view.pixels = {static_cast<std::int64_t>(std::ceil(b.x - 0.5 - fine)), static_cast<std::int64_t>(std::floor(b.z - 0.5 + fine)), static_cast<std::int64_t>(std::ceil(b.y - 0.5 - fine)),
                 static_cast<std::int64_t>(std::floor(b.w - 0.5 + fine))};
  return view;
}

/// Whether anything within a radius of a point can lie in the lobe; never wrongly no.
bool SarImage::View::may_see(const glm::dvec3& from_sensor, double radius) const {
  const double range = glm::length(from_sensor);
  if (range - radius > range_max || range + radius < range_min) return false;
  const double x = glm::dot(from_sensor, ahead), y = glm::dot(from_sensor, left);
  if (!amplitude.empty()) return x > -radius && std::abs(y) < radius + line_width;
  return cosine_azimuth < 0.0 || std::abs(y) * cosine_azimuth - x * sine_azimuth <= radius;
}

std::vector<std::pair<SarImage::Place, SarImage::Tile*>> SarImage::tiles_for(const View& view) {
  const double size = edge * spec_.resolution_m, radius = 0.7072 * size;
  const auto tile_at = [&](double coordinate) { return static_cast<std::int64_t>(std::floor(coordinate / size)); };
  const auto tile_of = [](std::int64_t pixel) { return pixel >= 0 ? pixel / edge : -((edge - 1 - pixel) / edge); };
  const std::int64_t first_column = std::max(tile_at(view.at.x - view.range_max), tile_of(view.pixels[0])), last_column = std::min(tile_at(view.at.x + view.range_max), tile_of(view.pixels[1]));
  const std::int64_t first_row = std::max(tile_at(view.at.y - view.range_max), tile_of(view.pixels[2])), last_row = std::min(tile_at(view.at.y + view.range_max), tile_of(view.pixels[3]));
  std::vector<std::pair<Place, Tile*>> list;
  for (std::int64_t row = first_row; row <= last_row; ++row) {
    for (std::int64_t column = first_column; column <= last_column; ++column) {
      const glm::dvec3 middle((static_cast<double>(column) + 0.5) * size, (static_cast<double>(row) + 0.5) * size, 0.0);
      if (!view.may_see(middle - view.at, radius)) continue;
      std::shared_ptr<Tile>& tile = tiles_[{row, column}];
      if (!tile) tile = std::make_shared<Tile>();
      else if (tile.use_count() > 1) tile = std::make_shared<Tile>(*tile);
      list.emplace_back(Place{row, column}, tile.get());
    }
  }
  return list;
}

std::uint64_t SarImage::View::back_project(Tile& tile, const Place& place, double resolution) const {
  std::uint64_t added = 0;
  std::array<double, edge> east, north, range, turns, cosine, sine, azimuth_cosine{}, azimuth_sine{};
  std::array<std::uint8_t, edge> inside;
  for (int j = 0; j < edge; ++j) {
    const std::int64_t row = place.first * edge + j, first = place.second * edge;
    const double y = (static_cast<double>(row) + 0.5) * resolution - at.y, z = -at.z;
    if (std::abs(y) > range_max || row < pixels[2] || row > pixels[3]) continue;
    std::uint8_t any = 0;
    for (int i = 0; i < edge; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double x = (static_cast<double>(first + i) + 0.5) * resolution - at.x, r = std::sqrt(x * x + y * y + z * z);
      const double forward = x * ahead.x + y * ahead.y + z * ahead.z, sideways = x * left.x + y * left.y + z * left.z, upward = x * up.x + y * up.y + z * up.z;
      const std::uint8_t ok = (r >= range_min) & (r <= range_max) & (forward >= cosine_azimuth * std::sqrt(forward * forward + sideways * sideways)) & (std::abs(upward) <= sine_elevation * r) &
                              (first + i >= pixels[0]) & (first + i <= pixels[1]);
      east[k] = x;
      north[k] = y;
      range[k] = r;
      turns[k] = r * turns_per_m;  // half the carrier's wave length a turn: the way is there and back
      azimuth_cosine[k] = forward;
      azimuth_sine[k] = sideways;
      inside[k] = ok;
      any |= ok;
    }
    if (!any) continue;
    cosine_and_sine(turns, cosine, sine);
    for (std::size_t i = 0; i < edge; ++i) {
      if (!inside[i]) continue;
      const double where = (range[i] - first_range) / bin_size, t = where - std::floor(where);
      const std::complex<float>* const from = iq.data() + static_cast<std::ptrdiff_t>(where) + padding - 1;
      // Lagrange's cubic through the four bins about it. The receiver's field has the phase -4 pi f r / c of its return's own range, and its envelope moves slowly: no carrier runs along a profile.
      const std::array<double, 4> weight = {-t * (t - 1.0) * (t - 2.0) / 6.0, (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0, -(t + 1.0) * t * (t - 2.0) / 2.0, (t + 1.0) * t * (t - 1.0) / 6.0};
      double re = 0.0, im = 0.0;
      for (std::size_t n = 0; n < 4; ++n) {
        re += weight[n] * static_cast<double>(from[n].real());
        im += weight[n] * static_cast<double>(from[n].imag());
      }
      double share = 1.0;
      if (hann) {
        const double c = std::cos(pi * std::atan2(azimuth_sine[i], azimuth_cosine[i]) / azimuth_opening);
        share = c * c;
      }
      const std::size_t pixel = static_cast<std::size_t>(j) * edge + i;
      tile.re[pixel] += share * (re * cosine[i] - im * sine[i]);
      tile.im[pixel] += share * (re * sine[i] + im * cosine[i]);
      tile.looks[pixel] += static_cast<float>(share);
      const double level = std::sqrt(east[i] * east[i] + north[i] * north[i]), unit = level > 0.0 ? share / level : 0.0;
      tile.east[pixel] += static_cast<float>(unit * east[i]);
      tile.north[pixel] += static_cast<float>(unit * north[i]);
      ++added;
    }
  }
  return added;
}

std::uint64_t SarImage::View::lay_along_line(Tile& tile, const Place& place, double resolution) const {
  std::uint64_t added = 0;
  const double level = std::sqrt(ahead.x * ahead.x + ahead.y * ahead.y);  // of the axis over the ground, against its length
  if (!(level > 1e-6)) return 0;
  const double ux = ahead.x / level, uy = ahead.y / level;
  for (int j = 0; j < edge; ++j) {
    const std::int64_t row = place.first * edge + j;
    if (row < pixels[2] || row > pixels[3]) continue;
    const double y = (static_cast<double>(row) + 0.5) * resolution - at.y;
    for (int i = 0; i < edge; ++i) {
      const std::int64_t column = place.second * edge + i;
      const double x = (static_cast<double>(column) + 0.5) * resolution - at.x;
      const double across = std::abs(x * uy - y * ux), range = (x * ux + y * uy) / level;
      if (across >= line_width || !(range >= range_min && range <= range_max) || column < pixels[0] || column > pixels[1]) continue;
      const double where = (range - first_range) / bin_size, share = 1.0 - across / line_width;
      const auto bin = std::min(static_cast<std::size_t>(where), static_cast<std::size_t>(std::max(0, bins - 2)));
      const double t = where - static_cast<double>(bin), here = static_cast<double>(amplitude[bin]), next = bins > 1 ? static_cast<double>(amplitude[bin + 1]) : here;
      const std::size_t pixel = static_cast<std::size_t>(j) * edge + static_cast<std::size_t>(i);
      tile.re[pixel] += share * (here + t * (next - here));
      tile.looks[pixel] += static_cast<float>(share);
      tile.east[pixel] += static_cast<float>(share * ux);
      tile.north[pixel] += static_cast<float>(share * uy);
      ++added;
    }
  }
  return added;
}

void SarImage::add(const Scan& scan, const Pose& sensor) {
  if (!counts(scan, sensor)) return;
  const View view = view_of(scan, sensor);
  const auto list = tiles_for(view);
  std::vector<std::uint64_t> added(list.size());
  const bool coherent = method_ == "back_projection";
  tbb::parallel_for(std::size_t{0}, list.size(), [&](std::size_t t) {
    const auto& [place, tile] = list[t];
    added[t] = coherent ? view.back_project(*tile, place, spec_.resolution_m) : view.lay_along_line(*tile, place, spec_.resolution_m);
  });
  for (const std::uint64_t n : added) pixels_added_ += n;
}

std::size_t SarImage::memory_bytes() const { return tiles_.size() * sizeof(Tile) + track_.size() * sizeof(glm::dvec2); }

namespace {

/// rad: the width of an even spread of directions whose mean has this length, sin(u) / u with u half of it.
double spread_of(double mean_length) {
  if (mean_length >= 1.0) return 0.0;
  double u = std::sqrt(6.0 * (1.0 - mean_length));
  for (int step = 0; step < 6 && u > 1e-3; ++step) {
    u = std::min(u, 3.1);
    const double slope = (std::cos(u) * u - std::sin(u)) / (u * u);
    u -= (std::sin(u) / u - mean_length) / slope;
  }
  return 2.0 * std::clamp(u, 0.0, pi);
}

}  // namespace

SarGrid SarImage::grid() const {
  SarGrid grid;
  grid.resolution = spec_.resolution_m;
  std::array<std::int64_t, 4> limits{INT64_MAX, INT64_MIN, INT64_MAX, INT64_MIN};  // first and last column and row
  if (spec_.bounds_m) {
    const glm::dvec4 b = *spec_.bounds_m / spec_.resolution_m;
    limits = {static_cast<std::int64_t>(std::ceil(b.x - 0.5 - 1e-9)), static_cast<std::int64_t>(std::floor(b.z - 0.5 + 1e-9)), static_cast<std::int64_t>(std::ceil(b.y - 0.5 - 1e-9)),
              static_cast<std::int64_t>(std::floor(b.w - 0.5 + 1e-9))};
  }
  const auto each = [&](auto&& use) {
    for (const auto& [place, tile] : tiles_)
      for (std::size_t pixel = 0; pixel < area; ++pixel)
        if (tile->looks[pixel] > 0.0f) use(*tile, pixel, place.second * edge + static_cast<std::int64_t>(pixel % edge), place.first * edge + static_cast<std::int64_t>(pixel / edge));
  };
  if (!spec_.bounds_m)
    each([&](const Tile&, std::size_t, std::int64_t column, std::int64_t row) {
      limits = {std::min(limits[0], column), std::max(limits[1], column), std::min(limits[2], row), std::max(limits[3], row)};
    });
  if (scans_ == 0 || limits[0] > limits[1] || limits[2] > limits[3]) return grid;
  grid.width = static_cast<int>(limits[1] - limits[0] + 1);
  grid.height = static_cast<int>(limits[3] - limits[2] + 1);
  grid.origin = glm::dvec2(static_cast<double>(limits[0]), static_cast<double>(limits[2])) * spec_.resolution_m;
  const std::size_t count = static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height);
  for (auto* values : {&grid.amplitude, &grid.looks, &grid.aperture, &grid.bearing}) values->assign(count, 0.0f);
  each([&](const Tile& tile, std::size_t pixel, std::int64_t column, std::int64_t row) {
    const std::size_t i = grid.index(static_cast<int>(column - limits[0]), static_cast<int>(row - limits[2]));
    const double looks = static_cast<double>(tile.looks[pixel]), east = static_cast<double>(tile.east[pixel]), north = static_cast<double>(tile.north[pixel]);
    grid.amplitude[i] = static_cast<float>(std::hypot(tile.re[pixel], tile.im[pixel]));
    grid.looks[i] = tile.looks[pixel];
    grid.aperture[i] = static_cast<float>(spread_of(std::hypot(east, north) / looks));
    grid.bearing[i] = static_cast<float>(std::atan2(north, east));
  });
  return grid;
}

}  // namespace thicket
