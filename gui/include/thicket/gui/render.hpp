// `thicket render`: the window's views as pictures, without a screen.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "thicket/base/result.hpp"
#include "thicket/sim/mission.hpp"

namespace thicket::gui {

struct RenderOptions {
  std::filesystem::path file;  ///< a mission, a world, or the folder of a run
  std::vector<Override> overrides;
  std::string view = "world";  ///< one of `view_names`
  std::optional<double> time;  ///< s, simulated; nothing: until the verdict
  std::filesystem::path out;
  int width = 1280, height = 800;
  bool light = false;
};

/// "world", "3d", ..., and "all" for the whole window.
std::vector<std::string> view_names();

/// Simulates up to the time and draws. The same mission, time and size give the same bytes on the same computer, but for wall times in the profiler.
Result<Done> render_picture(const RenderOptions& options);

}  // namespace thicket::gui
