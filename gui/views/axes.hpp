// Diagrams drawn by hand: round ticks, two axes, and what is between them. Private to the room.
#pragma once

#include <string>
#include <vector>

#include "../view.hpp"

namespace thicket::gui {

/// Round numbers in an interval: multiples of 1, 2 or 5 times a power of ten.
struct Ticks {
  double step = 1.0;
  std::vector<double> at;
};
/// The finest that are at most so many; none if the interval is empty or not finite.
Ticks nice_ticks(double low, double high, int at_most);
/// With as many digits as the step needs.
std::string tick_text(double value, double step);

/// An interval that grows by what it holds.
struct Range {
  double low = 1e300, high = -1e300;

  bool empty() const { return low > high; }
  /// Numbers that are not finite do not count.
  void hold(double value);
  /// A little more on both sides, and never of no length; [0, 1] if nothing was held.
  Range padded(double share = 0.05) const;
};

/// A rectangle of the screen with two linear axes.
struct Chart {
  ImVec2 low, high;  ///< its left upper and right lower corners
  Range x, y;
  bool hovered = false;

  float to_x(double value) const { return low.x + static_cast<float>((value - x.low) / (x.high - x.low)) * (high.x - low.x); }
  float to_y(double value) const { return high.y - static_cast<float>((value - y.low) / (y.high - y.low)) * (high.y - low.y); }
  double x_at(float pixel) const { return x.low + static_cast<double>((pixel - low.x) / (high.x - low.x)) * (x.high - x.low); }
  double y_at(float pixel) const { return y.low + static_cast<double>((high.y - pixel) / (high.y - low.y)) * (y.high - y.low); }
  int columns() const { return static_cast<int>(high.x - low.x); }
};

/// Takes all the width that there is, or `width`, and so much height; draws ground, grid, ticks and titles. An ImGui item of that id: what was hovered or dragged is the chart.
/// Until `end_chart` nothing is drawn outside of the axes.
Chart begin_chart(const Frame& frame, const char* id, ImVec2 size, Range x, Range y, const char* x_title, const char* y_title);
void end_chart();

/// Words on a ground that makes them readable over lines.
void label(const Frame& frame, ImVec2 at, const std::string& words, ImU32 colour);

/// Dark to bright by amounts of 0...1: blue, purple, orange, yellow; brighter is more for every eye.
ImU32 heat(double share);

}  // namespace thicket::gui
