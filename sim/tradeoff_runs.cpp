// Single runs of the study of the trade, and how far one is from another.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <fstream>
#include <string>

#include <glm/geometric.hpp>

#include "thicket/sim/map_score.hpp"
#include "tradeoff_parts.hpp"

namespace thicket {
namespace {

constexpr double between_moments_s = 0.2, between_places_m = 0.05;

/// Linux forgets the most memory that this process ever had; without it the peak is of all runs so far, and not told.
bool forget_peak() {
  std::ofstream file("/proc/self/clear_refs");
  return static_cast<bool>(file << "5" << std::flush);
}
std::optional<double> peak_mb() {
  std::ifstream file("/proc/self/status");
  for (std::string word; file >> word;)
    if (double kilobytes = 0.0; word == "VmHWM:" && file >> kilobytes) return kilobytes / 1024.0;
  return std::nullopt;
}

/// What scans of one kind add up to.
struct Sums {
  double squares = 0.0;
  std::size_t both = 0, one = 0, beams = 0;
  std::vector<double> decibels;

  void add(const Scan& reference, const Beam& a, const Scan& other, const Beam& b) {
    ++beams;
    one += (a.echo_count > 0) != (b.echo_count > 0);
    if (a.echo_count == 0 || b.echo_count == 0) return;
    const Echo &first = reference.echoes[a.first_echo], &its = other.echoes[b.first_echo];
    ++both;
    squares += (first.range - its.range) * (first.range - its.range);
    if (first.amplitude > 0.0f && its.amplitude > 0.0f) decibels.push_back(std::abs(20.0 * std::log10(static_cast<double>(its.amplitude) / static_cast<double>(first.amplitude))));
  }
};

/// The beam nearest in azimuth; of equally near ones the first. `scan` has beams.
const Beam& nearest_beam(const Scan& scan, double azimuth) {
  return *std::ranges::min_element(scan.beams, {}, [azimuth](const Beam& beam) { return std::abs(wrap_angle(beam.azimuth - azimuth)); });
}

double distance_to_way(const glm::dvec2& p, const std::vector<glm::dvec2>& way) {
  double least = glm::distance(p, way.front());
  for (std::size_t i = 1; i < way.size(); ++i) {
    const glm::dvec2 along = way[i] - way[i - 1];
    const double length = glm::dot(along, along), t = length > 0.0 ? std::clamp(glm::dot(p - way[i - 1], along) / length, 0.0, 1.0) : 0.0;
    least = std::min(least, glm::distance(p, way[i - 1] + t * along));
  }
  return least;
}

double mean_distance(const std::vector<glm::dvec2>& from, const std::vector<glm::dvec2>& to) {
  double sum = 0.0;
  for (const glm::dvec2& p : from) sum += distance_to_way(p, to);
  return sum / static_cast<double>(from.size());
}

}  // namespace

Result<TradeRun> trade_run(const Mission& mission, const Scene& scene, bool score, const std::function<bool()>& interrupted) {
  auto simulation = Simulation::create(mission, scene);
  if (!simulation) return simulation.error();
  TradeRun run;
  double due = 0.0;
  const auto note = [&] {
    const glm::dvec2& place = simulation->vehicle().pose.position;
    if (run.way.empty() || glm::distance(place, run.way.back()) > between_places_m) run.way.push_back(place);
    if (simulation->time() < due - 1e-9) return;
    run.moments.push_back({simulation->time(), simulation->platform()});
    due += between_moments_s;
  };
  const bool fresh = forget_peak();
  const std::clock_t cpu = std::clock();
  const auto wall = std::chrono::steady_clock::now();
  note();
  while (simulation->step()) {
    note();
    if (interrupted && simulation->steps() % 16 == 0 && interrupted()) simulation->stop("interrupted");
  }
  run.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count();
  run.cpu_s = static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
  if (fresh) run.peak_mb = peak_mb();
  run.way.push_back(simulation->vehicle().pose.position);
  run.simulated_s = simulation->time();
  run.rays = simulation->totals().rays;
  run.map_bytes = mission.map.enabled ? simulation->map().memory_bytes() : 0;
  run.verdict = *simulation->verdict();
  if (!score) return run;
  if (const auto judged = score_run(*simulation)) run.map_f1 = judged->map.f1;  // without a map, or with nothing known, there is none
  return run;
}

std::vector<TradeMoment> thinned(const std::vector<TradeMoment>& moments, std::size_t most) {
  if (moments.size() <= most) return moments;
  std::vector<TradeMoment> list;
  for (std::size_t i = 0; i < most; ++i) list.push_back(moments[i * moments.size() / most]);
  return list;
}

std::vector<Scan> measured(const Mission& mission, const Scene& given, const std::vector<TradeMoment>& moments, std::uint64_t seed) {
  Scene scene = given;
  std::vector<std::shared_ptr<const Sensor>> sensors;
  for (std::size_t s = 0; s < mission.sensors.size(); ++s) sensors.push_back(make_sensor(mission.sensors[s], static_cast<std::uint16_t>(s)));
  std::vector<Scan> scans;
  for (std::size_t m = 0; m < moments.size(); ++m) {
    scene.set_time(moments[m].time);
    for (std::size_t s = 0; s < sensors.size(); ++s)
      sensors[s]->measure(scene, moments[m].platform, moments[m].time, m, Random(seed, static_cast<std::uint16_t>(s)), scans.emplace_back());
  }
  return scans;
}

void compare_scans(const std::vector<Scan>& reference, const std::vector<Scan>& other, TradeError& error) {
  Sums sums;
  for (std::size_t s = 0; s < std::min(reference.size(), other.size()); ++s) {
    if (other[s].beams.empty()) continue;
    for (const Beam& beam : reference[s].beams) sums.add(reference[s], beam, other[s], nearest_beam(other[s], beam.azimuth));
  }
  if (sums.beams == 0) return;
  error.disagreement = static_cast<double>(sums.one) / static_cast<double>(sums.beams);
  if (sums.both > 0) error.range_rmse_m = std::sqrt(sums.squares / static_cast<double>(sums.both));
  if (sums.decibels.empty()) return;
  const auto middle = sums.decibels.begin() + static_cast<std::ptrdiff_t>(sums.decibels.size() / 2);
  std::ranges::nth_element(sums.decibels, middle);
  error.amplitude_db = *middle;
}

double way_distance(const std::vector<glm::dvec2>& a, const std::vector<glm::dvec2>& b) {
  if (a.empty() || b.empty()) return TradeError::none;
  return std::max(mean_distance(a, b), mean_distance(b, a));
}

TradeError trade_error(const TradeRun& reference, const TradeRun& run, const std::vector<Scan>& reference_scans, const std::vector<Scan>& scans) {
  TradeError error;
  compare_scans(reference_scans, scans, error);
  error.map_f1 = run.map_f1;
  error.map_f1_loss = std::isfinite(reference.map_f1 - run.map_f1) ? std::max(0.0, reference.map_f1 - run.map_f1) : TradeError::none;
  error.path_m = way_distance(reference.way, run.way);
  // What ran until it was cut short is not the same as what stopped by itself.
  const auto cut = [](const Verdict& verdict) { return verdict.reason == "interrupted" || verdict.reason.starts_with("time limit"); };
  error.same_verdict = reference.verdict.kind == run.verdict.kind && cut(reference.verdict) == cut(run.verdict);
  return error;
}

double TradeError::total() const {
  double squares = 0.0;
  int count = 0;
  const auto add = [&](double value, double tolerance) {
    if (!std::isfinite(value)) return;
    squares += value * value / (tolerance * tolerance);
    ++count;
  };
  add(range_rmse_m, trade_tolerances.range_m);
  add(amplitude_db, trade_tolerances.amplitude_db);
  add(disagreement, trade_tolerances.disagreement);
  add(map_f1_loss, trade_tolerances.map_f1);
  add(path_m, trade_tolerances.path_m);
  return count ? std::sqrt(squares / count) : none;
}

}  // namespace thicket
