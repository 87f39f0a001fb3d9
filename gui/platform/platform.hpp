// What the window stands on: a screen, or none. Private to the room.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <imgui.h>

#include "picture.hpp"
#include "thicket/base/result.hpp"
#include "view.hpp"

namespace thicket::gui {

/// The left stick of a gamepad, -1 to 1: forward and left.
struct Stick {
  double forward = 0.0, left = 0.0;
};

/// A key that went down. ImGui 1.86 sees only what is down at a frame: what is pressed and let go between two it would miss.
struct KeyPress {
  int key = 0;  ///< of GLFW
  bool ctrl = false, shift = false, other = false;  ///< held with it; other: Alt, Super
  bool again = false;  ///< by being held
};

/// Open, poll, draw, close: there is one per ImGui context, which it makes and takes down.
class Platform {
 public:
  virtual ~Platform() = default;
  /// Takes what came from the person, after waiting up to `wait` seconds for it; whether there was anything.
  virtual bool poll(double wait) = 0;
  /// The person wants the window closed.
  virtual bool closing() const = 0;
  /// Begins a frame of ImGui.
  virtual void begin() = 0;
  /// Ends it: draws it, over a colour.
  virtual void draw(ImU32 background) = 0;
  /// Shows what was drawn.
  virtual void show() = 0;
  /// What was drawn, before it is shown.
  virtual Picture pixels() = 0;
  virtual Textures& textures() = 0;
  virtual double scale() const = 0;  ///< of letters and lines
  virtual std::vector<std::filesystem::path> dropped() { return {}; }  ///< files, since the last call
  virtual std::vector<KeyPress> pressed() { return {}; }  ///< since the last call
  virtual Stick stick() { return {}; }
  virtual void title(const std::string&) {}
  /// OpenGL's errors since the last call, as their number.
  virtual unsigned faults() = 0;
};

struct Size {
  int width = 1280, height = 800;
};

/// A window; an error says what to do where there is no screen.
Result<std::unique_ptr<Platform>> open_screen(const std::string& title, const Size& size);
/// Pictures without a screen, by EGL. Frames are 1/60 s apart, so that the same frames give the same picture.
Result<std::unique_ptr<Platform>> open_offscreen(const Size& size, double scale = 1.0);

/// Why no window can be opened here; empty if one can.
std::string no_screen();
/// Sets up a new ImGui context's letters and looks.
void make_context(double scale);
void use_look(bool dark, double scale);

}  // namespace thicket::gui
