// The 3D view, drawn by ImGui without any back end.
#include <doctest/doctest.h>

#include <chrono>
#include <thread>

#include <glm/geometric.hpp>

#include "gui/missions.hpp"
#include "gui/panels_sheet.hpp"
#include "views/space_view.hpp"

namespace thicket::gui {
using namespace panels;

TEST_CASE("3D: the solid in the middle has its colour and its distance, and the camera goes around it") {
  World world;
  world.name = "test";
  world.materials.emplace_back().name = "red_paint";
  world.solids.push_back({"thing", 0, {3.0, 0.0, 1.0}, 0.0, Box{{2.0, 2.0, 2.0}}});
  Runner runner;
  opened(runner, "rooms/u", 0);
  runner.post(ChangeWorld{world});
  const auto now = runner.settled();
  REQUIRE_FALSE(now->message.error);
  Sheet sheet(161.0f, 121.0f);
  NoTextures none;
  SpaceView view;
  sheet.draw(view, *now, none, true);
  view.camera.at = {3.0, 0.0, 1.0};
  view.camera.distance = 7.0;
  view.camera.azimuth = pi;
  view.camera.elevation = 0.0;
  sheet.draw(view, *now, none, true);
  const WorldImage* image = view.image();
  REQUIRE(image);
  CHECK(image->finest);
  const std::size_t middle = static_cast<std::size_t>(image->height / 2) * static_cast<std::size_t>(image->width) + static_cast<std::size_t>(image->width / 2);
  const std::uint32_t pixel = image->pixels[middle];
  CHECK((pixel & 255u) > 1.3 * (pixel >> 16 & 255u));
  CHECK((pixel & 255u) > 1.3 * (pixel >> 8 & 255u));
  // Seen from the west: its face is at x = 2, the camera at x = -4.
  const PictureCamera eye(image->view);
  CHECK(static_cast<double>(image->depth_at(0.0, 0.0)) == doctest::Approx(6.0).epsilon(1e-4));
  CHECK(static_cast<double>(image->depth[0]) == infinity);
  Overlay overlay(*ImGui::GetForegroundDrawList(), {0.0f, 0.0f}, {161.0f, 121.0f}, image->view, image);
  CHECK(overlay.hidden({5.0, 0.0, 1.0}));
  CHECK_FALSE(overlay.hidden({1.9, 0.0, 1.0}));
  const auto place = overlay.place({3.0, 0.0, 1.0});
  REQUIRE(place);
  CHECK(place->x == doctest::Approx(80.5));
  CHECK_FALSE(overlay.place({-5.0, 0.0, 1.0}));
}

TEST_CASE("3D: the mouse turns, moves and zooms, and F fits; a coarse picture comes first and a fine one when it stands") {
  Runner runner;
  const auto now = opened(runner, "rooms/u", 4);
  Sheet sheet;
  KeptTextures textures;
  SpaceView view;
  ImGuiIO& io = ImGui::GetIO();
  const auto frames = [&](int count) {
    for (int i = 0; i < count; ++i) sheet.draw(view, *now, textures);
  };
  io.MousePos = {300.0f, 250.0f};
  frames(2);
  const Orbit fitted = view.camera;
  const auto drag = [&](int button, float x, float y) {
    io.MouseDown[button] = true;
    frames(2);
    io.MousePos = {io.MousePos.x + x, io.MousePos.y + y};
    frames(1);
    io.MouseDown[button] = false;
    frames(1);
  };
  drag(0, 50.0f, 0.0f);
  CHECK(view.camera.azimuth != doctest::Approx(fitted.azimuth));
  CHECK(view.camera.at == fitted.at);
  drag(1, 0.0f, 40.0f);
  CHECK(view.camera.at != fitted.at);
  io.MouseWheel = 2.0f;
  frames(1);
  CHECK(view.camera.distance == doctest::Approx(fitted.distance * 0.85 * 0.85));
  io.KeysDown[static_cast<int>('F')] = true;
  frames(1);
  io.KeysDown[static_cast<int>('F')] = false;
  frames(1);
  CHECK(view.camera.distance == doctest::Approx(fitted.distance));
  CHECK(view.camera.azimuth == doctest::Approx(fitted.azimuth));
  // Left alone, it becomes as fine as the view.
  const auto begun = std::chrono::steady_clock::now();
  while ((!view.image() || !view.image()->finest) && std::chrono::steady_clock::now() - begun < std::chrono::seconds(60)) {
    frames(1);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  REQUIRE(view.image());
  CHECK(view.image()->finest);
  CHECK(view.image()->width == view.image()->view.width);
  CHECK(textures.all.at("space").width == view.image()->width);
}

TEST_CASE("3D: a click selects the solid that is seen there, a drag does not, and a double click sets the goal") {
  World world;
  world.name = "test";
  world.materials.emplace_back().name = "red_paint";
  world.solids.push_back({"ceiling", 0, {3.0, 0.0, 3.0}, 0.0, Box{{20.0, 20.0, 0.1}}});
  world.solids.push_back({"near", 0, {3.0, -3.0, 1.0}, 0.0, Box{{2.0, 2.0, 2.0}}});
  world.solids.push_back({"far", 0, {3.0, 3.0, 1.0}, 0.0, Sphere{1.0}});
  Runner runner;
  opened(runner, "rooms/u", 0);
  runner.post(ChangeWorld{world});
  const auto now = runner.settled();
  REQUIRE_FALSE(now->message.error);
  Sheet sheet(641.0f, 481.0f);
  KeptTextures textures;
  SpaceView view;
  ImGuiIO& io = ImGui::GetIO();
  io.MousePos = {300.0f, 250.0f};
  const auto frames = [&](int count) {
    for (int i = 0; i < count; ++i) sheet.draw(view, *now, textures);
  };
  frames(1);
  view.camera = {{3.0, 0.0, 1.0}, 14.0, -0.5 * pi, radians(50.0), 50.0};
  const auto begun = std::chrono::steady_clock::now();
  do {
    frames(1);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  } while ((!view.image() || !view.image()->finest || view.image()->view.from != view.camera.view(1, 1).from) && std::chrono::steady_clock::now() - begun < std::chrono::seconds(60));
  REQUIRE(view.image());
  const PictureCamera eye(view.image()->view);
  const float bar = static_cast<float>(481 - 8 - view.image()->view.height);  // what is above the picture
  const auto to = [&](const glm::dvec3& p) {
    const glm::dvec3 seen = eye.seen(p);
    io.MousePos = {8.0f + 0.5f * (1.0f + static_cast<float>(seen.x)) * static_cast<float>(view.image()->view.width), bar + 0.5f * (1.0f - static_cast<float>(seen.y)) * static_cast<float>(view.image()->view.height)};
    frames(2);
  };
  const auto click = [&](const glm::dvec3& p) {
    to(p);
    for (int i = 0; i < 40; ++i) frames(1);  // long after the last one
    for (const bool down : {true, false}) io.MouseDown[0] = down, frames(1);
  };
  const int plain = sheet.draw(view, *now, textures);
  click({3.0, -3.0, 2.0});
  CHECK(sheet.desk.solid == 1u);
  CHECK(sheet.draw(view, *now, textures) > plain);  // its edges
  click({3.0, 3.0, 1.0});
  CHECK(sheet.desk.solid == 2u);
  click({8.0, -4.0, 0.0});
  CHECK_FALSE(sheet.desk.solid);
  click({3.0, 3.0, 1.0});
  to({3.0, -3.0, 2.0});
  io.MouseDown[0] = true;
  frames(1);
  io.MousePos.x += 40.0f;
  frames(1);
  io.MouseDown[0] = false;
  frames(1);
  CHECK(sheet.desk.solid == 2u);
  CHECK(sheet.posted.empty());

  // The camera has turned: what is under the mouse is another place.
  const auto there = pick_in_space(now->simulation->scene(), view.camera.view(641, 481), 0.0, 0.0);
  CHECK_FALSE(there);
  SpaceView fresh;
  sheet.draw(fresh, *now, textures);
  for (int i = 0; i < 40; ++i) sheet.draw(fresh, *now, textures);
  io.MousePos = {320.0f, 470.0f};  // below all that there is
  for (const bool down : {false, true, false, true, false}) io.MouseDown[0] = down, sheet.draw(fresh, *now, textures);
  REQUIRE(sheet.posted.size() == 1);
  const auto* goal = std::get_if<SetGoal>(&sheet.posted[0]);
  REQUIRE(goal);
  CHECK(std::isfinite(goal->goal.x));
}

TEST_CASE("3D: what is picked is the first surface that is shown") {
  World world;
  world.materials.emplace_back().name = "paint";
  world.solids.push_back({"ceiling", 0, {0.0, 0.0, 3.0}, 0.0, Box{{20.0, 20.0, 0.1}}});
  world.solids.push_back({"box", 0, {0.0, 0.0, 1.0}, 0.0, Box{{2.0, 2.0, 2.0}}});
  const auto scene = Scene::build(world);
  REQUIRE(scene);
  PictureView view;
  view.from = glm::dvec3(0.0, -1.0, 9.0);
  view.at = glm::dvec3(0.0, 0.0, 2.0);
  // Through the ceiling, which is left out from above.
  const auto box = pick_in_space(*scene, view, 0.0, 0.0);
  REQUIRE(box);
  CHECK(box->solid == 1);
  CHECK(glm::distance(box->point, {0.0, 0.0, 2.0}) < 1e-6);
  CHECK_FALSE(pick_in_space(*scene, view, 1.0, 0.0));
  view.from = glm::dvec3(0.0, -5.0, 1.0);
  view.at = glm::dvec3(0.0, 0.0, 6.0);
  const auto ceiling = pick_in_space(*scene, view, 0.0, 0.0);
  REQUIRE(ceiling);
  CHECK(ceiling->solid == 0);
}

}  // namespace thicket::gui
