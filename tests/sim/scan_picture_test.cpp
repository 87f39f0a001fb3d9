// Plots, and pictures of scans that tests fill by hand: with and without profiles, at one pose and on a way.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "plot.hpp"
#include "temporary_folder.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/image.hpp"
#include "thicket/sim/scan_report.hpp"

namespace thicket {
namespace {

/// A lobe with a receiver that has a wall at `range` and clutter that is the same each time.
Scan lobe_scan(double range, std::uint64_t number) {
  Scan scan;
  scan.number = number;
  scan.range_max = 9.9;
  scan.rays = 3364;
  Profiles& p = scan.profiles;
  p.bins = 188;
  p.first_range = -0.2;
  p.bin_size = 0.0525;
  for (std::uint32_t i = 0; i < p.bins; ++i) {
    const double off = (p.range(i) - range) / 0.12, leak = p.range(i) / 0.15;
    const double noise = 0.006 * std::abs(std::sin(12.9898 * i + 78.233 * static_cast<double>(number)));
    p.amplitude.push_back(static_cast<float>(0.3 / range * std::exp(-0.5 * off * off) + 0.05 * std::exp(-0.5 * leak * leak) + noise));
    p.threshold.push_back(0.038f);
    p.iq.emplace_back(p.amplitude.back(), 0.0f);
  }
  Beam beam;
  beam.sensed_range = 9.9;
  beam.echo_count = 1;
  scan.beams.push_back(beam);
  scan.echoes.push_back({range, static_cast<float>(0.3 / range)});
  return scan;
}

ScanReport lobe_report(int poses) {
  ScanReport report;
  report.world = "a wall";
  report.poses = straight_way({{0.0, 0.0, 1.0}, 0.0, 0.0, {}}, {{3.0, 0.0, 1.0}, 0.0, 0.0, {}}, poses);
  LobeRadarSpec lobe;
  lobe.echoes = "receiver";
  report.sensors.push_back({"lobe", lobe, {}});
  for (int i = 0; i < poses; ++i) report.sensors[0].scans.push_back(lobe_scan(5.0 - report.poses[static_cast<std::size_t>(i)].position.x, static_cast<std::uint64_t>(i)));
  return report;
}

/// A scanning radar with a receiver in a round room.
ScanReport scanning_report() {
  ScanReport report;
  report.world = "a round room";
  report.poses = {{{0.0, 0.0, 0.4}, 30.0, 0.0, {}}};
  Scan scan;
  scan.range_max = 10.0;
  scan.profiles.bins = 100;
  scan.profiles.first_range = 0.05;
  scan.profiles.bin_size = 0.1;
  for (int b = 0; b < 120; ++b) {
    Beam beam;
    beam.azimuth = radians(3.0 * b - 180.0);
    const double range = 6.0 + 2.0 * std::sin(3.0 * beam.azimuth);
    beam.sensed_range = range;
    beam.end = BeamEnd::stopped;
    beam.first_echo = static_cast<std::uint32_t>(scan.echoes.size());
    beam.echo_count = 1;
    const auto strength = static_cast<float>(0.4 + 0.3 * std::cos(beam.azimuth));
    scan.echoes.push_back({range, strength, 0.5f, 0.0f, b % 7 == 0 ? Edge::thin : Edge::front, static_cast<std::uint8_t>(b % 11 == 0 ? 2 : 1)});
    for (std::uint32_t i = 0; i < scan.profiles.bins; ++i) {
      const double off = (scan.profiles.range(i) - range) / 0.15;
      scan.profiles.amplitude.push_back(static_cast<float>(strength * std::exp(-0.5 * off * off) + 0.002 * (1.0 + std::sin(7.1 * i + 3.7 * b))));
      scan.profiles.threshold.push_back(0.02f);
    }
    scan.beams.push_back(beam);
  }
  ScannerSpec plane;
  plane.step_deg = 3.0;
  ScanningRadarSpec radar;
  static_cast<ScannerSpec&>(radar) = plane;
  radar.echoes = "receiver";
  report.sensors.push_back({"scanning", radar, {std::move(scan)}});
  return report;
}

std::string drawn(const ScanReport& report, const std::string& name, int width, int height_least) {
  const TemporaryFolder folder;
  const auto file = folder.path() / name;
  const auto written = draw_scans(report, file);
  REQUIRE_MESSAGE(static_cast<bool>(written), (written ? "" : written.error().message));
  const auto image = read_image(file);
  REQUIRE(image);
  CHECK(image->width == width);
  CHECK(image->height >= height_least);
  std::size_t inked = 0;
  for (const std::uint8_t grey : image->pixels) inked += grey < 250;
  CHECK(inked > image->pixels.size() / 200);
  return *read_text_file(file);
}

}  // namespace

TEST_CASE("scan plots: ticks are 1, 2 or 5 apart and none is outside") {
  using List = std::vector<double>;
  CHECK(nice_ticks(0.0, 10.0, 11) == List{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
  CHECK(nice_ticks(0.0, 10.0, 10) == List{0, 2, 4, 6, 8, 10});
  CHECK(nice_ticks(0.0, 10.0, 3) == List{0, 5, 10});
  CHECK(nice_ticks(-61.0, -9.0, 6) == List{-60, -50, -40, -30, -20, -10});
  CHECK(even_ticks(-180.0, 180.0, 90.0) == List{-180, -90, 0, 90, 180});
  CHECK(nice_ticks(1.0, 1.0, 5).empty());
  CHECK(nice_ticks(0.0, INFINITY, 5).empty());
  for (const double high : {1e-6, 0.03, 0.7, 1.0, 12.5, 999.0, 4e7}) {
    const List ticks = nice_ticks(-0.3 * high, high, 8);
    CHECK(ticks.size() >= 3);
    CHECK(ticks.size() <= 8);
    CHECK(ticks.front() >= -0.3 * high * (1.0 + 1e-6));
    CHECK(ticks.back() <= high * (1.0 + 1e-6));
    const double step = (ticks[1] - ticks[0]) / std::pow(10.0, std::floor(std::log10(ticks[1] - ticks[0]) + 1e-9));
    CHECK_MESSAGE((std::abs(step - 1.0) < 1e-6 || std::abs(step - 2.0) < 1e-6 || std::abs(step - 5.0) < 1e-6), step);
  }
  CHECK(tick_labels({-0.5, 0.0, 0.5}) == std::vector<std::string>{"−0.5", "0.0", "0.5"});
  CHECK(tick_labels({0.0, 200.0}) == std::vector<std::string>{"0", "200"});
}

TEST_CASE("scan plots: colours grow lighter evenly") {
  double last = -1.0;
  for (int i = 0; i <= 20; ++i) {
    const Colour c = heat_colour(i / 20.0);
    const double light = 0.2126 * c.red + 0.7152 * c.green + 0.0722 * c.blue;
    CHECK(light > last);
    last = light;
  }
}

TEST_CASE("scan pictures with profiles: a lobe, a way, a scanning receiver, the same bytes twice") {
  for (const auto& [report, width, height] : {std::tuple{lobe_report(1), 940, 400}, {lobe_report(40), 1000, 700}, {scanning_report(), 940, 1000}})
    CHECK(drawn(report, "a.png", width, height) == drawn(report, "b.png", width, height));
  // One with another, one above the other.
  ScanReport two = lobe_report(1);
  two.sensors.push_back(two.sensors[0]);
  two.sensors[1].name = "other";
  drawn(two, "two.png", 940, 700);
}

TEST_CASE("scan pictures without echoes, and of echoes of few beams") {
  ScanReport report = lobe_report(1);
  report.sensors[0].scans[0].profiles = {};
  drawn(report, "stems.png", 940, 400);
  for (ScanReport empty : {report, scanning_report(), lobe_report(3)}) {
    for (Scan& scan : empty.sensors[0].scans) {
      scan.echoes.clear();
      scan.profiles = {};
      for (Beam& beam : scan.beams) beam.first_echo = beam.echo_count = 0;
    }
    const TemporaryFolder folder;
    CHECK(draw_scans(empty, folder.path() / "empty.png"));
  }
}

TEST_CASE("scan text of a lobe with hundreds of echoes names the strongest") {
  ScanReport report = lobe_report(1);
  Scan& scan = report.sensors[0].scans[0];
  scan.profiles = {};
  scan.echoes.clear();
  for (int i = 0; i < 300; ++i) scan.echoes.push_back({1.0 + 0.01 * i, i == 250 ? 1.0f : 1e-3f / static_cast<float>(1 + i)});
  scan.beams[0].echo_count = 300;
  const std::string table = scan_table(report);
  CHECK_MESSAGE(table.find("3.500 m     0.0 dB front") != std::string::npos, table);
  CHECK_MESSAGE(table.find("and 260 weaker ones, which --csv tells") != std::string::npos, table);
  CHECK(std::count(table.begin(), table.end(), '\n') < 60);
}

TEST_CASE("scan text of a receiver: detections, tops, and a row for each range bin") {
  const ScanReport report = lobe_report(1);
  const std::string table = scan_table(report);
  CHECK_MESSAGE(table.find("1 detection") != std::string::npos, table);
  CHECK_MESSAGE(table.find("strongest tops of the profile") != std::string::npos, table);
  const std::string csv = profile_csv(report);
  CHECK(csv.starts_with("beam,range_m,amplitude,threshold,i,q\n0,-0.2,"));
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 189);
  const std::string way = scan_csv(lobe_report(4));
  CHECK(way.starts_with("scan,way_m,x_m,y_m,z_m,yaw_deg,pitch_deg,echoes,"));
  CHECK(std::count(way.begin(), way.end(), '\n') == 5);
}

}  // namespace thicket
