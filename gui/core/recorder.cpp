#include "recorder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <sstream>

namespace thicket::gui {

bool has_program(const char* name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((std::filesystem::path(folder) / name).c_str(), X_OK) == 0) return true;
  return false;
}

std::filesystem::path free_name(const std::filesystem::path& folder, const std::string& stem, const std::string& ending) {
  std::error_code none;
  for (int i = 1;; ++i)
    if (auto file = folder / fmt::format("{}-{:03}.{}", stem, i, ending); !std::filesystem::exists(file, none)) return file;
}

Result<Done> Recorder::begin(const std::filesystem::path& file, int width, int height) {
  if (!has_program("ffmpeg")) return Error{"a video needs ffmpeg, which is not there (on Debian: apt-get install ffmpeg)"};
  std::signal(SIGPIPE, SIG_IGN);  // an ffmpeg that fails is a message, not the end
  std::string quoted = "'";
  for (const char c : file.string()) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  quoted += "'";
  // (H.264 wants even numbers of pixels.)
  const std::string command = fmt::format("exec ffmpeg -loglevel error -y -f rawvideo -pixel_format rgb24 -video_size {}x{} -framerate {} -i - -vf 'crop=trunc(iw/2)*2:trunc(ih/2)*2' -pix_fmt yuv420p {}", width, height, rate, quoted);
  pipe_ = popen(command.c_str(), "w");
  if (!pipe_) return Error{"ffmpeg cannot be started"};
  file_ = file;
  width_ = width;
  height_ = height;
  written_ = 0;
  return Done{};
}

Result<Done> Recorder::add(const Picture& picture, double time) {
  if (picture.width != width_ || picture.height != height_) {
    (void)end();
    return Error{fmt::format("{}: the video ends here, because the window has another size now", file_.string())};
  }
  // Not more than a second for one picture: who leaves the window alone does not want to see it for long.
  const auto wanted = static_cast<std::uint64_t>(time * rate) + 1;
  const std::uint64_t first = std::max(written_, wanted > 30 ? wanted - 30 : 0);
  for (std::uint64_t i = first; i < wanted; ++i)
    if (std::fwrite(picture.rgb.data(), 1, picture.rgb.size(), pipe_) != picture.rgb.size()) {
      (void)end();
      return Error{fmt::format("{}: ffmpeg has stopped; its messages are in the terminal", file_.string())};
    }
  written_ = wanted;
  return Done{};
}

std::future<std::string> Recorder::end_beside() {
  return std::async(std::launch::async, [pipe = std::exchange(pipe_, nullptr), file = file_] {
    return pipe && pclose(pipe) != 0 ? fmt::format("{}: ffmpeg failed; its messages are in the terminal", file.string()) : std::string();
  });
}

Result<Done> Recorder::end() {
  const std::string wrong = end_beside().get();
  if (!wrong.empty()) return Error{wrong};
  return Done{};
}

}  // namespace thicket::gui
