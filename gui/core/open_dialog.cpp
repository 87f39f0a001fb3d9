#include "open_dialog.hpp"

#include <imgui.h>

#include <algorithm>
#include <cctype>
#include <cstring>

#include "thicket/base/document.hpp"
#include "thicket/base/files.hpp"
#include "thicket/sim/shipped.hpp"

namespace thicket::gui {
namespace {

namespace fs = std::filesystem;

std::string small(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

template <std::size_t size>
void put(char (&field)[size], const std::string& text) {
  std::strncpy(field, text.c_str(), size - 1);
  field[size - 1] = '\0';
}

std::string text_of(const Node& document, const char* key) {
  const Node* node = document.find(key);
  const auto* text = node ? std::get_if<std::string>(&node->content) : nullptr;
  return text ? *text : "";
}

}  // namespace

bool can_open(const fs::path& file) {
  const std::string ending = small(file.extension().string());
  return ending == ".toml" || ending == ".yaml" || ending == ".yml" || ending == ".map" || ending == ".obj";
}

void OpenDialog::list_shipped() {
  std::vector<Row> worlds;
  for (const fs::path& file : shipped_worlds()) {
    const auto document = read_document(file);
    if (!document) continue;
    const bool mission = document->find("world") != nullptr;
    const std::string name = fs::relative(file, shipped_worlds_root()).replace_extension().generic_string();
    (mission ? shipped_ : worlds).push_back({file, name, (mission ? "mission: " : "world: ") + text_of(*document, mission ? "description" : "name")});
  }
  shipped_.insert(shipped_.end(), worlds.begin(), worlds.end());
}

void OpenDialog::list_folder() {
  here_.clear();
  std::error_code none;
  folder_ = fs::absolute(folder_.empty() ? fs::current_path(none) : folder_, none).lexically_normal();
  for (const auto& entry : fs::directory_iterator(folder_, fs::directory_options::skip_permission_denied, none)) {
    const std::string name = entry.path().filename().string();
    const bool folder = entry.is_directory(none);
    if (name.empty() || name[0] == '.' || (!folder && !can_open(entry.path()))) continue;
    here_.push_back({entry.path(), folder ? name + "/" : name, "", folder});
  }
  std::sort(here_.begin(), here_.end(), [](const Row& a, const Row& b) { return a.folder != b.folder ? a.folder : a.name < b.name; });
  here_.insert(here_.begin(), {folder_.parent_path(), "../", "the folder above", true});
  put(path_, folder_.string());
}

std::optional<fs::path> OpenDialog::draw_rows(const std::vector<Row>& rows, double scale) {
  std::optional<fs::path> chosen;
  const std::string wanted = small(filter_);
  ImGui::BeginChild("rows", ImVec2(0.0f, static_cast<float>(320.0 * scale)), true);
  for (const Row& row : rows) {
    if (!wanted.empty() && small(row.name + " " + row.what).find(wanted) == std::string::npos) continue;
    if (ImGui::Selectable(row.name.c_str(), false, ImGuiSelectableFlags_DontClosePopups)) chosen = row.file;
    if (row.what.empty()) continue;
    ImGui::SameLine(static_cast<float>(220.0 * scale));
    ImGui::TextDisabled("%s", row.what.c_str());
  }
  ImGui::EndChild();
  return chosen;
}

std::optional<fs::path> OpenDialog::draw(double scale) {
  if (wanted_) {
    wanted_ = false;
    if (shipped_.empty()) list_shipped();
    list_folder();
    ImGui::OpenPopup("Open");
  }
  ImGui::SetNextWindowSize({static_cast<float>(720.0 * scale), 0.0f});
  if (!ImGui::BeginPopupModal("Open", nullptr, ImGuiWindowFlags_NoResize)) return std::nullopt;
  std::optional<fs::path> result;
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  ImGui::InputTextWithHint("##filter", "part of a name", filter_, sizeof filter_);
  if (ImGui::BeginTabBar("where")) {
    if (ImGui::BeginTabItem("Shipped")) {
      result = draw_rows(shipped_, scale);
      ImGui::EndTabItem();
    }
    if (ImGui::BeginTabItem("Files")) {
      ImGui::SetNextItemWidth(-1.0f);
      const bool entered = ImGui::InputText("##path", path_, sizeof path_, ImGuiInputTextFlags_EnterReturnsTrue);
      auto chosen = draw_rows(here_, scale);
      if (entered) chosen = fs::path(path_);
      std::error_code none;
      if (chosen && fs::is_directory(*chosen, none)) {
        folder_ = *chosen;
        filter_[0] = '\0';
        list_folder();
      } else if (chosen) result = chosen;
      ImGui::EndTabItem();
    }
    ImGui::EndTabBar();
  }
  ImGui::TextDisabled("Missions and worlds (.toml), maps (.yaml, .map) and meshes (.obj). Files may also be dropped on the window.");
  if (ImGui::Button("Cancel") || result || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
  return result;
}

void AskDialog::show(std::string title, const fs::path& name, std::function<void(const fs::path&)> done) {
  wanted_ = true;
  title_ = std::move(title);
  put(name_, name.string());
  done_ = std::move(done);
}

void AskDialog::draw(double scale) {
  if (title_.empty()) return;
  if (wanted_) ImGui::OpenPopup(title_.c_str());
  wanted_ = false;
  if (!ImGui::BeginPopupModal(title_.c_str(), nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return;
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(static_cast<float>(520.0 * scale));
  const bool entered = ImGui::InputText("##name", name_, sizeof name_, ImGuiInputTextFlags_EnterReturnsTrue);
  std::error_code none;
  if (fs::exists(name_, none)) ImGui::TextUnformatted("There is such a file: it will be replaced.");
  const bool write = ImGui::Button("Write") || entered;
  ImGui::SameLine();
  const bool leave = ImGui::Button("Cancel") || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
  if (write && name_[0]) done_(fs::path(name_));
  if ((write && name_[0]) || leave) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
}

}  // namespace thicket::gui
