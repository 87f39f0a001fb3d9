// Changes to a file's tree before it is read, so that the same reader judges them. Private to the room.
#pragma once

#include <string>

#include "thicket/base/document.hpp"
#include "thicket/sim/mission.hpp"

namespace thicket {

/// A text that comes from somewhere else than a file: `origin` stands in messages.
Node text_node(std::string text, const std::string& origin);

/// The value of a change: TOML, or a text if it is not valid TOML.
Node override_value(const Override& change);

/// The member of a table, which becomes one if it is none; a new, empty member if there is none of that name.
Node& member(Node& table, const std::string& key);

}  // namespace thicket
