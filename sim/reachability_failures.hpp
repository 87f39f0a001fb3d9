// Runs that went wrong, as files that repeat them.
#pragma once

#include <filesystem>

#include "thicket/base/result.hpp"
#include "thicket/sim/mission.hpp"
#include "thicket/sim/problem.hpp"

namespace thicket {

/// Writes NAME.toml, the mission by its name, into a folder (made if need be); of a generated problem also its world, FAMILY-NUMBER.world.toml, beside it. `thicket run` then
/// repeats the run to its verdict, path length and time.
Result<Done> keep_failure(const std::filesystem::path& folder, const Mission& mission, const Problem& problem);

}  // namespace thicket
