#include "editor_keys.hpp"

#include <fmt/format.h>

#include "editor.hpp"
#include "editor_shapes.hpp"
#include "mission_form.hpp"
#include "thicket/base/pose.hpp"
#include "thicket/worlds/shape_fault.hpp"

namespace thicket::gui {
namespace {

using Form = SolidForm;
const Range place = between(-1e9, 1e9), size = above_up_to(0.0, 1e9), angle = between(-36000.0, 36000.0);

template <class S>
S& shape(Form& form) {
  return std::get<S>(form.solid.shape);
}

void add_shape_keys(SectionOf<Form>& section, const Solid& solid) {
  if (std::holds_alternative<Box>(solid.shape)) section.add("size_m", [](Form& f) -> glm::dvec3& { return shape<Box>(f).size; }, "m", size, "edge lengths along x, y, z");
  if (std::holds_alternative<Sphere>(solid.shape)) section.add("radius_m", [](Form& f) -> double& { return shape<Sphere>(f).radius; }, "m", size, "radius");
  if (std::holds_alternative<Cylinder>(solid.shape)) {
    section.add("radius_m", [](Form& f) -> double& { return shape<Cylinder>(f).radius; }, "m", size, "radius");
    section.add("height_m", [](Form& f) -> double& { return shape<Cylinder>(f).height; }, "m", size, "height");
  }
  if (std::holds_alternative<Wall>(solid.shape)) {
    section.add("thickness_m", [](Form& f) -> double& { return shape<Wall>(f).thickness; }, "m", size, "thickness");
    section.add("height_m", [](Form& f) -> double& { return shape<Wall>(f).height; }, "m", size, "height, upward from its position's z");
    section.add("points_m", [](Form& f) -> std::vector<glm::dvec2>& { return shape<Wall>(f).points; }, "m", place, "the middle line, from its position: two points or more");
  }
  if (std::holds_alternative<Prism>(solid.shape)) {
    section.add("height_m", [](Form& f) -> double& { return shape<Prism>(f).height; }, "m", size, "height, upward from its position's z");
    section.add("points_m", [](Form& f) -> std::vector<glm::dvec2>& { return shape<Prism>(f).outline; }, "m", place, "the outline, from its position: three points or more");
  }
  if (std::holds_alternative<MapSolid>(solid.shape)) section.add("height_m", [](Form& f) -> double& { return shape<MapSolid>(f).height; }, "m", size, "height, upward from its position's z");
  if (std::holds_alternative<MeshSolid>(solid.shape)) section.add("scale", [](Form& f) -> double& { return shape<MeshSolid>(f).scale; }, "", between(1e-6, 1e6), "metres in a unit of the mesh");
}

}  // namespace

SolidForm form_of(const World& world, const Solid& solid) {
  const auto rounded = [](double a) {
    // Degrees that were typed are shown as they were typed.
    const double d = degrees(a), tidy = std::round(d * 1e9) / 1e9;
    return radians(tidy) == a ? tidy : d;
  };
  return {solid, world.materials[solid.material].name, rounded(solid.yaw), rounded(solid.pitch), rounded(solid.roll)};
}

Section solid_section(const Solid& solid) {
  SectionOf<Form> section(fmt::format("[[solid]] of type \"{}\"", kind_of(solid)), "a solid of the world");
  section.add("name", [](Form& f) -> std::string& { return f.solid.name; }, "", {}, "name of the solid, for messages");
  section.key("material", &Form::material, "what it is made of: of this world, or one that is shipped");
  if (!solid.motion) section.add("position_m", [](Form& f) -> glm::dvec3& { return f.solid.position; }, "m", place, "x, y, z of the shape's origin");
  section.key("yaw_deg", &Form::yaw_deg, "deg", angle, "turn about its own vertical axis, counter-clockwise");
  const bool tilts = !std::holds_alternative<Sphere>(solid.shape) && !std::holds_alternative<Wall>(solid.shape) && !std::holds_alternative<MapSolid>(solid.shape);
  if (tilts) {
    section.key("pitch_deg", &Form::pitch_deg, "deg", angle, "turn about its y axis, before the yaw: forward end down");
    section.key("roll_deg", &Form::roll_deg, "deg", angle, "turn about its x axis, before the pitch: left side up");
  }
  add_shape_keys(section, solid);
  return section;
}

Result<SolidForm> with_key(const World& world, const Solid& solid, const Section& section, const Key& key, const std::string& typed) {
  SolidForm form = form_of(world, solid);
  const auto value = judged(section, key, typed);
  if (!value) return value.error();
  key.set(&form, *value);
  if (key.name == "yaw_deg") form.solid.yaw = radians(form.yaw_deg);
  if (key.name == "pitch_deg") form.solid.pitch = radians(form.pitch_deg);
  if (key.name == "roll_deg") form.solid.roll = radians(form.roll_deg);
  if (const auto fault = shape_fault(form.solid.shape)) return Error{*fault};
  return form;
}

}  // namespace thicket::gui
