#include <doctest/doctest.h>
#include <stdlib.h>  // setenv

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <nlohmann/json.hpp>

#include "core/desk.hpp"
#include "missions.hpp"
#include "platform/clicks.hpp"
#include "temporary_folder.hpp"
#include "thicket/base/files.hpp"
#include "thicket/gui/render.hpp"
#include "thicket/gui/window.hpp"

namespace thicket::gui {
namespace {

namespace fs = std::filesystem;

bool of_one_colour(const Picture& picture) {
  for (std::size_t i = 3; i < picture.rgb.size(); ++i)
    if (picture.rgb[i] != picture.rgb[i - 3]) return false;
  return true;
}

bool is(const Picture& picture, int x, int y, ImU32 colour) {
  const std::uint8_t* p = picture.at(x, y);
  return p[0] == (colour & 255) && p[1] == (colour >> 8 & 255) && p[2] == (colour >> 16 & 255);
}

std::unique_ptr<Platform> offscreen(const Size& size) {
  auto platform = open_offscreen(size);
  if (!platform) FAIL(platform.error().message);
  return std::move(*platform);
}

/// The status of a command, and what it printed.
std::pair<int, std::string> call(const std::string& command) {
  std::string printed;
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  REQUIRE(pipe);
  char buffer[4096];
  while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, pipe)) printed.append(buffer, count);
  const int status = pclose(pipe);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, printed};
}

/// A session with the window, on a screen of its own (Xvfb), with real clicks and keys (xdotool).
struct Session {
  TemporaryFolder folder;
  nlohmann::json report;

  /// Opens the mission, does what the lines of shell say, and quits by Ctrl+Q. False, with a message, where the programs for it are not there.
  bool run(const std::string& mission, const std::string& deeds) {
    for (const char* needed : {"Xvfb", "xdotool"})
      if (!has_program(needed)) {
        MESSAGE("skipped: there is no ", needed, " (Debian packages xvfb, xdotool)");
        return false;
      }
    // The server picks a free display and tells it when it listens. Without -noreset it would refuse who comes while it forgets its last client.
    const fs::path script = folder.write("session.sh", "cd '" + folder.path().string() + R"SH('; export XDG_CONFIG_HOME=$PWD
mkfifo display
Xvfb -displayfd 3 -screen 0 1280x800x24 -nolisten tcp -noreset -ac 3>display 2>xvfb.log & server=$!
trap 'kill $server' EXIT
read -r number <display || { cat xvfb.log; exit 9; }
export DISPLAY=:$number
)SH" THICKET_PROGRAM " gui " + mission + R"SH( --report report.json & program=$!
window() { xdotool search --pid $program 2>/dev/null | tail -n 1; }
for i in $(seq 200); do [ -n "$(window)" ] && break; kill -0 $program || exit 8; sleep 0.1; done
sleep 1.5; xdotool windowfocus "$(window)"; sleep 0.3
)SH" + deeds + "xdotool key ctrl+q; wait $program\n");
    const auto [code, text] = call("timeout 90 bash '" + script.string() + "'");
    INFO(text);
    REQUIRE(code == 0);
    report = nlohmann::json::parse(*read_text_file(folder.path() / "report.json"));
    CHECK(report["gl_errors"] == 0);
    return true;
  }
};

}  // namespace

TEST_CASE("keys: a key does one thing, every deed has one, and typed letters are letters") {
  const auto table = key_table();
  for (std::size_t i = 0; i < table.size(); ++i)
    for (std::size_t j = i + 1; j < table.size(); ++j) {
      CAPTURE(table[i].help);
      CAPTURE(table[j].help);
      CHECK_FALSE((table[i].key == table[j].key && table[i].ctrl == table[j].ctrl && table[i].shift == table[j].shift));
    }
  for (int deed = 0; deed <= static_cast<int>(Deed::fly_right); ++deed) {
    CAPTURE(deed);
    CHECK(*key_of(static_cast<Deed>(deed)) != '\0');
  }
  CHECK(deed_of({GLFW_KEY_SPACE}, false) == Deed::play);
  CHECK(deed_of({GLFW_KEY_SPACE}, true) == std::nullopt);
  CHECK(deed_of({GLFW_KEY_SPACE, false, false, false, true}, false) == std::nullopt);  // held: not once more
  CHECK(deed_of({GLFW_KEY_RIGHT, false, false, false, true}, false) == Deed::forward);
  CHECK(deed_of({GLFW_KEY_RIGHT, false, true}, false) == Deed::forward_ten);
  CHECK(deed_of({GLFW_KEY_S, true}, true) == Deed::save_mission);
  CHECK(deed_of({GLFW_KEY_S, true, true}, true) == Deed::save_mission_as);
  CHECK(deed_of({GLFW_KEY_S}, false) == std::nullopt);  // drives, while it is held
  CHECK(deed_of({GLFW_KEY_F5}, true) == Deed::reload);
  CHECK(deed_of({GLFW_KEY_Q, true, false, true}, false) == std::nullopt);
}

TEST_CASE("keys: those that are held, and the stick, are one command within the limits") {
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  CHECK(hand_command({}, 0.7, 2.0).speed == 0.0);
  io.KeysDown[GLFW_KEY_W] = io.KeysDown[GLFW_KEY_D] = true;
  CHECK(hand_command({}, 0.7, 2.0).speed == doctest::Approx(0.7));
  CHECK(hand_command({}, 0.7, 2.0).turn_rate == doctest::Approx(-1.0));
  CHECK(hand_command({1.0, 0.5}, 0.7, 2.0).speed == doctest::Approx(0.7));
  CHECK(hand_command({1.0, 0.5}, 0.7, 2.0).turn_rate == doctest::Approx(-0.5));
  // Pressed with Ctrl, and Ctrl let go first: that is no wish to drive.
  Chords chords;
  const KeyPress with_ctrl[] = {{GLFW_KEY_W, true}};
  follow(chords, with_ctrl);
  CHECK(hand_command({}, 0.7, 2.0, chords).speed == 0.0);
  io.KeysDown[GLFW_KEY_W] = false;
  follow(chords, {});
  CHECK(chords.empty());
  io.WantTextInput = true;
  CHECK(hand_command({}, 0.7, 2.0).speed == 0.0);
  ImGui::DestroyContext();
}

TEST_CASE("mouse: clicks that fall between two frames are two clicks, where the mouse was then") {
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.DeltaTime = 0.1f;  // a busy computer
  io.MouseDoubleClickTime = 0.45f;
  io.DisplaySize = {100.0f, 100.0f};
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  io.Fonts->GetTexDataAsAlpha8(&pixels, &width, &height);
  Clicks clicks;
  for (const bool down : {true, false, true, false}) clicks.note(0, down, {30.0f, 40.0f});
  clicks.note(99, true, {0.0f, 0.0f});  // such a button ImGui does not know
  int presses = 0, doubles = 0, frames = 0;
  for (; !clicks.empty(); ++frames) {
    io.MousePos = {70.0f, 70.0f};  // it is somewhere else by now
    clicks.next(io);
    CHECK(io.MousePos.x == 30.0f);
    ImGui::NewFrame();
    presses += ImGui::IsMouseClicked(0) ? 1 : 0;
    doubles += ImGui::IsMouseDoubleClicked(0) ? 1 : 0;
    ImGui::EndFrame();
  }
  CHECK(frames == 4);
  CHECK(presses == 2);
  CHECK(doubles == 1);
  CHECK_FALSE(io.MouseDown[0]);
  ImGui::DestroyContext();
}

TEST_CASE("settings: what is written is read; what cannot be read is as by default") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "thicket" / "window.json";
  Settings s;
  s.dark = false;
  s.width = 1000;
  s.left_share = 0.3;
  s.lower_view = "Plots";
  for (int i = 0; i < 20; ++i) s.used(fmt::format("/maps/{}.toml", i % 15));
  s.used("/maps/14.toml");
  CHECK(s.recent.size() == Settings::most_recent);
  CHECK(s.recent[0] == "/maps/14.toml");
  CHECK(std::count(s.recent.begin(), s.recent.end(), "/maps/14.toml") == 1);
  REQUIRE(write_settings(file, s));
  const Settings read = read_settings(file);
  CHECK_FALSE(read.dark);
  CHECK(read.width == 1000);
  CHECK(read.left_share == 0.3);
  CHECK(read.lower_view == "Plots");
  CHECK(read.recent == s.recent);

  CHECK(read_settings(folder.write("broken.json", "{\"dark\": ")).dark);
  CHECK(read_settings(folder.write("list.json", "[1]")).width == 1280);
  const Settings odd = read_settings(folder.write("odd.json", R"({"dark": "no", "width": -5, "left_share": 7, "recent": [1]})"));
  CHECK(odd.dark);
  CHECK(odd.width == 320);
  CHECK(odd.left_share == 0.9);
  CHECK(odd.recent.empty());
}

TEST_CASE("pictures: free names, what can be opened") {
  const TemporaryFolder folder;
  CHECK(free_name(folder.path(), "a", "png") == folder.path() / "a-001.png");
  folder.write("a-001.png", "");
  CHECK(free_name(folder.path(), "a", "png") == folder.path() / "a-002.png");
  CHECK(can_open("x/World.TOML"));
  CHECK(can_open("x.obj"));
  CHECK_FALSE(can_open("x.png"));
}

TEST_CASE("offscreen: known colours at known points, of rectangles and of textures") {
  auto platform = offscreen({64, 48});
  const ImU32 background = palette(true).background, cells[] = {0xFF0000FF, 0xFF00FF00, 0xFFFF0000, 0xFFFFFFFF};
  for (int frame = 0; frame < 2; ++frame) {
    platform->begin();
    ImDrawList& draw = *ImGui::GetForegroundDrawList();
    draw.AddRectFilled({10.0f, 10.0f}, {20.0f, 20.0f}, IM_COL32(230, 159, 0, 255));
    bool fresh = false;
    const ImTextureID texture = platform->textures().get("cells", 2, 2, fresh);
    CHECK(fresh == (frame == 0));
    if (fresh) platform->textures().update("cells", 0, 0, 2, 2, cells);
    draw.AddImage(texture, {40.0f, 20.0f}, {60.0f, 40.0f});
    platform->draw(background);
  }
  const Picture picture = platform->pixels();
  CHECK(is(picture, 0, 0, background));
  CHECK(is(picture, 63, 47, background));
  CHECK(is(picture, 15, 15, IM_COL32(230, 159, 0, 255)));
  CHECK(is(picture, 45, 25, IM_COL32(255, 0, 0, 255)));
  CHECK(is(picture, 55, 25, IM_COL32(0, 255, 0, 255)));
  CHECK(is(picture, 45, 35, IM_COL32(0, 0, 255, 255)));
  CHECK(is(picture, 55, 35, IM_COL32(255, 255, 255, 255)));
  CHECK(platform->faults() == 0);
}

TEST_CASE("offscreen: every view of every shipped mission is drawn, without an error of OpenGL") {
  auto platform = offscreen({640, 400});
  const Palette colours = palette(true);
  for (const fs::path& file : shipped_missions()) {
    Runner runner;
    const auto now = opened(runner, file, 30);
    CAPTURE(file.string());
    REQUIRE(now->simulation);
    for (const auto& view : make_views()) {
      CAPTURE(view->name());
      Desk desk;
      const Frame frame{*now, colours, platform->textures(), desk, [](Action) {}, 1.0, true};
      for (int i = 0; i < 2; ++i) {
        platform->begin();
        ImGui::SetNextWindowPos({0.0f, 0.0f});
        ImGui::SetNextWindowSize({640.0f, 400.0f});
        ImGui::Begin("picture", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground);
        view->draw(frame);
        ImGui::End();
        platform->draw(colours.background);
      }
      CHECK_FALSE(of_one_colour(platform->pixels()));
      CHECK(platform->faults() == 0);
    }
  }
}

TEST_CASE("offscreen: a broken file leaves the old world running, with its message on the desk") {
  const TemporaryFolder folder;
  Runner runner;
  runner.post(Open{"rooms/u", {}});
  runner.post(Open{folder.write("broken.toml", "world = \"rooms/u_room\"\n[planner]\nspeed_m_s = \"quick\"\n"), {}});
  const auto now = runner.settled();
  REQUIRE(now->simulation);
  CHECK(now->simulation->mission().name == "u");
  CHECK(now->message.error);
  CHECK(now->message.text.find("broken.toml:3") != std::string::npos);
  auto platform = offscreen({800, 500});
  Workbench bench(runner, {}, true);
  const auto draw = [&](const Snapshot& snapshot) {
    for (int i = 0; i < 3; ++i) {
      platform->begin();
      bench.draw(snapshot, *platform);
      platform->draw(0);
    }
    return platform->pixels();
  };
  // The message is written in the palette's warning colour, at the bottom. (Letters are thin: few pixels have all of it.)
  const auto warnings = [](const Picture& picture) {
    int count = 0;
    for (int y = 400; y < 500; ++y)
      for (int x = 0; x < 800; ++x) count += is(picture, x, y, palette(true).warning) ? 1 : 0;
    return count;
  };
  Snapshot good = *now;
  good.message = {1, false, "opened"};
  CHECK(warnings(draw(good)) == 0);
  CHECK(warnings(draw(*now)) > 5);
}

TEST_CASE("render: the same bytes each time, of the time that was asked for") {
  const TemporaryFolder folder;
  RenderOptions options;
  options.file = "rooms/u";
  options.view = "world";
  options.time = 3.0;
  options.width = 400;
  options.height = 300;
  const auto draw = [&](const char* name) {
    options.out = folder.path() / name;
    const auto drawn = render_picture(options);
    if (!drawn) FAIL(drawn.error().message);
    return *read_text_file(options.out);
  };
  const std::string first = draw("a.png");
  CHECK(first == draw("b.png"));
  options.light = true;
  CHECK(first != draw("light.png"));
  options.light = false;
  options.time = 8.0;
  CHECK(first != draw("later.png"));
  options.view = "all";
  draw("all.png");
  options.view = "nothing";
  const auto wrong = render_picture(options);
  REQUIRE_FALSE(wrong);
  CHECK(wrong.error().message.find("world, 3d, map") != std::string::npos);
}

TEST_CASE("gui: without a screen it says what to do; render says what it expects") {
  const auto [code, text] = call("env -u DISPLAY -u WAYLAND_DISPLAY " THICKET_PROGRAM " gui rooms/u");
  CHECK(code == 2);
  CHECK(text.find("xvfb-run") != std::string::npos);
  CHECK(text.find("thicket render") != std::string::npos);
}

TEST_CASE("gui, render: what is wrong is told before anything is opened, and what to do, with exit code 2") {
  const TemporaryFolder folder;
  const std::string here = folder.path().string(), broken = folder.write("broken.toml", "world = 3 = 4\n").string(), no_world = folder.write("empty.toml", "").string();
  const std::string render = THICKET_PROGRAM " render ", gui = "env -u WAYLAND_DISPLAY DISPLAY=:9999 " THICKET_PROGRAM " gui ", out = " --at 0 --out '" + here + "/x.png'";
  const auto refused = [&](const std::string& command, const std::string& told) {
    const auto [code, text] = call(command);
    INFO(command);
    INFO(text);
    CHECK(code == 2);
    CHECK(text.find(told) != std::string::npos);
  };
  for (const std::string& program : {gui, render}) {
    const std::string end = program == render ? out : "";
    refused(program + "no/such/mission" + end, "`thicket worlds`");
    refused(program + "'" + here + "'" + end, "a folder without a mission.toml");
    refused(program + "'" + broken + "'" + end, "broken.toml:1:");
    refused(program + "'" + no_world + "'" + end, "lacks the key 'name'");
    refused(program + "rooms/u --set planner.clearance_m=-1" + end, "clearance_m");
  }
  refused(gui + "rooms/u", "no window can be opened");
  for (const char* size : {"0x0", "9000x100", "12x800x"}) refused(render + "rooms/u --size " + size + out, "expected WIDTHxHEIGHT");
  for (const char* time : {"-1", "nan"}) refused(render + "rooms/u --out '" + here + "/x.png' --at " + time, "expected simulated seconds");
  refused(render + "rooms/u --view side" + out, "expected one of: world, 3d");
  refused(render + "rooms/u --at 0 --out '" + here + "/x.jpg'", "ending in .png");
  refused(render + "rooms/u --at 0 --out /proc/x.png", "cannot be written");
  CHECK_FALSE(fs::exists(folder.path() / "x.png"));
  // Beyond its end a run is as it ended.
  CHECK(call(render + "rooms/u --set limits.time_s=1 --size 64x48 --at 1e9 --out '" + here + "/x.png'").first == 0);
}

TEST_CASE("gui: a real session: played, paused, stepped back, photographed, saved, quit by keys") {
  Session session;
  if (!session.run("rooms/u", R"SH(xdotool key space; sleep 2; xdotool key space; sleep 0.5
xdotool key shift+Left; sleep 0.5
xdotool key F12; for i in $(seq 50); do [ -f thicket-picture-001.png ] && break; sleep 0.1; done
xdotool key ctrl+s; sleep 0.7; xdotool key Return; sleep 0.5
)SH"))
    return;
  CHECK(session.report["mission"] == "u");
  CHECK(session.report["newest_step"] >= 12);
  CHECK(session.report["steps"] == session.report["newest_step"].get<std::int64_t>() - 10);
  CHECK(session.report["frames"] > 10);
  const fs::path folder = session.folder.path();
  CHECK(fs::exists(folder / "thicket-picture-001.png"));
  CHECK(is_mission(folder / "u-changed.toml"));
  CHECK(fs::exists(folder / "thicket" / "window.json"));
}

TEST_CASE("gui: a real session: a double click sets the goal, and the robot goes there") {
  Session session;
  // The window opens at 1280 x 800 with the world to the left, fitted: (-8, -5) m is in the open below the start.
  if (!session.run("foliage_wall/bug2", R"SH(xdotool mousemove 160 571; sleep 0.3; xdotool click --repeat 2 --delay 80 1; sleep 0.5
for i in 1 2 3 4 5 6 7 8; do xdotool key plus; sleep 0.1; done
xdotool key space; sleep 2
)SH"))
    return;
  const auto& report = session.report;
  INFO(report.dump());
  REQUIRE(report["goal_m"].is_array());
  const auto at = [&](const char* what, int i) { return report[what][i].get<double>(); };
  CHECK(std::abs(at("goal_m", 0) + 8.0) < 1.0);
  CHECK(std::abs(at("goal_m", 1) + 5.0) < 1.0);
  CHECK(std::hypot(at("position_m", 0) - at("goal_m", 0), at("position_m", 1) - at("goal_m", 1)) < 0.2);
}

}  // namespace thicket::gui
