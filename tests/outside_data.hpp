// Files that nobody here wrote: read by some tests where they are present, never needed.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>

namespace thicket {

/// Where `relative` lies in the folder of outside data: the environment variable `THICKET_OUTSIDE_DATA`, else `../shared/data` beside the
/// source tree. Nothing if it is not there; the test then says MESSAGE("skipped: no outside data") and returns.
inline std::optional<std::filesystem::path> outside_data(const char* relative) {
  std::filesystem::path folder;
  if (const char* chosen = std::getenv("THICKET_OUTSIDE_DATA"); chosen != nullptr && *chosen != '\0') {
    folder = chosen;
  } else {
#ifdef THICKET_SOURCE_ROOT
    folder = std::filesystem::path(THICKET_SOURCE_ROOT) / ".." / "shared" / "data";
#endif
  }
  if (folder.empty()) return std::nullopt;
  std::error_code none;
  const std::filesystem::path file = folder / relative;
  if (!std::filesystem::exists(file, none)) return std::nullopt;
  return file;
}

}  // namespace thicket
