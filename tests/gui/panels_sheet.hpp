// Views drawn by ImGui without any back end, and textures where a test can look at them.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "view.hpp"

namespace thicket::gui::panels {

/// Textures that are kept where a test can look at them, as a card would keep them.
class KeptTextures final : public Textures {
 public:
  struct Kept {
    int width = 0, height = 0;
    std::vector<std::uint32_t> pixels;
  };
  std::map<std::string, Kept> all;

  ImTextureID get(const std::string& name, int width, int height, bool& fresh) override {
    Kept& kept = all[name];
    fresh = kept.width != width || kept.height != height;
    if (fresh) kept = {width, height, std::vector<std::uint32_t>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0u)};
    return &kept;
  }
  void update(const std::string& name, int x, int y, int width, int height, const std::uint32_t* pixels) override {
    Kept& kept = all.at(name);
    REQUIRE(x >= 0);
    REQUIRE(y >= 0);
    REQUIRE(x + width <= kept.width);
    REQUIRE(y + height <= kept.height);
    for (int row = 0; row < height; ++row)
      std::copy_n(pixels + static_cast<std::ptrdiff_t>(row) * width, width, kept.pixels.begin() + static_cast<std::ptrdiff_t>(y + row) * kept.width + x);
  }
};

class NoTextures final : public Textures {
 public:
  ImTextureID get(const std::string&, int, int, bool& fresh) override {
    fresh = false;
    return nullptr;
  }
  void update(const std::string&, int, int, int, int, const std::uint32_t*) override {}
};

/// ImGui without a screen, and one window that a view fills.
class Sheet {
 public:
  explicit Sheet(float width = 640.0f, float height = 480.0f) : context_(ImGui::CreateContext()) {
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {width, height};
    io.DeltaTime = 1.0f / 60.0f;
    unsigned char* pixels = nullptr;
    int w = 0, h = 0;
    io.Fonts->GetTexDataAsAlpha8(&pixels, &w, &h);
  }
  ~Sheet() { ImGui::DestroyContext(context_); }
  Sheet(const Sheet&) = delete;
  Sheet& operator=(const Sheet&) = delete;

  /// One frame; returns how many vertices it has.
  int draw(View& view, const Snapshot& now, Textures& textures, bool still = false) {
    ImGui::NewFrame();
    ImGui::SetNextWindowPos({0.0f, 0.0f});
    ImGui::SetNextWindowSize(ImGui::GetIO().DisplaySize);
    ImGui::Begin(view.name(), nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
    view.draw({now, colours_, textures, desk, [this](Action action) { posted.push_back(std::move(action)); }, 1.0, still});
    ImGui::End();
    ImGui::Render();
    return ImGui::GetDrawData()->TotalVtxCount;
  }

  Desk desk;
  std::vector<Action> posted;

 private:
  ImGuiContext* context_;
  Palette colours_ = palette(true);
};

}  // namespace thicket::gui::panels
