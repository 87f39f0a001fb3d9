#include "scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <locale>
#include <optional>
#include <sstream>
#include <string>

#include "thicket/base/files.hpp"

namespace thicket {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_beside(const fs::path& map) {
  const std::string name = map.filename().string(), stem = map.stem().string();
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(map.has_parent_path() ? map.parent_path() : fs::path("."), none)) {
    const std::string file = entry.path().filename().string();
    if (file.ends_with(".scen") && (file == stem + ".scen" || file == name + ".scen" || file.starts_with(stem + "-"))) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Appends a file's rows. Their columns: bucket, map, its width and height, x and y of start and goal, length of the shortest way.
std::optional<Error> append(const fs::path& file, const std::string& map, const glm::ivec2& size, std::vector<Scenario>& list) {
  const auto content = read_text_file(file);
  if (!content) return content.error();
  std::istringstream lines(*content);
  lines.imbue(std::locale::classic());
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const auto fault = [&](const std::string& what) { return Error{fmt::format("{}:{}: {}", file.string(), number, what)}; };
    std::istringstream words(line);
    words.imbue(std::locale::classic());
    std::string first, name;
    if (!(words >> first)) continue;
    if (number == 1) {
      if (first != "version") return fault(fmt::format("begins with '{}', expected 'version 1'", first.substr(0, 40)));
      continue;
    }
    glm::ivec2 of{0}, start{0}, goal{0};
    if (!(words >> name >> of.x >> of.y >> start.x >> start.y >> goal.x >> goal.y))
      return fault("is no scenario, expected: bucket, map, width, height, x and y of start and goal, length");
    if (fs::path(name).filename() != map) continue;
    if (of != size) return fault(fmt::format("is for a map of {} x {} cells, expected {} x {}", of.x, of.y, size.x, size.y));
    for (const glm::ivec2& c : {start, goal})
      if (c.x < 0 || c.y < 0 || c.x >= size.x || c.y >= size.y) return fault(fmt::format("names the cell {}, {}, expected one of {} x {} from 0, 0 on", c.x, c.y, size.x, size.y));
    list.push_back({{start.x, size.y - 1 - start.y}, {goal.x, size.y - 1 - goal.y}});
  }
  return std::nullopt;
}

}  // namespace

Result<std::vector<Scenario>> read_scenarios(const fs::path& map, const glm::ivec2& size) {
  std::vector<Scenario> list;
  for (const fs::path& file : files_beside(map))
    if (auto fault = append(file, map.filename().string(), size, list)) return *fault;
  return list;
}

}  // namespace thicket
