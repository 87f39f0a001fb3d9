// Every key of the window, in one table: what is done and what F1 shows are read from it.
#pragma once

#include <optional>
#include <set>
#include <span>
#include <string>

#include "../platform/platform.hpp"
#include "thicket/nav/planner.hpp"

namespace thicket::gui {

/// What a key does.
enum class Deed {
  play, back, forward, back_ten, forward_ten, reset, reload, faster, slower, by_hand, next_view, open, save_mission, save_mission_as, screenshot, record, export_map, light, help, quit,
  drive_forward, drive_back, drive_left, drive_right, fly_up, fly_down, fly_left, fly_right,
};

struct KeyBinding {
  Deed deed;
  int key;  ///< of GLFW, which for letters and digits is the capital letter's number
  bool ctrl = false, shift = false;
  const char* keys;    ///< as people call it; empty: another key for what the row before does
  const char* help;
  bool repeats = false;
  bool held = false;   ///< it does what it does for as long as it is held
};
std::span<const KeyBinding> key_table();

/// The name of the key for a deed, for buttons and menus.
const char* key_of(Deed deed);

/// What a press of a key is for. While letters are typed into a field, only keys with Ctrl and function keys count.
std::optional<Deed> deed_of(const KeyPress& press, bool typing);

/// Keys that are still down since they were pressed together with Ctrl: who lets go of Ctrl first does not mean the key alone.
using Chords = std::set<int>;
/// Adds those that were pressed, drops those that are up.
void follow(Chords& chords, std::span<const KeyPress> pressed);

/// Whether the key of a deed is held now, by itself.
bool is_held(Deed deed, const Chords& chords = {});

/// Where the keys that are held and the stick want the robot to go, as shares of its limits. `climb_max`, m/s, is of one that flies, which goes sideways too; 0: it does not.
Command hand_command(const Stick& stick, double speed_max, double turn_rate_max, const Chords& chords = {}, double climb_max = 0.0);

}  // namespace thicket::gui
