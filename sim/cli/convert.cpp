// `thicket convert`: maps from one format to another.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "map_parts.hpp"
#include "program.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/movingai.hpp"
#include "thicket/base/probability_file.hpp"
#include "thicket/base/text.hpp"
#include "thicket/sim/probability_picture.hpp"
#include "thicket/worlds/mesh_file.hpp"

namespace thicket::cli {
namespace {

namespace fs = std::filesystem;

bool is_one_of(const std::string& ending, const std::vector<std::string>& endings) { return std::ranges::find(endings, ending) != endings.end(); }
bool is_tree(const std::string& ending) { return is_one_of(ending, {".ot", ".bt"}); }
bool is_yaml(const std::string& ending) { return is_one_of(ending, {".yaml", ".yml"}); }

/// A map's own probabilities, or as sure as may be what a map without them says.
Result<ProbabilityGrid> read_own_probabilities(const fs::path& in, const ConvertArguments& a) {
  ProbabilityReading reading{a.cell_size, std::nullopt, is_tree(in.extension().string()) ? a.z : std::nullopt, a.map_image};
  if (!a.origin.empty()) {
    const auto origin = numbers<2>(a.origin);
    if (!origin) return Error{fmt::format("--origin is '{}', expected X,Y, for example -10,-7.5", a.origin)};
    reading.origin = glm::dvec2((*origin)[0], (*origin)[1]);
  }
  return read_probabilities(in, reading);
}

/// The cells of a file: a map's own, or those that the matter of a world meets.
Result<GridMap> read_cells(const fs::path& in, const ConvertArguments& a) {
  const std::string ending = in.extension().string();
  if (ending == ".map") {
    if (!a.map_image.empty()) return Error{fmt::format("{}: a map image is given, but the map is not a map_server YAML file", in.string())};
    return read_movingai_map(in, a.cell_size.value_or(1.0));
  }
  if (is_yaml(ending)) return read_map_file(in, a.map_image);
  if (ending == ".npy" || is_tree(ending)) {
    const auto grid = read_own_probabilities(in, a);
    if (!grid) return grid.error();
    return judged(*grid);
  }
  MapOptions options;
  options.image = a.map_image;
  options.cell_size = a.cell_size;
  const auto world = read_world(in, options);
  if (!world) return world.error();
  const auto area = area_of(*world);
  if (!area) return area.error();
  const auto grid = occupancy(world_at(*world, 0.0), area->low, area->high, a.resolution, a.z_low, a.z_high, Convention::any_overlap);
  if (!grid) return grid.error();
  return to_map(*grid);
}

Result<ProbabilityGrid> read_grid(const fs::path& in, const ConvertArguments& a) {
  const std::string ending = in.extension().string();
  if (is_yaml(ending) || ending == ".npy" || is_tree(ending)) return read_own_probabilities(in, a);
  const auto map = read_cells(in, a);
  if (!map) return map.error();
  return probabilities_of(*map);
}

std::string world_of_map(const fs::path& yaml, const fs::path& in, const GridMap& map, double height) {
  // Turned maps leave their bounds to be found.
  const glm::dvec2 high = map.origin + glm::dvec2(map.width, map.height) * map.resolution;
  const std::string bounds = map.origin_yaw == 0.0 ? fmt::format("bounds_m = [{:#}, {:#}, {:#}, {:#}]\n", map.origin.x, map.origin.y, high.x, high.y) : "";
  return fmt::format("# Written by `thicket convert`.\nname = {}\nsource = {}\n{}\n[material.wall]\nreflectivity = 0.5\n\n[[solid]]\ntype = \"map\"\nname = \"map\"\nmaterial = \"wall\"\nfile = {}\nheight_m = {:#}\n",
                     toml_string(yaml.stem().string()), toml_string(in.filename().string()), bounds, toml_string(yaml.filename().string()), height);
}

/// A world of an OBJ file, which stays where it is, with every MTL material to be given one of Thicket's.
Result<std::string> world_of_obj(const fs::path& obj, const fs::path& out) {
  const auto file = read_obj(obj);
  if (!file) return file.error();
  auto presets = material_presets();
  if (!presets) return presets.error();
  std::error_code failed;
  fs::path relative = fs::relative(obj, fs::absolute(out).parent_path(), failed);
  if (failed || relative.empty()) relative = fs::absolute(obj);
  std::string text = fmt::format("# Written by `thicket convert`.\nname = {}\nsource = {}\n\n[material.wall]\nreflectivity = 0.5\n\n[[solid]]\ntype = \"mesh\"\nname = {}\nmaterial = \"wall\"         # where nothing else is said\n"
                                 "file = {}\nup = \"z\"                  # \"y\" if the model lies on its side\nscale = 1.0               # metres in a unit of the file\nsheet_thickness_m = 0.001\n",
                                 toml_string(obj.stem().string()), toml_string("OBJ file " + obj.filename().string()), toml_string(obj.stem().string()), toml_string(relative.generic_string()));
  const bool named = std::any_of(file->materials.begin(), file->materials.end(), [](const ObjMaterial& m) { return !m.name.empty(); });
  if (named) text += "\n[solid.materials]         # MTL name = material; `thicket materials` lists them\n";
  for (const ObjMaterial& mtl : file->materials) {
    if (mtl.name.empty()) continue;
    const bool shipped = std::any_of(presets->begin(), presets->end(), [&](const Material& m) { return m.name == mtl.name; });
    const std::string hint = mtl.dissolve < 1.0 ? fmt::format("  # its dissolve is {}: light may pass (\"glass\"?)", mtl.dissolve) : "";
    text += fmt::format("{} = {}{}\n", toml_string(mtl.name), toml_string(shipped ? mtl.name : "wall"), hint);
  }
  return text;
}

/// Flags that say nothing of these two files.
std::optional<Error> misplaced(const std::string& in, const std::string& out, const ConvertArguments& a) {
  if (!a.mode.empty() && out != ".yaml") return Error{fmt::format("--mode is '{}', expected that only for a map_server map, which ends in .yaml", a.mode)};
  if (!a.mode.empty() && !map_mode(a.mode)) return Error{fmt::format("--mode is '{}', expected {}{}", a.mode, fmt::join(map_mode_names(), ", "), did_you_mean(a.mode, map_mode_names()))};
  if (!a.origin.empty() && in != ".npy") return Error{fmt::format("--origin is '{}', expected that only for a .npy, which has none", a.origin)};
  if (a.z && !is_tree(in) && !is_tree(out)) return Error{fmt::format("--z is {}, expected that only for an .ot or .bt", *a.z)};
  if (!(a.height > 0.0) || !std::isfinite(a.height)) return Error{fmt::format("--height is {}, expected metres, a finite number greater than 0", a.height)};
  return std::nullopt;
}

void print_written(int width, int height, double resolution, const std::string& note, const std::vector<fs::path>& outputs) {
  fmt::print("cells      {} x {} of {} m\n{}", width, height, resolution, note);
  for (const fs::path& one : outputs) fmt::print("written    {}\n", one.string());
}

/// To the formats that hold probabilities.
int convert_probabilities(const fs::path& in, const fs::path& out, const std::vector<fs::path>& outputs, const ConvertArguments& a) {
  const std::string ending = out.extension().string();
  const auto grid = read_grid(in, a);
  if (!grid) return complain(grid.error());
  const double z = a.z.value_or(0.0);
  const auto written = ending == ".npy"   ? write_npy(out, *grid)
                       : is_tree(ending)  ? write_octomap(out, *grid, z)
                       : ending == ".png" ? write_probability_picture(out, *grid, in.filename().string())
                                          : write_map_server(stem_of(out), *grid, *map_mode(a.mode));
  if (!written) return complain(written.error());
  std::string note;
  if (ending == ".npy") note = fmt::format("note       a .npy keeps neither resolution nor origin: {} m a cell, origin {}, {} m\n", grid->resolution, grid->origin.x, grid->origin.y);
  if (is_tree(ending) && !a.z) note = "note       the layer of voxels is the one from 0 m up; --z gives another height\n";
  print_written(grid->width, grid->height, grid->resolution, note, outputs);
  return done;
}

}  // namespace

int convert_map(const ConvertArguments& a) {
  const fs::path out = a.out, stem = stem_of(out);
  const std::string ending = out.extension().string();
  const fs::path yaml = fs::path(stem) += ".yaml", pgm = fs::path(stem) += ".pgm", png = fs::path(stem) += ".png";
  if (!is_one_of(ending, {".yaml", ".map", ".toml", ".npy", ".ot", ".bt", ".png"}))
    return complain({fmt::format("'{}': cannot tell the format to write, expected a name ending in .yaml (map_server), .npy (NumPy), .ot or .bt (OctoMap), .png (picture), .map (MovingAI) or .toml (world)", a.out)});
  if (const auto fault = misplaced(fs::path(a.in).extension().string(), ending, a)) return complain(*fault);
  const auto in = find_input(a.in);
  if (in.empty()) return complain({missing_input(a.in)});
  if (in.extension() == ".obj" && ending == ".toml") {
    if (const auto fault = overwrites({out}, in, a.map_image)) return complain(*fault);
    const auto text = world_of_obj(in, out);
    if (!text) return complain(text.error());
    if (const auto written = write_file(out, *text); !written) return complain(written.error());
    fmt::print("written    {}\n", out.string());
    return done;
  }
  const std::vector<fs::path> outputs = ending == ".yaml" ? std::vector{yaml, a.mode == "scale" ? png : pgm} : ending == ".toml" ? std::vector{out, yaml, pgm} : std::vector{out};
  if (const auto fault = overwrites(outputs, in, a.map_image)) return complain(*fault);
  const bool states_only = is_one_of(ending, {".map", ".toml"}) || (ending == ".yaml" && (a.mode.empty() || a.mode == "trinary"));
  if (!states_only) return convert_probabilities(in, out, outputs, a);
  const auto map = read_cells(in, a);
  if (!map) return complain(map.error());

  std::string note;
  if (ending == ".map") {
    if (const auto written = write_movingai_map(out, *map); !written) return complain(written.error());
    const auto unknown = std::count(map->cells.begin(), map->cells.end(), CellState::unknown);
    if (unknown > 0) note += fmt::format("note       {} unknown cells became '@', not passable\n", unknown);
    note += fmt::format("note       a .map keeps neither resolution nor origin: {} m a cell, origin {}, {} m, {} rad\n", map->resolution, map->origin.x, map->origin.y, map->origin_yaw);
  } else {
    if (const auto written = write_map_file(stem, *map); !written) return complain(written.error());
    if (ending == ".toml")
      if (const auto written = write_file(out, world_of_map(yaml, in, *map, a.height)); !written) return complain(written.error());
  }
  print_written(map->width, map->height, map->resolution, note, outputs);
  return done;
}

}  // namespace thicket::cli
