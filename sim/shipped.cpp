#include "thicket/sim/shipped.hpp"

#include <algorithm>

#include "thicket/base/files.hpp"

namespace thicket {

std::filesystem::path shipped_worlds_root() { return shipped_root() / "worlds" / "data"; }

std::vector<std::filesystem::path> shipped_worlds() {
  std::vector<std::filesystem::path> files;
  std::error_code none;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(shipped_worlds_root(), none))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace thicket
