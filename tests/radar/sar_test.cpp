// Images of synthetic aperture against closed forms: the widths of a point, the hyperbola of the simple sum, two points that only the aperture tells apart.
#include <doctest/doctest.h>

#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "lobe.hpp"
#include "thicket/radar/sar.hpp"

using namespace thicket;

namespace {

constexpr double carrier_ghz = 7.29, bandwidth_ghz = 1.5;
const double wave_length = 299792458.0 / (carrier_ghz * 1e9);
/// m, at half the power: the field exp(-x^2 / (2 s^2)) of a spectrum that is 1/10 at half the bandwidth, s = c sqrt(ln 10) / (2 pi B).
const double pulse_width = 2.0 * std::sqrt(std::log(2.0)) * 0.5 * 299792458.0 * std::sqrt(std::log(10.0)) / (pi * bandwidth_ghz * 1e9);

/// A fan of rays, dense enough for a ball of 6 mm at 3 m to be met by several in every scan: its echo is that of a point, whose depth is a tenth of the wave length.
LobeRadarSpec fan(double bin_size = 0.0064256) {
  LobeRadarSpec spec = bare_lobe(65.0, 1, 6.0);
  spec.elevation_opening_deg = 0.25;
  spec.azimuth_rays = 1200;
  spec.elevation_rays = 5;
  spec.scattering = "lambert";
  spec.frequency_ghz = carrier_ghz;
  spec.bandwidth_ghz = bandwidth_ghz;
  spec.bin_size_m = bin_size;
  spec.signal = "iq";
  return spec;
}

Scene balls(const std::vector<glm::dvec2>& places) {
  HandMadeWorld w;
  const auto metal = rough_metal(w);
  for (const glm::dvec2& place : places) {
    Solid ball;
    ball.name = "ball";
    ball.material = metal;
    ball.position = {place, 0.0};
    ball.shape = Sphere{0.006};
    w.world.solids.push_back(ball);
  }
  return traced(w);
}

/// Poses along y at x = 0, looking along +x.
std::vector<Pose> straight_track(double half_length, int steps) {
  std::vector<Pose> poses;
  for (int i = 0; i <= steps; ++i) poses.push_back(Pose::planar(0.0, half_length * (2.0 * i / steps - 1.0), 0.0, 0.0));
  return poses;
}
/// Poses on a circle's arc about (-2, 0) of radius 2, through the origin, looking along +x whatever the way's direction.
std::vector<Pose> arc_track(double half_angle, int steps) {
  std::vector<Pose> poses;
  for (int i = 0; i <= steps; ++i) {
    const double a = half_angle * (2.0 * i / steps - 1.0);
    poses.push_back(Pose::planar(-2.0 + 2.0 * std::cos(a), 2.0 * std::sin(a), 0.0, 0.5 * a));
  }
  return poses;
}

SarImage image_of(const LobeRadarSpec& sensor, const Scene& scene, const std::vector<Pose>& poses, const SarSpec& spec, const std::string& method) {
  SarImage image(spec, method, sensor.frequency_ghz);
  const auto radar = make_sensor(sensor, 0);
  Scan scan;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    radar->measure(scene, poses[i], 0.1 * static_cast<double>(i), i, Random(1, 0), scan);
    image.add(scan, poses[i]);
  }
  return image;
}

SarSpec around(const glm::dvec2& point, double half, double resolution) {
  SarSpec spec;
  spec.resolution_m = resolution;
  spec.bounds_m = {point.x - half, point.y - half, point.x + half, point.y + half};
  return spec;
}

/// rad, over which a track sees a point.
double angle_over(const std::vector<Pose>& poses, const glm::dvec2& point) {
  const auto from = [&](const Pose& p) { return bearing(point - glm::dvec2(p.position)); };
  return std::abs(wrap_angle(from(poses.back()) - from(poses.front())));
}

struct Widths {
  double range, azimuth;
};
/// The point's, checked for its place and for what the image tells of its aperture.
Widths widths_of(const std::vector<Pose>& track, double bin_size, const glm::dvec2& point) {
  const SarImage image = image_of(fan(bin_size), balls({point}), track, around(point, 0.15, 0.0025), "back_projection");
  const SarGrid grid = image.grid();
  const auto peaks = sar_peaks(grid, -12.0, 0.02);
  REQUIRE(!peaks.empty());
  const SarPeak& peak = peaks[0];
  const double angle = angle_over(track, point);
  MESSAGE("bins of ", bin_size, ", point at ", point.x, ": range width ", peak.range_width, " of ", pulse_width, ", azimuth width ", peak.azimuth_width, " of ", sar_azimuth_width(carrier_ghz, angle), " over ", degrees(angle), " degrees");
  // The ball's face is nearer than its middle.
  CHECK(std::abs(peak.position.x - (point.x - 0.005)) < 0.005);
  CHECK(std::abs(peak.position.y - point.y) < 0.002);
  const auto at = grid.index(static_cast<int>((point.x - grid.origin.x) / grid.resolution), static_cast<int>((point.y - grid.origin.y) / grid.resolution));
  CHECK(std::abs(static_cast<double>(grid.aperture[at]) - angle) < 0.06 * angle);
  CHECK(grid.looks[at] == static_cast<float>(track.size()));
  return {peak.range_width, peak.azimuth_width};
}

void check_widths(const std::vector<Pose>& track, double bin_size, const std::vector<double>& places) {
  double range_width = 0.0;
  for (const double x : places) {
    const Widths widths = widths_of(track, bin_size, {x, 0.0});
    const double expected = sar_azimuth_width(carrier_ghz, angle_over(track, {x, 0.0}));
    CHECK(std::abs(widths.azimuth - expected) < 0.10 * expected);
    range_width += widths.range / static_cast<double>(places.size());
  }
  CHECK(std::abs(range_width - pulse_width) < 0.05 * pulse_width);
}

bool same(const SarGrid& a, const SarGrid& b) {
  const auto equal = [](const std::vector<float>& x, const std::vector<float>& y) { return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(float)) == 0; };
  return a.width == b.width && a.height == b.height && a.origin == b.origin && equal(a.amplitude, b.amplitude) && equal(a.looks, b.looks) && equal(a.aperture, b.aperture) && equal(a.bearing, b.bearing);
}

}  // namespace

TEST_CASE("sar: a point is as wide as the pulse and as the aperture let it be, on a straight and on a curved track") {
  for (const double bin_size : {0.0064256, 0.0514}) {
    CAPTURE(bin_size);
    // Of bins that are nearly as long as the pulse, the receiver's sharing of a return between two of them widens the pulse by where it lies, unless the track has it wander over several: on a short one the mean counts.
    const std::vector<double> one = {3.0}, four = {3.0, 3.0 + 0.25 * bin_size, 3.0 + 0.5 * bin_size, 3.0 + 0.75 * bin_size};
    check_widths(straight_track(0.7, 70), bin_size, bin_size < 0.01 ? one : four);
    check_widths(straight_track(1.1, 110), bin_size, one);
    check_widths(arc_track(radians(25.0), 90), bin_size, one);
  }
}

TEST_CASE("sar: the simple sum of a point is the hyperbola of its range") {
  const glm::dvec2 point(2.5, 0.3);
  const auto track = straight_track(1.4, 140);
  SarSpec spec;
  spec.resolution_m = 0.01;
  spec.frame = "line";
  const SarImage image = image_of(fan(), balls({point}), track, spec, "simple_sum");
  const SarGrid grid = image.grid();
  // The line begins at (0, -1.4) and looks along +x: what is right of that is -y.
  const glm::dvec2 in_line = image.from_world(point);
  CHECK(std::abs(in_line.x + 1.7) < 1e-9);
  CHECK(std::abs(in_line.y - 2.5) < 1e-9);
  int columns = 0;
  double worst = 0.0;
  for (int column = 0; column < grid.width; ++column) {
    const double along = grid.centre(column, 0).x, range = std::hypot(in_line.y, along - in_line.x) - 0.006;
    if (along > -0.005 || along < -2.795 || std::abs(std::atan2(along - in_line.x, in_line.y)) > radians(32.0)) continue;
    int best = 0;
    for (int row = 1; row < grid.height; ++row)
      if (grid.amplitude[grid.index(column, row)] > grid.amplitude[grid.index(column, best)]) best = row;
    worst = std::max(worst, std::abs(grid.centre(column, best).y - range));
    ++columns;
  }
  CHECK(columns > 250);
  MESSAGE(columns, " columns, at most off by ", worst, " m");
  CHECK(worst <= 0.016);  // a pixel, half a bin and the ball
}

TEST_CASE("sar: back-projection tells two points apart that lie in one real beam, the simple sum does not") {
  const std::vector<glm::dvec2> points = {{3.0, -0.1}, {3.0, 0.1}};
  const auto track = straight_track(0.9, 120);
  const Scene scene = balls(points);
  const auto middle_against_points = [&](const std::string& method) {
    const SarGrid grid = image_of(fan(), scene, track, around({3.0, 0.0}, 0.3, 0.005), method).grid();
    // The strongest of each column along the track, over the pulse's width.
    const auto at = [&](double y) {
      float most = 0.0f;
      const int row = static_cast<int>((y - grid.origin.y) / grid.resolution);
      for (int column = 0; column < grid.width; ++column) most = std::max(most, grid.amplitude[grid.index(column, row)]);
      return static_cast<double>(most);
    };
    return 20.0 * std::log10(at(0.0025) / std::min(at(-0.0975), at(0.1025)));
  };
  const double focused = middle_against_points("back_projection"), summed = middle_against_points("simple_sum");
  MESSAGE("between the points, against them: back-projection ", focused, " dB, simple sum ", summed, " dB");
  CHECK(focused < -10.0);
  CHECK(summed > -3.0);
}

TEST_CASE("sar: the same bytes for any number of threads, and of a copy that was made on the way") {
  const auto track = straight_track(0.5, 20);
  const Scene scene = balls({{3.0, 0.0}});
  SarSpec spec;
  spec.resolution_m = 0.04;
  const auto with_threads = [&](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    return image_of(fan(), scene, track, spec, "back_projection").grid();
  };
  const SarGrid one = with_threads(1);
  CHECK(one.width > 100);
  CHECK(same(one, with_threads(2)));

  const auto radar = make_sensor(fan(), 0);
  SarImage first(spec, "back_projection", carrier_ghz);
  Scan scan;
  const auto add = [&](SarImage& image, std::size_t i) {
    radar->measure(scene, track[i], 0.1 * static_cast<double>(i), i, Random(1, 0), scan);
    image.add(scan, track[i]);
  };
  for (std::size_t i = 0; i < 10; ++i) add(first, i);
  const SarImage kept = first;
  SarImage second = first;
  const SarGrid then = kept.grid();
  for (std::size_t i = 10; i < track.size(); ++i) {
    add(first, i);
    add(second, i);
  }
  CHECK(same(kept.grid(), then));
  CHECK(!same(first.grid(), then));
  CHECK(same(first.grid(), one));
  CHECK(same(second.grid(), one));
}

TEST_CASE("sar: who stands still adds nothing, and Hann's window lowers the side lobes") {
  const glm::dvec2 point(3.0, 0.0);
  const Scene scene = balls({point});
  std::vector<Pose> track = straight_track(0.4, 20), waiting = track;
  waiting.insert(waiting.begin() + 10, 30, track[10]);
  SarSpec spec = around(point, 0.2, 0.01);
  CHECK(same(image_of(fan(), scene, track, spec, "back_projection").grid(), image_of(fan(), scene, waiting, spec, "back_projection").grid()));
  spec.spacing_m = 0.0;
  CHECK(image_of(fan(), scene, waiting, spec, "back_projection").scans() == waiting.size());

  // Farther than the lobe is wide, so that its opening is the aperture.
  const auto whole = straight_track(1.1, 130);
  const glm::dvec2 near(1.4, 0.0);
  const Scene near_scene = balls({near});
  spec = around(near, 0.2, 0.0025);
  const auto side_lobe = [&](const std::string& window) {
    spec.window = window;
    const SarGrid grid = image_of(fan(), near_scene, whole, spec, "back_projection").grid();
    const auto peaks = sar_peaks(grid, -60.0, 0.012);
    REQUIRE(peaks.size() > 1);
    return std::pair(peaks[1].db, peaks[0].azimuth_width);
  };
  const auto [plain_db, plain_width] = side_lobe("none");
  const auto [hann_db, hann_width] = side_lobe("hann");
  MESSAGE("side lobe ", plain_db, " dB, with Hann's window ", hann_db, " dB; width ", plain_width, " and ", hann_width, " m");
  CHECK(plain_db > -21.0);
  CHECK(hann_db < plain_db - 6.0);
  CHECK(hann_width > 1.2 * plain_width);
}
