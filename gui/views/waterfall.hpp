// Profiles of one beam over time, the newest on top. Private to the room.
#pragma once

#include <deque>
#include <vector>

#include "axes.hpp"

namespace thicket::gui {

/// Amplitude in dB, and -240 for nothing.
double decibels(double amplitude);

class Waterfall {
 public:
  static constexpr int most_rows = 256;

  struct Row {
    std::uint64_t number = 0;  ///< of the scan
    double time = 0.0;
    std::vector<float> amplitude;  ///< over `range()`; where there is no profile, of the echoes
    float most = 0.0f;
    int slot = 0;  ///< row of the texture
  };

  /// Adds a row if the scan is a new one. Another beam begins anew, and so does another world; after a way back in time what had not been yet is forgotten.
  void take(const Snapshot& now, const Scan& scan, std::size_t beam);
  void clear();
  const std::deque<Row>& rows() const { return rows_; }  ///< the newest first
  Range range() const { return range_; }                 ///< of the columns, m
  double most() const;                                   ///< amplitude of all rows
  void draw(const Frame& frame, ImVec2 size, bool decibel);

 private:
  std::uint32_t pixel(float amplitude, double top, bool decibel) const;
  void upload(const Frame& frame, bool decibel);
  void read_out(const Frame& frame, const Chart& chart, float row_height) const;

  std::deque<Row> rows_;
  Range range_{0.0, 1.0};
  std::size_t columns_ = 0, beam_ = 0;
  std::uint16_t sensor_ = 0;
  std::uint64_t run_ = 0, world_ = 0;
  int next_slot_ = 0, new_rows_ = 0;
  bool all_new_ = true, was_decibel_ = false;
  double top_ = 0.0;  ///< amplitude of the brightest colour in the texture
  std::vector<std::uint32_t> pixels_;
};

}  // namespace thicket::gui
