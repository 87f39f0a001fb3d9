// ImGui without a back end, for tests of views and tools: a mouse, some keys, and what was posted.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "thicket/gui/runner.hpp"
#include "view.hpp"

namespace thicket::gui {

struct NoTextures final : Textures {
  ImTextureID get(const std::string&, int, int, bool& fresh) override {
    fresh = false;
    return nullptr;
  }
  void update(const std::string&, int, int, int, int, const std::uint32_t*) override {}
};

class Screen {
 public:
  Screen() : context_(ImGui::CreateContext()) {
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {800.0f, 600.0f};
    io.DeltaTime = 1.0f / 60.0f;
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsAlpha8(&pixels, &width, &height);
    for (const auto& [key, index] : {std::pair{ImGuiKey_Z, 'Z'}, {ImGuiKey_Y, 'Y'}, {ImGuiKey_A, 'A'}}) io.KeyMap[key] = index;
    io.KeyMap[ImGuiKey_Escape] = 256;
    io.KeyMap[ImGuiKey_Enter] = 257;
    io.KeyMap[ImGuiKey_Delete] = 261;
  }
  ~Screen() { ImGui::DestroyContext(context_); }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// One frame, a window as large as the screen.
  void draw(const Snapshot& now, const std::function<void(const Frame&)>& content) {
    ImGui::NewFrame();
    ImGui::SetNextWindowPos({0.0f, 0.0f});
    ImGui::SetNextWindowSize(ImGui::GetIO().DisplaySize);
    ImGui::Begin("screen", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
    content(Frame{now, colours, textures, desk, [this](Action action) { posted.push_back(std::move(action)); }});
    ImGui::End();
    ImGui::Render();
  }
  void mouse(const ImVec2& at, bool down) {
    ImGui::GetIO().MousePos = at;
    ImGui::GetIO().MouseDown[0] = down;
  }
  void key(int index, bool down, bool control = false) {
    ImGui::GetIO().KeysDown[index] = down;
    ImGui::GetIO().KeyCtrl = control;
    ImGui::GetIO().KeyMods = control ? ImGuiKeyModFlags_Ctrl : ImGuiKeyModFlags_None;
  }
  /// The worlds that were posted are done by the runner; what it says then.
  std::shared_ptr<const Snapshot> pass_on(Runner& runner) {
    for (Action& action : posted) runner.post(std::move(action));
    posted.clear();
    return runner.settled();
  }

  Palette colours = palette(true);
  NoTextures textures;
  Desk desk;
  std::vector<Action> posted;

 private:
  ImGuiContext* context_;
};

}  // namespace thicket::gui
