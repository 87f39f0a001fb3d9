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

}  // namespace

int open_window(const GuiArguments& a) {
  if (!a.file.empty() && find_input(a.file).empty()) return complain({missing_input(a.file)});
  const auto shown = gui::show_window({a.file, a.overrides, a.report});
  return shown ? done : complain(shown.error());
}

int render_views(const RenderArguments& a) {
  const auto size = size_of(a.size);
  if (!size) return complain({fmt::format("--size is '{}', expected WIDTHxHEIGHT in pixels, each from 16 to 8192, for example 1280x800", a.size)});
  if (a.at && !(*a.at >= 0.0 && std::isfinite(*a.at))) return complain({fmt::format("--at is {}, expected simulated seconds, a finite number of at least 0", *a.at)});
  std::error_code none;
  if (!std::filesystem::is_directory(a.file, none) && find_input(a.file).empty()) return complain({missing_input(a.file)});
  const auto drawn = gui::render_picture({a.file, a.overrides, a.view, a.at, a.out, size->first, size->second, a.light});
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
