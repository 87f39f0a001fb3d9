#include "thicket/sim/mission.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "overrides.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/text.hpp"
#include "thicket/sim/mission_parts.hpp"
#include "thicket/sim/sar.hpp"

namespace thicket {
namespace {

SectionOf<Mission> header_section() {
  using S = Mission;
  SectionOf<S> section("mission file", "at the top of the file, without a table header");
  section.key("name", &S::name, "what the mission is called")
      .key("description", &S::description, "one sentence, shown by `thicket worlds`")
      .key("world", &S::world, "world file or map_server YAML, relative to this file, else a shipped one")
      .required()
      .key("world_image", &S::world_image, "for a map_server world: an image to read instead of the one that it names")
      .key("world_cell_size_m", &S::world_cell_size_m, "m", above_up_to(0.0, 1e6), "for a MovingAI .map world: size of a cell; 1 if it is not given")
      .key("world_height_m", &S::world_height_m, "m", above_up_to(0.0, 1e4), "for a map_server world: how high its matter is")
      .key("world_unknown_is_matter", &S::world_unknown_is_matter, "for a map_server world: whether unknown cells are matter")
      .key("seed", &S::seed, "", at_least(0.0), "of everything random: one seed, one result")
      .key("step_s", &S::step_s, "s", between(1e-5, 0.2), "simulated time of a step")
      .choice("fidelity", &S::fidelity, {"auto", "fast", "reference"}, "what is modelled: what the scene requires; less, and with fewer rays; or all there is, with more rays, as a check");
  return section;
}

const Section& start_section() {
  using S = StartSpec;
  static const Section section = SectionOf<S>("[start]", "where the vehicle starts")
                                     .key("x_m", &S::x_m, "m", between(-1e9, 1e9), "east")
                                     .key("y_m", &S::y_m, "m", between(-1e9, 1e9), "north")
                                     .key("z_m", &S::z_m, "m", between(-1e9, 1e9), "height of the ground under it; of a quadrotor its own altitude, 0: it stands on the floor")
                                     .key("yaw_deg", &S::yaw_deg, "deg", between(-36000.0, 36000.0), "heading, counter-clockwise from east");
  return section;
}

const Section& limit_section() {
  using S = LimitSpec;
  static const Section section = SectionOf<S>("[limits]", "what ends a run with the verdict stopped")
                                     .key("time_s", &S::time_s, "s", above_up_to(0.0, 1e9), "simulated time")
                                     .key("distance_m", &S::distance_m, "m", above_up_to(0.0, 1e9), "distance driven")
                                     .key("stuck_s", &S::stuck_s, "s", above_up_to(0.0, 1e9), "time without getting 5 cm away or turning; four times as long may it turn and twitch without getting 25 cm away");
  return section;
}

const Section& output_section() {
  using S = OutputSpec;
  static const Section section =
      SectionOf<S>("[output]", "which files a run leaves, beside result.json, timing.json and mission.toml")
          .key("trajectory", &S::trajectory, "trajectory.csv and trajectory.tum")
          .key("map", &S::map, "map.pgm and map.yaml")
          .key("map_formats", &S::map_formats, "further files of the map, separated by commas: scale, raw (for map_server, with probabilities), npy (NumPy), ot, bt (OctoMap), picture (of the probabilities)")
          .key("picture", &S::picture, "map.png: what the robot mapped")
          .key("path_picture", &S::path_picture, "path.png: its way in the world as it is")
          .key("score", &S::score, "score.json: how good the map is, judged by the world itself; the headline is in result.json")
          .key("observed_region_m", &S::observed_region_m, "m", between(-1e9, 1e9),
               "x_min, y_min, x_max, y_max: result.json tells which share of the free area in it was observed (from the world itself)");
  return section;
}

struct Part {
  const char* key;
  const Section& (*section)();
  void* (*object)(Mission&);
};
/// The tables of a mission file, sensors apart.
const std::vector<Part>& parts() {
  static const std::vector<Part> list = {
      {"vehicle", &vehicle_section, [](Mission& m) -> void* { return &m.vehicle; }}, {"start", &start_section, [](Mission& m) -> void* { return &m.start; }},
      {"bumpers", &bumper_section, [](Mission& m) -> void* { return &m.bumpers; }},  {"planner", &planner_section, [](Mission& m) -> void* { return &m.planner; }},
      {"odometry", &odometry_section, [](Mission& m) -> void* { return &m.odometry; }},
      {"map", &map_section, [](Mission& m) -> void* { return &m.map; }},             {"sar", &sar_section, [](Mission& m) -> void* { return &m.sar; }},
      {"limits", &limit_section, [](Mission& m) -> void* { return &m.limits; }},
      {"output", &output_section, [](Mission& m) -> void* { return &m.output; }},
  };
  return list;
}

std::filesystem::path vehicle_preset_folder() { return shipped_root() / "sim" / "presets"; }

void read_vehicle(const Node& table, VehicleSpec& vehicle, Faults& faults) {
  if (const Node* preset = table.find("preset")) {
    const auto* name = std::get_if<std::string>(&preset->content);
    std::filesystem::path file = name ? vehicle_preset_folder() / (*name + ".toml") : std::filesystem::path{};
    if (name && !std::filesystem::exists(file)) file = *name;
    if (!name || !std::filesystem::is_regular_file(file)) {
      faults.add(preset->place, fmt::format("there is no vehicle preset {}, expected one of '{}' or a file{}", name ? "'" + *name + "'" : preset->kind_in_words(),
                                            fmt::join(vehicle_presets(), "', '"), name ? did_you_mean(*name, vehicle_presets()) : ""));
    } else if (const auto document = read_document(file)) {
      read_section(*document, vehicle_section(), &vehicle, faults);
    } else {
      faults.take(document.error());
    }
  }
  read_section(table, vehicle_section(), &vehicle, faults, {"preset"});
}

// --- overrides: changes to the tree before it is read, so that the same reader judges them ---

/// The name of a [[sensor]] entry, its preset's if it has none of its own. Faults are told when the entry is read.
std::string name_of_sensor(const Node& entry) {
  Faults ignored;
  return mounted(read_sensor(entry, ignored)).name;
}

void apply_to_sensors(Node& root, const std::string& rest, const Override& change, Faults& faults) {
  auto* sensors = std::get_if<Node::Array>(&member(root, "sensor").content);
  if (!sensors) return;  // told by the reader
  const auto dot = rest.find('.');
  const std::string name = dot == std::string::npos ? "" : rest.substr(0, dot);
  const std::string key = dot == std::string::npos ? rest : rest.substr(dot + 1);
  bool found = false;
  for (Node& sensor : *sensors) {
    if (!name.empty() && name != name_of_sensor(sensor)) continue;
    member(sensor, key) = override_value(change);
    found = true;
  }
  if (!found) faults.add({change.origin, 0, 0}, fmt::format("there is no sensor named '{}'", name));
}

void apply(Node& root, const Override& change, Faults& faults) {
  const auto dot = change.key.find('.');
  if (change.key.empty() || dot == 0 || dot + 1 == change.key.size()) return faults.add({change.origin, 0, 0}, "expected key=value, for example planner.clearance_m=0.5");
  if (dot == std::string::npos) {
    member(root, change.key) = override_value(change);
  } else if (change.key.substr(0, dot) == "sensor") {
    apply_to_sensors(root, change.key.substr(dot + 1), change, faults);
  } else {
    Node& table = member(root, change.key.substr(0, dot));
    if (!table.table()) {
      table.content = Node::Table{};
      table.place = table.key_place = {change.origin, 0, 0};
    }
    member(table, change.key.substr(dot + 1)) = override_value(change);
  }
}

/// A path in a mission: relative to the mission's folder (or, if an override gave it, to the working directory), then among what is shipped.
std::filesystem::path locate(const Node* node, const std::string& name, const std::filesystem::path& mission) {
  const bool from_file = node && node->place.line > 0;
  const std::filesystem::path beside = from_file ? mission.parent_path() / name : std::filesystem::path(name);
  std::error_code ignored;
  if (std::filesystem::is_regular_file(beside, ignored)) return std::filesystem::absolute(beside).lexically_normal();
  const auto shipped = find_shipped(name);
  return shipped.empty() ? shipped : std::filesystem::absolute(shipped).lexically_normal();
}

void find_files(const Node& root, const std::filesystem::path& file, Mission& mission, Faults& faults) {
  const auto find = [&](const char* key, const std::string& name) {
    const auto found = locate(root.find(key), name, file);
    if (found.empty()) {
      const Node* node = root.find(key);
      const bool from_file = node && node->place.line > 0;
      faults.add(node ? node->place : root.place, fmt::format("there is no file '{}', expected a path relative to {}, or a shipped world (`thicket worlds`)", name, from_file ? "the mission" : "the working directory"));
    }
    return found;
  };
  if (!mission.world.empty()) mission.world_file = find("world", mission.world);
  if (!mission.world_image.empty()) mission.image_file = find("world_image", mission.world_image);
  if (mission.map.initial.empty()) return;
  const Node* map = root.find("map");
  const Node* key = map ? map->find("initial") : nullptr;
  mission.initial_map_file = locate(key, mission.map.initial, file);
  if (mission.initial_map_file.empty())
    faults.add(key ? key->place : root.place, fmt::format("there is no file '{}', expected a map (.yaml, .npy, .ot, .bt) by a path relative to {}", mission.map.initial, key && key->place.line > 0 ? "the mission" : "the working directory"));
}

/// The names in a list separated by commas, without the blanks around them.
std::vector<std::string> names_in(const std::string& list) {
  std::vector<std::string> names;
  for (std::size_t from = 0; from <= list.size();) {
    const std::size_t comma = std::min(list.find(',', from), list.size()), first = list.find_first_not_of(" \t", from);
    if (first < comma) names.push_back(list.substr(first, list.find_last_not_of(" \t", comma - 1) + 1 - first));
    from = comma + 1;
  }
  return names;
}

std::vector<std::string> sensor_names(const Mission& mission) {
  std::vector<std::string> names;
  for (const SensorSpec& sensor : mission.sensors) names.push_back(mounted(sensor).name);
  return names;
}

void check_together(const Node& root, const Mission& mission, Faults& faults) {
  if (mission.map.cell_bits != 8 && mission.map.cell_bits != 16) {
    const Node* map = root.find("map");
    const Node* key = map ? map->find("cell_bits") : nullptr;
    faults.add(key ? key->place : root.place, fmt::format("map.cell_bits is {}, expected 8 or 16", mission.map.cell_bits));
  }
  const auto place = [&](const char* table) { return root.find(table) ? root.find(table)->place : root.place; };
  const PlannerNeeds needs = planner_needs(mission.planner.name);
  if ((needs == PlannerNeeds::waypoints && mission.planner.waypoints_m.empty()) || (needs == PlannerNeeds::goal && !mission.planner.goal_m)) {
    const char* lack = needs == PlannerNeeds::waypoints ? "way-points: give planner.waypoints_m" : "a goal: give planner.goal_m, or --goal X,Y";
    faults.add(place("planner"), fmt::format("the planner '{}' lacks {}", mission.planner.name, lack));
  }
  if (const std::string fault = flight_fault(mission.planner, mission.vehicle.flies(), mission.start.z_m); !fault.empty()) faults.add(place("planner"), fault);
  if (mission.vehicle.drag.size() != 1 && mission.vehicle.drag.size() != 3)
    faults.add(place("vehicle"), fmt::format("'drag' has {} numbers, expected one, or three along the body axes", mission.vehicle.drag.size()));
  if (mission.vehicle.flies() && mission.start.z_m < 0.0) faults.add(place("start"), fmt::format("'z_m' is {}, expected at least 0: a quadrotor flies above the floor at z = 0", mission.start.z_m));
  for (const SensorSpec& sensor : mission.sensors) {
    const double cells = 2.0 * mounted(sensor).range_max_m / mission.map.resolution_m;
    if (mission.map.enabled && cells * cells > 0x1p28)
      faults.add(place("map"), fmt::format("a scan of sensor '{}' covers {:.0f} x {:.0f} cells, expected at most 16384 x 16384: make map.resolution_m coarser or the range shorter",
                                           mounted(sensor).name, cells, cells));
  }
  for (std::size_t i = 0; i < mission.sensors.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (mounted(mission.sensors[i]).name == mounted(mission.sensors[j]).name)
        faults.add(place("sensor"), fmt::format("two sensors are named '{}', expected different names", mounted(mission.sensors[i]).name));
  const auto known = sensor_names(mission);
  for (const std::string& name : names_in(mission.bumpers.sensors))
    if (std::ranges::find(known, name) == known.end())
      faults.add(place("bumpers"), fmt::format("'sensors' names '{}', expected names of sensors separated by commas, of '{}'{}", name, fmt::join(known, "', '"), did_you_mean(name, known)));
  for (const std::string& name : names_in(mission.output.map_formats))
    if (std::ranges::find(map_format_names(), name) == map_format_names().end())
      faults.add(place("output"), fmt::format("'map_formats' names '{}', expected names separated by commas, of '{}'{}", name, fmt::join(map_format_names(), "', '"), did_you_mean(name, map_format_names())));
  if (const auto fault = sar_fault(mission)) faults.add(place("sar"), *fault);
  if (const auto& r = mission.output.observed_region_m; r && (r->z - r->x) * (r->w - r->y) > 1e7 * mission.map.resolution_m * mission.map.resolution_m)
    faults.add(place("output"), "'observed_region_m' has more than 10 million cells, expected a smaller one");
  if (const auto& r = mission.output.observed_region_m; r && !(r->x < r->z && r->y < r->w))
    faults.add(place("output"), "'observed_region_m' is empty, expected x_min < x_max and y_min < y_max");
}

}  // namespace

Result<Mission> read_mission(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  Node root;
  root.content = Node::Table{};
  root.place = {"command line", 0, 0};
  if (!file.empty()) {
    auto document = read_document(file);
    if (!document) return document.error();
    root = std::move(*document);
  }
  if (!root.find("world") && root.find("solid"))
    return Error{fmt::format("{}: this is a world and not a mission: thicket run --world {} --start X,Y,YAW_DEG --goal X,Y --planner bug2", file.string(), file.string())};
  Faults faults;
  if (!root.find("sensor")) {
    Node standard;
    standard.content = Node::Table{{"preset", text_node("usarsim2012", "default sensor")}};
    standard.place = {"default sensor", 0, 0};
    member(root, "sensor").content = Node::Array{standard};
  }
  for (const Override& change : overrides) apply(root, change, faults);

  Mission mission;
  if (!file.empty()) mission.name = file.stem().string();
  std::vector<std::string> tables = {"sensor"};
  for (const Part& part : parts()) tables.emplace_back(part.key);
  read_section(root, header_section(), &mission, faults, tables);
  for (const Part& part : parts()) {
    const Node* table = root.find(part.key);
    if (!table) continue;
    if (part.object(mission) == &mission.vehicle) {
      read_vehicle(*table, mission.vehicle, faults);
    } else {
      read_section(*table, part.section(), part.object(mission), faults);
    }
  }
  const Node& sensors = *root.find("sensor");
  if (const auto* array = sensors.array(); array && !array->empty()) {
    for (const Node& entry : *array) mission.sensors.push_back(read_sensor(entry, faults));
  } else {
    faults.add(sensors.place, "'sensor' is not an array of tables, expected entries [[sensor]]");
  }
  find_files(root, file, mission, faults);
  if (faults.none()) check_together(root, mission, faults);
  if (!faults.none()) return faults.error();
  return mission;
}

namespace {

std::string sensor_entry(const SensorSpec& sensor) {
  return fmt::format("type = {}\n{}", toml_string(sensor_type(sensor)), write_section(sensor_section(sensor), sensor_object(sensor)));
}

}  // namespace

std::string write_mission(const Mission& mission) {
  Mission copy = mission;
  copy.world = portable_name(mission.world_file);
  if (!mission.image_file.empty()) copy.world_image = portable_name(mission.image_file);
  if (!mission.initial_map_file.empty()) copy.map.initial = portable_name(mission.initial_map_file);
  std::string text = "# Fully resolved: running this file again gives the same result.\n" + write_section(header_section(), &copy);
  for (const Part& part : parts()) text += fmt::format("\n[{}]\n{}", part.key, write_section(part.section(), part.object(copy)));
  for (const SensorSpec& sensor : mission.sensors)
    text += "\n[[sensor]]\n" + sensor_entry(sensor);
  return text;
}

std::string describe_mission_file() {
  Mission defaults;
  std::string text = describe_section(header_section(), &defaults);
  for (const Part& part : parts()) text += "\n" + describe_section(part.section(), part.object(defaults));
  for (const std::string& type : sensor_types()) {
    const SensorSpec sensor = default_sensor(type);
    text += "\n" + describe_section(sensor_section(sensor), sensor_object(sensor));
  }
  return text + fmt::format("\nA [[sensor]] names a type, or a preset whose keys it may change: {}. Without any [[sensor]], usarsim2012.\nVehicle presets: {}.\n",
                            fmt::join(sensor_presets(), ", "), fmt::join(vehicle_presets(), ", "));
}

const std::vector<std::string>& map_format_names() {
  static const std::vector<std::string> names = {"scale", "raw", "npy", "ot", "bt", "picture"};
  return names;
}

std::vector<std::string> map_formats(const OutputSpec& output) {
  const auto named = names_in(output.map_formats);
  std::vector<std::string> formats;
  for (const std::string& name : map_format_names())
    if (std::ranges::find(named, name) != named.end()) formats.push_back(name);
  return formats;
}

std::vector<std::size_t> bumper_sensors(const Mission& mission) {
  std::vector<std::size_t> chosen;
  const auto known = sensor_names(mission);
  for (const std::string& name : names_in(mission.bumpers.sensors))
    if (const auto found = std::ranges::find(known, name); found != known.end()) chosen.push_back(static_cast<std::size_t>(found - known.begin()));
  if (!chosen.empty()) return chosen;
  for (std::size_t i = 0; i < mission.sensors.size(); ++i)
    if (i == 0 || (std::holds_alternative<LobeRadarSpec>(mission.sensors[0]) && std::holds_alternative<LobeRadarSpec>(mission.sensors[i]))) chosen.push_back(i);
  return chosen;
}

namespace {

void put_at(Node& node, const Place& place) {
  node.place = node.key_place = place;
  if (auto* array = std::get_if<Node::Array>(&node.content))
    for (Node& item : *array) put_at(item, place);
  if (auto* table = std::get_if<Node::Table>(&node.content))
    for (auto& [name, item] : *table) put_at(item, place);
}

/// What the reader says of a sensor's keys together: it is asked.
void check_sensor(const SensorSpec& sensor, Faults& faults) {
  auto entry = parse_document(sensor_entry(sensor), "sensor");
  if (!entry) return faults.take(entry.error());
  put_at(*entry, {"sensor " + mounted(sensor).name, 0, 0});
  read_sensor(*entry, faults);
}

}  // namespace

std::vector<MissionPart> mission_parts(Mission& mission) {
  static const SectionOf<Mission> header = header_section();
  std::vector<MissionPart> list = {{"mission", &header, &mission}};
  for (const Part& part : parts()) list.push_back({part.key, &part.section(), part.object(mission)});
  for (SensorSpec& sensor : mission.sensors) list.push_back({"sensor " + mounted(sensor).name, &sensor_section(sensor), sensor_object(sensor)});
  return list;
}

Result<Mission> reconsidered_mission(const Mission& was, Mission is, const std::filesystem::path& mission_file) {
  Node root;
  root.content = Node::Table{};
  root.place = {"mission", 0, 0};
  Faults faults;
  const auto find = [&](const char* key, const std::string& before, const std::string& name, std::filesystem::path& file) {
    if (name == before) return;
    file = name.empty() ? std::filesystem::path() : locate(nullptr, (mission_file.parent_path() / name).string(), {});
    if (file.empty() && !name.empty()) file = locate(nullptr, name, {});
    if (file.empty() && !name.empty()) faults.add(root.place, fmt::format("'{}' is '{}', expected a file, by a path relative to the mission's, or a shipped one", key, name));
  };
  find("world", was.world, is.world, is.world_file);
  find("world_image", was.world_image, is.world_image, is.image_file);
  find("map.initial", was.map.initial, is.map.initial, is.initial_map_file);
  if (is.world.empty()) faults.add(root.place, "'world' is empty, expected a world file or map_server YAML");
  for (std::size_t i = 0; i < is.sensors.size(); ++i)
    if (i >= was.sensors.size() || sensor_entry(was.sensors[i]) != sensor_entry(is.sensors[i])) check_sensor(is.sensors[i], faults);
  if (faults.none()) check_together(root, is, faults);
  if (!faults.none()) return faults.error();
  return is;
}

Result<World> read_mission_world(const Mission& mission) {
  return read_world(mission.world_file, {mission.image_file, mission.world_unknown_is_matter, mission.world_height_m, mission.world_cell_size_m});
}

std::vector<std::string> vehicle_presets() { return shipped_names("sim/presets"); }

bool is_mission(const std::filesystem::path& file) {
  if (file.extension() != ".toml") return false;
  const auto document = read_document(file);
  return document && (document->find("world") || document->find("planner") || document->find("sensor"));
}

}  // namespace thicket
