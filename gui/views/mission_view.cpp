#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>

#include "../core/editor.hpp"
#include "../core/mission_form.hpp"
#include "../view.hpp"
#include "key_widget.hpp"
#include "thicket/base/files.hpp"

namespace thicket::gui {
namespace {

/// Whether a key says which world it is: then the run goes on in that.
bool concerns_world(const Key& key, std::size_t part) { return part == 0 && key.name.starts_with("world"); }

/// Where a refused change of the list of sensors is told.
constexpr const char* new_sensor = "new sensor";

class MissionView final : public View {
 public:
  const char* name() const override { return "Mission"; }
  void draw(const Frame& frame) override;

 private:
  void follow(const Snapshot& now);
  void draw_part(const Frame& frame, std::size_t part, bool searching);
  void draw_key(const Frame& frame, KeyPlace at, const Key& key);
  void change(const Frame& frame, KeyPlace at, const std::optional<std::string>& typed);
  void draw_new_sensor(const Frame& frame);
  void change_sensors(const Frame& frame, const Result<Mission>& next);
  void show_refusal(const Frame& frame) const;
  void draw_saving(const Frame& frame);
  void save(const Frame& frame);

  Mission mission_, opened_, defaults_;   ///< as it runs, as it was when the file was opened, and without anything given
  std::vector<MissionPart> parts_, opened_parts_, default_parts_;
  std::filesystem::path file_;
  std::uint64_t revision_ = ~std::uint64_t{0};
  const Stage* stage_ = nullptr;
  std::array<char, 128> search_{};
  bool only_changed_ = false;
  Typing typing_;
  std::uint64_t posted_at_ = ~std::uint64_t{0};  ///< the number of the run's message when a change was posted; a later error is about it
  std::string refused_key_, refused_;     ///< the key whose typed value was refused, and why
  std::string save_as_, save_world_as_, saved_;
  bool save_failed_ = false;
};

/// Takes over what runs: nothing of it is kept but for comparing.
void MissionView::follow(const Snapshot& now) {
  const Stage* stage = &now.simulation->stage();
  if (stage == stage_ && revision_ == now.run_revision && file_ == now.file) return;
  mission_ = now.simulation->mission();
  defaults_ = defaults_of(mission_);
  if (stage_ == nullptr || file_ != now.file || !now.mission_changed) opened_ = mission_;
  if (stage_ == nullptr || file_ != now.file) {
    refused_.clear();
    saved_.clear();
    // What is shipped is not written over.
    const bool own = is_mission(now.file) && find_shipped(std::filesystem::path(portable_name(now.file))).empty();
    const std::filesystem::path target = own ? now.file : std::filesystem::path(now.file.stem().string() + "_mission.toml");
    save_as_ = target.string();
    save_world_as_ = (target.parent_path() / (now.file.stem().string() + "_world.toml")).string();
  }
  parts_ = mission_parts(mission_);
  opened_parts_ = mission_parts(opened_);
  default_parts_ = mission_parts(defaults_);
  stage_ = stage;
  revision_ = now.run_revision;
  file_ = now.file;
}

void MissionView::change(const Frame& frame, KeyPlace at, const std::optional<std::string>& typed) {
  const Key& key = parts_[at.part].section->keys[at.key];
  refused_.clear();
  posted_at_ = frame.now.message.number;
  refused_key_ = parts_[at.part].title + "." + key.name;
  const auto next = with_key(mission_, file_, at, typed);
  const auto refuse = [&](const Error& error) { refused_ = error.message; };
  if (!next) return refuse(next.error());
  if (!concerns_world(key, at.part)) return frame.post(ChangeMission{*next});
  auto world = read_mission_world(*next);
  if (!world) return refuse(world.error());
  frame.post(ChangeMission{*next});
  frame.post(ChangeWorld{std::move(*world)});
}

void MissionView::draw_key(const Frame& frame, KeyPlace at, const Key& key) {
  const Value now = key.get(parts_[at.part].object), usual = key.get(default_parts_[at.part].object);
  // (A sensor may have been added or removed: then another table stands there.)
  const bool changed = at.part < opened_parts_.size() && opened_parts_[at.part].section == parts_[at.part].section && key.get(opened_parts_[at.part].object) != now;
  ImGui::PushID(static_cast<int>(at.key));
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::AlignTextToFramePadding();
  ImGui::PushStyleColor(ImGuiCol_Text, changed ? (frame.colours.dark ? frame.colours.selected : frame.colours.start) : now != usual ? frame.colours.text : frame.colours.faint);
  ImGui::Text("%s%s", changed ? "* " : "", key.name.c_str());
  ImGui::PopStyleColor();
  key_tooltip(key, usual);
  ImGui::TableNextColumn();
  const bool given = !std::holds_alternative<std::monostate>(now);
  if (std::holds_alternative<std::monostate>(usual)) {
    bool want = given;
    if (ImGui::Checkbox("##given", &want)) {
      if (!want) change(frame, at, std::nullopt);
      else change(frame, at, first_value(key));
    }
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("given, or not");
    ImGui::SameLine();
  }
  if (given) {
    if (const auto typed = key_widget(key, now, typing_)) change(frame, at, typed);
  } else {
    ImGui::TextDisabled("not given");
  }
  ImGui::TableNextColumn();
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s", key.unit.c_str());
  if (now != usual && given && !std::holds_alternative<std::monostate>(usual) && (key.kind != KeyKind::text || !key.choices.empty())) {
    ImGui::SameLine();
    if (ImGui::SmallButton("default")) change(frame, at, to_toml(usual));
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", to_toml(usual).c_str());
  }
  if (!refused_.empty() && refused_key_ == parts_[at.part].title + "." + key.name) {
    ImGui::TableNextRow();
    ImGui::TableSetColumnIndex(1);
    show_refusal(frame);
  }
  ImGui::PopID();
}

void MissionView::show_refusal(const Frame& frame) const {
  ImGui::PushStyleColor(ImGuiCol_Text, frame.colours.warning);
  ImGui::TextWrapped("%s", refused_.c_str());
  ImGui::PopStyleColor();
}

void MissionView::change_sensors(const Frame& frame, const Result<Mission>& next) {
  refused_.clear();
  posted_at_ = frame.now.message.number;
  refused_key_ = new_sensor;
  if (next) frame.post(ChangeMission{*next});
  else refused_ = next.error().message;
}

void MissionView::draw_new_sensor(const Frame& frame) {
  ImGui::SetNextItemWidth(16.0f * ImGui::GetFontSize());
  if (ImGui::BeginCombo("##new sensor", "add a sensor ...")) {
    for (const std::string& preset : sensor_presets())
      if (ImGui::Selectable(preset.c_str())) change_sensors(frame, with_sensor(mission_, file_, preset));
    ImGui::EndCombo();
  }
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("one of the shipped presets; its keys can be changed then");
  if (!refused_.empty() && refused_key_ == new_sensor) show_refusal(frame);
}

void MissionView::draw_part(const Frame& frame, std::size_t part, bool searching) {
  const MissionPart& p = parts_[part];
  std::vector<std::size_t> shown;
  for (std::size_t k = 0; k < p.section->keys.size(); ++k) {
    const Key& key = p.section->keys[k];
    if (only_changed_ && key.get(p.object) == key.get(default_parts_[part].object)) continue;
    if (matches(search_.data(), p.title, key)) shown.push_back(k);
  }
  if (shown.empty()) return;
  if (searching) ImGui::SetNextItemOpen(true);
  else ImGui::SetNextItemOpen(part == 0 || p.title == "planner", ImGuiCond_Once);
  const bool open = ImGui::CollapsingHeader(p.title.c_str());
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", p.section->help.c_str());
  const std::size_t others = parts_.size() - mission_.sensors.size();
  if (open && part >= others && ImGui::SmallButton("remove this sensor")) change_sensors(frame, without_sensor(mission_, file_, part - others));
  if (!open || !ImGui::BeginTable("keys", 3, ImGuiTableFlags_BordersInnerH | ImGuiTableFlags_SizingStretchProp)) return;
  ImGui::TableSetupColumn("key", ImGuiTableColumnFlags_WidthStretch, 0.40f);
  ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch, 0.45f);
  ImGui::TableSetupColumn("unit", ImGuiTableColumnFlags_WidthStretch, 0.15f);
  for (const std::size_t k : shown) draw_key(frame, {part, k}, p.section->keys[k]);
  ImGui::EndTable();
}

void MissionView::save(const Frame& frame) {
  const Simulation& run = *frame.now.simulation;
  const auto done = save_mission(run.mission(), run.scene().world(), save_as_, save_world_as_);
  save_failed_ = !done;
  if (!done) {
    saved_ = done.error().message;
    return;
  }
  saved_ = fmt::format("saved {}{}", done->mission.string(), done->world.empty() ? "" : " and its world " + done->world.string());
  // From now on it runs in the world that the file names.
  if (!done->world.empty()) frame.post(ChangeMission{in_world_file(run.mission(), done->world)});
}

void MissionView::draw_saving(const Frame& frame) {
  std::error_code ignored;
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - 6.0f * ImGui::GetFontSize());
  text_field("mission##file", save_as_, typing_);
  if (frame.now.world_changed) {
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - 6.0f * ImGui::GetFontSize());
    text_field("world##file", save_world_as_, typing_);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("The world was edited: it is saved too, and the mission names it.");
  }
  const bool exists = std::filesystem::exists(save_as_, ignored);
  const char* label = frame.now.world_changed ? (exists ? "Save mission and world (overwrite)###save" : "Save mission and world###save") : (exists ? "Save mission (overwrite)###save" : "Save mission###save");
  if (ImGui::Button(label)) save(frame);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("Every key is written; `thicket run` gives the result that Reset and Play give here.");
  if (saved_.empty()) return;
  ImGui::PushStyleColor(ImGuiCol_Text, save_failed_ ? frame.colours.warning : frame.colours.text);
  ImGui::TextWrapped("%s", saved_.c_str());
  ImGui::PopStyleColor();
}

void MissionView::draw(const Frame& frame) {
  if (!frame.now.simulation) return ImGui::TextUnformatted("Nothing is open.");
  follow(frame.now);
  // What only the run could tell: it stands at the key too.
  if (frame.now.message.error && frame.now.message.number > posted_at_) {
    refused_ = frame.now.message.text;
    posted_at_ = ~std::uint64_t{0};
  }
  draw_saving(frame);
  ImGui::Separator();
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x * 0.5f);
  ImGui::InputTextWithHint("##search", "search keys", search_.data(), search_.size());
  ImGui::SameLine();
  ImGui::Checkbox("not default", &only_changed_);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("only keys that are not at their default");
  const bool searching = search_[0] != '\0' || only_changed_;
  if (ImGui::BeginChild("keys")) {
    for (std::size_t part = 0; part < parts_.size(); ++part) {
      ImGui::PushID(static_cast<int>(part));
      draw_part(frame, part, searching);
      ImGui::PopID();
    }
    if (!searching) draw_new_sensor(frame);
  }
  ImGui::EndChild();
}

}  // namespace

std::unique_ptr<View> make_mission_view() { return std::make_unique<MissionView>(); }

}  // namespace thicket::gui
