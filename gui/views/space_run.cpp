#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "space_view.hpp"

namespace thicket::gui {
namespace {

/// Where the robot really was when a scan was made.
Pose pose_at(const Snapshot& now, double time) {
  const Simulation& s = *now.simulation;
  Pose2 pose = s.vehicle().pose;
  const auto step = static_cast<std::uint64_t>(std::llround(time / s.mission().step_s));
  if (const std::size_t count = now.samples.count_until(step); count > 0 && now.samples[count - 1].step == step) pose = now.samples[count - 1].pose;
  return Pose::planar(pose.position.x, pose.position.y, s.vehicle_pose().position.z, pose.yaw);
}

/// The border of a lobe: four edges, and an arc at its end; an echo may come from anywhere at its range, and is an arc too.
void draw_lobe(const Frame& frame, const Pose& sensor, const Scan& scan, const Beam& beam, const SpaceLayers& layers, Overlay& overlay) {
  const double far = beam.sensed_range > 0.0 ? beam.sensed_range : scan.range_max;
  const auto towards = [&](double azimuth, double elevation) {
    const double a = beam.azimuth + azimuth, e = beam.elevation + elevation;
    return sensor.orientation * glm::dvec3(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
  };
  const ImU32 colour = frame.colours.ray | IM_COL32_A_MASK;
  const double half_a = 0.5 * scan.azimuth_opening, half_e = 0.5 * scan.elevation_opening;
  constexpr int parts = 16;
  const auto arc = [&](double range, ImU32 arc_colour, float width) {
    for (int i = 0; i < parts; ++i)
      overlay.line(sensor.position + range * towards(half_a * (2.0 * i / parts - 1.0), 0.0), sensor.position + range * towards(half_a * (2.0 * (i + 1) / parts - 1.0), 0.0), arc_colour, width);
  };
  if (layers.rays) {
    for (const double e : {-half_e, half_e})
      for (const double a : {-half_a, half_a}) overlay.line(sensor.position, sensor.position + far * towards(a, e), colour);
    arc(far, colour, 1.0f);
  }
  if (!layers.echoes) return;
  for (const Echo& echo : scan.echoes_of(beam)) arc(echo.range, frame.colours.echo, 2.0f);
}

void draw_scan(const Frame& frame, const Scan& scan, bool lidar, const SpaceLayers& layers, Overlay& overlay) {
  const Pose sensor = pose_at(frame.now, scan.time) * Pose{scan.mount_position, scan.mount_orientation};
  // More lines than these cannot be told apart.
  const std::size_t every = std::max<std::size_t>(1, scan.beams.size() / 480);
  for (std::size_t i = 0; i < scan.beams.size(); ++i) {
    const Beam& beam = scan.beams[i];
    if (scan.azimuth_opening > radians(10.0)) {
      draw_lobe(frame, sensor, scan, beam, layers, overlay);
      continue;
    }
    const glm::dvec3 along = sensor.orientation * beam.direction;
    if (layers.rays && i % every == 0) overlay.line(sensor.position, sensor.position + beam.sensed_range * along, lidar ? frame.colours.lidar : frame.colours.ray);
    if (!layers.echoes) continue;
    for (const Echo& echo : scan.echoes_of(beam)) overlay.point(sensor.position + echo.range * along, lidar ? frame.colours.lidar | IM_COL32_A_MASK : frame.colours.echo, 2.0f);
  }
}

void draw_robot(const Frame& frame, const Simulation& s, Overlay& overlay) {
  const Hull hull = s.mission().vehicle.hull();
  const glm::dvec3 base = s.vehicle_pose().position, low = base + glm::dvec3(0.0, 0.0, hull.z_low), high = base + glm::dvec3(0.0, 0.0, hull.z_high);
  const ImU32 colour = frame.colours.robot;
  overlay.circle(low, hull.radius, colour, 2.0f);
  overlay.circle(high, hull.radius, frame.colours.robot_edge, 2.0f);
  for (int i = 0; i < 12; ++i) {
    const glm::dvec3 off(hull.radius * direction(2.0 * pi * i / 12.0), 0.0);
    overlay.line(low + off, high + off, colour);
  }
  const glm::dvec3 ahead(direction(s.vehicle().pose.yaw), 0.0);
  overlay.line(high, high + 2.5 * hull.radius * ahead, frame.colours.robot_edge, 2.5f);
  // How high it is above z = 0, where it is not on it.
  if (std::abs(base.z) > 0.05) {
    const glm::dvec3 ground(base.x, base.y, 0.0);
    overlay.line(ground, base, frame.colours.clearance, 1.5f);
    overlay.circle(ground, 0.3 * hull.radius, frame.colours.clearance);
    overlay.text(0.5 * (ground + base), frame.colours.clearance, fmt::format("{:.2f} m", base.z).c_str());
  }
}

void draw_trail(const Frame& frame, const Simulation& s, Overlay& overlay) {
  const Samples& samples = frame.now.samples;
  const std::size_t count = samples.count_until(s.steps()), every = std::max<std::size_t>(1, count / 1500);
  const double z = s.vehicle_pose().position.z + 0.02;
  for (std::size_t i = every; i < count + every - 1; i += every) {
    const glm::dvec2 from = samples[i - every].pose.position, to = samples[std::min(i, count - 1)].pose.position;
    overlay.line({from, z}, {to, z}, frame.colours.trail, 2.0f);
  }
}

void draw_goal(const Frame& frame, const Simulation& s, Overlay& overlay) {
  const PlannerSpec& planner = s.mission().planner;
  const double z = s.vehicle_pose().position.z + 0.02;
  const auto pole = [&](const glm::dvec2& at, const char* words) {
    overlay.circle({at, z}, std::max(0.15, planner.goal_tolerance_m), frame.colours.goal, 2.0f);
    overlay.line({at, z}, {at, z + 1.0}, frame.colours.goal, 2.0f);
    overlay.text({at, z + 1.0}, frame.colours.goal, words);
  };
  if (planner.goal_m) pole(*planner.goal_m, "goal");
  for (std::size_t i = 0; i < planner.waypoints_m.size(); ++i) pole(planner.waypoints_m[i], fmt::format("{}", i + 1).c_str());
}

}  // namespace

void draw_run(const Frame& frame, const SpaceLayers& layers, Overlay& overlay) {
  const Simulation& s = *frame.now.simulation;
  if (layers.trail) draw_trail(frame, s, overlay);
  draw_goal(frame, s, overlay);
  if (layers.rays || layers.echoes)
    for (std::size_t i = 0; i < s.scans().size(); ++i)
      if (!s.scans()[i].beams.empty()) draw_scan(frame, s.scans()[i], std::holds_alternative<LidarSpec>(s.mission().sensors[i]), layers, overlay);
  if (layers.robot) draw_robot(frame, s, overlay);
}

}  // namespace thicket::gui
