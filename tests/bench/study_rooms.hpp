// The rooms that two studies are made in.
#pragma once

#include "study_runs.hpp"

namespace thicket::study {

/// As many rooms as the options ask for whose goal can be reached, and as many where it cannot; `words` tells which.
std::vector<Judged> rooms(const Options& options, const Mission& lean, std::string& words);
/// The lean mission at 0.35 m/s, the speed of 2019.
Mission room_mission(const std::vector<Override>& changes);

}  // namespace thicket::study
