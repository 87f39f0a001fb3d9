// Files: written whole or not at all, and found wherever the program is called from.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "thicket/base/result.hpp"

namespace thicket {

/// The whole content of a file; an error names it.
Result<std::string> read_text_file(const std::filesystem::path& file);

/// Writes to a temporary name in the same folder and renames, so that a killed run leaves the old file or the whole new one.
/// Missing folders are made.
Result<Done> write_file(const std::filesystem::path& file, std::string_view content);

/// The folder that holds what is shipped (`worlds/data`, `worlds/presets`, `radar/presets`, `sim/presets`): the first that exists of the environment variable
/// `THICKET_DATA`, `../share/thicket` beside the running program, and the source tree that it was built from.
std::filesystem::path shipped_root();

/// `name` as it is if it exists; else, if it is relative, below `shipped_root()`, below its `worlds/data`, and then the same three with
/// `.toml` added. A folder is not an input. Empty if there is no such file.
std::filesystem::path find_input(const std::filesystem::path& name);
/// The same without looking at `name` as it is: only what is shipped.
std::filesystem::path find_shipped(const std::filesystem::path& name);

/// The names of the TOML files in a shipped folder ("radar/presets"), without their ending, sorted.
std::vector<std::string> shipped_names(const std::filesystem::path& folder);

/// How a file is named in a written mission: relative to `shipped_root()` if it lies there, else absolute.
std::string portable_name(const std::filesystem::path& file);

}  // namespace thicket
