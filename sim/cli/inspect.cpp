// Commands that look at files without running them.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "program.hpp"
#include "thicket/base/document.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/text.hpp"
#include "thicket/sim/check.hpp"
#include "thicket/sim/scan_report.hpp"
#include "thicket/sim/shipped.hpp"

namespace thicket::cli {
namespace {

std::string text_of(const Node& document, const char* key) {
  const Node* node = document.find(key);
  const auto* text = node ? std::get_if<std::string>(&node->content) : nullptr;
  return text ? *text : "";
}

int print_end(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) fmt::print("warning: {}\n", warning);
  fmt::print("ok{}\n", warnings.empty() ? "" : fmt::format(", with {} warning{}", warnings.size(), warnings.size() == 1 ? "" : "s"));
  return done;
}

int check_world(const std::filesystem::path& file, const CheckArguments& arguments) {
  for (const Override& change : arguments.overrides)
    if (change.key != "world_image" && change.key != "world_cell_size_m")
      return complain({fmt::format("{}: '{}' is a world, which has no key '{}' of a mission", change.origin, file.string(), change.key)});
  MapOptions options;
  options.image = arguments.map_image;
  options.cell_size = arguments.cell_size;
  auto world = read_world(file, options);
  if (!world) return complain(world.error());
  const auto scene = Scene::build(std::move(*world));
  if (!scene) return complain(scene.error());
  const auto sensor = find_sensor(arguments.sensor, "--sensor");
  if (!sensor) return complain(sensor.error());
  fmt::print("{}", describe_scene(*scene));
  return print_end(stealth_warnings(scene->world(), *make_sensor(*sensor, 0)));
}

int check_mission(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  const auto mission = read_mission(file, overrides);
  if (!mission) return complain(mission.error());
  const auto simulation = Simulation::create(*mission);
  if (!simulation) return complain(simulation.error());
  fmt::print("mission    {}\n{}", mission->name, describe_scene(simulation->stage().scene));
  return print_end(mission_warnings(*simulation));
}

}  // namespace

int complain(const Error& error) {
  fmt::print(stderr, "{}\n", error.message);
  return bad_input;
}

std::string missing_input(const std::string& name) {
  std::error_code none;
  if (std::filesystem::is_directory(name, none)) return fmt::format("'{}' is a folder, expected a file in it", name);
  return fmt::format("there is no file '{}'; shipped ones are listed by `thicket worlds`", name);
}

namespace {

/// Names of shipped worlds and missions as they are given on the command line: "rooms/u".
std::vector<std::string> shipped_world_names() {
  std::vector<std::string> names;
  for (const auto& file : shipped_worlds()) names.push_back(file.lexically_relative(shipped_worlds_root()).replace_extension().generic_string());
  return names;
}

}  // namespace

Result<std::filesystem::path> find_world(const std::string& name) {
  const auto file = find_input(name);
  if (file.empty()) return Error{fmt::format("there is no world '{}'; shipped ones are listed by `thicket worlds`{}", name, did_you_mean(name, shipped_world_names()))};
  if (is_mission(file)) return Error{fmt::format("{}: this is a mission and not a world, expected a world file", file.string())};
  return file;
}

int check_file(const CheckArguments& arguments) {
  const auto file = find_input(arguments.file);
  if (file.empty()) return complain({missing_input(arguments.file)});
  return is_mission(file) ? check_mission(file, arguments.overrides) : check_world(file, arguments);
}

int list_worlds() {
  const auto files = shipped_worlds();
  if (files.empty()) return complain({fmt::format("no shipped worlds were found in {}: set THICKET_DATA to the folder that holds worlds/data", shipped_worlds_root().string())});
  std::string worlds, missions;
  for (const auto& file : files) {
    const auto document = read_document(file);
    if (!document) continue;
    const bool mission = document->find("world") != nullptr;
    const std::string path = std::filesystem::relative(file, shipped_root()).generic_string();
    (mission ? missions : worlds) += fmt::format("  {:<46} {}\n", path, text_of(*document, mission ? "description" : "name"));
  }
  fmt::print("missions (thicket run FILE)\n{}\nworlds (thicket run --world FILE --start X,Y,YAW_DEG --goal X,Y --planner bug2)\n{}", missions, worlds);
  return done;
}

int help_topic(const std::string& topic, bool markdown) {
  if (markdown && topic != "world") return complain({fmt::format("--markdown is for `help world`, not for '{}'", topic)});
  if (markdown) {
    fmt::print("{}", describe_world_file(true));
  } else if (topic == "mission") {
    fmt::print("A mission file is TOML. `thicket run FILE --set section.key=value` changes any of its keys.\n\n{}", describe_mission_file());
  } else if (topic == "world") {
    fmt::print("A world file is TOML; a map_server YAML is a world too.\n\n{}", describe_world_file());
  } else {
    return complain({fmt::format("there is no help on '{}', expected mission or world; for the commands: thicket --help", topic)});
  }
  return done;
}

}  // namespace thicket::cli
