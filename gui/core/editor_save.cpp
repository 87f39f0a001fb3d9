#include <fmt/format.h>

#include "editor.hpp"
#include "thicket/base/files.hpp"
#include "thicket/worlds/world_text.hpp"

namespace thicket::gui {
namespace {

bool is_map_file(const std::filesystem::path& file) { return file.extension() == ".yaml" || file.extension() == ".yml" || file.extension() == ".map"; }

/// The solids that a world file cannot hold, by name; nothing if there are none.
std::string unwritable(const World& world) {
  const bool map_named = is_map_file(world.file);
  std::string names;
  std::size_t count = 0;
  for (const Solid& solid : world.solids) {
    const bool map = std::holds_alternative<MapSolid>(solid.shape);
    if (!std::holds_alternative<MeshSolid>(solid.shape) && !(map && !map_named)) continue;
    if (++count <= 5) names += fmt::format("{}'{}' ({})", count > 1 ? ", " : "", solid.name, kind_of(solid));
  }
  return count > 5 ? names + fmt::format(" and {} more", count - 5) : names;
}

/// A map as an entry that names its file.
std::string map_entry(const World& world, const Solid& solid, const std::filesystem::path& image) {
  const MapSolid& map = std::get<MapSolid>(solid.shape);
  std::string text = fmt::format("\n[[solid]]\ntype = \"map\"\nname = {}\nmaterial = {}\nfile = {}\nheight_m = {}\nunknown_is_matter = {}\n", toml_string(solid.name), toml_string(world.materials[solid.material].name),
                                 toml_string(std::filesystem::absolute(world.file).string()), to_toml(Value(map.height)), map.unknown_is_matter);
  if (world.file.extension() == ".map") text += fmt::format("cell_size_m = {}\n", to_toml(Value(map.grid.resolution)));
  if (!image.empty()) text += fmt::format("image = {}\n", toml_string(std::filesystem::absolute(image).string()));
  return text;
}

/// The world as text, its maps named in their places among the solids.
Result<std::string> text_with_maps(const World& world, const std::filesystem::path& image) {
  World part = world;
  part.solids.clear();
  const auto head = write_world(part);
  if (!head) return head;
  std::string text = *head;
  for (const Solid& solid : world.solids) {
    if (std::holds_alternative<MapSolid>(solid.shape)) {
      text += map_entry(world, solid, image);
      continue;
    }
    part.solids = {solid};
    const auto one = write_world(part);
    if (!one) return one;
    text += one->substr(head->size());
  }
  return text;
}

}  // namespace

Result<Done> save_world(const World& world, const std::filesystem::path& file, const std::filesystem::path& image) {
  const auto fail = [&](const std::string& why) { return Error{fmt::format("{}: not written: {}", file.string(), why)}; };
  if (const std::string names = unwritable(world); !names.empty())
    return fail(fmt::format("a world file cannot hold {}, expected boxes, spheres, cylinders, walls and prisms; maps and meshes are kept in files of their own", names));
  if (!is_map_file(world.file)) {
    const auto text = write_world(world);
    return text ? write_file(file, *text) : fail(text.error().message);
  }
  const auto text = text_with_maps(world, image);
  if (!text) return fail(text.error().message);
  // A map that was moved or whose file is another by now would come back as something else: it is read before it counts.
  const std::filesystem::path trial = file.parent_path() / ("." + file.stem().string() + ".trial.toml");
  if (const auto written = write_file(trial, *text); !written) return written;
  const auto read = read_world(trial);
  std::error_code ignored;
  std::filesystem::remove(trial, ignored);
  if (!read) return fail(read.error().message);
  if (!same_world(*read, world)) return fail(fmt::format("the map does not stand as {} has it, expected it where it was", world.file.filename().string()));
  return write_file(file, *text);
}

}  // namespace thicket::gui
