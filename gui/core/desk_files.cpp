// What the desk reads and writes.
#include <fmt/format.h>

#include <chrono>

#include "desk.hpp"
#include "mission_form.hpp"
#include "thicket/base/files.hpp"
#include "thicket/base/probability_file.hpp"

namespace thicket::gui {
namespace {

namespace fs = std::filesystem;

/// So that who reads the message finds the file.
std::string full(const fs::path& file) {
  std::error_code none;
  return fs::absolute(file, none).lexically_normal().string();
}

}  // namespace

void Workbench::open(const fs::path& file) {
  if (!can_open(file)) return say(true, fmt::format("{}: expected a mission or world (.toml), a map (.yaml, .map) or a mesh (.obj)", file.string()));
  runner_.post(Open{file, {}});
}

void Workbench::write_mission_to(const Simulation& simulation, bool world_changed, const fs::path& file) {
  if (world_changed) {
    // A mission only names its world: one that was edited stands beside it, and runs headless as it does here.
    const auto saved = gui::save_mission(simulation.mission(), simulation.scene().world(), file, file.parent_path() / (file.stem().string() + "_world.toml"));
    if (!saved) return say(true, saved.error().message);
    if (!saved->world.empty()) runner_.post(ChangeMission{in_world_file(simulation.mission(), saved->world)});
    saved_as_ = file;
    return say(false, fmt::format("the mission is in {}{}", full(file), saved->world.empty() ? "" : ", its world in " + full(saved->world)));
  }
  if (const auto written = write_file(file, write_mission(simulation.mission())); !written) return say(true, written.error().message);
  saved_as_ = file;
  say(false, fmt::format("the mission is in {}", full(file)));
}

void Workbench::save_mission(const Snapshot& now, bool ask) {
  if (!now.simulation) return;
  // A file that a person wrote has comments, which are lost in what is written here: it is not overwritten unasked.
  if (!ask && !saved_as_.empty()) return write_mission_to(*now.simulation, now.world_changed, saved_as_);
  const fs::path name = saved_as_.empty() ? fs::path(now.simulation->mission().name + "-changed.toml") : saved_as_;
  ask_dialog_.show("Save mission as", name, [this, simulation = now.simulation, changed = now.world_changed](const fs::path& file) { write_mission_to(*simulation, changed, file); });
}

void Workbench::export_map(const Snapshot& now) {
  if (!now.simulation) return;
  ask_dialog_.show("Export map (.yaml for map_server, .npy for NumPy)", now.simulation->mission().name + "-map.yaml", [this, simulation = now.simulation](const fs::path& file) {
    const ProbabilityGrid grid = simulation->map().to_probabilities();
    const bool numpy = file.extension() == ".npy";
    const auto written = numpy ? write_npy(file, grid) : write_map_server(file.extension() == ".yaml" ? fs::path(file).replace_extension() : file, grid, MapMode::trinary);
    if (!written) say(true, written.error().message);
    else say(false, fmt::format("the map is in {}", full(file)));
  });
}

void Workbench::take_pictures(Platform& platform, double time) {
  std::erase_if(writing_, [&](Writing& w) {
    if (w.wrong.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    const std::string wrong = w.wrong.get();
    say(!wrong.empty(), wrong.empty() ? w.good : wrong);
    return true;
  });
  // (One picture at a time, so that two do not get one name.)
  if (wants_picture_ && writing_.empty()) {
    wants_picture_ = false;
    const fs::path file = free_name("", "thicket-picture", "png");
    auto wrong = std::async(std::launch::async, [file, picture = platform.pixels()] {
      const auto written = write_picture(file, picture);
      return written ? std::string() : written.error().message;
    });
    writing_.push_back({std::move(wrong), fmt::format("the picture is in {}", full(file))});
  }
  if (wants_record_) {
    wants_record_ = false;
    if (recorder_.running()) {
      writing_.push_back({recorder_.end_beside(), fmt::format("the video is in {}", full(recorder_.file()))});
    } else {
      const Picture first = platform.pixels();
      const auto begun = recorder_.begin(free_name("", "thicket-video", "mp4"), first.width, first.height);
      if (!begun) say(true, begun.error().message);
      recording_since_ = time;
    }
  }
  if (recorder_.due(time - recording_since_))
    if (const auto added = recorder_.add(platform.pixels(), time - recording_since_); !added) say(true, added.error().message);
}

}  // namespace thicket::gui
