// Foreign text in error messages. Not a public header.
#pragma once

#include <string>
#include <string_view>

namespace thicket {

/// `text` as one short line of ASCII, whatever it holds: a broken file must not scramble the terminal.
inline std::string printable(std::string_view text) {
  std::string shown(text.substr(0, 40));
  for (char& letter : shown) {
    if (letter < ' ' || letter > '~') letter = '.';
  }
  return shown.size() < text.size() ? shown + "..." : shown;
}

}  // namespace thicket
