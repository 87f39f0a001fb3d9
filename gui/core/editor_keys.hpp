// A solid's keys, as a form shows them: those of a world file.
#pragma once

#include <optional>
#include <string>

#include "thicket/base/schema.hpp"
#include "thicket/worlds/world.hpp"

namespace thicket::gui {

/// What of a solid is shown as keys: the solid itself with its material by name and its angles in degrees.
struct SolidForm {
  Solid solid;
  std::string material;
  double yaw_deg = 0.0, pitch_deg = 0.0, roll_deg = 0.0;
};
SolidForm form_of(const World& world, const Solid& solid);

/// The keys of a solid of this kind, with the ranges of a world file. Objects are `SolidForm`.
Section solid_section(const Solid& solid);

/// The solid with a key typed; the material is left to who keeps the list of them. Errors as the reader of world files has them.
Result<SolidForm> with_key(const World& world, const Solid& solid, const Section& section, const Key& key, const std::string& typed);

}  // namespace thicket::gui
