// Worlds as text.
#pragma once

#include <string>

#include "thicket/base/result.hpp"
#include "thicket/worlds/world.hpp"

namespace thicket {

/// A world file (TOML) that `read_world` reads as the same world: boxes, spheres, cylinders, walls and prisms with their materials, poses and motions, to the bits of
/// every number. Angles, which a file has in degrees, come back to the same bits if they came from degrees (`radians(d)` for any d), else to within 2^-51 of themselves.
/// The file, and the notices, of a world that was read are not part of it; a solid without a name gets one when it is read.
/// Errors: a map or mesh, which a file of its own holds; two materials of one name, or a solid whose material there is none.
Result<std::string> write_world(const World& world);

}  // namespace thicket
