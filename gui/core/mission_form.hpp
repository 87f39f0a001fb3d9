// The logic of forms: a key typed by a person is judged as a file with it would be; a mission, and the world that it runs in, become files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "thicket/base/schema.hpp"
#include "thicket/sim/mission_parts.hpp"

namespace thicket::gui {

/// What was typed as a value of a key, or what the reader of files would say of it. What is not valid TOML is taken as a text, as on the command line.
Result<Value> judged(const Section& section, const Key& key, const std::string& typed);

/// A key of a mission: places in `mission_parts` and in the section's keys.
struct KeyPlace {
  std::size_t part = 0, key = 0;
};

/// The mission with one key typed, or (nothing typed) not given.
Result<Mission> with_key(const Mission& mission, const std::filesystem::path& mission_file, KeyPlace at, const std::optional<std::string>& typed);

/// The mission with one sensor more, at the end: a shipped preset (`sensor_presets`), under a name that no other has.
Result<Mission> with_sensor(const Mission& mission, const std::filesystem::path& mission_file, const std::string& preset);
/// The mission without its sensor of that place. The last one stays.
Result<Mission> without_sensor(const Mission& mission, const std::filesystem::path& mission_file, std::size_t sensor);

/// What a mission of nothing but defaults has there: as many sensors, of the same types.
Mission defaults_of(const Mission& mission);

/// Whether a key need not be given.
bool is_optional(const Key& key, const void* defaults);

/// What an optional key begins with when it is given at last: 0 or the nearest that its range allows, as many as it takes.
std::string first_value(const Key& key);

/// Whether every word stands in the name of a key, its help, or the title of its section; letters' case does not count, and "planner.name" is found as the command line has it.
bool matches(std::string_view search, std::string_view title, const Key& key);

/// What was saved.
struct Saved {
  std::filesystem::path mission, world;  ///< world: empty if the mission's own world is what it runs in
};
/// Writes a mission that runs headless as it runs in `world`. If its own world file does not hold that world, `world_file` is written too and the mission names it.
Result<Saved> save_mission(const Mission& mission, const World& world, const std::filesystem::path& mission_file, const std::filesystem::path& world_file);
/// The mission that runs in a world file of its own, without what was said about another kind of world.
Mission in_world_file(Mission mission, const std::filesystem::path& world_file);

}  // namespace thicket::gui
