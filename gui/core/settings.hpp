// What the window remembers from one time to the next.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "thicket/base/result.hpp"

namespace thicket::gui {

struct Settings {
  static constexpr std::size_t most_recent = 12;

  bool dark = true;
  int width = 1280, height = 800;              ///< of the window
  double left_share = 0.6, upper_share = 0.6;  ///< of the panes
  std::string left_view = "World", upper_view = "Map", lower_view = "Planner";
  std::vector<std::string> recent;  ///< files, the newest first
  std::string imgui;                ///< of ImGui itself: tables' columns and the like

  /// Puts a file first.
  void used(const std::filesystem::path& file);
};

/// $XDG_CONFIG_HOME/thicket/window.json, or in ~/.config; empty if there is neither a home.
std::filesystem::path settings_file();
/// What cannot be read is as it is by default: no one's day should be spoilt by that.
Settings read_settings(const std::filesystem::path& file);
Result<Done> write_settings(const std::filesystem::path& file, const Settings& settings);

/// How a session ended, for scripts and tests: `thicket gui --report FILE`.
struct Report {
  std::string file, mission, planner, verdict;  ///< empty: none
  std::uint64_t steps = 0, newest_step = 0;
  double time = 0.0;
  double x = 0.0, y = 0.0;                      ///< of the robot, m
  std::vector<double> goal;                     ///< x, y; empty: none
  double left = 0.0, top = 0.0, width = 0.0, height = 0.0;  ///< of the left view in the window, pixels
  std::uint64_t frames = 0, gl_errors = 0;
  double first_frame_ms = 0.0, median_frame_ms = 0.0, longest_frame_ms = 0.0;  ///< from the events to the picture; median and longest without the first, in which OpenGL gets ready
};
std::string report_json(const Report& report);

}  // namespace thicket::gui
