// Letters and looks, the same on a screen and without one.
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "platform.hpp"

namespace thicket::gui {
namespace {

namespace fs = std::filesystem;

/// DejaVu Sans where the system has it; its letters stay sharp at any size.
fs::path letters() {
  const char* given = std::getenv("XDG_DATA_DIRS");
  std::istringstream folders(given && *given ? given : "/usr/local/share:/usr/share");
  std::error_code none;
  for (std::string folder; std::getline(folders, folder, ':');)
    for (const char* below : {"fonts/truetype/dejavu/DejaVuSans.ttf", "fonts/dejavu-sans-fonts/DejaVuSans.ttf", "fonts/TTF/DejaVuSans.ttf"})
      if (fs::path file = fs::path(folder) / below; fs::exists(file, none)) return file;
  return {};
}

}  // namespace

void make_context(double scale) {
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // the settings keep what it would
  io.LogFilename = nullptr;
  io.MouseDoubleClickTime = 0.45f;  // between frames, of which a busy computer shows few
  const fs::path file = letters();
  // What the views write: Latin, Greek, arrows, mathematical signs.
  static const ImWchar ranges[] = {0x20, 0xFF, 0x370, 0x3FF, 0x2010, 0x2027, 0x2070, 0x209C, 0x2190, 0x21FF, 0x2200, 0x22FF, 0x25A0, 0x25FF, 0};
  if (file.empty() || !io.Fonts->AddFontFromFileTTF(file.string().c_str(), static_cast<float>(14.0 * scale), nullptr, ranges)) {
    ImFontConfig plain;
    plain.SizePixels = static_cast<float>(13.0 * scale);
    io.Fonts->AddFontDefault(&plain);
  }
}

void use_look(bool dark, double scale) {
  ImGuiStyle style;
  dark ? ImGui::StyleColorsDark(&style) : ImGui::StyleColorsLight(&style);
  style.WindowRounding = style.ChildRounding = 0.0f;
  style.FrameRounding = style.TabRounding = style.GrabRounding = 3.0f;
  style.WindowBorderSize = 0.0f;
  // White fields on a light grey need an edge.
  if (!dark) style.FrameBorderSize = 1.0f;
  // Windows over others (the keys) are read, not looked through.
  style.Colors[ImGuiCol_WindowBg].w = 1.0f;
  style.ScaleAllSizes(static_cast<float>(scale));
  ImGui::GetStyle() = style;
}

}  // namespace thicket::gui
