#include <doctest/doctest.h>

#include <chrono>
#include <thread>
#include <utility>

#include <glm/geometric.hpp>
#include <imgui.h>

#include "thicket/base/files.hpp"
#include "thicket/gui/runner.hpp"
#include "thicket/sim/material_colour.hpp"
#include "missions.hpp"
#include "views/plan.hpp"

namespace thicket::gui {
namespace {

/// Counts what would go to a graphics card.
struct CountedTextures final : Textures {
  std::map<std::string, std::pair<int, int>> sizes;
  std::map<std::string, std::vector<std::uint32_t>> pixels;
  std::size_t sent = 0;
  ImTextureID get(const std::string& name, int width, int height, bool& fresh) override {
    fresh = sizes[name] != std::pair(width, height);
    sizes[name] = {width, height};
    if (fresh) pixels[name].assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0u);
    return nullptr;
  }
  void update(const std::string& name, int x, int y, int width, int height, const std::uint32_t* from) override {
    const auto across = static_cast<std::size_t>(sizes[name].first);
    REQUIRE(x + width <= sizes[name].first);
    REQUIRE(y + height <= sizes[name].second);
    for (int r = 0; r < height; ++r)
      for (int c = 0; c < width; ++c) pixels[name][static_cast<std::size_t>(y + r) * across + static_cast<std::size_t>(x + c)] = from[r * width + c];
    sent += static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};

/// ImGui without any back end, with one window that a view fills, and a hand that moves the mouse.
class Stand {
 public:
  explicit Stand(std::unique_ptr<View> view) : view_(std::move(view)) {
    context_ = ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {1000.0f, 700.0f};
    io.IniFilename = nullptr;
    unsigned char* alpha = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsAlpha8(&alpha, &width, &height);
    io.MousePos = {-1.0f, -1.0f};
  }
  ~Stand() { ImGui::DestroyContext(context_); }
  Stand(const Stand&) = delete;
  Stand& operator=(const Stand&) = delete;

  /// Draws and gives the number of vertices.
  int frame(bool still = false) {
    ImGuiIO& io = ImGui::GetIO();
    io.DeltaTime = 1.0f / 60.0f;
    ImGui::NewFrame();
    ImGui::SetNextWindowPos({0.0f, 0.0f});
    ImGui::SetNextWindowSize({1000.0f, 700.0f});
    ImGui::Begin("stand", nullptr, ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoCollapse);
    const Frame frame{*now, colours_, textures, desk, [this](Action action) { posted.push_back(std::move(action)); }, 1.0, still};
    view_->draw(frame);
    ImGui::End();
    ImGui::Render();
    io.MouseWheel = 0.0f;
    std::fill(std::begin(io.KeysDown), std::end(io.KeysDown), false);
    return ImGui::GetDrawData()->TotalVtxCount;
  }
  void move(const ImVec2& to) {
    ImGui::GetIO().MousePos = to;
    frame();
  }
  void press(bool down) {
    ImGui::GetIO().MouseDown[0] = down;
    frame();
  }
  void click(const ImVec2& at) {
    move(at);
    press(true);
    press(false);
  }
  void drag(const ImVec2& from, const ImVec2& to) {
    move(from);
    press(true);
    move({0.5f * (from.x + to.x), 0.5f * (from.y + to.y)});
    move(to);
    press(false);
  }
  int key(char which) {
    ImGui::GetIO().KeysDown[static_cast<int>(which)] = true;
    frame();
    return frame();
  }
  /// Where the world view's plan is.
  PlanCamera camera() {
    struct Spy final : PlanTool {
      explicit Spy(PlanCamera& to) : seen(to) {}
      const char* name() const override { return "spy"; }
      const char* help() const override { return ""; }
      void use(const Frame&, const PlanCamera& c, bool, ImDrawList&) override { seen = c; }
      PlanCamera& seen;
    };
    PlanCamera seen;
    auto before = std::exchange(desk.tool, std::make_unique<Spy>(seen));
    frame();
    desk.tool = std::move(before);
    return seen;
  }

  std::shared_ptr<const Snapshot> now;
  CountedTextures textures;
  Desk desk;
  std::vector<Action> posted;

 private:
  ImGuiContext* context_;
  std::unique_ptr<View> view_;
  Palette colours_ = palette(true);
};

std::shared_ptr<const Snapshot> snapshot_of(const std::string& mission, int steps = 0, std::vector<Override> overrides = {}) {
  Runner runner;
  return opened(runner, mission, steps, std::move(overrides));
}

/// The one action that was posted.
template <class A>
A only(const std::vector<Action>& posted) {
  REQUIRE(posted.size() == 1);
  REQUIRE(std::holds_alternative<A>(posted[0]));
  return std::get<A>(posted[0]);
}

}  // namespace

TEST_CASE("plan: the wheel keeps the point under the cursor, a drag moves the plan with the hand") {
  Stand stand(make_world_view());
  stand.now = snapshot_of("rooms/u");
  stand.frame();
  const ImVec2 cursor{620.0f, 300.0f};
  stand.move(cursor);
  const PlanCamera before = stand.camera();
  ImGui::GetIO().MouseWheel = 3.0f;
  const PlanCamera zoomed = stand.camera();
  CHECK(zoomed.pixels_per_metre > 1.5 * before.pixels_per_metre);
  CHECK(glm::distance(zoomed.to_world(cursor), before.to_world(cursor)) < 1e-6);
  // Somewhere without robot or goal.
  const ImVec2 from{30.0f, 60.0f}, to{130.0f, 110.0f};
  const glm::dvec2 held = zoomed.to_world(from);
  stand.move(from);
  stand.press(true);
  stand.move({60.0f, 80.0f});
  stand.move(to);
  const PlanCamera dragged = stand.camera();
  stand.press(false);
  CHECK(glm::distance(dragged.to_world(to), held) * dragged.pixels_per_metre < 1.0);
  CHECK(stand.posted.empty());
  stand.key('F');
  CHECK(stand.camera().pixels_per_metre == doctest::Approx(before.pixels_per_metre));
}

TEST_CASE("plan: robot up and follow") {
  Stand stand(make_world_view());
  stand.now = snapshot_of("rooms/u", 100);
  stand.frame();
  stand.move({500.0f, 400.0f});
  stand.key('N');
  stand.key('T');
  const PlanCamera camera = stand.camera();
  const Pose2& pose = stand.now->simulation->vehicle().pose;
  const ImVec2 robot = camera.to_screen(pose.position), ahead = camera.to_screen(pose.position + direction(pose.yaw));
  CHECK(std::abs(ahead.x - robot.x) < 0.01f);
  CHECK(ahead.y < robot.y - 1.0f);
  CHECK(std::abs(robot.x - (camera.low.x + 0.5f * camera.size.x)) < 0.01f);
}

TEST_CASE("plan: a click with the goal tool and a double click without one set the goal there") {
  Stand stand(make_world_view());
  stand.now = snapshot_of("rooms/u");
  stand.frame();
  const PlanCamera camera = stand.camera();
  const ImVec2 at{200.0f, 500.0f};
  REQUIRE(Handles::at(Frame{*stand.now, palette(true), stand.textures, stand.desk, nullptr}, camera, at) == Handles::What::nothing);
  SUBCASE("tool") {
    stand.move({300.0f, 300.0f});
    stand.key('G');
    REQUIRE(stand.desk.tool);
    stand.click(at);
  }
  SUBCASE("double click") {
    stand.click(at);
    CHECK(stand.posted.empty());
    stand.click(at);
  }
  CHECK(glm::distance(only<SetGoal>(stand.posted).goal, camera.to_world(at)) < 1e-9);
}

TEST_CASE("plan: robot, heading and goal are dragged without a tool") {
  Stand stand(make_world_view());
  stand.now = snapshot_of("rooms/u");
  stand.frame();
  const PlanCamera camera = stand.camera();
  const Pose2 pose = stand.now->simulation->vehicle().pose;
  const glm::dvec2 goal = *stand.now->simulation->mission().planner.goal_m, moved = pose.position + glm::dvec2(0.7, 0.4);
  SUBCASE("a click alone does nothing") {
    stand.click(camera.to_screen(pose.position));
    CHECK(stand.posted.empty());
  }
  SUBCASE("robot") {
    stand.drag(camera.to_screen(pose.position), camera.to_screen(moved));
    const Pose2 wanted = only<MoveRobot>(stand.posted).pose;
    CHECK(glm::distance(wanted.position, moved) < 2.0 / camera.pixels_per_metre);  // the mouse knows whole pixels
    CHECK(wanted.yaw == pose.yaw);
  }
  SUBCASE("goal") {
    stand.drag(camera.to_screen(goal), camera.to_screen(goal + glm::dvec2(-0.5, 0.2)));
    CHECK(glm::distance(only<SetGoal>(stand.posted).goal, goal + glm::dvec2(-0.5, 0.2)) < 2.0 / camera.pixels_per_metre);
  }
  SUBCASE("heading") {
    const double radius = stand.now->simulation->mission().vehicle.radius_m, off = radius + std::max(0.4 * radius, 14.0 / camera.pixels_per_metre);
    stand.drag(camera.to_screen(pose.position + off * direction(pose.yaw)), camera.to_screen(pose.position + direction(2.0)));
    const Pose2 wanted = only<MoveRobot>(stand.posted).pose;
    CHECK(wanted.position == pose.position);
    CHECK(wanted.yaw == doctest::Approx(2.0).epsilon(0.01));
  }
  // The plan stood still meanwhile.
  CHECK(stand.camera().centre == camera.centre);
}

TEST_CASE("plan: the inspector finds the solid under the cursor, and the desk knows it") {
  Stand stand(make_world_view());
  stand.now = snapshot_of("foliage_wall/bug2");
  stand.frame();
  const PlanCamera camera = stand.camera();
  const World& world = stand.now->simulation->scene().world();
  stand.move({300.0f, 300.0f});
  stand.key('I');
  int found = 0;
  for (const Solid& solid : world.solids) {
    const Bounds box = extent(solid);
    const glm::dvec3 point = box.low + glm::dvec3(0.03, 0.03, 0.2);
    if (solid.name == "floor" || solid.name == "ceiling" || !inside(solid, point)) continue;
    stand.click(camera.to_screen(glm::dvec2(point)));
    REQUIRE(stand.desk.solid);
    const Bounds other = extent(world.solids[*stand.desk.solid]);
    CHECK(point.x > other.low.x - 0.05);
    CHECK(point.x < other.high.x + 0.05);
    ++found;
  }
  CHECK(found > 0);
}

TEST_CASE("plan: every layer's key changes what is drawn, and again changes it back") {
  struct Layer {
    const char* mission;
    std::string keys;
  };
  for (const auto& [mission, keys] : {Layer{"foliage_wall/bug2", "123478Y0BK"}, {"findings/lobes", "6"}, {"foliage_wall/map_lidar", "5"}}) {
    Stand stand(make_world_view());
    stand.now = snapshot_of(mission, 120);
    stand.frame();
    stand.move({500.0f, 350.0f});
    for (const char key : keys) {
      CAPTURE(key);
      const int before = stand.frame();
      stand.key(key);
      for (int i = 0; i < 200 && stand.frame() == before; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));  // the truth comes from beside
      CHECK(stand.frame() != before);
      for (int again = key == '7' || key == 'Y' ? 2 : 1; again > 0; --again) stand.key(key);
      CHECK(stand.frame() == before);
    }
  }
}

TEST_CASE("plan: beams that the screen cannot tell apart are merged, and all of them are seen") {
  Stand stand(make_world_view());
  stand.now = snapshot_of("rooms/u", 4, {{"sensor.step_deg", "0.02675", "test"}});
  REQUIRE(stand.now->simulation->scans()[0].beams.size() >= 13456);
  stand.frame();
  stand.move({500.0f, 350.0f});
  stand.key('2');
  const int with = stand.frame(), without = stand.key('1');
  CHECK(with - without > 1000);
  CHECK(with - without < 40000);
}

TEST_CASE("plan: of the map only what has changed is sent, and the pictures are the map") {
  Stand stand(make_map_view());
  Runner runner;
  runner.post(Open{"rooms/u", {}});
  runner.post(StepBy{200});
  stand.now = runner.settled();
  stand.frame();
  CHECK(stand.textures.sent > 0);
  const auto check = [&] {
    const OccupancyMap& map = stand.now->simulation->map();
    std::size_t wrong = 0, known = 0;
    for (const auto& [name, pixels] : stand.textures.pixels) {
      int column = 0, row = 0;
      REQUIRE(std::sscanf(name.c_str(), "map %d %d", &column, &row) == 2);
      for (int y = 0; y < 512; ++y)
        for (int x = 0; x < 512; ++x) {
          const CellView cell = map.view({column * 512 + x, row * 512 + y});
          const std::uint32_t pixel = pixels[static_cast<std::size_t>(y) * 512 + static_cast<std::size_t>(x)];
          known += cell.known;
          wrong += cell.known ? pixel == MapPicture::unknown_colour || (pixel == IM_COL32(0x11, 0x11, 0x11, 255)) != (cell.probability > 0.5) : pixel != MapPicture::unknown_colour;
        }
    }
    CHECK(wrong == 0);
    CHECK(known == map.known_cells());
  };
  check();
  stand.textures.sent = 0;
  stand.frame();
  CHECK(stand.textures.sent == 0);
  runner.post(StepBy{2});
  stand.now = runner.settled();
  stand.frame();
  CHECK(stand.textures.sent > 0);
  CHECK(stand.textures.sent < 100 * 64 * 64);
  check();
  runner.post(SeekTo{0});
  stand.now = runner.settled();
  stand.frame();
  check();
}

TEST_CASE("plan: the map view tells the cell under the cursor and the score against the truth") {
  const auto now = snapshot_of("rooms/u", 200);
  const Simulation& run = *now->simulation;
  CHECK(describe_cell(run, run.vehicle().pose.position).find("p 0.") != std::string::npos);
  CHECK(describe_cell(run, {1e4, 1e4}).find("never sensed") != std::string::npos);
  Stand stand(make_map_view());
  stand.now = now;
  const int plain = stand.frame();
  stand.move({500.0f, 350.0f});
  CHECK(stand.frame() > plain);
  const int before = stand.frame();
  stand.key('C');
  int judged = stand.frame();
  for (int i = 0; i < 500 && judged < before + 400; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    judged = stand.frame();
  }
  CHECK(judged >= before + 400);  // lines of words, four corners a letter
}

TEST_CASE("plan: what a radar passes is told from what stops it") {
  Material leaves{.name = "foliage", .attenuation_db_per_m = 5.0}, metal{.name = "metal"};
  CHECK(material_colour(leaves).penetrable);
  CHECK_FALSE(material_colour(metal).penetrable);
  CHECK(material_colour(leaves).display.y > material_colour(leaves).display.x);
}

TEST_CASE("plan: an edited world sends only meshes that are new") {
  Stand stand(make_world_view());
  Runner runner;
  runner.post(Open{"thicket/way_round", {}});
  stand.now = runner.settled();
  stand.frame(true);
  CHECK(stand.textures.sent > 0);
  stand.textures.sent = 0;
  World world = stand.now->simulation->scene().world();
  world.solids.push_back({"added", 0, {-6.0, 3.0, 0.5}, 0.0, Box{}});
  runner.post(ChangeWorld{world});
  const int before = stand.frame();
  stand.now = runner.settled();
  REQUIRE_FALSE(stand.now->message.error);
  CHECK(stand.frame() > before);
  CHECK(stand.textures.sent == 0);
}

TEST_CASE("plan: every shipped mission is drawn in both views, at its start and after 50 steps") {
  for (const auto& file : shipped_missions()) {
    CAPTURE(file.string());
    Runner runner;
    runner.post(Open{file, {}});
    for (const int steps : {0, 50}) {
      if (steps > 0) runner.post(StepBy{steps});
      const auto now = runner.settled();
      REQUIRE(now->simulation);
      for (auto* make : {&make_world_view, &make_map_view}) {
        Stand stand((*make)());
        stand.now = now;
        CHECK(stand.frame(true) > 100);
        CHECK(stand.frame() > 100);
      }
    }
  }
}

}  // namespace thicket::gui
