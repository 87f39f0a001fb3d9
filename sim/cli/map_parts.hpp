// What commands about maps share.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "thicket/base/map_file.hpp"
#include "thicket/worlds/truth.hpp"

namespace thicket::cli {

struct Area {
  glm::dvec2 low, high;
};

/// What the world states, else all that it has and a metre around.
Result<Area> area_of(const World& world);

GridMap to_map(const TruthGrid& grid);

/// A file name without its ending, which write_map_file adds.
inline std::filesystem::path stem_of(const std::filesystem::path& file) { return std::filesystem::path(file).replace_extension(); }

/// What a command would write must not be what it reads: the input, or a file that its text names.
std::optional<Error> overwrites(const std::vector<std::filesystem::path>& outputs, const std::filesystem::path& in, const std::filesystem::path& map_image);

}  // namespace thicket::cli
