// Images of synthetic aperture as missions make them: keys, files, `thicket sar`, copies on the way, and what they take off a map.
#include <doctest/doctest.h>

#include <cstring>
#include <string>

#include "finished.hpp"
#include "program_call.hpp"
#include "thicket/sim/sar.hpp"
#include "thicket/sim/simulation.hpp"

namespace thicket {
namespace {

Mission strafing(const std::vector<Override>& more = {}) {
  auto mission = read_mission(find_input("sar/strafe"), more);
  if (!mission) FAIL(mission.error().message);
  return *mission;
}

/// What the reader says of the mission with a change.
std::string fault_with(const std::vector<Override>& more) {
  const auto mission = read_mission(find_input("sar/strafe"), more);
  return mission ? "" : mission.error().message;
}

bool same_image(const Simulation& a, const Simulation& b) {
  const SarGrid x = a.sar()->grid(), y = b.sar()->grid();
  return x.width == y.width && x.height == y.height && std::memcmp(x.amplitude.data(), y.amplitude.data(), x.amplitude.size() * sizeof(float)) == 0;
}

/// The brightest within a distance of a point.
const SarPeak* peak_near(const SarReport& report, const glm::dvec2& point, double distance) {
  for (const SarPeak& peak : report.peaks)
    if (glm::distance(peak.position, point) < distance) return &peak;
  return nullptr;
}

}  // namespace

TEST_CASE("sar: the keys of [sar] are read, written, and judged together") {
  const Mission mission = strafing({{"sar.window", "\"hann\"", "test"}, {"sar.height_m", "0.9", "test"}});
  CHECK(mission.sar.enabled);
  CHECK(has(write_mission(mission), "window = \"hann\""));
  CHECK(has(write_mission(mission), "height_m = 0.9"));
  CHECK(has(describe_mission_file(), "[sar]"));
  CHECK(!Mission{}.sar.enabled);

  CHECK(has(fault_with({{"sar.sensor", "\"rihgt\"", "test"}}), "did you mean 'right'"));
  CHECK(has(fault_with({{"sar.method", "\"back\"", "test"}}), "back_projection"));
  CHECK(has(fault_with({{"sensor.signal", "\"amplitude\"", "test"}, {"sar.method", "\"back_projection\"", "test"}}), "expected signal = \"iq\""));
  CHECK(has(fault_with({{"sensor.signal", "\"amplitude\"", "test"}}), "simple sum"));  // and fuse is on
  CHECK(fault_with({{"sensor.signal", "\"amplitude\"", "test"}, {"sar.fuse", "false", "test"}}).empty());
  CHECK(has(fault_with({{"map.enabled", "false", "test"}}), "expected a map"));
  CHECK(has(fault_with({{"sensor.echoes", "\"traced\"", "test"}}), "x4m05"));
  CHECK(has(fault_with({{"sar.bounds_m", "[1, 0, 0, 1]", "test"}}), "is empty"));
  CHECK(has(fault_with({{"sar.resolution_m", "0.0005", "test"}}), "coarser"));
}

TEST_CASE("sar: the strafing mission's image shows posts and plate where they are, and is the same of a run that was copied on the way") {
  const Mission mission = strafing();
  auto created = Simulation::create(mission);
  REQUIRE(created);
  Simulation run = *created;
  while (run.time() < 6.0 && run.step()) {
  }
  const std::uint64_t scans = run.sar()->scans();
  Simulation copy = run;
  while (run.step()) {
  }
  CHECK(copy.sar()->scans() == scans);
  while (copy.step()) {
  }
  CHECK(run.sar()->scans() > 2 * scans);
  CHECK(same_image(run, copy));
  CHECK(state_hash(run) == state_hash(copy));

  const auto report = report_sar(run);
  REQUIRE(report);
  for (const glm::dvec2 post : {glm::dvec2(2.0, 0.55), glm::dvec2(2.0, 0.05)}) {
    const SarPeak* peak = peak_near(*report, post, 0.04);
    REQUIRE(peak);
    CHECK(peak->db > -12.0);
    CHECK(peak->azimuth_width < 0.08);
  }
}

TEST_CASE("sar: what the image takes off the map was false") {
  const auto report = report_sar(finished(strafing()));
  REQUIRE(report);
  REQUIRE(report->fusion);
  REQUIRE(report->before);
  REQUIRE(report->after);
  MESSAGE("claimed ", report->fusion->claimed, ", judged ", report->fusion->judged, ", taken off ", report->fusion->removed, "; F1 ", report->before->f1, " -> ", report->after->f1, ", precision ",
          report->before->precision, " -> ", report->after->precision, ", recall ", report->before->recall, " -> ", report->after->recall);
  CHECK(report->fusion->removed > 0);
  CHECK(report->after->precision > report->before->precision + 0.05);
  CHECK(report->after->f1 > report->before->f1);
  CHECK(report->after->recall == report->before->recall);
}

TEST_CASE("sar: cells that the image did not see, or did not see well, stay") {
  SarSpec spec;
  spec.bounds_m = {0.0, 0.0, 1.0, 1.0};
  const SarImage nothing(spec, "back_projection", 7.29);
  ProbabilityGrid map{10, 10, 0.1, {0.0, 0.0}, std::vector<float>(100, 0.9f), {}};
  const SarFusion fusion = fuse_sar(map, nothing);
  CHECK(fusion.claimed == 100);
  CHECK(fusion.judged == 0);
  CHECK(fusion.removed == 0);
  // A lobe that stands still sees over no angle.
  const Simulation standing = finished(strafing({{"limits.time_s", "0.2", "test"}}));
  const auto report = report_sar(standing);
  REQUIRE(report);
  REQUIRE(report->fusion);
  CHECK(report->fusion->judged == 0);
}

TEST_CASE("sar: a changed mission goes on with its image unless the image's keys change") {
  auto run = Simulation::create(strafing());
  REQUIRE(run);
  while (run->time() < 2.0) run->step();
  const std::uint64_t scans = run->sar()->scans();
  CHECK(scans > 10);
  Mission other = run->mission();
  other.planner.speed_m_s = 0.2;
  const auto goes_on = run->changed(other);
  REQUIRE(goes_on);
  CHECK(goes_on->sar()->scans() == scans);
  other.sar.resolution_m = 0.05;
  const auto anew = run->changed(other);
  REQUIRE(anew);
  CHECK(anew->sar()->scans() == 0);
  other.sar.enabled = false;
  const auto off = run->changed(other);
  REQUIRE(off);
  CHECK(off->sar() == nullptr);
}

TEST_CASE("thicket run leaves the image's files, `thicket sar` the same ones, and neither leaves any where there is none") {
  const TemporaryFolder folder;
  CHECK(call(folder, "run sar/strafe --quiet --set limits.time_s=4 --out a").code == 4);
  for (const char* name : {"sar.png", "sar.npy", "sar.json", "map_fused.pgm", "map_fused.yaml"}) CHECK(std::filesystem::exists(folder.path() / "a" / name));
  const std::string json = *read_text_file(folder.path() / "a/sar.json"), npy = *read_text_file(folder.path() / "a/sar.npy"), png = *read_text_file(folder.path() / "a/sar.png");
  const auto told = json_of(folder.path() / "a/sar.json");
  CHECK(told["method"] == "back_projection");
  CHECK(told["width"] == 200);
  CHECK(told["height"] == 250);
  CHECK(npy.starts_with("\x93NUMPY\x01"));
  CHECK(has(npy.substr(0, 128), "'shape': (250, 200)"));
  CHECK(npy.size() == 128 + 4 * 200 * 250);

  const Answer again = call(folder, "sar a --out b");
  CHECK(again.code == 0);
  CHECK(has(again.out, "back-projection of "));
  CHECK(*read_text_file(folder.path() / "b/sar.json") == json);
  CHECK(*read_text_file(folder.path() / "b/sar.npy") == npy);
  CHECK(*read_text_file(folder.path() / "b/sar.png") == png);

  const Answer summed = call(folder, "sar a --out c --method simple_sum --frame line --bounds -0.5,0,1.5,4 --resolution 0.05 --set sar.fuse=false --json");
  CHECK(summed.code == 0);
  const auto sum = nlohmann::json::parse(summed.out);
  CHECK(sum["method"] == "simple_sum");
  CHECK(sum["frame"] == "line");
  CHECK(sum["width"] == 40);
  CHECK(sum["height"] == 80);

  CHECK(call(folder, "run sar/strafe --quiet --set limits.time_s=1 --set sar.enabled=false --out a").code == 4);
  for (const std::string& name : sar_files()) CHECK(!std::filesystem::exists(folder.path() / "a" / name));
  const Answer none = call(folder, "sar foliage_wall/map_radar");
  CHECK(none.code == 2);
  CHECK(has(none.err, "no sensor is a lobe radar"));
  CHECK(call(folder, "sar nowhere").code == 2);
}

}  // namespace thicket
