// What the sensors' beams did, from above.
#include <algorithm>
#include <bit>
#include <cmath>

#include <glm/geometric.hpp>

#include "plan.hpp"

namespace thicket::gui {
namespace {

/// One way of a beam with one look.
struct Piece {
  double from = 0.0, to = 0.0;  ///< m, in the plane
  ImU32 colour = 0;
};

/// Draws all beams of a scan.
class BeamPainter {
 public:
  BeamPainter(const Frame& frame, const PlanCamera& camera, const Layers& layers, const Scan& scan, bool light, ImDrawList& draw)
      : frame_(frame), camera_(camera), layers_(layers), scan_(scan), light_(light), draw_(draw) {
    const Pose2 then = pose_at(frame.now, scan.time);
    sensor_ = Pose::planar(then.position.x, then.position.y, 0.0, then.yaw) * Pose{scan.mount_position, scan.mount_orientation};
    origin_ = camera.to_screen(glm::dvec2(sensor_.position));
    for (const Echo& echo : scan.echoes) strongest_ = std::max(strongest_, static_cast<double>(echo.amplitude));
  }

  void rays() {
    double farthest = 0.0;
    for (const Beam& beam : scan_.beams) farthest = std::max(farthest, beam.sensed_range);
    const double circle = 2.0 * pi * farthest * camera_.pixels_per_metre;
    // Bins of bearings that the screen can tell apart. With more beams than every other bin has, each bin is one wedge.
    const auto bins = static_cast<std::size_t>(std::clamp(circle / 3.0, 64.0, 2048.0));
    if (scan_.beams.size() > bins) wedges(bins);
    else lines();
  }

  void echoes() {
    const float size = static_cast<float>(frame_.scale) * (scan_.echoes.size() > 2000 ? 1.0f : 1.8f);
    ImVec2 last{-1e9f, -1e9f};
    for (const Beam& beam : scan_.beams)
      for (const Echo& echo : scan_.echoes_of(beam)) {
        const ImVec2 at = screen(beam, echo.range);
        if (std::abs(at.x - last.x) < 1.0f && std::abs(at.y - last.y) < 1.0f) continue;
        last = at;
        const ImU32 colour = light_ ? with_alpha(frame_.colours.lidar, 2.2) : echo.edge == Edge::back ? with_alpha(frame_.colours.echo, 0.45) : frame_.colours.echo;
        draw_.AddRectFilled({at.x - size, at.y - size}, {at.x + size, at.y + size}, colour);
      }
  }

  /// Opening of each beam, and the arcs on which its echoes lie.
  void lobes() {
    for (const Beam& beam : scan_.beams) {
      const glm::dvec2 axis(sensor_.orientation * beam.direction);
      const double middle = bearing(axis), half = 0.5 * scan_.azimuth_opening;
      const double reach = beam.sensed_range;
      std::vector<ImVec2> points{origin_};
      arc(middle, half, reach, points);
      fan(points, with_alpha(frame_.colours.lobe, 1.0));
      points.push_back(origin_);
      draw_.AddPolyline(points.data(), static_cast<int>(points.size()), with_alpha(frame_.colours.lobe, 3.0), 0, 1.0f);
      for (const Echo& echo : scan_.echoes_of(beam)) {
        points.clear();
        arc(middle, half, echo.range, points);
        draw_.AddPolyline(points.data(), static_cast<int>(points.size()), frame_.colours.echo, 0, 2.0f);
      }
    }
  }

 private:
  glm::dvec2 flat(const Beam& beam) const { return glm::dvec2(sensor_.orientation * beam.direction); }
  ImVec2 screen(const Beam& beam, double range) const { return camera_.to_screen(glm::dvec2(sensor_.position) + range * flat(beam)); }
  ImVec2 at(double bearing, double range) const { return camera_.to_screen(glm::dvec2(sensor_.position) + range * direction(bearing)); }

  void arc(double middle, double half, double range, std::vector<ImVec2>& points) const {
    constexpr int count = 32;
    for (int i = 0; i <= count; ++i) points.push_back(at(middle - half + 2.0 * half * i / count, range));
  }
  void fan(const std::vector<ImVec2>& points, ImU32 colour) {
    const ImDrawListFlags flags = draw_.Flags;
    draw_.Flags &= ~ImDrawListFlags_AntiAliasedFill;  // neighbours would show seams
    for (std::size_t i = 2; i < points.size(); ++i) draw_.AddTriangleFilled(points[0], points[i - 1], points[i], colour);
    draw_.Flags = flags;
  }

  ImU32 plain() const { return light_ ? frame_.colours.lidar : frame_.colours.ray; }

  /// How a beam is drawn, in pieces by range along it. At most a few.
  void pieces_of(const Beam& beam, std::vector<Piece>& pieces) const {
    pieces.clear();
    const auto echoes = scan_.echoes_of(beam);
    if (light_) return pieces.push_back({0.0, beam.sensed_range, with_alpha(plain(), 0.6)});
    if (layers_.ray_mode == Layers::Rays::side) {
      const ImU32 colour = beam.side > 0 ? frame_.colours.side_left : beam.side < 0 ? frame_.colours.side_right : with_alpha(frame_.colours.ray, 0.8);
      return pieces.push_back({0.0, beam.sensed_range, colour});
    }
    if (layers_.ray_mode == Layers::Rays::amplitude) {
      double amplitude = 0.0;
      for (const Echo& echo : echoes) amplitude = std::max(amplitude, static_cast<double>(echo.amplitude));
      if (amplitude <= 0.0) return pieces.push_back({0.0, beam.sensed_range, with_alpha(frame_.colours.faint, 0.25)});
      const double weak = std::clamp(-20.0 * std::log10(amplitude / strongest_) / 40.0, 0.0, 1.0);  // 40 dB down: the end of the ramp
      return pieces.push_back({0.0, beam.sensed_range, ramp(weak, 0.42)});
    }
    // By depth: bright in the open, then by how much matter was passed so far.
    bool inside = beam.starts_inside;
    double from = 0.0, depth = 0.0;
    const auto piece = [&](double to) {
      if (to > from) pieces.push_back({from, to, !inside && depth == 0.0 ? with_alpha(frame_.colours.ray, 0.8) : ramp(0.2 + 0.8 * (depth + (inside ? 0.5 * (to - from) : 0.0)) / 1.0, inside ? 0.75 : 0.42)});
      if (inside) depth += std::max(0.0, to - from);
      from = std::max(from, to);
    };
    for (const Echo& echo : echoes) {
      if (echo.edge == Edge::thin || echo.range > beam.sensed_range) continue;
      piece(echo.range);
      inside = echo.edge != Edge::back;
    }
    piece(beam.sensed_range);
  }

  void lines() {
    std::vector<Piece> pieces;
    const auto thick = static_cast<float>(frame_.scale);
    const ImDrawListFlags flags = draw_.Flags;
    // Thin and translucent as they are, soft edges would not be seen, and take a software renderer twice the time.
    draw_.Flags &= ~(ImDrawListFlags_AntiAliasedLines | ImDrawListFlags_AntiAliasedLinesUseTex);
    const double thinned = thinned_until();
    for (std::size_t i = 0; i < scan_.beams.size(); ++i) {
      // Every other beam begins where there is room between its neighbours, of the rest every other one at half that range, and so on; whole if it ends there.
      const Beam& beam = scan_.beams[i];
      // Not all at one range, which would be seen as a ring that is not there.
      const double scatter = 0.5 + std::fmod(0.618034 * static_cast<double>(i / 2), 1.0);
      double from = std::ldexp(scatter * thinned, -std::min(8, std::countr_zero(i | 256u)));
      if (beam.sensed_range < 1.2 * from) from = 0.0;
      pieces_of(beam, pieces);
      for (const Piece& piece : pieces)
        if (piece.to > from) draw_.AddLine(screen(beam, std::max(from, piece.from)), screen(beam, piece.to), piece.colour, thick);
    }
    draw_.Flags = flags;
  }
  /// Up to this range, m, level beams are so near to one another on the screen that they can hardly be told apart.
  double thinned_until() const {
    if (scan_.beams.size() < 16 || std::abs(flat(scan_.beams[0]).x) + std::abs(flat(scan_.beams[0]).y) < 0.99) return 0.0;
    const double step = std::abs(wrap_angle(scan_.beams[1].azimuth - scan_.beams[0].azimuth));
    return step > 1e-6 && step < 0.1 ? 2.2 / (step * camera_.pixels_per_metre) : 0.0;
  }

  /// Of beams that the screen cannot tell apart the longest stands for all.
  void wedges(std::size_t bins) {
    std::vector<std::pair<double, const Beam*>> longest(bins, {-1.0, nullptr});
    for (const Beam& beam : scan_.beams) {
      const glm::dvec2 along = flat(beam);
      const double share = bearing(along) / (2.0 * pi) + 0.5, range = glm::length(along) * beam.sensed_range;
      auto& bin = longest[std::min(bins - 1, static_cast<std::size_t>(share * static_cast<double>(bins)))];
      if (range > bin.first) bin = {range, &beam};
    }
    // Neighbours fill gaps of a bin or two between beams; a sector's border stays one.
    const std::size_t reach = scan_.beams.size() < bins ? bins / scan_.beams.size() + 1 : 1;
    std::vector<Piece> pieces;
    for (std::size_t i = 0; i < bins; ++i) {
      if (!longest[i].second) continue;
      std::size_t past = i + 1;
      while (past < bins && past < i + reach && !longest[past].second) ++past;
      const double low = (static_cast<double>(i) / static_cast<double>(bins) - 0.5) * 2.0 * pi, high = (static_cast<double>(past) / static_cast<double>(bins) - 0.5) * 2.0 * pi;
      const double slope = longest[i].first / std::max(1e-9, longest[i].second->sensed_range);
      pieces_of(*longest[i].second, pieces);
      for (const Piece& piece : pieces) wedge(low, high, slope * piece.from, slope * piece.to, piece.colour);
    }
  }
  void wedge(double low, double high, double from, double to, ImU32 colour) {
    const ImU32 thin = with_alpha(colour, 0.75);
    const ImDrawListFlags flags = draw_.Flags;
    draw_.Flags &= ~ImDrawListFlags_AntiAliasedFill;
    if (from <= 0.0) draw_.AddTriangleFilled(origin_, at(low, to), at(high, to), thin);
    else draw_.AddQuadFilled(at(low, from), at(low, to), at(high, to), at(high, from), thin);
    draw_.Flags = flags;
  }

  const Frame& frame_;
  const PlanCamera& camera_;
  const Layers& layers_;
  const Scan& scan_;
  bool light_;
  ImDrawList& draw_;
  Pose sensor_;
  ImVec2 origin_;
  double strongest_ = 1e-30;
};

}  // namespace

void draw_scans(const Frame& frame, const PlanCamera& camera, const Layers& layers, ImDrawList& draw) {
  const Simulation& simulation = *frame.now.simulation;
  for (std::size_t i = 0; i < simulation.scans().size(); ++i) {
    const Scan& scan = simulation.scans()[i];
    if (scan.beams.empty()) continue;
    const bool light = i < simulation.mission().sensors.size() && std::holds_alternative<LidarSpec>(simulation.mission().sensors[i]);
    BeamPainter painter(frame, camera, layers, scan, light, draw);
    if (light) {
      if (!layers.lidar) continue;
      painter.rays();
      painter.echoes();
    } else if (scan.azimuth_opening > 0.0) {
      if (layers.lobes) painter.lobes();
    } else {
      if (layers.rays) painter.rays();
      if (layers.echoes) painter.echoes();
    }
  }
}

}  // namespace thicket::gui
