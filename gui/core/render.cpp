#include "thicket/gui/render.hpp"

#include <fmt/format.h>

#include <cmath>

#include "desk.hpp"
#include "thicket/base/files.hpp"

namespace thicket::gui {
namespace {

/// The run as it is at the time, or its end if that comes before.
Result<std::shared_ptr<const Snapshot>> run_until(Runner& runner, const RenderOptions& options) {
  std::error_code none;
  const bool folder = std::filesystem::is_directory(options.file, none);
  const std::filesystem::path file = folder ? options.file / "mission.toml" : options.file;
  runner.post(Open{file, options.overrides});
  auto now = runner.settled();
  if (!now->simulation) return Error{now->message.text};
  if (!options.time) {
    runner.post(SetSpeed{0.0});
    return runner.finished();
  }
  const double steps = std::ceil(*options.time / now->simulation->mission().step_s - 1e-9);
  runner.post(StepBy{static_cast<int>(std::clamp(steps, 0.0, 1e9))});
  return runner.settled();
}

/// One view over the whole picture.
void draw_alone(View& view, const Frame& frame) {
  ImGui::SetNextWindowPos({0.0f, 0.0f});
  ImGui::SetNextWindowSize(ImGui::GetIO().DisplaySize);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0.0f, 0.0f));
  ImGui::Begin("picture", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBackground);
  ImGui::PopStyleVar();
  view.draw(frame);
  ImGui::End();
}

}  // namespace

std::vector<std::string> view_names() {
  std::vector<std::string> names;
  for (const auto& view : make_views()) names.push_back(small_name(*view));
  names.push_back("all");
  return names;
}

Result<Done> render_picture(const RenderOptions& options) {
  auto views = make_views();
  const auto chosen = std::find_if(views.begin(), views.end(), [&](const auto& view) { return small_name(*view) == options.view; });
  if (chosen == views.end() && options.view != "all") return Error{fmt::format("there is no view '{}', expected one of: {}", options.view, fmt::join(view_names(), ", "))};
  Runner runner;
  const auto now = run_until(runner, options);
  if (!now) return now.error();
  auto platform = open_offscreen({options.width, options.height});
  if (!platform) return platform.error();
  Settings settings;
  settings.dark = !options.light;
  Workbench bench(runner, settings, true);
  Desk desk;
  const Palette colours = palette(settings.dark);
  const Frame frame{**now, colours, (*platform)->textures(), desk, [](Action) {}, 1.0, true};
  // ImGui needs a few frames until everything has its size.
  for (int i = 0; i < 4; ++i) {
    (*platform)->begin();
    if (options.view == "all") bench.draw(**now, **platform);
    else {
      use_look(settings.dark, 1.0);
      draw_alone(**chosen, frame);
    }
    (*platform)->draw(colours.background);
  }
  if (const unsigned faults = (*platform)->faults()) return Error{fmt::format("OpenGL reports {} errors while the view '{}' is drawn", faults, options.view)};
  return write_picture(options.out, (*platform)->pixels());
}

}  // namespace thicket::gui
