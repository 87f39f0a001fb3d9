#include "keys.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>

namespace thicket::gui {

std::span<const KeyBinding> key_table() {
  static constexpr bool ctrl = true, shift = true, no = false;
  static const KeyBinding table[] = {
      {Deed::play, GLFW_KEY_SPACE, no, no, "Space", "play or pause"},
      {Deed::forward, GLFW_KEY_RIGHT, no, no, "Right", "a step forward", true},
      {Deed::back, GLFW_KEY_LEFT, no, no, "Left", "a step back", true},
      {Deed::forward_ten, GLFW_KEY_RIGHT, no, shift, "Shift+Right", "ten steps forward", true},
      {Deed::back_ten, GLFW_KEY_LEFT, no, shift, "Shift+Left", "ten steps back", true},
      {Deed::reset, GLFW_KEY_HOME, no, no, "Home", "back to the start"},
      {Deed::faster, GLFW_KEY_EQUAL, no, no, "+", "faster"},
      {Deed::faster, GLFW_KEY_EQUAL, no, shift, "", "faster"},
      {Deed::faster, GLFW_KEY_KP_ADD, no, no, "", "faster"},
      {Deed::slower, GLFW_KEY_MINUS, no, no, "-", "slower"},
      {Deed::slower, GLFW_KEY_KP_SUBTRACT, no, no, "", "slower"},
      {Deed::drive_forward, GLFW_KEY_W, no, no, "W", "drive forward, while held", no, true},
      {Deed::drive_left, GLFW_KEY_A, no, no, "A", "turn left, while held", no, true},
      {Deed::drive_back, GLFW_KEY_S, no, no, "S", "drive back, while held", no, true},
      {Deed::drive_right, GLFW_KEY_D, no, no, "D", "turn right, while held", no, true},
      {Deed::fly_up, GLFW_KEY_R, no, no, "R", "climb, while held (a robot that flies)", no, true},
      {Deed::fly_down, GLFW_KEY_F, no, no, "F", "sink, while held (a robot that flies)", no, true},
      {Deed::fly_left, GLFW_KEY_Q, no, no, "Q", "fly to the left, while held (a robot that flies)", no, true},
      {Deed::fly_right, GLFW_KEY_E, no, no, "E", "fly to the right, while held (a robot that flies)", no, true},
      {Deed::by_hand, GLFW_KEY_H, no, no, "H", "drive by hand only, or let the planner drive when no key is held"},
      {Deed::next_view, GLFW_KEY_TAB, no, no, "Tab", "the next view, on the right"},
      {Deed::open, GLFW_KEY_O, ctrl, no, "Ctrl+O", "open a mission, a world or a map"},
      {Deed::reload, GLFW_KEY_F5, no, no, "F5", "read the files again"},
      {Deed::save_mission, GLFW_KEY_S, ctrl, no, "Ctrl+S", "save the mission as it is now"},
      {Deed::save_mission_as, GLFW_KEY_S, ctrl, shift, "Ctrl+Shift+S", "save it under another name"},
      {Deed::export_map, GLFW_KEY_E, ctrl, no, "Ctrl+E", "export the map"},
      {Deed::screenshot, GLFW_KEY_F12, no, no, "F12", "a picture of the window"},
      {Deed::record, GLFW_KEY_F9, no, no, "F9", "begin or end a video of the window"},
      {Deed::light, GLFW_KEY_F2, no, no, "F2", "dark or light"},
      {Deed::help, GLFW_KEY_F1, no, no, "F1", "show every key"},
      {Deed::quit, GLFW_KEY_Q, ctrl, no, "Ctrl+Q", "quit"},
  };
  return table;
}

const char* key_of(Deed deed) {
  for (const KeyBinding& binding : key_table())
    if (binding.deed == deed) return binding.keys;
  return "";
}

std::optional<Deed> deed_of(const KeyPress& press, bool typing) {
  if (press.other) return std::nullopt;
  const bool function = press.key >= GLFW_KEY_F1 && press.key <= GLFW_KEY_F25;
  for (const KeyBinding& b : key_table())
    if (b.key == press.key && b.ctrl == press.ctrl && b.shift == press.shift && !b.held && (b.repeats || !press.again) && (!typing || press.ctrl || function)) return b.deed;
  return std::nullopt;
}

void follow(Chords& chords, std::span<const KeyPress> pressed) {
  std::erase_if(chords, [](int key) { return !ImGui::IsKeyDown(key); });
  for (const KeyPress& press : pressed)
    if (press.ctrl && press.key >= 0 && press.key <= GLFW_KEY_LAST) chords.insert(press.key);
}

bool is_held(Deed deed, const Chords& chords) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantTextInput || io.KeyCtrl || io.KeyAlt || io.KeySuper) return false;
  for (const KeyBinding& b : key_table())
    if (b.deed == deed && b.held && ImGui::IsKeyDown(b.key) && !chords.contains(b.key)) return true;
  return false;
}

Command hand_command(const Stick& stick, double speed_max, double turn_rate_max, const Chords& chords, double climb_max) {
  const auto both = [&](Deed plus, Deed minus) { return (is_held(plus, chords) ? 1.0 : 0.0) - (is_held(minus, chords) ? 1.0 : 0.0); };
  const double forward = std::clamp(stick.forward + both(Deed::drive_forward, Deed::drive_back), -1.0, 1.0);
  const double left = std::clamp(stick.left + both(Deed::drive_left, Deed::drive_right), -1.0, 1.0);
  // Half the turn rate: at all of it nobody stops where they want to.
  Command command{forward * speed_max, 0.5 * left * turn_rate_max};
  if (climb_max > 0.0) {
    command.lateral = both(Deed::fly_left, Deed::fly_right) * speed_max;
    command.climb = both(Deed::fly_up, Deed::fly_down) * climb_max;
  }
  return command;
}

}  // namespace thicket::gui
