// One entry [[solid]] of a world file. Private to the room.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "thicket/base/document.hpp"
#include "thicket/worlds/world.hpp"

namespace thicket {

/// The materials that solids of a file may name.
class MaterialFinder {
 public:
  virtual ~MaterialFinder() = default;
  /// The index of a material of that name, which the world then has; a fault, and 0, if there is none.
  virtual std::uint32_t index_of(const std::string& name, const Place& place) = 0;
  virtual bool knows(const std::string& name) = 0;
};

/// Reads an entry and appends its solids: one, or those of all its parts, repeats and instances. Files are relative to `folder`.
void read_solid(const Node& entry, const std::filesystem::path& folder, MaterialFinder& materials, World& world, Faults& faults);

/// The file that a key of a table names, relative to `folder`; nothing, and a fault at the key's value, if there is none. (Nothing alone if the key is missing or
/// is no text: the section tells.)
std::optional<std::filesystem::path> file_of(const Node& table, const char* key, const std::filesystem::path& folder, Faults& faults);

/// Moves a solid and its way: `placed` gives the new place of a point.
template <class Place>
void move_solid(Solid& solid, const Place& placed) {
  solid.position = placed(solid.position);
  if (!solid.motion) return;
  auto motion = std::make_shared<Motion>(*solid.motion);
  for (glm::dvec3& p : motion->points) p = placed(p);
  solid.motion = std::move(motion);
}

/// A grid map as a solid: its frame is the map's own, placed by the solid's pose.
void place_map(Solid& solid, GridMap grid, const MapOptions& options);
/// A map by its ending: MovingAI for `.map`, else map_server.
Result<GridMap> read_any_map(const std::filesystem::path& file, const MapOptions& options);

/// The pieces of an OBJ file as solids with a pose, scale and sheet thickness, and their notices; `material_of` gives a material for an MTL name (empty: none).
Result<std::vector<Solid>> solids_of_obj(const std::filesystem::path& file, bool y_up, const Solid& pose, const MeshSolid& like, const std::function<std::uint32_t(const std::string&)>& material_of,
                                         World& world);

}  // namespace thicket
