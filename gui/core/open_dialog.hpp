// The dialogs about files: which to open, and where to write.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace thicket::gui {

/// Whether a file may be something to open, by its ending.
bool can_open(const std::filesystem::path& file);

class OpenDialog {
 public:
  void show() { wanted_ = true; }
  /// The file that was chosen in this frame.
  std::optional<std::filesystem::path> draw(double scale);

 private:
  struct Row {
    std::filesystem::path file;
    std::string name, what;
    bool folder = false;
  };
  void list_shipped();
  void list_folder();
  std::optional<std::filesystem::path> draw_rows(const std::vector<Row>& rows, double scale);

  bool wanted_ = false;
  std::vector<Row> shipped_, here_;
  std::filesystem::path folder_;
  char filter_[128] = "";
  char path_[1024] = "";
};

/// Asks for the name of a file to write.
class AskDialog {
 public:
  void show(std::string title, const std::filesystem::path& name, std::function<void(const std::filesystem::path&)> done);
  void draw(double scale);

 private:
  bool wanted_ = false;
  std::string title_;
  char name_[1024] = "";
  std::function<void(const std::filesystem::path&)> done_;
};

}  // namespace thicket::gui
