// What the charts of docs/performance.md are made of: cases that are measured in turn.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace thicket::study {

/// A point of a curve: what to do once, as often as it takes to be measured.
struct Case {
  std::string series;
  double x = 0.0;
  std::function<void()> work;
  double items = 1.0;      ///< of a call: the cost is that of one item
  bool wall_time = false;  ///< else CPU time of all threads
  std::vector<double> values = {};  ///< s an item, one a round
  /// The median; of wall time the least, for others only add to it.
  double cost() const;
};

/// A chart over one thing that costs, both axes in decades.
struct Chart {
  std::string name;   ///< of its file
  std::string title;
  std::vector<std::string> words;  ///< below the title
  std::string x, y;   ///< labels with units
  double unit = 1.0;  ///< of y, s
  std::vector<Case> cases;
};

/// Each is made when it is asked for, since some of them are large.
struct ChartMaker {
  std::string name;
  std::function<Chart()> make;
};
const std::vector<ChartMaker>& chart_makers();

}  // namespace thicket::study
