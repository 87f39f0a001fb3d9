// The window's desk: menu, transport, panes with views, status line. It owns no truth: it reads snapshots and posts actions.
#pragma once

#include <array>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "../platform/platform.hpp"
#include "keys.hpp"
#include "open_dialog.hpp"
#include "recorder.hpp"
#include "settings.hpp"
#include "view.hpp"

namespace thicket::gui {

/// All views, in the order of the tabs.
std::vector<std::unique_ptr<View>> make_views();
/// "3d" of "3D": as the command line has it.
std::string small_name(const View& view);

class Workbench {
 public:
  /// `still`: for a picture; nothing moves, and nothing is asked.
  Workbench(Runner& runner, Settings settings, bool still = false);

  /// Between ImGui's NewFrame and Render. Does what the keys say, and draws all.
  void draw(const Snapshot& now, Platform& platform);
  /// After `Platform::draw`: pictures and videos that were wanted.
  void take_pictures(Platform& platform, double time);
  void ask_for_a_file() { open_dialog_.show(); }
  void act(Deed deed, const Snapshot& now);

  bool quits() const { return quits_; }
  /// Something moves by itself: frames are wanted without a person's doing.
  bool moves() const { return recorder_.running() || driving_ || !writing_.empty(); }
  Settings& settings() { return settings_; }
  void say(bool error, std::string text);
  struct Place {
    ImVec2 low, size;
  };
  const Place& left_pane() const { return left_pane_; }

 private:
  struct Pane {
    std::vector<View*> views;
    std::string* shown;  ///< the name of the view that is
    bool select = true;  ///< tell ImGui so
  };
  struct Note {
    bool error;
    std::string text;
    double until;  ///< of ImGui's time; errors stay
  };

  void watch(const Snapshot& now);
  void drive(const Snapshot& now, const Stick& stick);
  void draw_menu(const Snapshot& now);
  void draw_recent();
  void draw_transport(const Snapshot& now);
  void draw_speed(const Snapshot& now);
  void draw_panes(const Frame& frame, double height);
  void draw_pane(Pane& pane, const char* id, const ImVec2& size, const Frame& frame);
  void draw_status(const Frame& frame, double height);
  double status_height() const;
  void draw_help();
  void change_speed(const Snapshot& now, int by);
  void open(const std::filesystem::path& file);
  void save_mission(const Snapshot& now, bool ask);
  void export_map(const Snapshot& now);
  void write_mission_to(const Simulation& simulation, bool world_changed, const std::filesystem::path& file);

  Runner& runner_;
  Settings settings_;
  bool still_, quits_ = false, help_ = false;
  Desk desk_;
  std::vector<std::unique_ptr<View>> views_;
  Pane left_, upper_, lower_;
  Place left_pane_{};
  OpenDialog open_dialog_;
  AskDialog ask_dialog_;
  std::vector<Note> notes_;
  std::uint64_t last_message_ = 0;
  std::filesystem::path last_file_;   ///< that was opened
  std::filesystem::path saved_as_;    ///< the mission, by the person
  bool driving_ = false, by_hand_ = false;
  Command last_command_;
  Chords chords_;
  Recorder recorder_;
  double recording_since_ = 0.0;
  /// What is written beside the window, because it takes longer than a frame.
  struct Writing {
    std::future<std::string> wrong;  ///< empty: nothing
    std::string good;                ///< what to say then
  };
  std::vector<Writing> writing_;
  bool wants_picture_ = false, wants_record_ = false;
};

}  // namespace thicket::gui
