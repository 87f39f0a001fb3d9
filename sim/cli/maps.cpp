// `thicket truth`: what is there as a map, and whether there is a way.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "map_parts.hpp"
#include "program.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/image.hpp"

namespace thicket::cli {
namespace {

namespace fs = std::filesystem;

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code none;
  return fs::equivalent(a, b, none) && !none;
}

/// Black is blocked, white free, grey the path.
GreyImage to_picture(const TruthGrid& grid, const std::optional<GridPath>& path) {
  GreyImage image{grid.width, grid.height, std::vector<std::uint8_t>(grid.blocked.size()), {}};
  const auto width = static_cast<std::size_t>(grid.width), height = static_cast<std::size_t>(grid.height);
  const auto pixel = [&](std::size_t cell) -> std::uint8_t& { return image.pixels[(height - 1 - cell / width) * width + cell % width]; };
  for (std::size_t cell = 0; cell < grid.blocked.size(); ++cell) pixel(cell) = grid.blocked[cell] ? 0 : 255;
  if (path)
    for (const glm::dvec2& point : path->points) pixel(grid.index_at(point)) = 128;
  return image;
}

void print_way(const TruthGrid& grid, const std::optional<GridPath>& path, const glm::dvec2& from, const glm::dvec2& to) {
  if (path) return fmt::print("connected  yes, the shortest path is {:.3f} m\n", path->length_m);
  const bool at_start = grid.blocked[grid.index_at(from)] != 0, at_goal = grid.blocked[grid.index_at(to)] != 0;
  fmt::print("connected  no{}\n", at_start ? ": --from lies in a blocked cell" : at_goal ? ": --to lies in a blocked cell" : "");
}

}  // namespace

Result<Area> area_of(const World& world) {
  if (const auto& b = world.bounds) return Area{{b->x, b->y}, {b->z, b->w}};
  const auto box = extent(world);
  if (!box) return Error{fmt::format("{}: the world is empty and states no bounds_m, expected --bounds X0,Y0,X1,Y1", world.file.string())};
  return Area{glm::dvec2(box->low) - 1.0, glm::dvec2(box->high) + 1.0};
}

GridMap to_map(const TruthGrid& grid) {
  GridMap map{grid.width, grid.height, grid.resolution, grid.low, 0.0, {}};
  map.cells.reserve(grid.blocked.size());
  for (const std::uint8_t blocked : grid.blocked) map.cells.push_back(blocked ? CellState::occupied : CellState::free);
  return map;
}

std::optional<Error> overwrites(const std::vector<fs::path>& outputs, const fs::path& in, const fs::path& map_image) {
  const std::string ending = in.extension().string();
  const bool names_files = ending == ".toml" || ending == ".yaml" || ending == ".yml";
  const auto text = names_files ? read_text_file(in) : Result<std::string>(std::string{});
  std::error_code none;
  for (const fs::path& out : outputs) {
    const bool named = fs::exists(out, none) && text && text->find(out.filename().string()) != std::string::npos;
    if (named || same_file(out, in) || same_file(out, map_image))
      return Error{fmt::format("{}: would be overwritten while it is read, expected another name to write to", out.string())};
  }
  return std::nullopt;
}

int write_truth(const TruthArguments& a) {
  const fs::path out = a.out;
  const std::string ending = out.extension().string();
  const bool picture = ending == ".png";
  // A dot may be part of a name: only what is surely another format is refused.
  for (const char* other : {".map", ".toml", ".pgm", ".jpg", ".npy", ".ot", ".bt"})
    if (ending == other) return complain({fmt::format("--out is '{}', expected a name ending in .yaml (or without an ending) for a map, in .png for a picture", a.out)});
  if (a.convention != "centre" && a.convention != "overlap") return complain({fmt::format("--convention is '{}', expected centre or overlap", a.convention)});
  if (a.grow > 0.0 && a.all_matter) return complain({"--all-matter does not go with --grow: obstacles are what stops motion"});
  if (a.from.empty() != a.to.empty()) return complain({fmt::format("--{} is missing, expected both --from X,Y and --to X,Y or neither", a.from.empty() ? "from" : "to")});
  const auto from = numbers<2>(a.from.empty() ? "0,0" : a.from), to = numbers<2>(a.to.empty() ? "0,0" : a.to);
  if (!from) return complain({fmt::format("--from is '{}', expected X,Y, for example 1.5,-2", a.from)});
  if (!to) return complain({fmt::format("--to is '{}', expected X,Y, for example 1.5,-2", a.to)});
  if (!std::isfinite(a.time)) return complain({fmt::format("--time is {}, expected a finite number", a.time)});

  const auto file = find_input(a.world);
  if (file.empty()) return complain({missing_input(a.world)});
  const fs::path stem = ending == ".yaml" || ending == ".yml" ? stem_of(out) : out;
  const fs::path map_yaml = fs::path(stem) += ".yaml", map_image = fs::path(stem) += ".pgm";
  if (const auto fault = overwrites(picture ? std::vector{out} : std::vector{map_yaml, map_image}, file, a.map_image)) return complain(*fault);
  MapOptions options;
  options.image = a.map_image;
  options.cell_size = a.cell_size;
  auto world = read_world(file, options);
  if (!world) return complain(world.error());
  *world = world_at(*world, a.time);

  auto area = a.bounds.empty() ? area_of(*world) : Result<Area>(Area{});
  if (!area) return complain(area.error());
  if (!a.bounds.empty()) {
    const auto b = numbers<4>(a.bounds);
    if (!b) return complain({fmt::format("--bounds is '{}', expected X0,Y0,X1,Y1, for example -10,-5,10,5", a.bounds)});
    *area = {{(*b)[0], (*b)[1]}, {(*b)[2], (*b)[3]}};
  }
  const auto convention = a.convention == "centre" ? Convention::cell_centre : Convention::any_overlap;
  const auto grid = a.grow == 0.0 ? occupancy(*world, area->low, area->high, a.resolution, a.z_low, a.z_high, convention, !a.all_matter)
                                  : grown_obstacles(*world, area->low, area->high, a.resolution, a.grow, a.z_low, a.z_high);
  if (!grid) return complain(grid.error());
  if (!a.from.empty())
    for (const auto& [flag, p] : {std::pair{"from", *from}, {"to", *to}})
      if (!grid->contains({p[0], p[1]})) return complain({fmt::format("--{} lies outside the grid, which is x {} to {}, y {} to {} m", flag, grid->low.x, area->high.x, grid->low.y, area->high.y)});

  std::optional<GridPath> path;
  const glm::dvec2 start((*from)[0], (*from)[1]), goal((*to)[0], (*to)[1]);
  if (!a.from.empty()) path = shortest_path(*grid, start, goal);
  const auto written = picture ? write_png(out, to_picture(*grid, path)) : write_map_file(stem, to_map(*grid));
  if (!written) return complain(written.error());
  const auto blocked = static_cast<double>(std::count(grid->blocked.begin(), grid->blocked.end(), 1));
  fmt::print("cells      {} x {} of {} m, from {}, {} m\noccupied   {:.3f} %{}\n", grid->width, grid->height, grid->resolution, grid->low.x, grid->low.y, 100.0 * blocked / static_cast<double>(grid->blocked.size()),
             a.grow > 0.0 ? fmt::format(" (obstacles grown by {} m)", a.grow) : "");
  if (a.from.empty()) return done;
  print_way(*grid, path, start, goal);
  return path ? done : unreachable;
}

}  // namespace thicket::cli
