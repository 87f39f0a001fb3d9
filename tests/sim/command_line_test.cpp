// The program as a person or a script meets it.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "outside_data.hpp"
#include "program_call.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/image.hpp"

namespace thicket {
namespace {

const std::vector<std::string> outputs = {"map.pgm", "map.png", "map.yaml", "mission.toml", "path.png", "result.json", "timing.json", "trajectory.csv", "trajectory.tum"};

}  // namespace

TEST_CASE("a shipped mission runs from any folder and leaves all its files") {
  const TemporaryFolder folder;
  const Answer answer = call(folder, "run worlds/data/foliage_wall/bug2.toml --out out");
  CHECK(answer.code == 0);
  CHECK(has(answer.out, "reached"));
  for (const std::string& name : outputs) CHECK_MESSAGE(std::filesystem::file_size(folder.path() / "out" / name) > 0, name);
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path() / "out"), {}) == static_cast<long>(outputs.size()));

  const auto result = json_of(folder.path() / "out/result.json");
  CHECK(result["verdict"] == "reached");
  CHECK(result["seed"] == 1);
  CHECK(result["rays"].get<long>() == 360 * result["scans"].get<long>());
  CHECK(result["path_length_m"].get<double>() > result["straight_distance_m"].get<double>());
  CHECK(result["minimum_clearance_m"].get<double>() > 0.85);
  CHECK_FALSE(result.contains("wall_run_s"));
  const auto timing = json_of(folder.path() / "out/timing.json");
  for (const char* phase : {"trace", "map", "plan", "contact"}) CHECK(timing["phases_s"][phase].get<double>() > 0.0);
  CHECK(timing["realtime_factor"].get<double>() > 1.0);
  const auto picture = read_image(folder.path() / "out/map.png");
  REQUIRE(picture);
  CHECK(picture->width > 600);
  CHECK(has(*read_text_file(folder.path() / "out/map.yaml"), "free_thresh: 0.196"));
}

TEST_CASE("the resolved mission gives the same result, and threads and folders do not matter") {
  const TemporaryFolder folder;
  REQUIRE(call(folder, "run foliage_wall/closed --out a --threads 1 --set sensor.range_noise_m=0.02 --seed 5").code == 3);
  REQUIRE(call(folder, "run a/mission.toml --out deep/b --threads 2").code == 3);
  for (const std::string& name : outputs)
    if (name != "timing.json") CHECK_MESSAGE(*read_text_file(folder.path() / "a" / name) == *read_text_file(folder.path() / "deep/b" / name), name);
}

TEST_CASE("exit codes and messages") {
  const TemporaryFolder folder;
  folder.write("stealth.toml", R"(name = "s"
[material.stealth]
reflectivity = 0.0
[[solid]]
type = "box"
material = "stealth"
position_m = [5.0, 0.0, 0.5]
size_m = [0.2, 3.0, 1.0]
)");
  const Answer collided = call(folder, "run --world stealth.toml --start 0,0,0 --goal 9,0 --planner bug2 --out o");
  CHECK(collided.code == 5);
  CHECK(has(collided.err, "warning: 1 solid ('box 1') of material 'stealth' stop motion but would not be detected"));
  CHECK(call(folder, "run foliage_wall/bug2 --set limits.time_s=2 --out o --quiet").code == 4);
  CHECK(json_of(folder.path() / "o/result.json")["reason"] == "time limit of 2 s");

  for (const auto& [arguments, words] : {std::pair{"run nowhere", "there is no mission 'nowhere'"}, {"run", "nothing to run"}, {"run foliage_wall/bug2 --goal 1", "--goal is '1', expected X,Y"},
                                         {"run foliage_wall/bug2 --set clearance", "expected KEY=VALUE"}, {"run foliage_wall/bug2 --set planner.clearence_m=2", "did you mean 'clearance_m'"},
                                         {"run foliage_wall/bug2 --planner bug9", "expected one of 'bug1', 'bug2', 'bug2_2012'"}, {"run foliage_wall/bug2 --no-such-flag", "--no-such-flag"},
                                         {"run foliage_wall/divided_room", "this is a world and not a mission"}, {"run foliage_wall/bug2 --seed 9223372036854775808", "--seed: 'seed' is a text"}, {"check nowhere.toml", "there is no file"}, {"help nothing", "expected mission or world"}, {"frobnicate", ""}, {"", ""}}) {
    CAPTURE(arguments);
    const Answer answer = call(folder, arguments);
    CHECK(answer.code == 2);
    CHECK(has(answer.err, words));
  }
}

TEST_CASE("a folder that is used again holds nothing of the run before, and no name or folder overwrites what is read") {
  const TemporaryFolder folder;
  REQUIRE(call(folder, "run foliage_wall/smoke --out o --quiet").code == 0);
  REQUIRE(call(folder, "run foliage_wall/smoke --out o --quiet --set output.map=false --set output.picture=false --set limits.time_s=1").code == 4);
  REQUIRE(call(folder, "run foliage_wall/smoke --out p --quiet --set output.path_picture=false --set limits.time_s=1").code == 4);
  CHECK_FALSE(std::filesystem::exists(folder.path() / "p/path.png"));
  CHECK_FALSE(std::filesystem::exists(folder.path() / "o/map.pgm"));
  CHECK_FALSE(std::filesystem::exists(folder.path() / "o/map.png"));
  CHECK(std::filesystem::exists(folder.path() / "o/path.png"));
  CHECK(json_of(folder.path() / "o/result.json")["verdict"] == "stopped");
  CHECK(call(folder, "run foliage_wall/smoke --quiet --set limits.time_s=1 --set name=../../evil").code == 4);
  CHECK(std::filesystem::exists(folder.path() / "thicket-out/_._.._evil/result.json"));

  const Answer own = call(folder, "run o/mission.toml --out o");
  CHECK(own.code == 2);
  CHECK(has(own.err, "would be overwritten"));
  folder.write("file", "");
  CHECK(has(call(folder, "run foliage_wall/smoke --out file").err, "cannot be written to"));
}

TEST_CASE("a goal far away does not make the picture too large") {
  const TemporaryFolder folder;
  CHECK(call(folder, "run foliage_wall/smoke --goal 10000,10000 --set limits.time_s=1 --out o --quiet").code == 4);
  CHECK(read_image(folder.path() / "o/map.png")->width < 3000);
  CHECK(read_image(folder.path() / "o/path.png")->width < 3000);
}

TEST_CASE("--json prints the result alone, --quiet nothing") {
  const TemporaryFolder folder;
  const Answer json = call(folder, "run foliage_wall/smoke --out o --json");
  CHECK(nlohmann::json::parse(json.out)["verdict"] == "reached");
  CHECK(json.out == *read_text_file(folder.path() / "o/result.json"));
  const Answer quiet = call(folder, "run foliage_wall/smoke --out o --quiet");
  CHECK(quiet.out.empty());
  CHECK(quiet.err.empty());
}

TEST_CASE("worlds, check, help and --version tell what there is") {
  const TemporaryFolder folder;
  const Answer worlds = call(folder, "worlds");
  CHECK(worlds.code == 0);
  for (const char* name : {"foliage_wall/bug1.toml", "foliage_wall/map_lidar.toml", "foliage_wall/divided_room.toml", "rooms/spiral.toml"}) CHECK(has(worlds.out, name));
  const Answer check = call(folder, "check foliage_wall/bug2");
  CHECK(check.code == 0);
  CHECK(has(check.out, "foliage"));
  CHECK(has(check.out, "ok"));
  CHECK(has(call(folder, "check foliage_wall/divided_room").out, "solids     8"));
  CHECK(has(call(folder, "check foliage_wall/bug2 --goal 0,0").out, "it cannot be reached"));
  folder.write("broken.toml", "name = \"x\"\n[[solid]]\ntype = \"bocks\"\n");
  const Answer broken = call(folder, "check broken.toml");
  CHECK(broken.code == 2);
  CHECK(has(broken.err, "broken.toml:3:8: 'type' is 'bocks'"));
  CHECK(has(call(folder, "help mission").out, "goal_tolerance_m"));
  CHECK(has(call(folder, "help world").out, "attenuation_db_per_m"));
  CHECK(has(call(folder, "--version").out, "0.1"));
  CHECK(has(call(folder, "--help").out, "Exit codes"));
}

TEST_CASE("materials prints the shipped ones, or those of a world, at a frequency") {
  const TemporaryFolder folder;
  const auto line = [](const std::string& text, const std::string& name) {
    const auto from = text.find("\n" + name + " ");
    return from == std::string::npos ? "" : text.substr(from + 1, text.find('\n', from + 1) - from - 1);
  };
  const Answer uwb = call(folder, "materials --frequency-ghz 7.29 --thickness-m 0.1");
  CHECK(uwb.code == 0);
  CHECK(uwb.err == "");
  CHECK(has(uwb.out, "at 7.29 GHz, walls of 0.1 m"));
  const std::string concrete = line(uwb.out, "concrete");
  for (const char* part : {" 5.24 ", " 0.219 ", " 0.155 ", " 156 ", " surface ", " light, motion ", " -17.03 ", "ITU-R P.2040-3"}) CHECK_MESSAGE(has(concrete, part), concrete);
  CHECK(has(line(uwb.out, "metal"), " opaque "));
  CHECK(has(line(uwb.out, "glass"), " motion "));
  CHECK(uwb.out.find("\nconcrete ") < uwb.out.find("\nbrick "));
  CHECK(uwb.out.find("\nabsorber ") < uwb.out.find("\nmirror "));

  const Answer standard = call(folder, "materials");
  CHECK(has(standard.out, "at 24 GHz\n"));
  CHECK(has(line(standard.out, "concrete"), " 396 "));
  CHECK_FALSE(has(standard.out, "passed dB"));

  folder.write("w.toml", "name = \"w\"\n[material.thin]\npreset = \"smoke\"\nlight_extinction_per_m = 0.25\n[[solid]]\ntype = \"sphere\"\nmaterial = \"brick\"\nradius_m = 1\n");
  const Answer world = call(folder, "materials w.toml --frequency-ghz 7.29");
  CHECK(world.code == 0);
  CHECK(has(line(world.out, "thin"), " 0.25 "));
  CHECK(has(line(world.out, "brick"), " 27.1 "));
  CHECK_FALSE(has(world.out, "concrete"));
  CHECK(has(call(folder, "check w.toml").out, "dB/m at 1 GHz"));

  for (const auto& [arguments, words] : {std::pair{"materials nowhere", "there is no world 'nowhere'"}, {"materials foliage_wall/smoke", "this is a mission and not a world"},
                                         {"materials --frequency-ghz 0.1", "--frequency-ghz"}, {"materials --thickness-m 0", "--thickness-m"}}) {
    CAPTURE(arguments);
    const Answer answer = call(folder, arguments);
    CHECK(answer.code == 2);
    CHECK(has(answer.err, words));
    CHECK(answer.out == "");
  }
  CHECK(has(call(folder, "help world").out, "conductivity_s_per_m"));
  CHECK(has(call(folder, "help mission").out, "frequency_ghz"));
  CHECK(has(call(folder, "help mission").out, "optical_depth_max"));
}

TEST_CASE("a map_server map is a world, a broken image reference says how to go on") {
  const auto yaml = outside_data("ros_maps/nav2_depot.yaml");
  if (!yaml) {
    MESSAGE("skipped: no outside data");
    return;
  }
  const TemporaryFolder folder;
  const std::string run = "run --world '" + yaml->string() + "' --start -5,0,0 --goal 20,0 --planner bug2 --set vehicle.preset=small --set planner.clearance_m=0.1 --out o";
  const Answer broken = call(folder, run);
  CHECK(broken.code == 2);
  CHECK(has(broken.err, "nav2_depot.yaml:1:8: image 'depot.pgm' does not exist; 'nav2_depot.pgm' is beside it"));
  std::filesystem::path image = *yaml;
  image.replace_extension(".pgm");
  const std::string with_image = " --map-image '" + image.string() + "'";
  CHECK(call(folder, run + with_image).code == 0);
  CHECK(has(call(folder, "check '" + yaml->string() + "'" + with_image).out, "solids     1"));
}

TEST_CASE("pacing keeps to the wanted factor, and an interrupted run still leaves its files") {
  const TemporaryFolder folder;
  // 2 s at 10 x real time is at least 0.2 s of wall time. (No upper bound: the machine is shared.)
  CHECK(call(folder, "run foliage_wall/bug2 --set limits.time_s=2 --realtime-factor 10 --out o --quiet").code == 4);
  CHECK(json_of(folder.path() / "o/timing.json")["wall_run_s"].get<double>() >= 0.19);
  const std::string command = "cd '" + folder.path().string() + "' && timeout -s INT 1 '" THICKET_PROGRAM "' run foliage_wall/bug2 --realtime-factor 1 --out p --quiet; true";
  REQUIRE(std::system(command.c_str()) == 0);
  const auto result = json_of(folder.path() / "p/result.json");
  CHECK(result["verdict"] == "stopped");
  CHECK(result["reason"] == "interrupted");
}

}  // namespace thicket
