// World files and maps with a fault each, named after it, and what is said of them.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>

#include "thicket/base/files.hpp"
#include "thicket/worlds/world.hpp"

using namespace thicket;
namespace fs = std::filesystem;

namespace {

/// Reads all files with one of these endings as worlds: each must fail, and its error hold every line of its sibling `.expected`. Returns how many there are.
std::size_t check_folder(const char* name, const std::set<std::string>& endings) {
  const fs::path folder = fs::path(THICKET_SOURCE_ROOT) / "tests" / "worlds" / "broken" / name;
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (!endings.contains(entry.path().extension().string())) continue;
    ++count;
    const std::string file = entry.path().filename().string();
    CAPTURE(file);
    const auto expected = read_text_file(fs::path(entry.path()).replace_extension(".expected"));
    CHECK_MESSAGE(static_cast<bool>(expected), "a fixture lacks its .expected");
    const auto world = read_world(entry.path());
    CHECK_MESSAGE(!world, "a broken file is accepted");
    if (!expected || world) continue;
    const std::string error = world.error().message;
    CAPTURE(error);
    std::istringstream lines(*expected);
    std::size_t told = 0;
    for (std::string line; std::getline(lines, line);) {
      if (line.empty()) continue;
      ++told;
      CAPTURE(line);
      CHECK(error.find(line) != std::string::npos);
    }
    CHECK(told >= 1);
    CHECK(static_cast<std::size_t>(std::count(error.begin(), error.end(), '\n')) + 1 == told);  // nothing is told twice, or beside it
  }
  return count;
}

}  // namespace

TEST_CASE("every broken world file is told of at its place") { CHECK(check_folder("world", {".toml"}) >= 80); }

TEST_CASE("every broken map is told of at its place") { CHECK(check_folder("map", {".yaml", ".map"}) >= 30); }

TEST_CASE("every expectation has its broken file") {
  std::size_t count = 0;
  for (const char* name : {"world", "map"})
    for (const auto& entry : fs::directory_iterator(fs::path(THICKET_SOURCE_ROOT) / "tests" / "worlds" / "broken" / name)) {
      if (entry.path().extension() != ".expected") continue;
      ++count;
      bool there = false;
      for (const char* ending : {".toml", ".yaml", ".map"}) there = there || fs::exists(fs::path(entry.path()).replace_extension(ending));
      CHECK_MESSAGE(there, entry.path().string());
    }
  CHECK(count >= 40);
}
