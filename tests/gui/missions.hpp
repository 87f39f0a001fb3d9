// What most tests of the window begin with: a shipped mission that is open, at some step.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>

#include "thicket/gui/runner.hpp"
#include "thicket/sim/shipped.hpp"

namespace thicket::gui {

/// Opens the mission in the runner and takes the steps; the test ends where that fails.
inline std::shared_ptr<const Snapshot> opened(Runner& runner, const std::filesystem::path& mission, int steps = 0, std::vector<Override> overrides = {}) {
  runner.post(Open{mission, std::move(overrides)});
  if (steps > 0) runner.post(StepBy{steps});
  auto now = runner.settled();
  if (!now->simulation) FAIL(now->message.text);
  return now;
}

/// All missions that are shipped, by name.
inline std::vector<std::filesystem::path> shipped_missions() {
  std::vector<std::filesystem::path> files;
  for (const auto& file : shipped_worlds())
    if (is_mission(file)) files.push_back(file);
  REQUIRE(files.size() > 10);
  return files;
}

}  // namespace thicket::gui
