#include "thicket/base/files.hpp"

#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <thread>

#include "../temporary_folder.hpp"

using namespace thicket;
namespace fs = std::filesystem;

namespace {

/// Sets an environment variable, or removes it with nullptr, and puts it back.
class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    value != nullptr ? ::setenv(name, value, 1) : ::unsetenv(name);
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;
  ~Environment() { old_ ? ::setenv(name_, old_->c_str(), 1) : ::unsetenv(name_); }

 private:
  const char* name_;
  std::optional<std::string> old_;
};

/// The folder that relative names are looked up in, put back at the end.
class WorkingFolder {
 public:
  explicit WorkingFolder(const fs::path& folder) : old_(fs::current_path()) { fs::current_path(folder); }
  WorkingFolder(const WorkingFolder&) = delete;
  WorkingFolder& operator=(const WorkingFolder&) = delete;
  ~WorkingFolder() { fs::current_path(old_); }

 private:
  fs::path old_;
};

std::string content_of(const fs::path& file) {
  const auto content = read_text_file(file);
  return content ? *content : "error: " + content.error().message;
}

std::string message_of(const Result<Done>& result) {
  return result ? "" : result.error().message;
}

std::size_t entries_in(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

}  // namespace

TEST_CASE("a file is read as it is") {
  const TemporaryFolder folder;
  CHECK(content_of(folder.write("empty", "")) == "");
  const std::string bytes("a\0b\r\n\xff", 6);
  CHECK(content_of(folder.write("bytes", bytes)) == bytes);
  const std::string large(200'000, 'x');  // several blocks
  CHECK(content_of(folder.write("large", large)) == large);
}

TEST_CASE("what cannot be read is named") {
  const TemporaryFolder folder;
  const std::string path = folder.path().string();
  CHECK(content_of(folder.path() / "none.toml") == "error: " + path + "/none.toml: does not exist");
  CHECK(content_of(folder.path()) == "error: " + path + ": is a folder, expected a file");
  CHECK(content_of("/dev/zero") == "error: /dev/zero: is a device, expected a file");
  folder.write("file", "");
  CHECK(content_of(folder.path() / "file" / "below").starts_with("error: " + path + "/file/below: "));
  CHECK(content_of("") == "error: : does not exist");
  fs::create_symlink("loop", folder.path() / "loop");
  CHECK(content_of(folder.path() / "loop").starts_with("error: " + path + "/loop: cannot be read: "));
}

TEST_CASE("a pipe is read to its end") {
  const TemporaryFolder folder;
  const fs::path pipe = folder.path() / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  const std::string sent(100'000, 'p');
  std::thread writer([&] { CHECK(write_file(pipe, sent)); });
  CHECK(content_of(pipe) == sent);
  writer.join();
  CHECK(fs::is_fifo(pipe));  // written to, not replaced
}

TEST_CASE("a sparse giant is refused, not loaded") {
  const TemporaryFolder folder;
  const fs::path giant = folder.write("giant", "");
  std::error_code failed;
  fs::resize_file(giant, std::uintmax_t{1} << 40, failed);
  if (failed) return;  // this file system has no sparse files
  CHECK(content_of(giant) == "error: " + giant.string() + ": is larger than 4294967296 bytes");
}

TEST_CASE("a written file is whole, alone in its folder, and its folders are made") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "a" / "b" / "result.json";
  const std::string bytes("one\0two", 7);
  REQUIRE(write_file(file, bytes));
  CHECK(content_of(file) == bytes);
  REQUIRE(write_file(file, "second"));
  CHECK(content_of(file) == "second");
  CHECK(entries_in(file.parent_path()) == 1);
}

TEST_CASE("a name without a folder is written to the working folder") {
  const TemporaryFolder folder;
  const WorkingFolder here(folder.path());
  REQUIRE(write_file("plain.txt", "x"));
  CHECK(content_of(folder.path() / "plain.txt") == "x");
}

TEST_CASE("the longest name that a file system takes can be written") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / std::string(255, 'n');
  CHECK(message_of(write_file(file, "x")) == "");
  CHECK(content_of(file) == "x");
}

TEST_CASE("a link stays a link, and permissions stay") {
  const TemporaryFolder folder;
  const fs::path target = folder.write("target", "old");
  fs::permissions(target, fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("target", folder.path() / "link");
  REQUIRE(write_file(folder.path() / "link", "new"));
  CHECK(fs::is_symlink(folder.path() / "link"));
  CHECK(content_of(target) == "new");
  CHECK(fs::status(target).permissions() == (fs::perms::owner_read | fs::perms::owner_write));
}

TEST_CASE("a device is written to, not replaced") {
  CHECK(write_file("/dev/null", "x"));
  CHECK(fs::is_character_file("/dev/null"));
}

TEST_CASE("what cannot be written is named, and nothing is left behind") {
  const TemporaryFolder folder;
  const std::string path = folder.path().string();
  CHECK(message_of(write_file(folder.path(), "x")) == path + ": is a folder, expected a file to write");
  CHECK(message_of(write_file("", "x")) == "'': has no file name to write to");
  CHECK(message_of(write_file(folder.path() / "none" / "", "x")) == "'" + path + "/none/': has no file name to write to");
  folder.write("file", "kept");
  CHECK(message_of(write_file(folder.path() / "file" / "below", "x")).starts_with(path + "/file/below: its folder cannot be made: "));
  CHECK(message_of(write_file(folder.path() / std::string(256, 'n'), "x")).find(": cannot be written: ") != std::string::npos);
  CHECK(entries_in(folder.path()) == 1);
  CHECK(content_of(folder.path() / "file") == "kept");
}

TEST_CASE("a full disc is an error") {
  if (!fs::is_character_file("/dev/full")) return;
  CHECK(message_of(write_file("/dev/full", "x")) == "/dev/full: cannot be written: No space left on device");
}

TEST_CASE("many writers of one file leave one whole content") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "shared";
  std::vector<std::thread> writers;
  for (char letter = 'a'; letter < 'i'; ++letter) {
    writers.emplace_back([&file, letter] {
      for (int i = 0; i < 20; ++i) CHECK(write_file(file, std::string(50'000, letter)));
    });
  }
  for (std::thread& writer : writers) writer.join();
  const std::string content = content_of(file);
  CHECK(content.size() == 50'000);
  CHECK(content.find_first_not_of(content.front()) == std::string::npos);
  CHECK(entries_in(folder.path()) == 1);
}

TEST_CASE("what is shipped is found by the environment first, and by nothing that does not exist") {
  const TemporaryFolder folder;
  {
    const Environment chosen("THICKET_DATA", folder.path().c_str());
    CHECK(shipped_root() == folder.path());
  }
  const fs::path none = folder.path() / "none";
  const Environment wrong("THICKET_DATA", none.c_str());
  CHECK(shipped_root() != none);
#ifdef THICKET_SOURCE_ROOT
  CHECK(shipped_root() == fs::path(THICKET_SOURCE_ROOT));
#endif
}

TEST_CASE("an input is found as it is named, then among what is shipped, then with .toml") {
  const TemporaryFolder shipped, elsewhere;
  const Environment chosen("THICKET_DATA", shipped.path().c_str());
  const WorkingFolder here(elsewhere.path());
  const fs::path mission = shipped.write("worlds/data/wall/bug2.toml", "");
  const fs::path preset = shipped.write("sim/presets/p3at.toml", "");
  CHECK(find_input("wall/bug2.toml") == mission);
  CHECK(find_input("wall/bug2") == mission);
  CHECK(find_input("worlds/data/wall/bug2.toml") == mission);
  CHECK(find_input("sim/presets/p3at") == preset);
  CHECK(find_input(mission) == mission);
  CHECK(find_input("wall/bug3") == fs::path());
  CHECK(find_input("") == fs::path());
  CHECK(find_input(shipped.path() / "worlds" / "data" / "wall" / "bug2") == fs::path());  // absolute: as it is or not at all

  // A folder is no input, and hides none.
  CHECK(find_input("wall") == fs::path());
  fs::create_directories("wall");
  const fs::path wall = shipped.write("worlds/data/wall.toml", "");
  CHECK(find_input("wall") == wall);

  // What lies in the working folder comes first.
  elsewhere.write("wall.toml", "");
  CHECK(find_input("wall") == "wall.toml");
  elsewhere.write("wall/bug2.toml", "");
  CHECK(find_input("wall/bug2.toml") == "wall/bug2.toml");
}

TEST_CASE("a portable name is relative to what is shipped, else absolute") {
  const TemporaryFolder shipped, elsewhere;
  const Environment chosen("THICKET_DATA", shipped.path().c_str());
  const fs::path mission = shipped.write("worlds/data/wall/bug2.toml", "");
  CHECK(portable_name(mission) == "worlds/data/wall/bug2.toml");
  CHECK(portable_name(shipped.path() / "worlds" / "." / "data" / ".." / "new.toml") == "worlds/new.toml");  // need not exist
  CHECK(portable_name(elsewhere.write("mine.toml", "")) == (elsewhere.path() / "mine.toml").string());
  CHECK(portable_name(shipped.path()) == shipped.path().string());
  // A name that only begins like the folder does not lie in it.
  CHECK(portable_name(shipped.path().string() + "-more/x.toml") == shipped.path().string() + "-more/x.toml");

  fs::create_directory_symlink(shipped.path() / "worlds" / "data", elsewhere.path() / "link");
  CHECK(portable_name(elsewhere.path() / "link" / "wall" / "bug2.toml") == "worlds/data/wall/bug2.toml");

  const WorkingFolder here(shipped.path() / "worlds");
  CHECK(portable_name("data/wall/bug2.toml") == "worlds/data/wall/bug2.toml");
  CHECK(find_input(portable_name(mission)) == mission);
}
