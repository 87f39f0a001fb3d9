// What is shipped to be run and looked at.
#pragma once

#include <filesystem>
#include <vector>

namespace thicket {

/// The folder of the worlds and missions that are shipped.
std::filesystem::path shipped_worlds_root();

/// All world and mission files (TOML) in it, sorted; empty where the folder is not found.
std::vector<std::filesystem::path> shipped_worlds();

}  // namespace thicket
