#include "thicket/base/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <optional>
#include <system_error>
#include <utility>

namespace thicket {
namespace {

namespace fs = std::filesystem;

/// More than the largest map there is; what is larger is not a file for this program, and would only fill the memory.
constexpr std::size_t max_file_bytes = std::size_t{1} << 32;

Error file_error(const fs::path& file, std::string_view what, int number) {
  return Error{fmt::format("{}: {}: {}", file.string(), what, std::generic_category().message(number))};
}

/// An open file, closed at the end of its scope.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  int operator*() const { return number_; }

  /// Closes now and returns errno, 0 for success: some file systems report a full disc only here.
  int close() { return ::close(std::exchange(number_, -1)) == 0 ? 0 : errno; }

 private:
  int number_;
};

/// Writes everything and returns errno, 0 for success.
int write_all(int descriptor, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(descriptor, content.data(), content.size());
    if (written < 0 && errno != EINTR) return errno;
    if (written > 0) content.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

/// A pipe or a device (`/dev/stdout`) is written to, where renaming would put a file in its place.
Result<Done> write_in_place(const fs::path& file, std::string_view content) {
  Descriptor out(::open(file.c_str(), O_WRONLY | O_CLOEXEC));
  if (*out < 0) return file_error(file, "cannot be opened for writing", errno);
  if (const int fault = write_all(*out, content)) return file_error(file, "cannot be written", fault);
  return Done{};
}

Result<Done> write_and_rename(const fs::path& file, std::string_view content, std::optional<fs::perms> permissions) {
  // Not derived from the file's own name, which may already be as long as names may be. The process id and the counter keep writers
  // apart, O_EXCL what a killed process of the same id left behind.
  static std::atomic<unsigned> counter{0};
  fs::path temporary;
  int opened = -1;
  do {
    temporary = file.parent_path() / fmt::format(".thicket-{}-{}.tmp", ::getpid(), counter++);
    opened = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (opened < 0 && errno == EEXIST);
  if (opened < 0) return file_error(file, "cannot be written in its folder", errno);

  Descriptor out(opened);
  int fault = write_all(*out, content);
  if (permissions && fault == 0 && ::fchmod(*out, static_cast<mode_t>(*permissions)) != 0) fault = errno;
  if (const int closing = out.close(); fault == 0) fault = closing;
  if (fault == 0 && ::rename(temporary.c_str(), file.c_str()) != 0) fault = errno;
  if (fault == 0) return Done{};
  ::unlink(temporary.c_str());
  return file_error(file, "cannot be written", fault);
}

bool is_folder(const fs::path& path) {
  std::error_code none;
  return fs::is_directory(path, none);
}

/// Anything that can be read: a folder of the same name does not hide a file further on in the search.
bool is_input(const fs::path& path) {
  std::error_code none;
  return fs::exists(path, none) && !fs::is_directory(path, none);
}

fs::path absolute_path(const fs::path& path) {
  std::error_code failed;
  fs::path resolved = fs::weakly_canonical(path, failed);
  if (!failed && resolved.is_absolute()) return resolved;
  const fs::path absolute = fs::absolute(path, failed);
  return (failed ? path : absolute).lexically_normal();
}

}  // namespace

Result<std::string> read_text_file(const fs::path& file) {
  std::error_code failed;
  const fs::file_status status = fs::status(file, failed);
  if (!fs::exists(status)) {
    if (failed && status.type() != fs::file_type::not_found) return file_error(file, "cannot be read", failed.value());
    return Error{file.string() + ": does not exist"};
  }
  if (fs::is_directory(status)) return Error{file.string() + ": is a folder, expected a file"};
  if (!fs::is_regular_file(status) && !fs::is_fifo(status)) return Error{file.string() + ": is a device, expected a file"};

  Descriptor in(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (*in < 0) return file_error(file, "cannot be opened", errno);

  std::string content;
  const auto too_large = [&] { return Error{fmt::format("{}: is larger than {} bytes", file.string(), max_file_bytes)}; };
  // The size saves copies, but does not end the reading: a pipe has none, and a file may grow meanwhile.
  const std::uintmax_t size = fs::is_regular_file(status) ? fs::file_size(file, failed) : 0;
  if (!failed && size > max_file_bytes) return too_large();
  if (!failed) content.reserve(static_cast<std::size_t>(size));
  std::vector<char> block(std::size_t{1} << 16);
  while (true) {
    const ssize_t got = ::read(*in, block.data(), block.size());
    if (got == 0) return content;
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return file_error(file, "cannot be read", errno);
    content.append(block.data(), static_cast<std::size_t>(got));
    if (content.size() > max_file_bytes) return too_large();
  }
}

Result<Done> write_file(const fs::path& file, std::string_view content) {
  std::error_code failed;
  const fs::file_status status = fs::status(file, failed);
  if (file.empty() || !file.has_filename()) return Error{fmt::format("'{}': has no file name to write to", file.string())};
  if (fs::is_directory(status)) return Error{file.string() + ": is a folder, expected a file to write"};
  if (fs::exists(status) && !fs::is_regular_file(status)) return write_in_place(file, content);

  if (file.has_parent_path()) {
    fs::create_directories(file.parent_path(), failed);
    if (failed) return file_error(file, "its folder cannot be made", failed.value());
  }
  if (!fs::exists(status)) return write_and_rename(file, content, std::nullopt);
  // A symbolic link stays one: what it points to is replaced.
  const fs::path target = fs::canonical(file, failed);
  return write_and_rename(failed ? file : target, content, status.permissions());
}

fs::path shipped_root() {
  std::error_code failed;
  if (const char* chosen = std::getenv("THICKET_DATA"); chosen != nullptr && *chosen != '\0' && is_folder(chosen)) {
    return absolute_path(chosen);
  }
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  if (!failed) {
    fs::path installed = program.parent_path().parent_path() / "share" / "thicket";
    if (is_folder(installed)) return installed;
  }
#ifdef THICKET_SOURCE_ROOT
  if (is_folder(THICKET_SOURCE_ROOT)) return THICKET_SOURCE_ROOT;
#endif
  return {};
}

fs::path find_shipped(const fs::path& name) {
  const fs::path root = shipped_root();
  if (name.empty() || name.is_absolute() || root.empty()) return {};
  for (const char* suffix : {"", ".toml"}) {
    for (fs::path place : {root / name, root / "worlds" / "data" / name}) {
      place += suffix;
      if (is_input(place)) return place;
    }
  }
  return {};
}

fs::path find_input(const fs::path& name) {
  if (name.empty() || is_input(name)) return name;
  if (name.is_absolute()) return {};
  fs::path with_suffix = name;
  with_suffix += ".toml";
  return is_input(with_suffix) ? with_suffix : find_shipped(name);
}

std::vector<std::string> shipped_names(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(shipped_root() / folder, none))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string portable_name(const fs::path& file) {
  const fs::path absolute = absolute_path(file);
  const fs::path root = shipped_root();
  if (root.empty()) return absolute.generic_string();
  const fs::path relative = absolute.lexically_relative(absolute_path(root));
  const bool below = !relative.empty() && relative != "." && *relative.begin() != "..";
  return (below ? relative : absolute).generic_string();
}

}  // namespace thicket
