// Known colours at known points of the views, drawn without a screen (EGL): the points are computed from the world, the colours from the legend.
#include <doctest/doctest.h>

#include <cmath>

#include <glm/geometric.hpp>

#include "missions.hpp"
#include "platform/platform.hpp"
#include "thicket/sim/material_colour.hpp"
#include "views/plan.hpp"
#include "views/radar_view.hpp"
#include "views/space_view.hpp"

namespace thicket::gui {
namespace {

constexpr int width = 640, height = 400;

/// A picture of a view that fills it, and what its letters are high.
struct Shot {
  Picture picture;
  float line = 0.0f;

  Shot(View& view, const Snapshot& now, bool dark = true) {
    auto platform = open_offscreen({width, height});
    if (!platform) FAIL(platform.error().message);
    const Palette colours = palette(dark);
    Desk desk;
    const Frame frame{now, colours, (*platform)->textures(), desk, [](Action) {}, 1.0, true};
    for (int i = 0; i < 3; ++i) {
      (*platform)->begin();
      use_look(dark, 1.0);
      ImGui::SetNextWindowPos({0.0f, 0.0f});
      ImGui::SetNextWindowSize({width, height});
      ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0.0f, 0.0f));
      ImGui::Begin("picture", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground);
      ImGui::PopStyleVar();
      line = ImGui::GetTextLineHeight();
      view.draw(frame);
      ImGui::End();
      (*platform)->draw(colours.background);
    }
    picture = (*platform)->pixels();
    CHECK((*platform)->faults() == 0);
  }
  glm::dvec3 at(const ImVec2& p) const {
    REQUIRE(p.x >= 0.0f);
    REQUIRE(p.y >= 0.0f);
    REQUIRE(p.x < width);
    REQUIRE(p.y < height);
    const std::uint8_t* c = picture.at(static_cast<int>(p.x), static_cast<int>(p.y));
    return {c[0], c[1], c[2]};
  }
};

glm::dvec3 of(ImU32 colour) { return {colour & 255, colour >> 8 & 255, colour >> 16 & 255}; }
double apart(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 d = glm::abs(a - b);
  return std::max({d.x, d.y, d.z});
}

/// The camera of a plan that fits the picture.
PlanCamera plan_of(const Snapshot& now) {
  PlanCamera camera;
  camera.size = {width, height};
  const PlanExtent all = extent_of(now);
  camera.fit(all.low, all.high);
  return camera;
}

/// The robot and the goal of rooms/u, a red box to the north that stops all, and a green one to the south that a radar passes.
World two_boxes() {
  World world;
  world.name = "two boxes";
  world.bounds = {-10.0, -6.0, 10.0, 6.0};
  world.materials.emplace_back().name = "red_paint";
  world.materials.emplace_back().name = "green_paint";
  world.materials.back().attenuation_db_per_m = 5.0;
  world.solids.push_back({"red", 0, {0.0, 3.5, 1.0}, 0.0, Box{{2.0, 2.0, 2.0}}});
  world.solids.push_back({"green", 1, {0.0, -3.5, 1.0}, 0.0, Box{{2.0, 2.0, 2.0}}});
  return world;
}

std::shared_ptr<const Snapshot> among_boxes(Runner& runner) {
  opened(runner, "rooms/u");
  runner.post(ChangeWorld{two_boxes()});
  auto now = runner.settled();
  INFO(now->message.text);
  REQUIRE_FALSE(now->message.error);
  return now;
}

}  // namespace

TEST_CASE("colours: the plan has the materials' where the solids are, what a radar passes lets the ground through, and the robot and its goal have theirs") {
  Runner runner;
  const auto now = among_boxes(runner);
  const World& world = now->simulation->scene().world();
  const PlanCamera plan = plan_of(*now);
  for (const bool dark : {true, false}) {
    CAPTURE(dark);
    const auto view = make_world_view();
    const Shot shot(*view, *now, dark);
    const Palette colours = palette(dark);
    const auto at = [&](double x, double y) { return shot.at(plan.to_screen({x, y})); };
    const glm::dvec3 ground = of(colours.background), red = 255.0 * material_colour(world.materials[0]).display, green = 255.0 * material_colour(world.materials[1]).display;
    CHECK(red.x > 1.5 * red.y);
    CHECK(green.y > 1.3 * green.x);
    CHECK(apart(at(3.3, -4.3), ground) <= 1.0);
    for (const glm::dvec2& p : {glm::dvec2(0.3, 3.3), glm::dvec2(-0.9, 2.6), glm::dvec2(0.9, 4.4)}) CHECK(apart(at(p.x, p.y), 0.95 * red + 0.05 * ground) <= 2.0);
    CHECK(apart(at(0.3, -3.3), 0.5 * green + 0.5 * ground) <= 2.0);
    for (const glm::dvec2& p : {glm::dvec2(1.2, 3.3), glm::dvec2(-1.2, -3.3), glm::dvec2(0.3, 2.3)}) CHECK(apart(at(p.x, p.y), ground) <= 1.0);
    const Pose2 robot = now->simulation->vehicle().pose;
    const glm::dvec2 behind = robot.position - 0.5 * now->simulation->mission().vehicle.radius_m * direction(robot.yaw);
    CHECK(apart(at(behind.x, behind.y), of(colours.robot)) < 40.0);
    const glm::dvec2 goal = *now->simulation->mission().planner.goal_m;
    CHECK(apart(at(goal.x, goal.y), of(colours.goal)) <= 3.0);
  }
}

TEST_CASE("colours: cells of the map are black where there is matter, white or light grey where there is none, and blue where nobody looked") {
  Runner runner;
  const auto now = opened(runner, "rooms/u", 60, {{"map.resolution_m", "0.25", "test"}});
  const auto view = make_map_view();
  const Shot shot(*view, *now);
  const PlanCamera plan = plan_of(*now);
  const OccupancyMap& map = now->simulation->map();
  const double r = 0.25;
  const auto bare = [&](const glm::dvec2& p) {  // nothing is drawn over it: no grid, way, words or scale
    const ImVec2 s = plan.to_screen(p);
    const glm::dvec2 off = glm::abs(p - glm::round(p));
    return std::min(off.x, off.y) > 0.1 && std::abs(p.y - 0.3) > 1.2 && s.x > 40.0f && s.y > 60.0f && s.x < width - 10.0f && s.y < height - 60.0f;
  };
  int matter = 0, free = 0, unknown = 0;
  const PlanExtent seen = seen_by(plan);
  for (auto row = static_cast<std::int64_t>(seen.low.y / r); row < static_cast<std::int64_t>(seen.high.y / r); ++row)
    for (auto column = static_cast<std::int64_t>(seen.low.x / r); column < static_cast<std::int64_t>(seen.high.x / r); ++column) {
      const glm::dvec2 middle = r * (glm::dvec2(static_cast<double>(column), static_cast<double>(row)) + 0.5);
      if (!bare(middle)) continue;
      const CellView cell = map.view({column, row});
      const glm::dvec3 pixel = shot.at(plan.to_screen(middle));
      CAPTURE(middle.x);
      CAPTURE(middle.y);
      if (!cell.known) {
        CHECK(apart(pixel, {0x2f, 0x4b, 0x8f}) <= 2.0);
        ++unknown;
      } else if (cell.probability > 0.51) {
        CHECK(apart(pixel, {0x11, 0x11, 0x11}) <= 2.0);
        ++matter;
      } else if (cell.probability < 0.49 && !cell.sensed_through) {
        CHECK(std::min(apart(pixel, {255, 255, 255}), apart(pixel, {0xc9, 0xcc, 0xd1})) <= 2.0);
        ++free;
      }
    }
  CHECK(matter > 20);
  CHECK(free > 200);
  CHECK(unknown > 100);
}

TEST_CASE("colours: an echo of the radar stands at its range, and nowhere else") {
  Runner runner;
  const auto now = opened(runner, "foliage_wall/bug2", 10);
  RadarView view;
  const Shot shot(view, *now);
  const Scan& scan = now->simulation->scans()[0];
  REQUIRE(scan.profiles.bins == 0);
  const auto echoes = scan.echoes_of(scan.beams[view.beam()]);
  REQUIRE_FALSE(echoes.empty());
  const Range shown = view.waterfall().range();
  const float low = 4.0f * shot.line, high = width - shot.line;  // of the axis, as `begin_chart` lays it out
  const auto column_has = [&](double range) {
    const float x = low + static_cast<float>((range - shown.low) / (shown.high - shown.low)) * (high - low);
    for (int y = 0; y < height / 2; ++y)
      if (apart(shot.at({x, static_cast<float>(y)}), of(palette(true).echo)) <= 8.0) return true;
    return false;
  };
  for (const Echo& echo : echoes) {
    CAPTURE(echo.range);
    CHECK(column_has(echo.range));
  }
  for (double range = 0.25 * shown.high; range < 0.99 * shown.high; range += 0.05 * shown.high) {
    const bool near = std::any_of(echoes.begin(), echoes.end(), [&](const Echo& echo) { return std::abs(echo.range - range) < 0.02 * shown.high; });
    CAPTURE(range);
    if (!near) CHECK_FALSE(column_has(range));
  }
}

TEST_CASE("colours: in the 3D view a solid's faces end where its corners are, and robot and goal stand in their places") {
  Runner runner;
  const auto now = among_boxes(runner);
  SpaceView view;
  Shot(view, *now);  // fits its camera
  view.camera.at = {0.0, 0.0, 0.5};
  view.camera.azimuth = -0.5 * pi;
  view.camera.elevation = radians(35.0);
  view.camera.distance = 22.0;
  const Shot shot(view, *now);
  REQUIRE(view.image());
  const PictureCamera eye(view.image()->view);
  const auto place = [&](const glm::dvec3& p) {
    const glm::dvec3 seen = eye.seen(p);
    return ImVec2(static_cast<float>(0.5 * (1.0 + seen.x) * width), static_cast<float>(0.5 * (1.0 - seen.y) * height));
  };
  const auto is_red = [&](const glm::dvec3& p) {
    const glm::dvec3 c = shot.at(place(p));
    return c.x > 1.3 * c.y && c.x > 1.3 * c.z;
  };
  // The face that looks to the camera, and the lid; a hand's breadth beside them is something else.
  for (const glm::dvec3& p : {glm::dvec3(0.0, 2.5, 1.0), glm::dvec3(-0.8, 2.5, 0.3), glm::dvec3(0.8, 2.5, 1.7), glm::dvec3(0.0, 3.5, 2.0), glm::dvec3(0.8, 4.2, 2.0)}) CHECK(is_red(p));
  for (const glm::dvec3& p : {glm::dvec3(1.2, 2.5, 1.0), glm::dvec3(-1.2, 2.5, 1.0), glm::dvec3(0.0, 2.5, -0.4), glm::dvec3(0.0, 5.0, 2.0)}) CHECK_FALSE(is_red(p));
  const glm::dvec3 green = shot.at(place({0.0, -4.5, 1.0}));
  CHECK(green.y > 1.15 * green.x);
  // Lines are thin: their colour is within two pixels.
  const auto near = [&](const glm::dvec3& p, ImU32 colour) {
    const ImVec2 s = place(p);
    double best = 255.0;
    for (float y = -2.0f; y <= 2.0f; ++y)
      for (float x = -2.0f; x <= 2.0f; ++x) best = std::min(best, apart(shot.at({s.x + x, s.y + y}), of(colour)));
    return best < 60.0;
  };
  const Simulation& s = *now->simulation;
  const glm::dvec3 base = s.vehicle_pose().position;
  const Hull hull = s.mission().vehicle.hull();
  CHECK(near(base + glm::dvec3(0.0, -hull.radius, hull.z_low), palette(true).robot));
  CHECK_FALSE(near(base + glm::dvec3(3.0, 0.0, 0.0), palette(true).robot));
  const glm::dvec2 goal = *s.mission().planner.goal_m;
  CHECK(near({goal, base.z + 0.5}, palette(true).goal));
  CHECK_FALSE(near({goal.x - 3.0, goal.y, base.z + 0.5}, palette(true).goal));
}

}  // namespace thicket::gui
