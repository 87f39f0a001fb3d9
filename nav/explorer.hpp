// What the explorers have in common: no goal, but a distance to drive. Private to the room.
#pragma once

#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "pilot.hpp"

namespace thicket {

class Explorer : public Planner {
 public:
  Explorer(const PlannerSpec& spec, const VehicleLimits& vehicle) : pilot_(spec, vehicle), explore_(spec.explore_m) {}

  Decision decide(const Senses& senses) final;
  std::vector<Mark> marks() const override { return marks_; }

 protected:
  /// One decision; the pilot has looked.
  virtual Decision drive() = 0;

  Pilot& pilot() { return pilot_; }
  const glm::dvec2& position() const { return pilot_.pose().position; }
  double driven() const { return driven_; }
  Decision go_to(const glm::dvec2& point, std::string state) const { return {pilot_.go_to(point), Outcome::running, std::move(state), ""}; }
  Decision explored(const std::string& why) const;
  void mark(const char* label, const glm::dvec2& at) { marks_.push_back({Mark::Kind::point, label, at, at}); }
  void mark_segment(const char* label, const glm::dvec2& from, const glm::dvec2& to) { marks_.push_back({Mark::Kind::segment, label, from, to}); }

  /// A bearing to go on with after what was met at `bearing`, by chance (the same one in every run): at least 60 degrees off, and open. `count`: of the bounces before.
  double another_way(double bearing, std::size_t count) const;
  /// A point far away at a bearing from here.
  glm::dvec2 far_away(double bearing) const { return position() + 1e4 * direction(bearing); }
  /// Lanes to and fro are this far apart, m: what passes within a metre of everything, and no nearer than the robot keeps from matter.
  double lane() const { return std::max(2.0, 2.0 * pilot_.keep()); }

 private:
  Pilot pilot_;
  double explore_;
  double driven_ = 0.0;
  std::optional<glm::dvec2> before_;
  std::vector<Mark> marks_;
};

}  // namespace thicket
