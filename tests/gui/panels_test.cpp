// Radar, 3D, planner, plots and profiler, drawn by ImGui without any back end.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <set>
#include <thread>

#include "gui/missions.hpp"
#include "gui/panels_sheet.hpp"
#include "thicket/base/files.hpp"
#include "views/extremes.hpp"
#include "views/radar_view.hpp"

namespace thicket::gui {
using namespace panels;
namespace {

std::vector<std::unique_ptr<View>> all_views() {
  std::vector<std::unique_ptr<View>> views;
  for (auto* make : {make_radar_view, make_sar_view, make_space_view, make_planner_view, make_plots_view, make_profiler_view}) views.push_back(make());
  return views;
}

/// A snapshot of a run that somebody made up: nothing but samples matters.
Samples long_run(std::size_t count) {
  Samples samples;
  for (std::size_t i = 0; i < count; ++i) {
    Sample sample;
    sample.step = i;
    sample.time = 0.05 * static_cast<double>(i);
    sample.speed = std::sin(1e-4 * static_cast<double>(i));
    samples.add(sample);
  }
  return samples;
}

double (*const speed_of)(const Sample&) = [](const Sample& s) { return s.speed; };

}  // namespace

TEST_CASE("panels: every view draws every shipped mission, and nothing") {
  KeptTextures kept;
  NoTextures none;
  const auto missions = shipped_missions();
  CHECK(missions.size() >= 20);
  {
    Sheet sheet;
    for (const auto& view : all_views()) CHECK(sheet.draw(*view, Snapshot(), none) > 0);
  }
  for (const auto& mission : missions) {
    CAPTURE(mission.string());
    Sheet sheet(240.0f, 180.0f);
    const auto views = all_views();
    Runner runner;
    auto now = opened(runner, mission.string().c_str(), 0);
    for (const auto& view : views) {
      CHECK(sheet.draw(*view, *now, none) > 0);
      CHECK(sheet.draw(*view, *now, kept, true) > 0);
    }
    runner.post(StepBy{12});
    now = runner.settled();
    for (const auto& view : views) {
      CHECK(sheet.draw(*view, *now, kept) > 0);
      CHECK(sheet.draw(*view, *now, none, true) > 0);
    }
  }
}

TEST_CASE("ticks are round, as many as are asked for, and inside") {
  const auto check = [](double low, double high, int most, double step, std::size_t count) {
    const Ticks ticks = nice_ticks(low, high, most);
    CAPTURE(low);
    CAPTURE(high);
    CHECK(ticks.step == doctest::Approx(step));
    CHECK(ticks.at.size() == count);
    for (const double at : ticks.at) {
      CHECK(at >= low - 1e-9 * step);
      CHECK(at <= high + 1e-9 * step);
      CHECK(std::abs(at / ticks.step - std::round(at / ticks.step)) < 1e-6);
    }
  };
  check(0.0, 10.0, 6, 2.0, 6);
  check(0.0, 10.0, 11, 1.0, 11);
  check(-0.37, 0.41, 5, 0.2, 5 - 1);
  check(0.0, 3600.0, 8, 500.0, 8);
  check(1e6, 1e6 + 0.5, 6, 0.1, 6);
  CHECK(nice_ticks(1.0, 1.0, 5).at.empty());
  CHECK(nice_ticks(0.0, infinity, 5).at.empty());
  CHECK(tick_text(0.30000000000000004, 0.1) == "0.3");
  CHECK(tick_text(-1e-17, 0.5) == "0.0");
  CHECK(tick_text(250.0, 50.0) == "250");
  CHECK(tick_text(0.025, 0.005) == "0.025");
}

TEST_CASE("extremes: a spike of one step is kept, what is not finite does not count, and a run that went another way is seen") {
  Samples samples = long_run(100'000);
  samples.keep_until(70'000);
  Sample spike = samples.back();
  spike.step = 70'001;
  spike.time = 0.05 * 70'001;
  spike.speed = 17.0;
  samples.add(spike);
  spike.step = 70'002;
  spike.speed = infinity;
  samples.add(spike);
  for (std::size_t i = 70'003; i < 80'000; ++i) {
    Sample sample;
    sample.step = i;
    sample.time = 0.05 * static_cast<double>(i);
    samples.add(sample);
  }
  Extremes extremes(speed_of);
  const std::size_t columns = 800, size = samples.size();
  int with_spike = 0;
  for (std::size_t c = 0; c < columns; ++c) {
    const Range seen = extremes.between(samples, c * size / columns, (c + 1) * size / columns);
    CHECK(seen.high < 18.0);
    if (seen.high == 17.0) ++with_spike;
  }
  CHECK(with_spike == 1);
  CHECK(extremes.between(samples, 70'002, 70'003).empty());
  // The same numbers as by hand, wherever the ends are.
  for (const auto& [first, last] : {std::pair<std::size_t, std::size_t>{5, 3000}, {1023, 1025}, {31, 33}, {69'000, 70'050}}) {
    Range by_hand;
    for (std::size_t i = first; i < last; ++i) by_hand.hold(samples[i].speed);
    const Range seen = extremes.between(samples, first, last);
    CHECK(seen.low == by_hand.low);
    CHECK(seen.high == by_hand.high);
  }
  for (const double time : {0.0, 0.05, 51.2, 51.21, 3000.0, 1e9})
    for (const std::size_t from : {std::size_t{0}, std::size_t{1}, std::size_t{1000}}) {
      std::size_t by_hand = 0;
      while (by_hand < size && samples[by_hand].time < time) ++by_hand;
      if (from <= by_hand) CHECK(first_at(samples, time, from) == by_hand);
    }
  // Back in time, and another way on.
  const Samples before = samples;
  samples.keep_until(2000);
  for (std::size_t i = 2001; i < 80'000; ++i) {
    Sample sample;
    sample.step = i;
    sample.speed = -3.0;
    samples.add(sample);
  }
  CHECK(extremes.between(samples, 0, samples.size()).low == -3.0);
  CHECK(extremes.between(samples, 3000, 70'000).high == -3.0);
  CHECK(extremes.between(before, 0, before.size()).high == 17.0);
}

TEST_CASE("plots: a million samples take no longer to draw than a few thousand, once they are known") {
  Runner runner;
  Snapshot now = *opened(runner, "rooms/u", 0);
  now.samples = long_run(1'000'000);
  now.newest_step = 999'999;
  Sheet sheet(1280.0f, 800.0f);
  NoTextures none;
  const auto view = make_plots_view();
  sheet.draw(*view, now, none);
  int vertices = 0;
  double ms = infinity;  // of the fastest: others may want the processor too
  for (int i = 0; i < 10; ++i) {
    const auto begun = std::chrono::steady_clock::now();
    vertices = sheet.draw(*view, now, none);
    ms = std::min(ms, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count());
  }
  MESSAGE("ms a frame: " << ms << ", vertices: " << vertices);
  CHECK(ms < 33.0);
  CHECK(vertices < 60'000);
}

TEST_CASE("plots: the cursor is in all of them, and a mark is where the run is back in time") {
  Runner runner;
  const auto newest = opened(runner, "rooms/u", 60);
  runner.post(StepBy{-20});
  const auto back = runner.settled();
  Sheet sheet;
  NoTextures none;
  const auto view = make_plots_view();
  sheet.draw(*view, *newest, none);
  const int plain = sheet.draw(*view, *newest, none);
  CHECK(sheet.draw(*view, *back, none) > plain);
  ImGui::GetIO().MousePos = {300.0f, 90.0f};
  sheet.draw(*view, *newest, none);
  // Of each of the four plots the line of the cursor; without it, the lines are as they were.
  const int with_cursor = sheet.draw(*view, *newest, none);
  CHECK(with_cursor >= plain + 4 * 4);
  ImGui::GetIO().MousePos = {-10.0f, -10.0f};
  sheet.draw(*view, *newest, none);
  CHECK(sheet.draw(*view, *newest, none) == plain);
}

TEST_CASE("radar: a click in the polar plot chooses the beam that looks there") {
  Runner runner;
  const auto now = opened(runner, "foliage_wall/map_radar", 20);
  Sheet sheet;
  NoTextures none;
  RadarView view;
  sheet.draw(view, *now, none);
  const Scan& scan = now->simulation->scans()[0];
  CHECK(std::abs(scan.beams[view.beam()].azimuth) < radians(2.0));
  ImGuiIO& io = ImGui::GetIO();
  io.MousePos = {580.0f, 370.0f};  // on the right of its middle
  for (const bool down : {false, true, false}) {
    io.MouseDown[0] = down;
    sheet.draw(view, *now, none);
  }
  CHECK(scan.beams[view.beam()].azimuth < radians(-45.0));
  CHECK(scan.beams[view.beam()].azimuth > radians(-135.0));
}

TEST_CASE("radar: a click chooses a sensor, and the waterfall has a row for each of its scans") {
  Runner runner;
  runner.post(Open{"foliage_wall/bug2", {}});
  auto now = runner.settled();
  REQUIRE(now->simulation);
  Mission mission = now->simulation->mission();
  mission.sensors.push_back(default_sensor("lidar"));
  mounted(mission.sensors.back()).name = "other";
  runner.post(ChangeMission{mission});
  runner.post(StepBy{10});
  now = runner.settled();
  INFO(now->message.text);
  REQUIRE(now->simulation->scans().size() == 2);
  Sheet sheet;
  KeptTextures textures;
  RadarView view;
  sheet.draw(view, *now, textures);
  sheet.draw(view, *now, textures);
  CHECK(view.sensor() == 0);
  CHECK(view.waterfall().rows().size() == 1);
  // Along the first line, until something happens.
  ImGuiIO& io = ImGui::GetIO();
  for (float x = 12.0f; x < 630.0f && view.sensor() == 0; x += 8.0f) {
    io.MousePos = {x, 18.0f};
    for (const bool down : {false, true, false}) {
      io.MouseDown[0] = down;
      sheet.draw(view, *now, textures);
    }
  }
  CHECK(view.sensor() == 1);
  io.MousePos = {-1.0f, -1.0f};
  std::set<std::uint64_t> numbers;
  for (int i = 0; i < 40; ++i) {
    runner.post(StepBy{1});
    now = runner.settled();
    sheet.draw(view, *now, textures);
    numbers.insert(now->simulation->scans()[1].number);
  }
  CHECK(view.waterfall().rows().size() >= numbers.size());
  const std::size_t before = view.waterfall().rows().size();
  // Back in time: what has not been yet is gone.
  runner.post(StepBy{-30});
  now = runner.settled();
  sheet.draw(view, *now, textures);
  CHECK(view.waterfall().rows().size() < before);
  CHECK(view.waterfall().rows().front().number == now->simulation->scans()[1].number);
  runner.post(Reset{});
  runner.post(StepBy{2});
  now = runner.settled();
  sheet.draw(view, *now, textures);
  CHECK(view.waterfall().rows().size() == 1);
}

TEST_CASE("radar: the texture's newest row is the profile that was measured") {
  Runner runner;
  const auto now = opened(runner, "foliage_wall/map_radar", 20);
  Sheet sheet;
  KeptTextures textures;
  RadarView view;
  sheet.draw(view, *now, textures);
  const auto& row = view.waterfall().rows().front();
  const auto& kept = textures.all.at("waterfall");
  const auto brightest = static_cast<int>(std::max_element(row.amplitude.begin(), row.amplitude.end()) - row.amplitude.begin());
  REQUIRE(row.most > 0.0f);
  REQUIRE(kept.width == static_cast<int>(row.amplitude.size()));
  // Brightness of a colour grows with the amplitude: no pixel of the row is brighter in green than the greatest.
  const auto green = [&](int column) { return kept.pixels[static_cast<std::size_t>(row.slot * kept.width + column)] >> 8 & 255u; };
  for (int column = 0; column < kept.width; ++column) CHECK(green(column) <= green(brightest));
  CHECK(green(brightest) > 100u);
}

TEST_CASE("profiler: while it plays, a row for what is beside the phases, and how fast it is") {
  Runner runner;
  runner.post(Open{"bugs/bug1_success", {}});
  runner.post(StepBy{5});
  auto now = runner.settled();
  REQUIRE(now->simulation);
  Sheet sheet;
  NoTextures none;
  const auto view = make_profiler_view();
  sheet.draw(*view, *now, none);
  const int paused = sheet.draw(*view, *now, none);
  runner.post(SetSpeed{2.0});
  runner.post(Play{});
  int playing = 0;
  const auto begun = std::chrono::steady_clock::now();
  while (playing <= paused && std::chrono::steady_clock::now() - begun < std::chrono::seconds(20)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    now = runner.snapshot();
    playing = sheet.draw(*view, *now, none);
  }
  runner.post(Pause{});
  CHECK(playing > paused);
}

TEST_CASE("planner: who drives by hand can give the wheel back by a click") {
  Runner runner;
  opened(runner, "rooms/u", 4);
  runner.post(Drive{Command{0.1, 0.0}});
  runner.post(StepBy{1});
  const auto now = runner.settled();
  Sheet sheet;
  NoTextures none;
  const auto view = make_planner_view();
  ImGuiIO& io = ImGui::GetIO();
  for (float y = 10.0f; y < 120.0f && sheet.posted.empty(); y += 6.0f) {
    io.MousePos = {16.0f, y};
    for (const bool down : {false, true, false}) {
      io.MouseDown[0] = down;
      sheet.draw(*view, *now, none);
    }
  }
  REQUIRE(sheet.posted.size() == 1);
  REQUIRE(std::holds_alternative<Drive>(sheet.posted[0]));
  CHECK_FALSE(std::get<Drive>(sheet.posted[0]).command.has_value());
}

}  // namespace thicket::gui
