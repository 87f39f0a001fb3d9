// A window on a screen, by GLFW and OpenGL 3.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <utility>

#include "clicks.hpp"
#include "gl_textures.hpp"
#include "platform.hpp"

namespace thicket::gui {
namespace {

std::string last_fault;

class Screen final : public Platform {
 public:
  ~Screen() override {
    if (ImGui::GetCurrentContext()) {
      ImGui_ImplOpenGL3_Shutdown();
      ImGui_ImplGlfw_Shutdown();
      ImGui::DestroyContext();
    }
    textures_.reset();
    if (window_) glfwDestroyWindow(window_);
    glfwTerminate();
  }

  std::optional<Error> open(const std::string& title, const Size& size) {
    glfwSetErrorCallback([](int, const char* text) { last_fault = text; });
    if (!glfwInit()) return Error{fmt::format("no window can be opened: {}", last_fault)};
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    window_ = glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
    if (!window_) return Error{fmt::format("no window with OpenGL 3.3 can be opened: {}", last_fault)};
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    float x = 1.0f, y = 1.0f;
    int width = 0, height = 0, inner_width = 0, inner_height = 0;
    glfwGetWindowContentScale(window_, &x, &y);
    glfwGetWindowSize(window_, &width, &height);
    glfwGetFramebufferSize(window_, &inner_width, &inner_height);
    // Where the system itself stretches (Wayland), ImGui does so too.
    scale_ = std::clamp(static_cast<double>(x) * std::max(width, 1) / std::max(inner_width, 1), 0.5, 4.0);
    listen();
    make_context(scale_);
    if (!ImGui_ImplGlfw_InitForOpenGL(window_, true)) return Error{"the window cannot be listened to"};
    if (!ImGui_ImplOpenGL3_Init("#version 330 core")) return Error{"OpenGL's functions cannot be loaded (libGL.so.1; on Debian: apt-get install libgl1)"};
    textures_.emplace();
    return std::nullopt;
  }

  bool poll(double wait) override {
    // What was not shown yet of the mouse's buttons waits for no other event.
    happened_ = !clicks_.empty();
    if (wait > 0.0 && !happened_) glfwWaitEventsTimeout(wait);
    else glfwPollEvents();
    return happened_;
  }
  bool closing() const override { return glfwWindowShouldClose(window_) != 0; }
  void begin() override {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    clicks_.next(ImGui::GetIO());
    // A key that was let go before this frame is down for the length of it, so that fields and views see it too.
    bool* const down = ImGui::GetIO().KeysDown;
    for (const int key : tapped_)
      if (glfwGetKey(window_, key) == GLFW_RELEASE) down[key] = false;
    tapped_.clear();
    const bool ctrl = glfwGetKey(window_, GLFW_KEY_LEFT_CONTROL) == GLFW_PRESS || glfwGetKey(window_, GLFW_KEY_RIGHT_CONTROL) == GLFW_PRESS;
    ImGui::GetIO().KeyCtrl = ctrl;
    for (const KeyPress& press : pressed_)
      if (press.key >= 0 && press.key <= GLFW_KEY_LAST && !down[press.key]) {
        down[press.key] = true;
        tapped_.push_back(press.key);
        if (press.ctrl) ImGui::GetIO().KeyCtrl = true;
      }
    ImGui::NewFrame();
  }
  void draw(ImU32 background) override {
    ImGui::Render();
    glfwGetFramebufferSize(window_, &width_, &height_);
    clear(width_, height_, background);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  }
  void show() override { glfwSwapBuffers(window_); }
  Picture pixels() override { return read_pixels(width_, height_); }
  Textures& textures() override { return *textures_; }
  double scale() const override { return scale_; }
  std::vector<std::filesystem::path> dropped() override { return std::exchange(dropped_, {}); }
  std::vector<KeyPress> pressed() override { return std::exchange(pressed_, {}); }
  Stick stick() override {
    GLFWgamepadstate state;
    for (int pad = GLFW_JOYSTICK_1; pad <= GLFW_JOYSTICK_LAST; ++pad) {
      if (!glfwJoystickIsGamepad(pad) || !glfwGetGamepadState(pad, &state)) continue;
      // In tenths and with a dead middle: each new value is a thing that the person did, and is kept in the history.
      const auto tenths = [](float value) { return std::abs(value) < 0.15f ? 0.0 : std::round(-10.0 * static_cast<double>(value)) / 10.0; };
      return {tenths(state.axes[GLFW_GAMEPAD_AXIS_LEFT_Y]), tenths(state.axes[GLFW_GAMEPAD_AXIS_LEFT_X])};
    }
    return {};
  }
  void title(const std::string& text) override {
    if (text == title_) return;
    title_ = text;
    glfwSetWindowTitle(window_, text.c_str());
  }
  unsigned faults() override { return count_faults(); }

 private:
  /// Notes that something happened. ImGui's own listeners, which come later, call these.
  void listen() {
    glfwSetWindowUserPointer(window_, this);
    static const auto self = [](GLFWwindow* window) { return static_cast<Screen*>(glfwGetWindowUserPointer(window)); };
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int mods) {
      self(w)->happened_ = true;
      if (action != GLFW_RELEASE) self(w)->pressed_.push_back({key, (mods & GLFW_MOD_CONTROL) != 0, (mods & GLFW_MOD_SHIFT) != 0, (mods & (GLFW_MOD_ALT | GLFW_MOD_SUPER)) != 0, action == GLFW_REPEAT});
    });
    glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned) { self(w)->happened_ = true; });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int) {
      self(w)->happened_ = true;
      double x = 0.0, y = 0.0;
      glfwGetCursorPos(w, &x, &y);
      self(w)->clicks_.note(button, action == GLFW_PRESS, {static_cast<float>(x), static_cast<float>(y)});
    });
    glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double, double) { self(w)->happened_ = true; });
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double) { self(w)->happened_ = true; });
    glfwSetWindowFocusCallback(window_, [](GLFWwindow* w, int) { self(w)->happened_ = true; });
    glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int, int) { self(w)->happened_ = true; });
    glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { self(w)->happened_ = true; });
    glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** files) {
      self(w)->happened_ = true;
      for (int i = 0; i < count; ++i) self(w)->dropped_.emplace_back(files[i]);
    });
  }

  GLFWwindow* window_ = nullptr;
  std::optional<GlTextures> textures_;
  std::vector<std::filesystem::path> dropped_;
  std::vector<KeyPress> pressed_;
  Clicks clicks_;
  std::vector<int> tapped_;  ///< keys that are down in this frame only
  std::string title_;
  bool happened_ = false;
  double scale_ = 1.0;
  int width_ = 0, height_ = 0;
};

}  // namespace

std::string no_screen() {
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"})
    if (const char* value = std::getenv(name); value && *value) return {};
  return "there is no screen to open a window on: neither DISPLAY nor WAYLAND_DISPLAY is set.\n"
         "  from another computer:   ssh -X USER@HOST, then thicket gui\n"
         "  without any screen:      xvfb-run -a thicket gui (Debian packages xvfb and xauth)\n"
         "  only a picture of it:    thicket render MISSION --view all --at 10 --out picture.png";
}

Result<std::unique_ptr<Platform>> open_screen(const std::string& title, const Size& size) {
  auto platform = std::make_unique<Screen>();
  if (auto fault = platform->open(title, size)) return *fault;
  return std::unique_ptr<Platform>(std::move(platform));
}

}  // namespace thicket::gui
