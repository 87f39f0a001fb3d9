// Problems on maps that are files.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenario.hpp"
#include "thicket/base/document.hpp"
#include "thicket/base/random.hpp"
#include "thicket/sim/problem.hpp"
#include "thicket/worlds/truth.hpp"

namespace thicket {
namespace {

namespace fs = std::filesystem;

constexpr double finest_grid = 0.05, coarsest_of_a_map = 0.25;  // m, of the places that are looked at
constexpr double most_places = 1.6e7;
constexpr std::uint16_t random_places = 1001;  // whose random numbers these are: no family's

bool is_map(const fs::path& file) { return file.extension() == ".map" || file.extension() == ".yaml" || file.extension() == ".yml"; }

/// A TOML file with one of a mission's sections, as the command line tells them apart.
bool is_mission(const fs::path& file) {
  if (file.extension() != ".toml") return false;
  const auto document = read_document(file);
  return document && (document->find("world") || document->find("planner") || document->find("sensor"));
}

Result<std::vector<fs::path>> worlds_in(const fs::path& place) {
  std::error_code failure;
  if (!fs::exists(place, failure)) return Error{fmt::format("there is no file or folder '{}'", place.string())};
  if (!fs::is_directory(place, failure)) {
    if (is_mission(place)) return Error{fmt::format("{}: this is a mission and not a world, expected a world or map", place.string())};
    return std::vector<fs::path>{place};
  }
  std::vector<fs::path> files;
  for (auto entry = fs::recursive_directory_iterator(place, failure); !failure && entry != fs::recursive_directory_iterator(); entry.increment(failure)) {
    const fs::path& file = entry->path();
    if (entry->is_regular_file(failure) && (is_map(file) || (file.extension() == ".toml" && !is_mission(file)))) files.push_back(file);
  }
  if (failure) return Error{fmt::format("{}: cannot be searched: {}", place.string(), failure.message())};
  if (files.empty()) return Error{fmt::format("{}: holds no map (.yaml, .map) and no world (.toml)", place.string())};
  std::sort(files.begin(), files.end());
  return files;
}

/// What all problems of one file have in common.
struct Source {
  std::shared_ptr<const World> world;
  fs::path file, image;
  double cell_size = 0.0;
  const Solid* map = nullptr;  ///< its only solid, if that is a grid map

  const GridMap& grid() const { return std::get<MapSolid>(map->shape).grid; }
};

Result<Source> read_source(const fs::path& file, const MapProblems& how) {
  Source source;
  source.file = file;
  MapOptions options;
  if (file.extension() == ".map") options.cell_size = source.cell_size = how.cell_size_m;
  auto world = read_world(file, options);
  if (!world && is_map(file) && file.extension() != ".map") {
    for (const char* ending : {".pgm", ".png"}) {
      std::error_code none;
      const fs::path image = fs::path(file).replace_extension(ending);
      if (!fs::exists(image, none)) continue;
      options.image = image;
      auto other = read_world(file, options);
      if (!other) continue;
      source.image = image;
      world = std::move(other);
      break;
    }
  }
  if (!world) return world.error();
  source.world = std::make_shared<const World>(std::move(*world));
  const auto& solids = source.world->solids;
  if (solids.size() == 1 && std::holds_alternative<MapSolid>(solids[0].shape)) source.map = &solids[0];
  return source;
}

/// Where the robot's axis may be, `grow` from matter, on a grid that has the cells of a MovingAI map.
Result<TruthGrid> places(const Source& source, const Robot& robot, double grow) {
  glm::dvec4 bounds(-1.0, -1.0, 1.0, 1.0);
  if (const auto all = extent(*source.world)) bounds = {all->low.x - 1.0, all->low.y - 1.0, all->high.x + 1.0, all->high.y + 1.0};
  bounds = source.world->bounds.value_or(bounds);
  const glm::dvec2 low(bounds.x, bounds.y), high(bounds.z, bounds.w), size = high - low;
  double resolution = source.cell_size > 0.0 ? source.cell_size : finest_grid;
  if (source.map && source.cell_size == 0.0) resolution = std::clamp(source.grid().resolution, finest_grid, coarsest_of_a_map);
  if (source.cell_size == 0.0) resolution = std::max(resolution, std::sqrt(size.x * size.y / most_places));
  const Hull hull = robot.vehicle.hull();
  auto grid = grown_obstacles(*source.world, low, high, resolution, grow, hull.z_low, hull.z_high);
  if (!grid) return Error{fmt::format("{}: {}", source.file.string(), grid.error().message)};
  return grid;
}

/// Another number for every file, whatever the folder that it lies in: FNV-1a of its name.
std::uint32_t number_of(const fs::path& file) {
  std::uint32_t hash = 2166136261u;
  for (const char c : file.filename().string()) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
  return hash;
}

class MapReader {
 public:
  MapReader(const MapProblems& how, const Robot& robot) : how_(how), robot_(robot), random_(how.seed, random_places) {}

  std::optional<Error> read(const fs::path& file) {
    const auto source = read_source(file, how_);
    if (!source) return source.error();
    if (!source->image.empty())
      result_.notices.push_back(fmt::format("{}: the image that it names cannot be read; '{}' beside it was taken", file.string(), source->image.filename().string()));
    const auto& solids = source->world->solids;
    if (std::any_of(solids.begin(), solids.end(), [](const Solid& solid) { return solid.motion != nullptr; })) {
      result_.notices.push_back(fmt::format("{}: something in it moves; it was passed over", file.string()));
      return std::nullopt;
    }
    const std::size_t before = result_.problems.size();
    if (source->cell_size > 0.0)
      if (auto fault = add_scenarios(*source)) return fault;
    return add_random(*source, how_.problems_per_map - (result_.problems.size() - before));
  }

  ReadProblems take() { return std::move(result_); }

 private:
  void add(const Source& source, const glm::dvec2& start, const glm::dvec2& goal) {
    Problem& problem = result_.problems.emplace_back();
    problem.family = source.file.stem().string();
    problem.number = result_.problems.size() - 1;
    problem.world = source.world;
    problem.world_file = source.file;
    problem.world_image = source.image;
    problem.cell_size_m = source.cell_size;
    problem.start = {start, radians(std::floor(360.0 * random_.uniform(problem.number, number_of(source.file), RandomUse::sampling, 1)[0]))};
    problem.goal = goal;
  }

  std::optional<Error> add_scenarios(const Source& source) {
    const GridMap& map = source.grid();
    const auto list = read_scenarios(source.file, {map.width, map.height});
    if (!list) return list.error();
    const auto grid = places(source, robot_, robot_.keep());
    if (!grid) return grid.error();
    const Pose2 frame{glm::dvec2(source.map->position), source.map->yaw};
    const auto middle = [&](const glm::ivec2& cell) { return frame.to_outer((glm::dvec2(cell) + 0.5) * map.resolution); };
    const auto is_free = [&](const glm::dvec2& point) { return grid->contains(point) && !grid->blocked[grid->index_at(point)]; };
    std::vector<Scenario> usable;
    for (const Scenario& scenario : *list)
      if (is_free(middle(scenario.start)) && is_free(middle(scenario.goal))) usable.push_back(scenario);
    if (usable.size() < list->size())
      result_.notices.push_back(fmt::format("{}: {} of {} scenarios begin or end nearer to matter than {:.3g} m; they were passed over", source.file.string(), list->size() - usable.size(), list->size(),
                                            robot_.keep()));
    const std::size_t taken = std::min(usable.size(), how_.problems_per_map);
    for (std::size_t i = 0; i < taken; ++i) {
      const Scenario& scenario = usable[i * usable.size() / taken];
      add(source, middle(scenario.start), middle(scenario.goal));
    }
    return std::nullopt;
  }

  std::optional<Error> add_random(const Source& source, std::size_t wanted) {
    if (wanted == 0) return std::nullopt;
    const auto grid = places(source, robot_, robot_.keep() + problem_doubt(robot_));
    if (!grid) return grid.error();
    std::vector<std::uint32_t> free;
    for (std::size_t i = 0; i < grid->blocked.size(); ++i)
      if (!grid->blocked[i]) free.push_back(static_cast<std::uint32_t>(i));
    if (free.size() < 2) {
      result_.notices.push_back(fmt::format("{}: has no room for a robot that keeps {:.3g} m from matter; it was passed over", source.file.string(), robot_.keep()));
      return std::nullopt;
    }
    const auto width = static_cast<std::uint32_t>(grid->width);
    const auto place = [&](double part) {
      const std::uint32_t cell = free[std::min(static_cast<std::size_t>(part * static_cast<double>(free.size())), free.size() - 1)];
      return grid->centre(static_cast<int>(cell % width), static_cast<int>(cell / width));
    };
    for (std::size_t i = 0; i < wanted; ++i) {
      const auto parts = random_.uniform(i, number_of(source.file), RandomUse::sampling, 0);
      add(source, place(parts[0]), place(parts[1]));
    }
    return std::nullopt;
  }

  const MapProblems& how_;
  const Robot& robot_;
  Random random_;
  ReadProblems result_;
};

}  // namespace

Result<ReadProblems> read_problems(const fs::path& folder_or_file, const MapProblems& how, const Robot& robot) {
  const auto files = worlds_in(folder_or_file);
  if (!files) return files.error();
  MapReader reader(how, robot);
  for (const fs::path& file : *files)
    if (auto fault = reader.read(file)) return *fault;
  return reader.take();
}

}  // namespace thicket
