// What a run leaves out, against a run that leaves nothing out.
#include <doctest/doctest.h>

#include "thicket/base/files.hpp"
#include "thicket/sim/fidelity.hpp"
#include "thicket/sim/shipped.hpp"
#include "thicket/sim/simulation.hpp"

namespace thicket {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> missions() {
  std::vector<fs::path> files;
  for (const auto& file : shipped_worlds())
    if (is_mission(file)) files.push_back(file);
  return files;
}

/// The mission with nothing left out, and as many rays as it has.
Mission complete(Mission mission) {
  for (SensorSpec& spec : mission.sensors) {
    if (auto* lobe = std::get_if<LobeRadarSpec>(&spec)) lobe->surfaces = lobe->rows = "all";
    if (auto* radar = std::get_if<ScanningRadarSpec>(&spec)) radar->surfaces = "all";
  }
  return mission;
}

}  // namespace

TEST_CASE("fidelity: on every shipped mission, what a scan leaves out by itself changes no echo") {
  for (const fs::path& file : missions()) {
    CAPTURE(file.filename().string());
    auto mission = read_mission(file, {});
    REQUIRE(mission);
    mission->map.enabled = mission->sar.enabled = false;
    auto run = Simulation::create(*mission);
    if (!run) FAIL(run.error().message);
    const Mission all = complete(*mission);
    std::vector<std::shared_ptr<const Sensor>> sensors;
    for (const SensorSpec& spec : all.sensors) sensors.push_back(make_sensor(spec, static_cast<std::uint16_t>(sensors.size())));
    Scan few, many;
    for (int look = 0; look < 3; ++look) {
      for (std::size_t i = 0; i < sensors.size(); ++i) {
        const Random random(static_cast<std::uint64_t>(mission->seed), static_cast<std::uint16_t>(i));
        const auto number = static_cast<std::uint64_t>(look);
        run->stage().sensors[i]->measure(run->scene(), run->platform(), run->time(), number, random, few);
        sensors[i]->measure(run->scene(), run->platform(), run->time(), number, random, many);
        REQUIRE(few.beams.size() == many.beams.size());
        REQUIRE(few.echoes.size() == many.echoes.size());
        for (std::size_t e = 0; e < few.echoes.size(); ++e) {
          REQUIRE(few.echoes[e].range == many.echoes[e].range);
          REQUIRE(few.echoes[e].amplitude == doctest::Approx(many.echoes[e].amplitude).epsilon(1e-5));
        }
      }
      for (int step = 0; step < 5 && run->step(); ++step) {}
    }
  }
}

TEST_CASE("fidelity: a run says what it models, and why it leaves out the rest") {
  const auto told = [](const char* name) {
    const auto mission = read_mission(find_input(name), {});
    REQUIRE(mission);
    const auto run = Simulation::create(*mission);
    REQUIRE(run);
    return describe(model_of(*run));
  };
  const std::string wall = told("foliage_wall/bug2");
  CHECK(wall.find("models penetration ('") != std::string::npos);
  CHECK(wall.find("multipath (bounces_max = 1)") != std::string::npos);
  const std::string room = told("bugs/bug1_success");
  CHECK(room.find("penetration (nothing lets the wave in") != std::string::npos);
  CHECK(room.find("moving solids (nothing moves)") != std::string::npos);
}

TEST_CASE("fidelity: fast and reference change rays and physics of a run, and not its file") {
  const auto mission = read_mission(find_input("strafe/strafe_plate"), {{"fidelity", "reference", "test"}});
  if (!mission) FAIL(mission.error().message);
  const auto run = Simulation::create(*mission);
  if (!run) FAIL(run.error().message);
  const auto rays = [](const Simulation& simulation) {
    Scan scan;
    simulation.stage().sensors.front()->measure(simulation.scene(), simulation.platform(), 0.0, 0, Random(1, 0), scan);
    return scan.rays;
  };
  const auto with = [&](const char* fidelity) {
    auto changed = *mission;
    changed.fidelity = fidelity;
    auto made = Simulation::create(changed);
    REQUIRE(made);
    return std::move(*made);
  };
  CHECK(rays(*run) == 4 * rays(with("auto")));
  CHECK(4 * rays(with("fast")) == rays(with("auto")));
  CHECK(run->stage().flight.rigid_body);
  CHECK_FALSE(with("fast").stage().flight.rigid_body);
  // Written and read again it is the same mission: nothing is doubled twice.
  CHECK(write_mission(run->mission()) == write_mission(*mission));
  CHECK(write_mission(*mission).find("fidelity = \"reference\"") != std::string::npos);
}

}  // namespace thicket
