// What the mouse's buttons did, one thing a frame. Private to the room.
#pragma once

#include <deque>

#include <imgui.h>

namespace thicket::gui {

/// ImGui 1.86 sees only what is down at a frame: two clicks between two frames it takes for one, and a double click on a busy computer for nothing. Here they wait for frames of their own.
class Clicks {
 public:
  void note(int button, bool down, const ImVec2& at) {
    if (button >= 0 && button < IM_ARRAYSIZE(held_)) events_.push_back({button, down, at});
  }
  bool empty() const { return events_.empty(); }
  /// Before ImGui's NewFrame: the next thing that happened, where the mouse was then. Without any, the mouse is where it is.
  void next(ImGuiIO& io) {
    if (!events_.empty()) {
      held_[events_.front().button] = events_.front().down;
      io.MousePos = events_.front().at;
      events_.pop_front();
    }
    for (int button = 0; button < IM_ARRAYSIZE(held_); ++button) io.MouseDown[button] = held_[button];
  }

 private:
  struct Event {
    int button;
    bool down;
    ImVec2 at;
  };
  std::deque<Event> events_;
  bool held_[ImGuiMouseButton_COUNT] = {};
};

}  // namespace thicket::gui
