// Materials as tables of a file. Private to the room.
#pragma once

#include <string>
#include <vector>

#include "thicket/base/document.hpp"
#include "thicket/worlds/material.hpp"

namespace thicket {

/// Reads a table [material.NAME]. A `preset` in it names one of `presets`, whose numbers then stand wherever the table has none.
Material read_material(const std::string& name, const Node& table, const std::vector<Material>& presets, Faults& faults);

/// The keys of a table that `read_material` reads as the same material, a line each.
std::string write_material(const Material& material);

/// The material of that name, or nothing.
const Material* find_material(const std::vector<Material>& materials, const std::string& name);
std::vector<std::string> names_of(const std::vector<Material>& materials);

/// The keys of a table [material.NAME], for `thicket help world` and its page.
std::string describe_material_table(bool markdown = false);

}  // namespace thicket
