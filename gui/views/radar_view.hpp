// The radar view's class, for its maker and its tests. Private to the room.
#pragma once

#include <optional>

#include "polar.hpp"
#include "waterfall.hpp"

namespace thicket::gui {

class RadarView final : public View {
 public:
  const char* name() const override { return "Radar"; }
  void draw(const Frame& frame) override;

  std::size_t sensor() const { return sensor_; }
  std::size_t beam() const { return beam_; }
  const Waterfall& waterfall() const { return waterfall_; }

 private:
  void choose_sensor(const Simulation& simulation);
  void choose_beam(const Frame& frame, const Scan& scan);
  void draw_profile(const Frame& frame, const Scan& scan, ImVec2 size);
  void read_out(const Frame& frame, const Scan& scan, const Chart& chart) const;

  std::size_t sensor_ = 0, beam_ = 0;
  std::optional<std::size_t> beam_of_;  ///< the sensor that the beam was chosen of
  bool decibel_ = false;
  Waterfall waterfall_;
  Polar polar_;
  std::vector<ImVec2> points_;
};

}  // namespace thicket::gui
