#include "mission_form.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "editor.hpp"
#include "thicket/base/document.hpp"
#include "thicket/base/files.hpp"

namespace thicket::gui {
namespace {

std::string lower(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

/// The mission without a key that need not be given. A value cannot be taken back from an object, so that one is made without it.
Mission without_key(const Mission& mission, KeyPlace at) {
  Mission from = mission, result = defaults_of(mission);
  result.world_file = mission.world_file;
  result.image_file = mission.image_file;
  result.initial_map_file = mission.initial_map_file;
  const auto have = mission_parts(from), next = mission_parts(result);
  for (std::size_t p = 0; p < have.size(); ++p)
    for (std::size_t k = 0; k < have[p].section->keys.size(); ++k) {
      const Key& key = have[p].section->keys[k];
      const Value value = key.get(have[p].object);
      if ((p == at.part && k == at.key) || std::holds_alternative<std::monostate>(value)) continue;
      key.set(next[p].object, value);
    }
  return result;
}

}  // namespace

Result<Value> judged(const Section& section, const Key& key, const std::string& typed) {
  auto document = parse_document("value = " + typed, key.name);
  Node node;
  if (document && document->table()->size() == 1) node = document->table()->front().second;
  else node.content = typed;
  // It stands in no file: messages name the section instead.
  const Place place{section.name, 0, 0};
  std::vector<Node*> all{&node};
  while (!all.empty()) {
    Node* next = all.back();
    all.pop_back();
    next->place = next->key_place = place;
    if (auto* array = std::get_if<Node::Array>(&next->content))
      for (Node& item : *array) all.push_back(&item);
  }
  Node table;
  table.place = place;
  table.content = Node::Table{{key.name, std::move(node)}};
  Value value;
  Section one{section.name, "", {key}};
  one.keys[0].set = [&](void*, const Value& read) { value = read; };
  Faults faults;
  read_section(table, one, nullptr, faults);
  if (!faults.none()) return faults.error();
  return value;
}

Result<Mission> with_key(const Mission& mission, const std::filesystem::path& mission_file, KeyPlace at, const std::optional<std::string>& typed) {
  Mission next = typed ? mission : without_key(mission, at);
  if (typed) {
    const MissionPart part = mission_parts(next)[at.part];
    const Key& key = part.section->keys[at.key];
    const auto value = judged(*part.section, key, *typed);
    if (!value) return value.error();
    key.set(part.object, *value);
  }
  return reconsidered_mission(mission, std::move(next), mission_file);
}

Result<Mission> with_sensor(const Mission& mission, const std::filesystem::path& mission_file, const std::string& preset) {
  auto entry = parse_document("preset = " + toml_string(preset), "sensor");
  if (!entry) return entry.error();
  Faults faults;
  SensorSpec sensor = read_sensor(*entry, faults);
  if (!faults.none()) return faults.error();
  const auto taken = [&](const std::string& name) { return std::ranges::any_of(mission.sensors, [&](const SensorSpec& other) { return mounted(other).name == name; }); };
  const std::string name = mounted(sensor).name;
  for (int i = 2; taken(mounted(sensor).name); ++i) mounted(sensor).name = name + std::to_string(i);
  Mission next = mission;
  next.sensors.push_back(std::move(sensor));
  return reconsidered_mission(mission, std::move(next), mission_file);
}

Result<Mission> without_sensor(const Mission& mission, const std::filesystem::path& mission_file, std::size_t sensor) {
  if (mission.sensors.size() < 2) return Error{"a robot without a sensor would see nothing: add another one first"};
  Mission next = mission;
  next.sensors.erase(next.sensors.begin() + static_cast<std::ptrdiff_t>(sensor));
  return reconsidered_mission(mission, std::move(next), mission_file);
}

Mission defaults_of(const Mission& mission) {
  Mission defaults;
  for (const SensorSpec& sensor : mission.sensors) defaults.sensors.push_back(default_sensor(sensor_type(sensor)));
  return defaults;
}

bool is_optional(const Key& key, const void* defaults) { return std::holds_alternative<std::monostate>(key.get(defaults)); }

std::string first_value(const Key& key) {
  double number = std::clamp(0.0, key.range.minimum, key.range.maximum);
  if (key.range.above_minimum && number <= key.range.minimum) number = std::isfinite(key.range.maximum) ? std::min(key.range.minimum + 1.0, key.range.maximum) : key.range.minimum + 1.0;
  switch (key.kind) {
    case KeyKind::flag:
      return "true";
    case KeyKind::integer:
      return to_toml(Value(static_cast<std::int64_t>(std::ceil(number))));
    case KeyKind::number:
      return to_toml(Value(number));
    case KeyKind::text:
      return toml_string(key.choices.empty() ? "" : key.choices.front());
    case KeyKind::numbers: {
      std::vector<double> list(key.length_min, number);
      // Of a rectangle, corners that differ.
      if (key.length_min == 4 && key.range.maximum >= number + 1.0) list[2] = list[3] = number + 1.0;
      return to_toml(Value(list));
    }
    case KeyKind::points:
      return to_toml(Value(std::vector<std::vector<double>>()));
  }
  return "";
}

bool matches(std::string_view search, std::string_view title, const Key& key) {
  const std::string text = lower(title) + "." + lower(key.name) + " " + lower(key.help) + " " + lower(key.unit), wanted = lower(search);
  for (std::size_t from = 0; from < wanted.size();) {
    const std::size_t end = std::min(wanted.find(' ', from), wanted.size());
    if (text.find(wanted.substr(from, end - from)) == std::string::npos) return false;
    from = end + 1;
  }
  return true;
}

Mission in_world_file(Mission mission, const std::filesystem::path& world_file) {
  const Mission defaults;
  mission.world_file = std::filesystem::absolute(world_file).lexically_normal();
  mission.world = mission.world_file.string();
  mission.world_image.clear();
  mission.image_file.clear();
  mission.world_cell_size_m.reset();
  mission.world_height_m = defaults.world_height_m;
  mission.world_unknown_is_matter = defaults.world_unknown_is_matter;
  return mission;
}

Result<Saved> save_mission(const Mission& mission, const World& world, const std::filesystem::path& mission_file, const std::filesystem::path& world_file) {
  Saved saved{mission_file, {}};
  Mission written = mission;
  const auto own = read_mission_world(mission);
  if (!own || !same_world(*own, world)) {
    const auto done = save_world(world, world_file, mission.image_file);
    if (!done) return done.error();
    saved.world = world_file;
    written = in_world_file(mission, world_file);
  }
  const auto done = write_file(mission_file, write_mission(written));
  if (!done) return done.error();
  return saved;
}

}  // namespace thicket::gui
