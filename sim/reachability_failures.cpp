#include "reachability_failures.hpp"

#include <fmt/format.h>

#include "thicket/base/files.hpp"
#include "thicket/base/schema.hpp"
#include "thicket/worlds/world_text.hpp"

namespace thicket {

Result<Done> keep_failure(const std::filesystem::path& folder, const Mission& mission, const Problem& problem) {
  const std::filesystem::path place = std::filesystem::absolute(folder);
  Mission kept = mission;
  kept.description = fmt::format("problem {} of {}, kept by `thicket reachability`", problem.number, problem.family);
  std::string beside;
  if (problem.world_file.empty()) {
    const auto world = write_world(*problem.world);
    if (!world) return world.error();
    beside = fmt::format("{}-{}.world.toml", problem.family, problem.number);
    // Several runs of one problem write the same bytes, one after the other or at once.
    if (const auto written = write_file(place / beside, *world); !written) return written;
    kept.world_file = place / beside;
  }
  std::string text = write_mission(kept);
  if (!beside.empty()) {
    // By its name alone, so that the folder can be moved.
    const std::string line = "world = " + toml_string(portable_name(kept.world_file));
    if (const auto at = text.find(line); at != std::string::npos) text.replace(at, line.size(), "world = " + toml_string(beside));
  }
  return write_file(place / (mission.name + ".toml"), text);
}

}  // namespace thicket
