// `thicket gui` and `thicket render`: the window, and its views as pictures.
#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "program.hpp"
#include "thicket/base/files.hpp"

#ifdef THICKET_GUI
#include "thicket/gui/render.hpp"
#include "thicket/gui/window.hpp"
#endif

namespace thicket::cli {

#ifdef THICKET_GUI

namespace {

/// "1280x800"; nothing if it is not so.
std::optional<std::pair<int, int>> size_of(const std::string& text) {
  int width = 0, height = 0;
  const char* const end = text.data() + text.size();
  const auto [x, first] = std::from_chars(text.data(), end, width);
  if (first != std::errc{} || x == end || *x != 'x') return std::nullopt;
  const auto [last, second] = std::from_chars(x + 1, end, height);
  if (second != std::errc{} || last != end || width < 16 || height < 16 || width > 8192 || height > 8192) return std::nullopt;
  return std::pair(width, height);
}

/// The mission of a run's folder, or the file itself.
Result<std::string> input(const std::string& name) {
  std::error_code none;
  if (std::filesystem::is_directory(name, none)) {
    const auto mission = std::filesystem::path(name) / "mission.toml";
    if (std::filesystem::exists(mission, none)) return mission.string();
    return Error{fmt::format("'{}' is a folder without a mission.toml, expected a mission, a world, or the folder of a run", name)};
  }
  if (!name.empty() && find_input(name).empty()) return Error{missing_input(name)};
  return name;
}

}  // namespace

int open_window(const GuiArguments& a) {
  const auto file = input(a.file);
  if (!file) return complain(file.error());
  const auto shown = gui::show_window({*file, a.overrides, a.report});
  return shown ? done : complain(shown.error());
}

int render_views(const RenderArguments& a) {
  const auto size = size_of(a.size);
  if (!size) return complain({fmt::format("--size is '{}', expected WIDTHxHEIGHT in pixels, each from 16 to 8192, for example 1280x800", a.size)});
  if (a.at && !(*a.at >= 0.0 && std::isfinite(*a.at))) return complain({fmt::format("--at is {}, expected simulated seconds, a finite number of at least 0", *a.at)});
  if (std::filesystem::path(a.out).extension() != ".png") return complain({fmt::format("--out is '{}', expected a name ending in .png", a.out)});
  const auto file = input(a.file);
  if (!file) return complain(file.error());
  const auto drawn = gui::render_picture({*file, a.overrides, a.view, a.at, a.out, size->first, size->second, a.light});
  return drawn ? done : complain(drawn.error());
}

#else

namespace {

int no_window() {
  return complain({"this build has no window. One that has: install libimgui-dev, libglfw3-dev, libegl-dev, libopengl-dev and libgl1, then cmake --preset release -DTHICKET_GUI=ON && cmake --build --preset release"});
}

}  // namespace

int open_window(const GuiArguments&) { return no_window(); }
int render_views(const RenderArguments&) { return no_window(); }

#endif

}  // namespace thicket::cli
