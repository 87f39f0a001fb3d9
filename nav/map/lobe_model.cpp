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

void SensorModel::draw_lobe(const Scan& scan, const Beam& beam, const glm::dvec2& from, double axis, double shrink, Prior& prior, Window& window) const {
  const auto echoes = scan.echoes_of(beam);
  const double scale = shrink / resolution_, spread = std::max(0.5, sigma(scan) / resolution_);
  const double echo = echoes.empty() ? INFINITY : echoes.front().range * scale;
  const double clear = std::min(beam.sensed_range * scale, echo - 2.0 * spread), reach = echoes.empty() ? clear : echo + 2.0 * spread;
  // In parts of a right angle at most, each the common part of two half planes.
  const int parts = std::max(1, static_cast<int>(std::ceil(scan.azimuth_opening / (0.5 * pi))));
  const double half = 0.5 * scan.azimuth_opening / parts;
  struct Candidate {
    Code* code;
    float likelihood;
    Level level;
  };
  static thread_local std::vector<Candidate> arc;
  arc.clear();
  double all = 0.0;
  const Code free = code_of(unseen_);
  const double per_spread = 1.0 / spread;
  for (int part = 0; part < parts; ++part) {
    const Sector sector(from, axis + half * (2 * part + 1 - parts), half);
    const auto low = static_cast<std::int64_t>(std::floor(from.y - reach)), high = static_cast<std::int64_t>(std::floor(from.y + reach));
    for (std::int64_t row = low; row <= high; ++row) {
      const double y = static_cast<double>(row) + 0.5;
      const Span whole = sector.row(y, reach);
      if (whole.empty()) continue;
      const Span inner = clear > 0.0 ? sector.row(y, clear) : Span{};
      Code* const codes = window.at(0, row);
      for (std::int64_t x = inner.first; x < inner.past; ++x) codes[x] = std::max(codes[x], free);
      if (echoes.empty()) continue;
      const double square = (y - from.y) * (y - from.y);
      const auto add = [&](Span span) {
        for (std::int64_t x = span.first; x < span.past;) {
          // As far as the tile goes.
          const std::int64_t past = std::min(span.past, (x | (tile_size - 1)) + 1);
          for (const Level* level = prior.at(x, row); x < past; ++x, ++level) {
            const double along = static_cast<double>(x) + 0.5 - from.x, off = (std::sqrt(along * along + square) - echo) * per_spread;
            if (std::abs(off) > 2.0) continue;
            const double likelihood = odds_of_level[*level] * bell(off);
            arc.push_back({codes + x, static_cast<float>(likelihood), *level});
            all += likelihood;
          }
        }
      };
      if (inner.empty()) add(whole);
      else {
        add({whole.first, inner.first});
        add({inner.past, whole.past});
      }
    }
  }
  // A cell that is the one with a probability w, and else what it was: its odds rise by a factor of 1 + w / (p (1 - w)). Most are too unlikely to be it for that to make a difference.
  const double least = 0.5 / evidence_per_nat;
  for (const Candidate& c : arc) {
    const double likelihood = static_cast<double>(c.likelihood), p = probability_of_level[c.level], others = std::max(1e-12 * all, all - likelihood);
    if (likelihood < least * p * others) continue;
    const int evidence = std::min(evidence_of(1.0 + likelihood / (p * others)), hit_);
    if (evidence > 0) *c.code = std::max(*c.code, code_of(evidence));
  }
}

}  // namespace thicket
