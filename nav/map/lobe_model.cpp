#include <cmath>

#include <glm/geometric.hpp>

#include "sensor_model.hpp"

namespace thicket {
namespace {

/// Cells [first, past) of a row.
struct Span {
  std::int64_t first = 0, past = 0;
  bool empty() const { return past <= first; }
};

/// Of cells whose middles are in [low, high], in cells from the row's begin.
Span cells_between(double low, double high) { return {static_cast<std::int64_t>(std::ceil(low - 0.5)), static_cast<std::int64_t>(std::floor(high - 0.5)) + 1}; }

/// A sector of a disc with an opening of a right angle at most, in cells: what it has of a row.
class Sector {
 public:
  Sector(const glm::dvec2& from, double axis, double half) : from_(from), right_(direction(axis - half)), left_(direction(axis + half)) {}

  /// Of the row whose middle is `y`, out to `radius`.
  Span row(double y, double radius) const {
    const double dy = y - from_.y, square = radius * radius - dy * dy;
    if (!(square > 0.0)) return {};
    double low = -std::sqrt(square), high = -low;
    // Left of the right side, right of the left one.
    clip(right_, dy, low, high);
    clip(-left_, dy, low, high);
    return cells_between(from_.x + low, from_.x + high);
  }

 private:
  /// side.x dy - side.y dx >= 0
  static void clip(const glm::dvec2& side, double dy, double& low, double& high) {
    if (side.y > 0.0) high = std::min(high, side.x * dy / side.y);
    else if (side.y < 0.0) low = std::max(low, side.x * dy / side.y);
    else if (side.x * dy < 0.0) high = low - 1.0;
  }
  glm::dvec2 from_, right_, left_;
};

}  // namespace

void SensorModel::draw_lobe(const Scan& scan, const Beam& beam, const glm::dvec2& from, double axis, double shrink, const Odds& odds, Window& window) const {
  const auto echoes = scan.echoes_of(beam);
  const double scale = shrink / resolution_, spread = std::max(0.5, sigma(scan) / resolution_);
  const double echo = echoes.empty() ? INFINITY : echoes.front().range * scale;
  const double clear = std::min(beam.sensed_range * scale, echo - 2.0 * spread), reach = echoes.empty() ? clear : echo + 2.0 * spread;
  // In parts of a right angle at most, each the common part of two half planes.
  const int parts = std::max(1, static_cast<int>(std::ceil(scan.azimuth_opening / (0.5 * pi))));
  const double half = 0.5 * scan.azimuth_opening / parts;
  struct Candidate {
    std::int64_t column, row;
    double likelihood, odds;
  };
  std::vector<Candidate> arc;
  double all = 0.0;
  const CellIndex corner = window.corner();
  const Code free = code_of(unseen_);
  for (int part = 0; part < parts; ++part) {
    const Sector sector(from, axis + half * (2 * part + 1 - parts), half);
    const auto low = static_cast<std::int64_t>(std::floor(from.y - reach)), high = static_cast<std::int64_t>(std::floor(from.y + reach));
    for (std::int64_t row = low; row <= high; ++row) {
      const double y = static_cast<double>(row) + 0.5;
      const Span whole = sector.row(y, reach), inner = clear > 0.0 ? sector.row(y, clear) : Span{};
      Code* const codes = window.at(0, row);
      for (std::int64_t x = inner.first; x < inner.past; ++x) codes[x] = std::max(codes[x], free);
      if (echoes.empty()) continue;
      for (std::int64_t x = whole.first; x < whole.past; ++x) {
        if (!inner.empty() && x == inner.first) x = inner.past;
        if (x >= whole.past) break;
        const double off = (glm::distance(glm::dvec2(static_cast<double>(x) + 0.5, y), from) - echo) / spread;
        if (std::abs(off) > 2.0) continue;
        const double before = odds({corner.column + x, corner.row + row});
        arc.push_back({x, row, before * bell(off), before});
        all += arc.back().likelihood;
      }
    }
  }
  // A cell that is the one with a probability w, and else what it was: its odds rise by a factor of 1 + w / (p (1 - w)) with p = odds / (1 + odds). Most are too unlikely to be it for that to make a difference.
  const double least = 0.5 / evidence_per_nat;
  for (const Candidate& c : arc) {
    const double is_it = c.likelihood / all, rise = is_it * (1.0 + c.odds) / (c.odds * std::max(1e-12, 1.0 - is_it));
    if (rise < least) continue;
    const int whole = static_cast<int>(std::lround(std::min(evidence_per_nat * std::log1p(rise), static_cast<double>(hit_))));
    if (whole > 0) {
      Code& code = *window.at(c.column, c.row);
      code = std::max(code, code_of(whole));
    }
  }
}

}  // namespace thicket
