#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>

#include "../core/editor_keys.hpp"
#include "../core/mission_form.hpp"
#include "../view.hpp"
#include "edit_tool.hpp"
#include "key_widget.hpp"
#include "thicket/base/files.hpp"

namespace thicket::gui {
namespace {

class EditView final : public View {
 public:
  const char* name() const override { return "Edit"; }
  void draw(const Frame& frame) override;

 private:
  void escape(const Frame& frame);
  void draw_tools(const Frame& frame);
  void draw_new_keys();
  void list_solids(const Frame& frame);
  void draw_row(const Frame& frame, std::uint32_t i);
  void draw_form(const Frame& frame);
  void change(const Frame& frame, std::uint32_t at, const Section& section, const Key& key, const std::string& typed);
  void draw_saving(const Frame& frame);

  std::shared_ptr<Editing> editing_ = std::make_shared<Editing>();
  void filter();

  std::array<char, 128> filter_{};
  std::vector<std::uint32_t> listed_;  ///< that pass the filter
  std::string listed_filter_;
  std::uint64_t listed_revision_ = 0;  ///< of the editor's world; 0: not listed yet
  Section section_;                    ///< of the selected solid, with its form
  SolidForm form_;
  std::uint64_t form_revision_ = 0;
  Typing typing_;
  std::string refused_key_, refused_;  ///< of the selected solid
  std::optional<std::uint32_t> shown_; ///< the solid whose form was drawn last
  std::filesystem::path file_;
  std::string save_as_, saved_;
  bool save_failed_ = false;
};

bool holds_tool(const Desk& desk) { return desk.tool && std::strcmp(desk.tool->name(), "edit") == 0; }

void EditView::escape(const Frame& frame) {
  if (frame.still || !holds_tool(frame.desk) || ImGui::GetIO().WantTextInput || !ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false)) return;
  // The tool drops first what is under way in it.
  if (editing_->escape_frame != ImGui::GetFrameCount() && editing_->drawing == Drawing::nothing) frame.desk.tool.reset();
}

void EditView::draw_tools(const Frame& frame) {
  struct Button {
    const char* label;
    Drawing drawing;
    const char* help;
  };
  constexpr Button buttons[] = {{"Select", Drawing::nothing, "select, move, turn and resize in the plan"},
                                {"+ Box", Drawing::box, "drag from corner to corner in the plan"},
                                {"+ Sphere", Drawing::sphere, "drag from the middle to the rim in the plan"},
                                {"+ Cylinder", Drawing::cylinder, "drag from the middle to the rim in the plan"},
                                {"+ Wall", Drawing::wall, "click its points in the plan, Enter ends it"},
                                {"+ Prism", Drawing::prism, "click the points of its outline in the plan, Enter closes it"}};
  const bool ours = holds_tool(frame.desk);
  bool first = true;
  for (const Button& button : buttons) {
    const ImVec2 size = ImGui::CalcTextSize(button.label);
    if (!first && ImGui::GetItemRectMax().x + size.x + 24.0f < ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x) ImGui::SameLine();
    first = false;
    const bool on = ours && editing_->drawing == button.drawing;
    if (on) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    const bool clicked = ImGui::Button(button.label);
    if (on) ImGui::PopStyleColor();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", button.help);
    if (!clicked) continue;
    if (on) {
      frame.desk.tool.reset();
      editing_->drawing = Drawing::nothing;
      continue;
    }
    editing_->drawing = button.drawing;
    frame.desk.tool = make_edit_tool(editing_);
  }
}

void EditView::draw_new_keys() {
  Editor& editor = editing_->editor;
  if (!ImGui::CollapsingHeader("New solids and the grid")) return;
  const auto names = material_names(editor.world());
  if (std::ranges::find(names, editor.new_material) == names.end() && !names.empty()) editor.new_material = names.front();
  ImGui::PushItemWidth(ImGui::GetContentRegionAvail().x * 0.55f);
  choice_field("material##new", editor.new_material, names);
  const auto length = [&](const char* label, double& value, double least) {
    std::string text = fmt::format("{}", value);
    if (!text_field(label, text, typing_)) return;
    const Key key{"value", KeyKind::number, "m", between(least, 1e4), 0, 0, {}, "", false, "", {}, {}};
    const auto read = judged(Section{label, "", {key}}, key, text);
    if (read) value = std::get<double>(*read);
    else editor.message = read.error().message;
  };
  length("height, m", editor.new_height, 0.01);
  length("wall thickness, m", editor.new_thickness, 0.001);
  length("grid, m", editor.grid, 0.001);
  ImGui::PopItemWidth();
}

void EditView::draw_row(const Frame& frame, std::uint32_t i) {
  const World& world = editing_->editor.world();
  const Solid& solid = world.solids[i];
  ImGui::PushID(static_cast<int>(i));
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  if (ImGui::Selectable(solid.name.empty() ? "(no name)" : solid.name.c_str(), frame.desk.solid == i, ImGuiSelectableFlags_SpanAllColumns)) frame.desk.solid = i;
  ImGui::TableNextColumn();
  ImGui::Text("%s%s", kind_of(solid), solid.motion ? ", moves" : "");
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(world.materials[solid.material].name.c_str());
  ImGui::PopID();
}

/// Anew only if something changed: there may be a million solids.
void EditView::filter() {
  const Editor& editor = editing_->editor;
  if (listed_revision_ == editor.revision() && listed_filter_ == filter_.data()) return;
  listed_revision_ = editor.revision();
  listed_filter_ = filter_.data();
  listed_.clear();
  const World& world = editor.world();
  Key words;
  for (std::uint32_t i = 0; i < world.solids.size(); ++i) {
    if (!listed_filter_.empty()) {
      words.name = kind_of(world.solids[i]);
      words.help = world.materials[world.solids[i].material].name;
      if (!matches(listed_filter_, world.solids[i].name, words)) continue;
    }
    listed_.push_back(i);
  }
}

void EditView::list_solids(const Frame& frame) {
  const World& world = editing_->editor.world();
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x * 0.6f);
  ImGui::InputTextWithHint("##filter", "filter by name, type or material", filter_.data(), filter_.size());
  filter();
  const std::vector<std::uint32_t>& shown = listed_;
  ImGui::SameLine();
  ImGui::TextDisabled("%d of %d", static_cast<int>(shown.size()), static_cast<int>(world.solids.size()));
  const float height = std::min(static_cast<float>(shown.size() + 2), 12.0f) * ImGui::GetTextLineHeightWithSpacing();
  if (!ImGui::BeginTable("solids", 3, ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersOuter | ImGuiTableFlags_Resizable, {0.0f, height})) return;
  ImGui::TableSetupScrollFreeze(0, 1);
  ImGui::TableSetupColumn("name");
  ImGui::TableSetupColumn("type");
  ImGui::TableSetupColumn("material");
  ImGui::TableHeadersRow();
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(shown.size()));
  while (clipper.Step())
    for (int row = clipper.DisplayStart; row < clipper.DisplayEnd; ++row) draw_row(frame, shown[static_cast<std::size_t>(row)]);
  // A solid that was picked in the plan comes into view.
  if (frame.desk.solid && frame.desk.solid != shown_) {
    const auto row = std::ranges::find(shown, *frame.desk.solid);
    if (row != shown.end()) ImGui::SetScrollFromPosY(ImGui::GetCursorStartPos().y + static_cast<float>(row - shown.begin()) * ImGui::GetTextLineHeightWithSpacing() - ImGui::GetScrollY());
  }
  ImGui::EndTable();
}

void EditView::change(const Frame& frame, std::uint32_t at, const Section& section, const Key& key, const std::string& typed) {
  Editor& editor = editing_->editor;
  refused_.clear();
  const auto form = with_key(editor.world(), editor.world().solids[at], section, key, typed);
  if (!form) {
    refused_key_ = key.name;
    refused_ = form.error().message;
    return;
  }
  if (key.name == "material") editor.set_material(at, form->material);
  else editor.replace(at, form->solid);
  post_edits(frame, *editing_);
}

void EditView::draw_form(const Frame& frame) {
  Editor& editor = editing_->editor;
  const bool other = shown_ != frame.desk.solid;
  if (other) refused_.clear();
  shown_ = frame.desk.solid;
  if (!shown_ || *shown_ >= editor.world().solids.size()) return ImGui::TextDisabled("No solid is selected.");
  const std::uint32_t at = *shown_;
  if (ImGui::Button("Copy")) frame.desk.solid = editor.copy(at, {0.5, -0.5});
  ImGui::SameLine();
  if (ImGui::Button("Delete")) {
    editor.erase(at);
    frame.desk.solid.reset();
  }
  post_edits(frame, *editing_);
  if (frame.desk.solid != at) return;
  // A copy, for what is typed changes the world under it; and made once, for a map may be large.
  if (other || form_revision_ != editor.revision()) {
    section_ = solid_section(editor.world().solids[at]);
    form_ = form_of(editor.world(), editor.world().solids[at]);
    form_revision_ = editor.revision();
  }
  if (!ImGui::BeginTable("solid", 2, ImGuiTableFlags_SizingStretchProp)) return;
  ImGui::TableSetupColumn("key", ImGuiTableColumnFlags_WidthStretch, 0.35f);
  ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch, 0.65f);
  for (const Key& key : section_.keys) {
    const Value now = key.get(&form_);
    ImGui::PushID(key.name.c_str());
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(key.name.c_str());
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", key.help.c_str());
    ImGui::TableNextColumn();
    Key shown = key;
    if (key.name == "material") shown.choices = material_names(editor.world());
    if (const auto typed = key_widget(shown, now, typing_)) change(frame, at, section_, key, *typed);
    if (!refused_.empty() && refused_key_ == key.name) {
      ImGui::PushStyleColor(ImGuiCol_Text, frame.colours.warning);
      ImGui::TextWrapped("%s", refused_.c_str());
      ImGui::PopStyleColor();
    }
    ImGui::PopID();
  }
  ImGui::EndTable();
  if (form_.solid.motion) ImGui::TextDisabled("It moves; its way is moved in the plan.");
}

void EditView::draw_saving(const Frame& frame) {
  const Editor& editor = editing_->editor;
  if (file_ != frame.now.file) {
    file_ = frame.now.file;
    save_as_ = file_.stem().string() + "_world.toml";
    saved_.clear();
  }
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - 4.0f * ImGui::GetFontSize());
  text_field("world##file", save_as_, typing_);
  std::error_code ignored;
  if (ImGui::Button(std::filesystem::exists(save_as_, ignored) ? "Save world (overwrite)###save" : "Save world###save")) {
    const auto done = save_world(editor.world(), save_as_, frame.now.simulation->mission().image_file);
    save_failed_ = !done;
    saved_ = done ? "saved " + save_as_ : done.error().message;
  }
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("The world as a file. The Mission view saves it together with the mission that runs in it.");
  if (saved_.empty()) return;
  ImGui::PushStyleColor(ImGuiCol_Text, save_failed_ ? frame.colours.warning : frame.colours.text);
  ImGui::TextWrapped("%s", saved_.c_str());
  ImGui::PopStyleColor();
}

void EditView::draw(const Frame& frame) {
  if (!frame.now.simulation) return ImGui::TextUnformatted("Nothing is open.");
  Editor& editor = editing_->editor;
  editor.follow(frame.now);
  escape(frame);
  use_edit_keys(frame, *editing_);
  draw_tools(frame);
  ImGui::BeginDisabled(editor.undoable() == 0);
  if (ImGui::Button("Undo")) editor.undo();
  ImGui::EndDisabled();
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("Ctrl+Z: %d", static_cast<int>(editor.undoable()));
  ImGui::SameLine();
  ImGui::BeginDisabled(editor.redoable() == 0);
  if (ImGui::Button("Redo")) editor.redo();
  ImGui::EndDisabled();
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("Ctrl+Y: %d", static_cast<int>(editor.redoable()));
  post_edits(frame, *editing_);
  draw_new_keys();
  if (!editor.message.empty()) {
    ImGui::PushStyleColor(ImGuiCol_Text, frame.colours.warning);
    ImGui::TextWrapped("%s", editor.message.c_str());
    ImGui::PopStyleColor();
  }
  draw_saving(frame);
  ImGui::Separator();
  list_solids(frame);
  draw_form(frame);
}

}  // namespace

std::unique_ptr<View> make_edit_view() { return std::make_unique<EditView>(); }

}  // namespace thicket::gui
