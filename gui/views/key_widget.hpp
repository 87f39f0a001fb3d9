// A key of a schema as a widget.
#pragma once

#include <optional>
#include <string>

#include <imgui.h>

#include "thicket/base/schema.hpp"

namespace thicket::gui {

/// What is being typed: at most one field at a time is.
struct Typing {
  ImGuiID field = 0;
  int frame = 0;
  std::string text;
};

/// One line of text; true when it was committed by Enter or by leaving the field.
bool text_field(const char* label, std::string& text, Typing& typing);

/// A drop-down list; true when another was chosen.
bool choice_field(const char* label, std::string& chosen, const std::vector<std::string>& choices);

/// The widget that fits a key, as wide as there is room. What was committed, as TOML, to be judged; nothing while it is being typed.
std::optional<std::string> key_widget(const Key& key, const Value& now, Typing& typing);

/// Help, unit and range, and the default, as a tooltip of the last item.
void key_tooltip(const Key& key, const Value& usual);

}  // namespace thicket::gui
