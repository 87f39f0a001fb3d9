#include "thicket/worlds/world_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <set>
#include <vector>

#include "material_file.hpp"
#include "thicket/base/pose.hpp"
#include "world_keys.hpp"

namespace thicket {
namespace {

/// The degrees that a reader turns into `angle`, if there are any: the next numbers to what division gives are tried. Else what division gives.
double degrees_of(double angle) {
  const double near = degrees(angle);
  double below = near, above = near;
  for (int i = 0; i < 4; ++i) {
    if (radians(below) == angle) return below;
    if (radians(above) == angle) return above;
    below = std::nextafter(below, -INFINITY);
    above = std::nextafter(above, INFINITY);
  }
  return near;
}

/// `write_section` but for the keys that stand for something else: a text that is not given, and those of `without`.
std::string write_keys(const Section& section, const void* object, const std::set<std::string>& without = {}) {
  std::string text;
  for (const Key& key : section.keys) {
    const Value value = key.get(object);
    const auto* words = std::get_if<std::string>(&value);
    if (std::holds_alternative<std::monostate>(value) || (words && words->empty() && !key.required) || without.contains(key.name)) continue;
    text += fmt::format("{} = {}\n", key.name, to_toml(value));
  }
  return text;
}

std::string write_motion(const Motion& motion) {
  MotionKeys keys;
  keys.waypoints = motion.points;
  keys.speed = motion.speed;
  keys.start_s = motion.start_s;
  keys.spin_deg_s = degrees_of(motion.spin);
  keys.mode = motion.mode == Motion::Mode::loop ? "loop" : motion.mode == Motion::Mode::back_and_forth ? "back_and_forth" : "once";
  return "\n[solid.motion]\n" + write_section(motion_section(), &keys);
}

class SolidWriter {
 public:
  SolidWriter(const World& world, const Solid& solid) : world_(world), solid_(solid) {}

  Result<std::string> operator()(const Box& shape) const { return tilted(box_section(), BoxKeys{}, "box", shape); }
  Result<std::string> operator()(const Cylinder& shape) const { return tilted(cylinder_section(), CylinderKeys{}, "cylinder", shape); }
  Result<std::string> operator()(const Sphere& shape) const { return upright(sphere_section(), SphereKeys{}, "sphere", shape); }
  Result<std::string> operator()(const Wall& shape) const { return upright(wall_section(), WallKeys{}, "wall", shape); }
  Result<std::string> operator()(const Prism& shape) const {
    auto text = tilted(prism_section(), PrismKeys{}, "prism", shape);
    if (!text) return text;
    for (const auto& hole : shape.holes) {
      const HoleKeys keys{hole};
      *text += "\n[[solid.hole]]\n" + write_section(hole_section(), &keys);
    }
    return text;
  }
  Result<std::string> operator()(const MapSolid&) const { return fault("a map, which is kept in a file of its own: write it with write_map_file and name that in a solid of type \"map\""); }
  Result<std::string> operator()(const MeshSolid&) const { return fault("a mesh, which is kept in a file of its own: keep the OBJ file and name it in a solid of type \"mesh\""); }

 private:
  Error fault(const char* what) const { return Error{fmt::format("the solid '{}' is {}", solid_.name, what)}; }

  template <class Keys, class ShapeOf>
  Result<std::string> tilted(const Section& section, Keys keys, const char* type, const ShapeOf& shape) const {
    keys.pitch_deg = degrees_of(solid_.pitch);
    keys.roll_deg = degrees_of(solid_.roll);
    return write(section, std::move(keys), type, shape);
  }
  template <class Keys, class ShapeOf>
  Result<std::string> upright(const Section& section, Keys keys, const char* type, const ShapeOf& shape) const {
    if (!solid_.upright()) return fault("tilted, but not of a kind that can be: expected pitch and roll of 0");
    return write(section, std::move(keys), type, shape);
  }
  template <class Keys, class ShapeOf>
  Result<std::string> write(const Section& section, Keys keys, const char* type, const ShapeOf& shape) const {
    if (solid_.material >= world_.materials.size()) return fault("of a material that the world does not have");
    keys.type = type;
    keys.name = solid_.name;
    keys.material = world_.materials[solid_.material].name;
    keys.position = solid_.position;
    keys.yaw_deg = degrees_of(solid_.yaw);
    keys.shape = shape;
    // A moving solid is where its way-points are.
    return "\n[[solid]]\n" + write_keys(section, &keys, solid_.motion ? std::set<std::string>{"position_m"} : std::set<std::string>{});
  }

  const World& world_;
  const Solid& solid_;
};

}  // namespace

Result<std::string> write_world(const World& world) {
  const HeaderKeys header{world.name, world.source, world.bounds};
  std::string text = write_keys(header_section(), &header);
  std::set<std::string> names;
  for (const Material& material : world.materials) {
    if (!names.insert(material.name).second) return Error{fmt::format("the world has two materials '{}', expected names that differ", material.name)};
    text += fmt::format("\n[material.{}]\n{}", toml_string(material.name), write_material(material));
  }
  for (const Solid& solid : world.solids) {
    const auto written = std::visit(SolidWriter(world, solid), solid.shape);
    if (!written) return written.error();
    text += *written;
    if (solid.motion) text += write_motion(*solid.motion);
  }
  return text;
}

}  // namespace thicket
