// Changes to a world, with the way back. It follows the world of the run and hands out worlds to be posted; it owns neither.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "thicket/gui/runner.hpp"

namespace thicket::gui {

/// Whether two worlds are the same for every ray and contact, and as files; where they were read from does not count.
bool same_world(const World& a, const World& b);

class Editor {
 public:
  /// Takes over what the run shows, unless changes are under way to it. A state that was undone or will be redone is recognised, also when the run is gone back and forth in.
  void follow(const Snapshot& now);
  /// As it is to be: with what is under way to the run.
  const World& world() const { return world_; }
  bool open() const { return open_; }
  /// Another number: another world.
  std::uint64_t revision() const { return revision_; }

  std::uint32_t add(Solid solid);
  /// Nothing happens if the solid is as it was.
  void replace(std::uint32_t at, Solid solid);
  void erase(std::uint32_t at);
  std::uint32_t copy(std::uint32_t at, const glm::dvec2& offset);
  /// A solid's material by name: the world's, else a shipped one, which the world then has too. False: there is none of that name.
  bool set_material(std::uint32_t at, const std::string& name);

  bool undo();
  bool redo();
  std::size_t undoable() const { return done_; }
  std::size_t redoable() const { return changes_.size() - done_; }

  /// The world, if it was changed since it was last asked for: to be posted.
  std::optional<World> take();

  /// "box 3": a name that no solid has.
  std::string fresh_name(const std::string& kind) const;
  /// The material that new solids get, of `material_names`.
  std::string new_material;
  double new_height = 2.5, new_thickness = 0.2;  ///< m
  double grid = 0.25;                            ///< m, to which the tool snaps
  std::string message;                           ///< why the last thing that was wanted was not done

 private:
  struct Change {
    std::uint32_t at = 0;
    std::optional<Solid> before, after;  ///< nothing: it was added, or erased
    std::vector<Material> materials;     ///< that came with it
  };
  void make(Change change);
  static void apply(World& world, const Change& change);
  static void revert(World& world, const Change& change);
  bool find_state(const World& shown);

  bool open_ = false, changed_ = false;
  World world_;
  std::vector<Change> changes_;
  std::size_t done_ = 0, bytes_ = 0;
  const World* seen_ = nullptr;
  std::uint64_t seen_world_ = 0, seen_run_ = 0, seen_message_ = 0, under_way_ = 0, revision_ = 0;
};

/// The names of a world's materials, then those of the shipped ones that it lacks.
std::vector<std::string> material_names(const World& world);

/// "box", "sphere", "cylinder", "wall", "map", "prism", "mesh".
const char* kind_of(const Solid& solid);

/// Writes a world file that `read_world` reads as the same world. Of a world that was read from a map file the map is named, not copied (`image`: as in `MapOptions`), where it stands as it stood. Errors: what such a file cannot
/// hold (meshes, maps of other worlds), by name, and what the disk says.
Result<Done> save_world(const World& world, const std::filesystem::path& file, const std::filesystem::path& image = {});

}  // namespace thicket::gui
