#include "settings.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <nlohmann/json.hpp>

#include "thicket/base/files.hpp"

namespace thicket::gui {
namespace {

using nlohmann::json;

template <class T>
void take(const json& object, const char* key, T& value) {
  const auto found = object.find(key);
  if (found == object.end()) return;
  try {
    value = found->get<T>();
  } catch (const json::exception&) {
    // Something else is written there: as it was.
  }
}

double share(double value, double otherwise) { return std::isfinite(value) ? std::clamp(value, 0.1, 0.9) : otherwise; }

}  // namespace

void Settings::used(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::erase(recent, name);
  recent.insert(recent.begin(), name);
  if (recent.size() > most_recent) recent.resize(most_recent);
}

std::filesystem::path settings_file() {
  if (const char* folder = std::getenv("XDG_CONFIG_HOME"); folder && *folder) return std::filesystem::path(folder) / "thicket" / "window.json";
  if (const char* home = std::getenv("HOME"); home && *home) return std::filesystem::path(home) / ".config" / "thicket" / "window.json";
  return {};
}

Settings read_settings(const std::filesystem::path& file) {
  Settings s;
  const auto text = read_text_file(file);
  const json object = text ? json::parse(*text, nullptr, false) : json();
  if (!object.is_object()) return s;
  take(object, "dark", s.dark);
  take(object, "width", s.width);
  take(object, "height", s.height);
  take(object, "left_share", s.left_share);
  take(object, "upper_share", s.upper_share);
  take(object, "left_view", s.left_view);
  take(object, "upper_view", s.upper_view);
  take(object, "lower_view", s.lower_view);
  take(object, "recent", s.recent);
  take(object, "imgui", s.imgui);
  const Settings fresh;
  s.width = std::clamp(s.width, 320, 16384);
  s.height = std::clamp(s.height, 240, 16384);
  s.left_share = share(s.left_share, fresh.left_share);
  s.upper_share = share(s.upper_share, fresh.upper_share);
  if (s.recent.size() > Settings::most_recent) s.recent.resize(Settings::most_recent);
  return s;
}

Result<Done> write_settings(const std::filesystem::path& file, const Settings& s) {
  const json object = {{"dark", s.dark},           {"width", s.width},           {"height", s.height},         {"left_share", s.left_share}, {"upper_share", s.upper_share},
                       {"left_view", s.left_view}, {"upper_view", s.upper_view}, {"lower_view", s.lower_view}, {"recent", s.recent},         {"imgui", s.imgui}};
  return write_file(file, object.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
}

std::string report_json(const Report& r) {
  const json object = {{"file", r.file},
                       {"mission", r.mission},
                       {"planner", r.planner},
                       {"verdict", r.verdict.empty() ? json() : json(r.verdict)},
                       {"steps", r.steps},
                       {"newest_step", r.newest_step},
                       {"time_s", r.time},
                       {"position_m", {r.x, r.y}},
                       {"goal_m", r.goal.empty() ? json() : json(r.goal)},
                       {"left_view_px", {r.left, r.top, r.width, r.height}},
                       {"frames", r.frames},
                       {"gl_errors", r.gl_errors},
                       {"first_frame_ms", r.first_frame_ms},
                       {"median_frame_ms", r.median_frame_ms},
                       {"longest_frame_ms", r.longest_frame_ms}};
  return object.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace thicket::gui
