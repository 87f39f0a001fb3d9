// Every plot of the program: curves, polar scans and images, in panels on one sheet. Private to the room.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>

#include "canvas.hpp"
#include "thicket/base/result.hpp"

namespace thicket {

/// Colours that everyone tells apart (Okabe & Ito 2008), without the yellow, which white swallows.
Colour plot_colour(std::size_t index);

/// A share 0...1 as a colour whose lightness grows evenly: viridis (Smith & van der Walt 2015), from dark to light.
Colour heat_colour(double share);

/// Round numbers 1, 2 or 5 x 10^n apart, all within [low, high], at most `most` of them.
std::vector<double> nice_ticks(double low, double high, int most);

/// The ticks as text, each with as many decimals as their distance needs.
std::vector<std::string> tick_labels(const std::vector<double>& ticks);

/// Of an axis of decades: the powers of ten, and where there are few of them 2 and 5 times those.
std::vector<double> decade_ticks(double low, double high);
/// "0.02", "500", "10⁶"
std::vector<std::string> decade_labels(const std::vector<double>& ticks);

/// Ticks at the multiples of a step, such as 30 degrees.
std::vector<double> even_ticks(double low, double high, double step);

/// Ticks of an axis whose numbers are decimal logarithms: at 1, 2 and 5 times powers of ten, or where these are too many at powers of ten alone.
std::vector<double> log_ticks(double low, double high, int most);

/// From the smallest to the largest of what is shown, where no limits are given.
struct Axis {
  std::string label;  ///< with its unit: "range, m"
  std::optional<double> low, high;
  double tick = 0.0;  ///< distance of ticks; 0: a round one
  bool logarithmic = false;  ///< its numbers, limits too, are decimal logarithms of what stands at its ticks; of a Plot
};

struct Series {
  enum class Kind : std::uint8_t { line, dashed, step, points, rings, stems };
  std::string name;  ///< in the legend, if not empty
  Kind kind = Kind::line;
  Colour colour;
  std::vector<glm::dvec2> points;  ///< a curve has a gap where a number is not finite
  std::vector<std::string> labels = {};  ///< beside the points, where there is room; of a Plot
};

/// Curves and marks over two axes.
struct Plot {
  std::string title;
  Axis x, y;
  std::vector<Series> series;
};

/// Amplitudes, in dB or not, over two axes: a column of values for each x.
struct ImagePlot {
  std::string title;
  Axis x, y, value;
  std::vector<double> columns;          ///< x, in any order
  double first = 0.0, step = 1.0;       ///< y of a column's first value, and to the next
  std::size_t rows = 0;                 ///< values a column
  std::vector<float> values;            ///< column by column
  std::vector<Series> series;           ///< on top
};

/// What a scanning sensor saw: its x axis points up, azimuths grow counter-clockwise.
struct PolarPlot {
  enum class Shape : std::uint8_t { disc, ring, diamond, square, cross };
  struct Point {
    double azimuth = 0.0, range = 0.0, value = 0.0;  ///< rad, m; the value gives colour and size
    Shape shape = Shape::disc;
  };
  std::string title;
  double range = 1.0;    ///< of the outer ring, m
  double sector = 6.3;   ///< rad, about the x axis; more than half a circle is drawn as a whole one
  Axis value;
  std::vector<Point> points;
  std::vector<glm::dvec2> sensed;  ///< azimuth and range: a closed outline of what was looked at
  std::vector<std::pair<Shape, std::string>> legend;
};

using Panel = std::variant<Plot, ImagePlot, PolarPlot>;

/// Panels in rows below a title. The panels of one column stand exactly above each other.
struct Sheet {
  struct Row {
    double height = 300.0;  ///< pixels
    std::vector<Panel> panels;
  };
  std::string title;
  std::vector<std::string> subtitles;  ///< a line each
  int width = 1000;
  std::vector<Row> rows;

  /// SVG if the name ends in .svg, else PNG; written whole or not at all.
  Result<Done> write(const std::filesystem::path& file) const;
};

}  // namespace thicket
