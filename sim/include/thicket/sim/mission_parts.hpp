// A mission as a form: its tables one by one, and the judge of a mission that a person put together.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "thicket/base/schema.hpp"
#include "thicket/sim/mission.hpp"

namespace thicket {

/// One table of a mission file. It points into the mission.
struct MissionPart {
  std::string title;  ///< "mission" for the keys at the top, "planner", "sensor NAME", ...
  const Section* section = nullptr;
  void* object = nullptr;
};

/// All tables, in the order of a written file: the keys at the top, the tables, the sensors.
std::vector<MissionPart> mission_parts(Mission& mission);

/// A mission some of whose keys were changed, each to a value of its range. What `read_mission` would say of them together is said here; files whose names were changed are looked for anew, relative
/// to `mission_file` and then among what is shipped.
Result<Mission> reconsidered_mission(const Mission& was, Mission is, const std::filesystem::path& mission_file);

}  // namespace thicket
