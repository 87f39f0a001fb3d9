// Large meshes in the plan: their footprints are made beside the drawing.
#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "missions.hpp"
#include "panels_sheet.hpp"
#include "thicket/worlds/mesh.hpp"

namespace thicket::gui {
using namespace panels;

namespace {

/// A hilly sheet of side x side squares, 4 m wide.
std::shared_ptr<const Mesh> hills(unsigned side) {
  std::vector<glm::dvec3> vertices;
  std::vector<glm::uvec3> triangles;
  for (unsigned row = 0; row <= side; ++row)
    for (unsigned column = 0; column <= side; ++column) {
      const double x = 4.0 * column / side - 2.0, y = 4.0 * row / side - 2.0;
      vertices.push_back({x, y, 1.0 + 0.3 * std::sin(3.0 * x) * std::cos(2.0 * y)});
      if (row == side || column == side) continue;
      const unsigned a = row * (side + 1) + column, b = a + side + 1;
      triangles.push_back({a, a + 1, b});
      triangles.push_back({a + 1, b + 1, b});
    }
  return make_mesh(std::move(vertices), std::move(triangles));
}

World with(const std::shared_ptr<const Mesh>& mesh) {
  World world;
  world.name = "hills";
  world.materials.emplace_back().name = "earth";
  world.solids.push_back({"hills", 0, {2.0, -3.0, 0.0}, 0.0, MeshSolid{mesh}});
  return world;
}

}  // namespace

TEST_CASE("plan: a large mesh is a rectangle until its footprint is made, which the window does not wait for") {
  Runner runner;
  opened(runner, "rooms/u");
  runner.post(ChangeWorld{with(hills(150))});
  auto now = runner.settled();
  INFO(now->message.text);
  REQUIRE_FALSE(now->message.error);
  const auto masks = [](const KeptTextures& textures) { return std::count_if(textures.all.begin(), textures.all.end(), [](const auto& kept) { return kept.first.starts_with("world mask"); }); };
  Sheet sheet;
  {
    // A picture has it at once.
    KeptTextures textures;
    const auto view = make_world_view();
    sheet.draw(*view, *now, textures, true);
    CHECK(masks(textures) == 1);
  }
  KeptTextures textures;
  const auto view = make_world_view();
  const auto begun = std::chrono::steady_clock::now();
  sheet.draw(*view, *now, textures);
  CHECK(masks(textures) == 0);
  while (masks(textures) == 0 && std::chrono::steady_clock::now() - begun < std::chrono::seconds(60)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    sheet.draw(*view, *now, textures);
  }
  REQUIRE(masks(textures) == 1);
  // All of the rectangle is covered.
  const auto& kept = std::find_if(textures.all.begin(), textures.all.end(), [](const auto& one) { return one.first.starts_with("world mask"); })->second;
  const auto middle = static_cast<std::size_t>(kept.height / 2 * kept.width + kept.width / 2);
  CHECK((kept.pixels[middle] >> 24) > 250u);
  // Another world while it is made: what is gone is not waited for, what is there comes.
  const auto other = make_world_view();
  KeptTextures fresh;
  sheet.draw(*other, *now, fresh);
  runner.post(ChangeWorld{with(hills(50))});
  now = runner.settled();
  for (int i = 0; i < 5000 && masks(fresh) == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    sheet.draw(*other, *now, fresh);
  }
  CHECK(masks(fresh) == 1);
}

}  // namespace thicket::gui
