// The program, called as a person or a script calls it.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include <nlohmann/json.hpp>

#include "temporary_folder.hpp"
#include "thicket/base/files.hpp"

namespace thicket {

struct Answer {
  int code = -1;
  std::string out, err;
};

/// Calls the program in a folder.
inline Answer call(const TemporaryFolder& folder, const std::string& arguments) {
  const std::string out = (folder.path() / "stdout").string(), err = (folder.path() / "stderr").string();
  const std::string command = "cd '" + folder.path().string() + "' && '" THICKET_PROGRAM "' " + arguments + " >'" + out + "' 2>'" + err + "' </dev/null";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, *read_text_file(out), *read_text_file(err)};
}

inline bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// A file that a run has written.
inline nlohmann::json json_of(const std::filesystem::path& file) { return nlohmann::json::parse(*read_text_file(file)); }

}  // namespace thicket
