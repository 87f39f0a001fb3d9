// `thicket run --score` and `thicket score` as a person or a script meets them; and what the truth of a mission takes for matter.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "program_call.hpp"
#include "thicket/base/files.hpp"
#include "thicket/sim/map_score.hpp"
#include "thicket/sim/simulation.hpp"

namespace thicket {
namespace {

void replace(const TemporaryFolder& folder, const std::string& file, const std::string& from, const std::string& to) {
  std::string text = *read_text_file(folder.path() / file);
  const auto at = text.find(from);
  REQUIRE_MESSAGE(at != std::string::npos, from);
  folder.write(file, text.replace(at, from.size(), to));
}

constexpr const char* short_run = "run foliage_wall/map_radar --quiet --set limits.time_s=3 ";

/// Blocks a metre wide, 3 m apart along y, of materials that sensors take for different things; a sensor in their midst.
std::string world_of(const std::vector<std::string>& materials) {
  std::string text = "name = \"w\"\nbounds_m = [-1.0, 0.0, 3.0, " + std::to_string(3 * materials.size()) + ".0]\n";
  for (std::size_t i = 0; i < materials.size(); ++i)
    text += "[material.m" + std::to_string(i) + "]\n" + materials[i] + "\n";
  for (std::size_t i = 0; i < materials.size(); ++i)
    text += "[[solid]]\ntype = \"box\"\nmaterial = \"m" + std::to_string(i) + "\"\nposition_m = [1.5, " + std::to_string(3 * i + 1) + ".5, 1.0]\nsize_m = [1.0, 1.0, 2.0]\n";
  return text;
}

/// 's' solid, 'p' penetrable, '.' air: what the truth says of the middle of each block.
std::string roles(const TemporaryFolder& folder, const std::vector<std::string>& materials, const std::string& sensors) {
  folder.write("w.toml", world_of(materials));
  const auto file = folder.write("m.toml", "world = \"w.toml\"\n[start]\nx_m = -0.5\ny_m = 0.5\n" + sensors + "[planner]\nname = \"waypoints\"\nwaypoints_m = [[-0.4, 0.5]]\n");
  const auto mission = read_mission(file, {});
  REQUIRE_MESSAGE(static_cast<bool>(mission), (mission ? "" : mission.error().message));
  const auto simulation = Simulation::create(*mission);
  REQUIRE_MESSAGE(static_cast<bool>(simulation), (simulation ? "" : simulation.error().message));
  const auto truth = map_truth(*simulation, ProbabilityGrid{}, Convention::cell_centre);
  REQUIRE(truth);
  std::string told;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const std::size_t cell = truth->solid.index_at({1.55, 3.0 * static_cast<double>(i) + 1.55});
    told += truth->solid.blocked[cell] ? 's' : !truth->penetrable.empty() && truth->penetrable[cell] ? 'p' : '.';
  }
  return told;
}

}  // namespace

TEST_CASE("run --score leaves score.json and its headline in result.json, and the same every time") {
  const TemporaryFolder folder;
  const Answer answer = call(folder, "run foliage_wall/map_radar --set limits.time_s=3 --score --out a");
  CHECK(answer.code == 4);
  CHECK(has(answer.out, "map: F1 "));
  const auto score = json_of(folder.path() / "a/score.json"), head = json_of(folder.path() / "a/result.json")["map"]["score"];
  CHECK(head["truth"] == "cell_centre");
  CHECK(head["tolerance_m"] == 0.2);
  CHECK(head["f1"] == score["within_tolerance"]["f1"]);
  CHECK(head["precision"] == score["within_tolerance"]["precision"]);
  for (const char* key : {"strict_precision", "claimed_nll", "coverage", "edge_error_m"}) CHECK(head[key].is_number());
  CHECK(score["within_tolerance"]["f1"].get<double>() > 0.9);
  CHECK(score["coverage"].get<double>() > 0.2);
  CHECK(score["cells"]["claimed"].get<long>() > 100);
  CHECK(score["map"]["known_cells"] == json_of(folder.path() / "a/result.json")["map"]["known_cells"]);
  CHECK(score["memory"]["bytes"].get<long>() > score["map"]["known_cells"].get<long>());
  const auto timing = json_of(folder.path() / "a/timing.json");
  CHECK(timing["map_ms_per_scan"].get<double>() > 0.0);
  CHECK(timing["map_ns_per_cell"].get<double>() > 0.0);
  CHECK(timing["map_ns_per_cell"].get<double>() < 1e6 * timing["map_ms_per_scan"].get<double>());
  // Three seconds, three updates; together they tell of each known cell, but runs of equal ones in few bytes.
  const auto updates = score["updates"];
  CHECK(updates["every_s"] == 1.0);
  CHECK(updates["count"] == 3);
  CHECK(updates["bytes_mean"].get<double>() > 100.0);
  CHECK(updates["bytes_most"].get<double>() >= updates["bytes_mean"].get<double>());
  CHECK(updates["bytes_most"].get<double>() < score["memory"]["bytes"].get<double>());

  CHECK(call(folder, "run a/mission.toml --out b --quiet").code == 4);  // the key is in the mission that was written
  for (const char* name : {"score.json", "result.json"}) CHECK(*read_text_file(folder.path() / "a" / name) == *read_text_file(folder.path() / "b" / name));

  // A run without it leaves none of the run before.
  CHECK(call(folder, std::string(short_run) + "--out a").code == 4);
  CHECK_FALSE(std::filesystem::exists(folder.path() / "a/score.json"));
  CHECK_FALSE(json_of(folder.path() / "a/result.json")["map"].contains("score"));
}

TEST_CASE("updates are counted at each whole second, and a follower that takes them in has the map") {
  const auto mission = read_mission(find_input("foliage_wall/map_radar"), {{"limits.time_s", "2.5", "test"}});
  REQUIRE(mission);
  auto simulation = Simulation::create(*mission);
  REQUIRE(simulation);
  OccupancyMap before = simulation->map(), follower = before;
  UpdateMeter meter;
  meter.note(*simulation);
  MapUpdates expected;
  double second = 1.0;
  while (simulation->step()) {
    meter.note(*simulation);
    meter.note(*simulation);  // once too often does no harm
    if (simulation->time() < second - 1e-6) continue;
    const auto update = simulation->map().changes_since(before);
    REQUIRE(follower.apply_changes(update));
    CHECK(follower.known_cells() == simulation->map().known_cells());
    before = simulation->map();
    ++expected.count;
    expected.bytes += update.size();
    expected.most = std::max(expected.most, update.size());
    second += 1.0;
  }
  meter.note(*simulation);
  CHECK(meter.updates().count == 2);  // the last half second is not counted
  CHECK(expected.count == 2);
  CHECK(meter.updates().bytes == expected.bytes);
  CHECK(meter.updates().most == expected.most);
  CHECK(meter.updates().mean() == doctest::Approx(0.5 * static_cast<double>(expected.bytes)));
  CHECK(std::isnan(MapUpdates{}.mean()));
}

TEST_CASE("score simulates a run again and judges the map that it left") {
  const TemporaryFolder folder;
  REQUIRE(call(folder, std::string(short_run) + "--score --out a").code == 4);
  const Answer centre = call(folder, "score a");
  CHECK(centre.code == 0);
  CHECK(has(centre.out, "the map is that of map.pgm"));
  CHECK(has(centre.out, "F1 within 0.2 m"));
  CHECK(has(centre.out, "bytes a second"));
  CHECK(has(centre.out, " ns a cell, "));
  CHECK(call(folder, "score a --json").out == *read_text_file(folder.path() / "a/score.json"));
  const auto overlap = nlohmann::json::parse(call(folder, "score a --json --truth any_overlap --tolerance 0").out);
  CHECK(overlap["truth"]["convention"] == "any_overlap");
  CHECK(overlap["within_tolerance"]["tolerance_m"] == 0.0);
  CHECK(overlap["strict"]["precision"] > json_of(folder.path() / "a/score.json")["strict"]["precision"]);
}

TEST_CASE("score tells a map that is not the run's, and stops where a person stopped the run") {
  const TemporaryFolder folder;
  REQUIRE(call(folder, std::string(short_run) + "--out a").code == 4);
  // As if Ctrl-C had ended it: the mission would go on for long.
  replace(folder, "a/mission.toml", "time_s = 3.0", "time_s = 3600.0");
  replace(folder, "a/result.json", "time limit of 3 s", "interrupted");
  const Answer interrupted = call(folder, "score a");
  CHECK(interrupted.code == 0);
  CHECK(has(interrupted.out, "3.0 s in"));

  std::string image = *read_text_file(folder.path() / "a/map.pgm");
  const auto free = image.rfind('\xfe');
  REQUIRE(free != std::string::npos);
  image[free] = '\0';
  folder.write("a/map.pgm", image);
  const Answer other = call(folder, "score a");
  CHECK(other.code == 6);
  CHECK(has(other.err, "another map"));
  CHECK(has(other.err, "as this one"));
  CHECK(has(other.out, "is NOT that of map.pgm"));
  replace(folder, "a/result.json", "\"version\": \"", "\"version\": \"0.0.");
  CHECK(has(call(folder, "score a").err, "is version 0.0."));
  std::filesystem::remove(folder.path() / "a/map.yaml");
  const Answer none = call(folder, "score a");
  CHECK(none.code == 0);
  CHECK(has(none.out, "no map.pgm to compare with"));
}

TEST_CASE("score tells what it cannot judge") {
  const TemporaryFolder folder;
  folder.write("file", "");
  folder.write("empty/readme", "");
  folder.write("bad/mission.toml", "world = 3");
  REQUIRE(call(folder, std::string(short_run) + "--set map.enabled=false --out without").code == 4);
  for (const auto& [arguments, words] : {std::pair{"score nowhere", "there is no folder 'nowhere'"}, {"score file", "is not a folder"}, {"score empty", "has no mission.toml, expected a folder that `thicket run` has written"},
                                         {"score bad", "bad/mission.toml:1"}, {"score without", "--set map.enabled=true"}, {"score empty --truth centre", "--truth is 'centre', expected cell_centre or any_overlap"},
                                         {"score empty --tolerance -1", "--tolerance"}, {"score", "run_dir"}}) {
    CAPTURE(arguments);
    const Answer answer = call(folder, arguments);
    CHECK(answer.code == 2);
    CHECK_MESSAGE(has(answer.err, words), answer.err);
  }
  // What cannot be scored is still a run.
  const Answer run = call(folder, "run foliage_wall/map_radar --set limits.time_s=1 --set map.enabled=false --score --out w");
  CHECK(run.code == 4);
  CHECK(has(run.err, "no score.json: the mission makes no map"));
  CHECK(std::filesystem::exists(folder.path() / "w/result.json"));
}

TEST_CASE("what a truth takes for matter is what the sensors can know") {
  const TemporaryFolder folder;
  const std::vector<std::string> materials = {"", "attenuation_db_per_m = 8.0\nreflectivity = 0.05", "attenuation_db_per_m = 50.0", "attenuation_db_per_m = 0.0\nreflectivity = 0.0\nstops_motion = false\nlight_extinction_per_m = 0.5",
                                              "preset = \"concrete\"", "preset = \"glass\"\nstops_light = false"};
  const std::string radar = "[[sensor]]\ntype = \"scanning_radar\"\n", lidar = "[[sensor]]\ntype = \"lidar\"\nname = \"lidar\"\n";
  // wall, foliage, hedge (50 dB/m: 10 dB are gone in 0.2 m), smoke, concrete, glass
  CHECK(roles(folder, materials, radar).substr(0, 5) == "sps.s");
  CHECK(roles(folder, materials, lidar) == "ssspsp");
  // What stops one of them is solid to both together.
  CHECK(roles(folder, materials, radar + lidar).substr(0, 5) == "sssps");
  // With twice the budget a hedge lets beams through for longer.
  CHECK(roles(folder, materials, radar + "penetration_budget_db = 20.0\n").substr(0, 5) == "spp.s");
}

}  // namespace thicket
