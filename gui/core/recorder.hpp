// Frames to a video, through ffmpeg.
#pragma once

#include <cstdio>
#include <filesystem>
#include <future>
#include <string>
#include <utility>

#include "../platform/picture.hpp"

namespace thicket::gui {

/// Whether a program of that name is on the PATH.
bool has_program(const char* name);

/// The first name STEM-001.ENDING, STEM-002.ENDING, ... in a folder that is not there yet.
std::filesystem::path free_name(const std::filesystem::path& folder, const std::string& stem, const std::string& ending);

class Recorder {
 public:
  static constexpr double rate = 30.0;  ///< pictures a second

  ~Recorder() { (void)end(); }
  Recorder() = default;
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  bool running() const { return pipe_ != nullptr; }
  const std::filesystem::path& file() const { return file_; }
  Result<Done> begin(const std::filesystem::path& file, int width, int height);
  /// What the window shows `time` seconds after the beginning; it is repeated for as long as there was no newer one. An error ends the recording.
  Result<Done> add(const Picture& picture, double time);
  /// Whether a picture is due at that time.
  bool due(double time) const { return running() && time * rate >= static_cast<double>(written_); }
  Result<Done> end();
  /// The same beside the window, since ffmpeg takes its time: what went wrong, empty if nothing did.
  std::future<std::string> end_beside();

 private:
  std::FILE* pipe_ = nullptr;
  std::filesystem::path file_;
  int width_ = 0, height_ = 0;
  std::uint64_t written_ = 0;
};

}  // namespace thicket::gui
