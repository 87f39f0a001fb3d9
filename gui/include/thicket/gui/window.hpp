// `thicket gui`: the window, from opening to closing.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "thicket/base/result.hpp"
#include "thicket/sim/mission.hpp"

namespace thicket::gui {

struct WindowOptions {
  std::filesystem::path file;  ///< a mission or a world; empty: the window asks
  std::vector<Override> overrides;
  std::filesystem::path report;  ///< a JSON file that tells how the session ended; empty: none
};

/// Why no window can be opened here, and what to do; empty if one can.
std::string no_screen();

/// Shows the window until the person closes it. An error if none can be opened.
Result<Done> show_window(const WindowOptions& options);

}  // namespace thicket::gui
