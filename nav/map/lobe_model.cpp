#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "rows.hpp"
#include "sensor_model.hpp"

namespace thicket {
namespace {

/// Cells [first, past) of a row.
struct Span {
  std::int64_t first = 0, past = 0;
  bool empty() const { return past <= first; }
};

/// Of cells whose middles are in [low, high], with what rounding may add, in cells from the row's begin, which lies before both.
Span cells_between(double low, double high) { return {static_cast<std::int64_t>(low + (0.5 - 1e-9)), static_cast<std::int64_t>(high + (0.5 + 1e-9))}; }

/// A sector of a disc with an opening of a right angle at most, in cells: what it has of a row.
class Sector {
 public:
  Sector(const glm::dvec2& from, double axis, double half) : from_(from), axis_(direction(axis)), right_(direction(axis - half)), left_(direction(axis + half)) {}

  /// The rectangle around the sector of radius 1 about the origin: its lower left and its upper right corner.
  std::pair<glm::dvec2, glm::dvec2> box() const {
    std::pair<glm::dvec2, glm::dvec2> box{glm::min(glm::dvec2(0.0), glm::min(right_, left_)), glm::max(glm::dvec2(0.0), glm::max(right_, left_))};
    for (const glm::dvec2& v : {glm::dvec2(1.0, 0.0), glm::dvec2(-1.0, 0.0), glm::dvec2(0.0, 1.0), glm::dvec2(0.0, -1.0)})
      if (glm::dot(v, axis_) > 0.0 && right_.x * v.y - right_.y * v.x >= 0.0 && v.x * left_.y - v.y * left_.x >= 0.0) box = {glm::min(box.first, v), glm::max(box.second, v)};
    return box;
  }

  /// Of the row whose middle is `y`, out to `radius`.
  Span row(double y, double radius) const {
    const double dy = y - from_.y, square = radius * radius - dy * dy;
    if (!(square > 0.0)) return {};
    double low = -std::sqrt(square), high = -low;
    // Left of the right side, right of the left one.
    clip(right_, right_slope_, dy, low, high);
    clip(-left_, left_slope_, dy, low, high);
    return cells_between(from_.x + low, from_.x + high);
  }

 private:
  /// side.x dy - side.y dx >= 0
  static void clip(const glm::dvec2& side, double slope, double dy, double& low, double& high) {
    if (side.y > 0.0) high = std::min(high, slope * dy);
    else if (side.y < 0.0) low = std::max(low, slope * dy);
    else if (side.x * dy < 0.0) high = low - 1.0;
  }
  glm::dvec2 from_, axis_, right_, left_;
  double right_slope_ = right_.x / right_.y, left_slope_ = left_.x / left_.y;  ///< infinite of a side along the rows, which does not ask for it
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
  if (reach <= 0.0) return;
  static const auto odds = for_levels<float>([](double log_odds) { return std::exp(log_odds); });
  const double sure = 0.5 * lobe_share_ * scan.azimuth_opening;
  arc_.clear();
  Arc arc{static_cast<float>(echo), static_cast<float>(1.0 / spread), odds.data()};
  const Code free = code_of(unseen_);
  for (int part = 0; part < parts; ++part) {
    const double middle = axis + half * (2 * part + 1 - parts);
    const Sector sector(from, middle, half);
    // Of the part whose silence counts.
    const double right = std::max(middle - half, axis - sure), left = std::min(middle + half, axis + sure);
    const Sector silent(from, 0.5 * (right + left), std::max(0.0, 0.5 * (left - right)));
    const auto [lowest, highest] = sector.box();
    window.mark(from + reach * lowest, from + reach * highest);
    const auto low = static_cast<std::int64_t>(std::floor(from.y + reach * lowest.y)), high = static_cast<std::int64_t>(std::floor(from.y + reach * highest.y));
    for (std::int64_t row = low; row <= high; ++row) {
      const double y = static_cast<double>(row) + 0.5;
      const Span whole = sector.row(y, reach);
      if (whole.empty()) continue;
      const Span inner = clear > 0.0 ? sector.row(y, clear) : Span{};
      Code* const codes = window.at(0, row);
      if (const Span told = left > right && clear > 0.0 ? silent.row(y, clear) : Span{}; !told.empty()) raise_all(codes + told.first, told.past - told.first, free);
      if (echoes.empty()) continue;
      const auto square = static_cast<float>((y - from.y) * (y - from.y));
      const auto add = [&](std::int64_t first, std::int64_t past) {
        for (std::int64_t x = first; x < past; x += piece_size) {
          Piece& piece = arc_.emplace_back();
          piece.codes = codes + x;
          const auto count = static_cast<int>(std::min<std::int64_t>(piece_size, past - x));
          prior.copy(x, row, count, piece.levels);
          add_piece(arc, static_cast<float>(static_cast<double>(x) + 0.5 - from.x), square, count, piece);
        }
      };
      if (inner.empty()) add(whole.first, whole.past);
      else {
        add(whole.first, inner.first);
        add(inner.past, whole.past);
      }
    }
  }
  const double all = std::accumulate(arc.sums.begin(), arc.sums.end(), 0.0);
  // A cell that is the one with a probability w, and else what it was: its odds rise by a factor of 1 + w / (p (1 - w)) with p its probability before. Most are too unlikely to be it for that to make a difference.
  const double least = 0.5 / evidence_per_nat;
  for (const Piece& piece : arc_) {
    if (static_cast<double>(piece.greatest) < least * least_probability_ * (all - static_cast<double>(piece.greatest))) continue;
    for (std::size_t i = 0; i < piece_size; ++i) {
      const double likelihood = static_cast<double>(piece.likelihood[i]), p = probability_of_level[piece.levels[i]], others = std::max(1e-12 * all, all - likelihood);
      if (likelihood <= 0.0 || likelihood < least * p * others) continue;
      const int evidence = std::min(evidence_of(1.0 + likelihood / (p * others)), hit_);
      if (evidence > 0) piece.codes[i] = std::max(piece.codes[i], code_of(evidence));
    }
  }
}

}  // namespace thicket
