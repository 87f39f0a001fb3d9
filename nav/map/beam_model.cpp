#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "sensor_model.hpp"

namespace thicket {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// How far a beam has anything to say, m.
double reach_of(const Scan& scan, const Beam& beam) { return beam.echo_count > 0 ? std::max(beam.sensed_range, scan.echoes_of(beam).back().range) : beam.sensed_range; }

/// A straight line through the window, in cells from its corner.
struct Line {
  glm::dvec2 from, along;  ///< a unit vector
  glm::dvec2 at(double distance) const { return from + distance * along; }
};

/// All cells that a line meets from `begin` to `end`, get a code that is the least there is, so that nothing need be compared: in each column (of a steep line, row) those from where it enters to where it leaves, which are
/// two at most. They are those that Amanatides & Woo's walk (1987) visits, without its branches.
template <bool steep>
void fill(Window& window, const Line& line, double begin, double end, Code code) {
  const auto major = [](const glm::dvec2& p) { return steep ? p.y : p.x; };
  const auto minor = [](const glm::dvec2& p) { return steep ? p.x : p.y; };
  const std::int64_t stride = window.stride(), major_step = steep ? stride : 1, minor_step = steep ? 1 : stride;
  Code* const codes = window.at(0, 0);
  glm::dvec2 low = line.at(begin), high = line.at(end);
  if (major(low) > major(high)) std::swap(low, high);
  const double slope = minor(line.along) / major(line.along);
  const auto first = static_cast<std::int64_t>(major(low)), last = static_cast<std::int64_t>(major(high));
  // Fixed point, 32 bits of fraction: windows are far smaller than 2^31 cells.
  constexpr double one = 4294967296.0;
  const auto fixed = [](double x) { return static_cast<std::int64_t>(x * one); };
  std::int64_t row = static_cast<std::int64_t>(minor(low));
  Code* column = codes + first * major_step;
  if (first == last) {
    column[row * minor_step] = code;
    column[static_cast<std::int64_t>(minor(high)) * minor_step] = code;
    return;
  }
  std::int64_t leaves = fixed(minor(low) + slope * (static_cast<double>(first + 1) - major(low)));
  const std::int64_t per_column = fixed(slope);
  for (std::int64_t c = first; c < last; ++c, column += major_step, leaves += per_column) {
    const std::int64_t next = leaves >> 32;
    column[row * minor_step] = code;
    column[next * minor_step] = code;
    row = next;
  }
  column[row * minor_step] = code;
  column[static_cast<std::int64_t>(minor(high)) * minor_step] = code;
}

void fill(Window& window, const Line& line, double begin, double end, Code code) {
  if (end <= begin) return;
  if (std::abs(line.along.y) > std::abs(line.along.x)) fill<true>(window, line, begin, end, code);
  else fill<false>(window, line, begin, end, code);
}

/// Calls `use(column, row, enters, leaves)` for every cell that a line meets between two distances.
template <class Use>
void walk(const Line& line, double begin, double end, Use&& use) {
  const glm::dvec2 start = line.at(begin);
  auto column = static_cast<std::int64_t>(start.x), row = static_cast<std::int64_t>(start.y);
  const glm::dvec2 d = line.along;
  const double step_x = d.x != 0.0 ? std::abs(1.0 / d.x) : never, step_y = d.y != 0.0 ? std::abs(1.0 / d.y) : never;
  const auto to_edge = [](double at, double towards) { return towards > 0.0 ? std::floor(at) + 1.0 - at : at - std::floor(at); };
  double next_x = d.x != 0.0 ? begin + to_edge(start.x, d.x) * step_x : never, next_y = d.y != 0.0 ? begin + to_edge(start.y, d.y) * step_y : never;
  for (double at = begin; at < end;) {
    const bool sideways = next_x < next_y;
    const double leaves = sideways ? next_x : next_y;
    use(column, row, at, std::min(leaves, end));
    at = leaves;
    if (sideways) {
      column += d.x > 0.0 ? 1 : -1;
      next_x += step_x;
    } else {
      row += d.y > 0.0 ? 1 : -1;
      next_y += step_y;
    }
  }
}

void raise(Code& code, Code to) { code = std::max(code, to); }

// Matter lies behind its face: as deep as this, in cells, a face tells of it. (Else cells of which the middle is matter would be left out wherever the face is in the cell before.)
constexpr double depth = 0.5;

// Of cells that may have given an echo that is not sure: what counts is half a nat and more, else one look would leave a veil of cells a little more likely than not behind every wall; and it counts for a third of a nat at most, for
// neighbouring beams tell the same story. Found by what makes the best map of the hall of docs/mapping.md, at a sigma of 1.5 cells.
constexpr int least_told = 16, most_told = 10;

// A surface that lies on the border of two cells, as in worlds with round numbers, is matter in the one behind it, whatever the last bit of its range.
constexpr double on_border = 0.01;

bool inside_after(const Echo& echo) { return echo.edge == Edge::front || echo.edge == Edge::inner; }

}  // namespace

SensorModel::SensorModel(const MapSpec& spec)
    : resolution_(spec.resolution_m),
      sigma_(spec.range_sigma_m.value_or(-1.0)),
      lobe_share_(spec.lobe_share),
      least_probability_(0.99 * spec.clamp_low),  // and rounding
      hit_(static_cast<int>(std::lround(evidence_per_nat * std::log(spec.probability_hit / (1.0 - spec.probability_hit))))),
      miss_(static_cast<int>(std::lround(evidence_per_nat * std::log(spec.probability_miss / (1.0 - spec.probability_miss))))),
      unseen_(static_cast<int>(std::lround(evidence_per_nat * std::log(1.0 - spec.probability_detection)))),
      probability_missed_(for_levels([this](double log_odds) { return 1.0 / (1.0 + std::exp(-(log_odds + miss_ / evidence_per_nat))); })) {}

double SensorModel::sigma(const Scan& scan) const { return sigma_ >= 0.0 ? sigma_ : scan.range_noise; }

double SensorModel::reach(const Scan& scan) const {
  double reach = 0.0;
  for (const Beam& beam : scan.beams) reach = std::max(reach, reach_of(scan, beam));
  return reach + 3.0 * sigma(scan);
}

void SensorModel::draw(const Scan& scan, const Pose& sensor, Prior& prior, Window& window) const {
  if (scan.azimuth_opening <= 0.0) return draw_beams(scan, sensor, prior, window);
  const glm::dvec2 from = window.place_of(glm::dvec2(sensor.position), resolution_);
  for (const Beam& beam : scan.beams) {
    const glm::dvec2 along(sensor.orientation * beam.direction);
    const double shrink = glm::length(along);  // of a beam that climbs or falls, its plan
    if (shrink > 1e-9) draw_lobe(scan, beam, from, std::atan2(along.y, along.x), shrink, prior, window);
  }
}

void SensorModel::draw_beams(const Scan& scan, const Pose& sensor, Prior& prior, Window& window) const {
  const glm::dvec2 from = window.place_of(glm::dvec2(sensor.position), resolution_);
  const double spread = sigma(scan) / resolution_;
  const bool sure = spread < 0.5;  // then an echo is in its cell
  const double about = 2.0 * spread;  // an echo that is not sure comes from within this
  const Code free = code_of(miss_);
  const auto for_beams = [&](auto&& use) {
    for (const Beam& beam : scan.beams) {
      const glm::dvec2 along(sensor.orientation * beam.direction);
      const double shrink = glm::length(along);  // of a beam that climbs or falls, its plan
      if (shrink > 1e-9) use(beam, Line{from, along / shrink}, shrink / resolution_);
    }
  };
  for_beams([&](const Beam& beam, const Line& line, double scale) {
    const glm::dvec2 end = line.at(reach_of(scan, beam) * scale + std::max(depth + 1.0, about));
    window.mark(glm::min(line.from, end), glm::max(line.from, end));
  });
  // First what is free, which is the least that can be said; then whatever counts more.
  for_beams([&](const Beam& beam, const Line& line, double scale) {
    double begin = 0.0;
    bool inside = beam.starts_inside;
    for (const Echo& echo : scan.echoes_of(beam)) {
      const double at = echo.range * scale;
      if (!inside) fill(window, line, begin, sure ? at - on_border : at - about, free);
      begin = sure ? at + on_border : at;
      inside = inside_after(echo);
    }
    if (!inside) fill(window, line, begin, beam.sensed_range * scale - (beam.end == BeamEnd::stopped ? on_border : 0.0), free);
  });
  for_beams([&](const Beam& beam, const Line& line, double scale) {
    double begin = 0.0;
    bool inside = beam.starts_inside;
    const auto through = [&](double end) {
      walk(line, begin, end, [&](std::int64_t column, std::int64_t row, double, double) {
        raise(*window.at(column, row), free);
        window.set_through(column, row);
      });
    };
    for (const Echo& echo : scan.echoes_of(beam)) {
      const double at = echo.range * scale;
      if (inside) through(at - on_border);
      begin = at + on_border;
      inside = inside_after(echo);
      if (sure) {
        const auto hit = [&](std::int64_t column, std::int64_t row, double, double) { raise(*window.at(column, row), code_of(hit_)); };
        if (inside) {
          const double next = &echo + 1 < scan.echoes.data() + beam.first_echo + beam.echo_count ? (&echo + 1)->range * scale - on_border : INFINITY;
          walk(line, at + on_border, std::max(at + 2.0 * on_border, std::min(at + depth, next)), hit);
        } else {
          const glm::dvec2 point = line.at(at + (echo.edge == Edge::back ? -on_border : on_border));
          hit(static_cast<std::int64_t>(point.x), static_cast<std::int64_t>(point.y), 0.0, 0.0);
        }
        continue;
      }
      candidates_.clear();
      double all = 0.0;
      walk(line, std::max(0.0, at - about), at + about, [&](std::int64_t column, std::int64_t row, double enters, double leaves) {
        const double off = (0.5 * (enters + leaves) - at) / spread;
        const Level level = *prior.at(column, row);
        const double likelihood = (leaves - enters) * odds_of_level[level] * bell(off);
        candidates_.push_back({window.at(column, row), static_cast<float>(likelihood), level});
        all += likelihood;
      });
      // If the matter is farther on, the beam went through this cell; if it is nearer, nothing is said of it.
      const double share = 1.0 / all;
      double nearer = 0.0;
      for (const Candidate& c : candidates_) {
        const double here = static_cast<double>(c.likelihood) * share, farther = std::max(0.0, 1.0 - here - nearer);
        const double after = here + farther * probability_missed_[c.level] + nearer * probability_of_level[c.level];
        const int evidence = std::clamp(evidence_of(after / (std::max(1e-12, 1.0 - after) * odds_of_level[c.level])), miss_, hit_);
        if (evidence < 0 || evidence >= least_told) raise(*c.code, code_of(std::min(evidence, most_told)));
        else if (nearer < 0.5) raise(*c.code, code_of(0));
        nearer += here;
      }
    }
    if (inside) through(beam.sensed_range * scale - (beam.end == BeamEnd::stopped ? on_border : 0.0));
  });
}

}  // namespace thicket
