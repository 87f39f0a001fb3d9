#include <doctest/doctest.h>

#include "thicket/gui/history.hpp"
#include <glm/geometric.hpp>

#include "thicket/base/files.hpp"
#include "thicket/gui/runner.hpp"

namespace thicket::gui {
namespace {

Simulation simulation_of(const char* mission) {
  const auto read = read_mission(find_input(mission), {});
  if (!read) FAIL(read.error().message);
  auto made = Simulation::create(*read);
  if (!made) FAIL(made.error().message);
  return *made;
}

}  // namespace

TEST_CASE("history: every state can be had again, exactly, with memory for a few") {
  Simulation simulation = simulation_of("rooms/u");
  History history(std::size_t{4} << 20);
  history.begin(simulation);
  std::vector<std::uint64_t> hashes{state_hash(simulation)};
  for (int i = 0; i < 400; ++i) {
    simulation.step();
    history.note(simulation);
    hashes.push_back(state_hash(simulation));
  }
  CHECK(history.newest_step() == 400);
  for (const std::uint64_t step : {std::uint64_t{399}, std::uint64_t{387}, std::uint64_t{250}, history.first_step()}) {
    CAPTURE(step);
    CHECK(state_hash(history.at(step)) == hashes[step]);
  }
}

TEST_CASE("runner: pause, step, back and reset give the states of a run without a window") {
  Simulation headless = simulation_of("foliage_wall/bug2");
  std::vector<std::uint64_t> hashes{state_hash(headless)};
  for (int i = 0; i < 120; ++i) {
    headless.step();
    hashes.push_back(state_hash(headless));
  }
  Runner runner;
  runner.post(Open{"foliage_wall/bug2", {}});
  auto now = runner.settled();
  REQUIRE(now->simulation);
  CHECK(state_hash(*now->simulation) == hashes[0]);
  runner.post(StepBy{50});
  CHECK(state_hash(*runner.settled()->simulation) == hashes[50]);
  runner.post(StepBy{-7});
  now = runner.settled();
  CHECK(now->simulation->steps() == 43);
  CHECK(now->newest_step == 50);
  CHECK(state_hash(*now->simulation) == hashes[43]);
  runner.post(SeekTo{10});
  CHECK(state_hash(*runner.settled()->simulation) == hashes[10]);
  runner.post(StepBy{110});
  CHECK(state_hash(*runner.settled()->simulation) == hashes[120]);
  runner.post(Reset{});
  now = runner.settled();
  CHECK(state_hash(*now->simulation) == hashes[0]);
  CHECK(now->samples.size() == 1);
}

TEST_CASE("runner: a run that is watched ends as one that nobody watches") {
  Simulation headless = simulation_of("rooms/u");
  while (headless.step()) {
  }
  Runner runner;
  runner.post(Open{"rooms/u", {}});
  runner.post(SetSpeed{0.0});
  runner.post(Play{});
  auto now = runner.snapshot();
  while (!now->simulation || !now->simulation->verdict()) now = runner.snapshot();
  now = runner.finished();
  CHECK(state_hash(*now->simulation) == state_hash(headless));
  CHECK(now->samples.size() == headless.steps() + 1);
}

TEST_CASE("runner: a goal that a person sets is driven to, and is there again when the run is gone through again") {
  Runner runner;
  runner.post(Open{"rooms/u", {}});
  runner.post(SetSpeed{0.0});
  runner.post(StepBy{40});
  const glm::dvec2 start = runner.settled()->simulation->vehicle().pose.position;
  const glm::dvec2 goal = start + glm::dvec2(0.0, -0.5);
  runner.post(SetGoal{goal});
  auto now = runner.finished();
  REQUIRE(now->simulation->verdict());
  INFO(now->simulation->verdict()->reason);
  CHECK(now->simulation->verdict()->kind == Verdict::Kind::reached);
  CHECK(glm::distance(now->simulation->vehicle().pose.position, goal) < 0.3);
  const std::uint64_t end = state_hash(*now->simulation), last = now->simulation->steps();
  runner.post(SeekTo{20});
  CHECK(runner.settled()->simulation->mission().planner.goal_m != goal);
  runner.post(StepBy{static_cast<int>(last) - 20});
  CHECK(state_hash(*runner.settled()->simulation) == end);
}

TEST_CASE("runner: what cannot be read leaves what was open, and says what is wrong") {
  Runner runner;
  runner.post(Open{"rooms/u", {}});
  const auto before = runner.settled();
  runner.post(Open{"no/such/file.toml", {}});
  const auto after = runner.settled();
  CHECK(after->simulation->mission().name == before->simulation->mission().name);
  CHECK(after->message.error);
  CHECK(after->message.text.find("no/such/file.toml") != std::string::npos);
}

TEST_CASE("runner: driven by hand, and the wheel given back") {
  Runner runner;
  runner.post(Open{"foliage_wall/bug2", {}});
  runner.post(Drive{Command{0.3, 0.0}});
  runner.post(StepBy{60});
  auto now = runner.settled();
  CHECK(now->simulation->driven_by_hand());
  CHECK(now->simulation->vehicle().speed == doctest::Approx(0.3));
  runner.post(Drive{std::nullopt});
  runner.post(StepBy{10});
  now = runner.settled();
  CHECK_FALSE(now->simulation->driven_by_hand());
  CHECK(now->simulation->decision().state != "driven by hand");
}

TEST_CASE("drive: who gives the wheel back leaves the robot with its own estimate, drift and all, and its map") {
  const auto mission = read_mission(find_input("foliage_wall/bug2"), {{"odometry.speed_scale", "1.2", "test"}});
  REQUIRE(mission);
  auto made = Simulation::create(*mission);
  REQUIRE(made);
  Simulation& run = *made;
  for (int i = 0; i < 40; ++i) run.step();
  run.drive(Command{0.3, 0.1});
  for (int i = 0; i < 40; ++i) run.step();
  const Pose2 estimate = run.estimate();
  const std::size_t known = run.map().known_cells();
  CHECK(glm::distance(estimate.position, run.vehicle().pose.position) > 0.1);
  run.drive(std::nullopt);
  CHECK_FALSE(run.driven_by_hand());
  CHECK(run.estimate().position == estimate.position);
  CHECK(run.map().known_cells() == known);
  for (int i = 0; i < 10; ++i) run.step();
  CHECK(run.decision().state != "driven by hand");
}

TEST_CASE("runner: a world by itself opens with a robot in the open") {
  Runner runner;
  runner.post(Open{"rooms/u_room", {}});
  const auto now = runner.settled();
  INFO(now->message.text);
  REQUIRE(now->simulation);
  CHECK(now->simulation->clearance().distance > 0.0);
}

}  // namespace thicket::gui
