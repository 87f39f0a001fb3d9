// What is wrong with a shape that a person put together.
#pragma once

#include <optional>
#include <string>

#include "thicket/worlds/world.hpp"

namespace thicket {

/// Why a world file with this shape would not be read though each of its numbers is in range, as a sentence without its end; nothing if it would.
std::optional<std::string> shape_fault(const Shape& shape);

}  // namespace thicket
