// What a study of the trade leaves: tables, JSON, charts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "plot.hpp"
#include "thicket/base/files.hpp"
#include "thicket/sim/tradeoff.hpp"

namespace thicket {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no NaN: what is not finite is null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
std::string figure(double value, int digits = 3) { return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "-"; }
/// For CSV: shortest digits, nothing for NaN.
std::string field(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

std::string changes_text(const std::vector<Override>& changes) {
  std::string text;
  for (const Override& change : changes) text += (text.empty() ? "" : " ") + change.key + "=" + change.value;
  return text;
}

Json error_json(const TradeError& e) {
  return {{"total", number(e.total())},         {"range_rmse_m", number(e.range_rmse_m)}, {"amplitude_db", number(e.amplitude_db)}, {"detection_disagreement", number(e.disagreement)},
          {"map_f1", number(e.map_f1)},         {"map_f1_loss", number(e.map_f1_loss)},   {"path_m", number(e.path_m)},             {"same_verdict", e.same_verdict}};
}

Json interval_json(const Interval& i) { return {{"ratio", number(i.value)}, {"low_95", number(i.low)}, {"high_95", number(i.high)}}; }

std::string with_interval(const Interval& i) { return std::isfinite(i.low) && i.low < i.high ? fmt::format("{:.2f} ({:.2f}-{:.2f})", i.value, i.low, i.high) : fmt::format("{:.2f}", i.value); }

std::vector<std::size_t> front_of(const Tradeoff& study) {
  std::vector<std::size_t> list;
  for (std::size_t i = 0; i < study.points.size(); ++i)
    if (study.points[i].on_front) list.push_back(i);
  std::ranges::stable_sort(list, [&](std::size_t a, std::size_t b) { return study.points[a].cpu.value < study.points[b].cpu.value; });
  return list;
}

/// Errors below this are drawn at it: the reference's own is 0.
constexpr double least_drawn = 0.01;

glm::dvec2 place(const TradePoint& p) { return {std::log10(p.cpu.value), std::log10(std::max(least_drawn, p.error.total()))}; }

Sheet chart(const Tradeoff& study) {
  Series all{"one knob turned", Series::Kind::points, plot_colour(5), {}, {}}, pairs{"several", Series::Kind::points, plot_colour(3), {}, {}};
  Series other{"another verdict than the reference's", Series::Kind::points, plot_colour(6), {}, {}};
  Series line{"Pareto front", Series::Kind::line, plot_colour(1), {}, {}}, front{"", Series::Kind::rings, plot_colour(1), {}, {}};
  Series advice{"recommended", Series::Kind::rings, plot_colour(2), {}, {}};
  std::vector<bool> told(study.points.size(), false);
  for (const Recommendation& r : study.recommended) {
    advice.points.push_back(place(study.points[r.point]));
    advice.labels.push_back(told[r.point] ? r.name : r.name + ": " + study.points[r.point].name);
    told[r.point] = true;
  }
  for (const std::size_t i : front_of(study)) {
    line.points.push_back(place(study.points[i]));
    if (told[i]) continue;
    front.points.push_back(line.points.back());
    front.labels.push_back(study.points[i].name);
  }
  for (const TradePoint& p : study.points) {
    if (p.on_front) continue;
    Series& series = !p.error.same_verdict ? other : p.knobs.size() > 1 ? pairs : all;
    series.points.push_back(place(p));
    series.labels.push_back(p.name);
  }
  Plot plot;
  double low = -0.1, high = 0.1;
  for (const Series* s : {&all, &pairs, &other, &line})
    for (const glm::dvec2& p : s->points)
      if (std::isfinite(p.x)) low = std::min(low, p.x - 0.1), high = std::max(high, p.x + 0.1);
  plot.x = {"CPU time per simulated second, over that of the mission as it is", low, high, 0.0, true};
  plot.y = {"error (1: as far off as the tolerances allow)", {}, {}, 0.0, true};
  // Labels are placed in this order, curves are drawn below points.
  plot.series = {line, advice, front, pairs, all, other};
  std::erase_if(plot.series, [](const Series& s) { return s.points.empty(); });
  if (const double floor = study.floor.total(); floor > least_drawn)
    plot.series.push_back({"the reference with other noise", Series::Kind::dashed, plot_colour(4), {{low, std::log10(floor)}, {high, std::log10(floor)}}, {}});
  return {"What accuracy costs: " + study.mission, {"Reference: " + study.reference, fmt::format("{:g} s simulated, {} settings; error: root mean square of range / {:g} m, amplitude / {:g} dB, detections / {:g}, F1 / {:g}, way / {:g} m", study.simulated_s,
          study.points.size(), trade_tolerances.range_m, trade_tolerances.amplitude_db, trade_tolerances.disagreement, trade_tolerances.map_f1, trade_tolerances.path_m)}, 1200, {{680.0, {plot}}}};
}

}  // namespace

std::string tradeoff_csv(const Tradeoff& study) {
  std::string text = "setting,changes,repeats,cpu_ratio,cpu_ratio_low,cpu_ratio_high,wall_ratio,wall_ratio_low,wall_ratio_high,cpu_s_per_s,wall_s_per_s,rays_per_s,map_bytes,peak_mb,simulated_s,"
                     "verdict,same_verdict,error,range_rmse_m,amplitude_db,detection_disagreement,map_f1,map_f1_loss,path_m,on_front\n";
  for (const TradePoint& p : study.points) {
    std::string changes = changes_text(p.changes);
    for (std::size_t at = 0; (at = changes.find('"', at)) != std::string::npos; at += 2) changes.insert(at, 1, '"');
    const TradeError& e = p.error;
    text += fmt::format("\"{}\",\"{}\",{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", p.name, changes, p.repeats, field(p.cpu.value), field(p.cpu.low), field(p.cpu.high), field(p.wall.value),
                        field(p.wall.low), field(p.wall.high), field(p.cpu_s), field(p.wall_s), field(p.rays_per_s), p.map_bytes, p.peak_mb ? field(*p.peak_mb) : "", field(p.simulated_s), p.verdict,
                        e.same_verdict, field(e.total()), field(e.range_rmse_m), field(e.amplitude_db), field(e.disagreement), field(e.map_f1), field(e.map_f1_loss), field(e.path_m), p.on_front);
  }
  return text;
}

std::string tradeoff_json(const Tradeoff& study) {
  Json json = {{"mission", study.mission}, {"reference", study.reference}, {"reference_verdict", study.reference_verdict}, {"simulated_s", study.simulated_s}, {"cut_s", study.cut_s ? Json(*study.cut_s) : Json(nullptr)},
               {"budget_s", study.budget_s}, {"spent_s", study.spent_s}, {"noise_floor", error_json(study.floor)}, {"left_out", study.left_out}};
  json["noise_floor"].erase("same_verdict");
  for (const TradePoint& p : study.points) {
    Json changes = Json::object();
    for (const Override& change : p.changes) changes[change.key] = change.value;
    json["points"].push_back({{"setting", p.name}, {"changes", std::move(changes)}, {"repeats", p.repeats}, {"cpu", interval_json(p.cpu)}, {"wall", interval_json(p.wall)}, {"cpu_s_per_s", number(p.cpu_s)},
                              {"wall_s_per_s", number(p.wall_s)}, {"rays_per_s", p.rays_per_s}, {"map_bytes", p.map_bytes}, {"peak_mb", p.peak_mb ? Json(*p.peak_mb) : Json(nullptr)},
                              {"simulated_s", p.simulated_s}, {"verdict", p.verdict}, {"error", error_json(p.error)}, {"on_front", p.on_front}});
  }
  json["recommended"] = Json::array();
  for (const Recommendation& r : study.recommended)
    json["recommended"].push_back({{"name", r.name}, {"file", r.file.filename().string()}, {"setting", study.points[r.point].name}, {"verified", r.verified}, {"verdict", r.verdict}, {"cpu_ratio", number(r.cpu_ratio)}, {"error", error_json(r.error)}});
  return json.dump(2) + "\n";
}

std::string tradeoff_text(const Tradeoff& study) {
  const auto row = [](const TradeError& e) {
    return fmt::format("{:>8} {:>8} {:>7} {:>9} {:>7} {:>7}", figure(e.total()), figure(e.range_rmse_m), figure(e.amplitude_db), std::isfinite(e.disagreement) ? fmt::format("{:.2f} %", 100.0 * e.disagreement) : "-", figure(e.map_f1), figure(e.path_m));
  };
  std::string text = fmt::format("reference  {}; {}\nruns       {:g} s simulated, {} settings, {:.0f} s of {:.0f} s used\n\n{:<24}{:>8} {:>8} {:>7} {:>9} {:>7} {:>7}  {}\n", study.reference, study.reference_verdict, study.simulated_s, study.points.size(), study.spent_s,
                                 study.budget_s, "CPU ratio (95 %)", "error", "range m", "dB", "detection", "map F1", "way m", "Pareto front, and the mission as it is");
  auto shown = front_of(study);
  if (!study.points.empty() && !study.points.front().on_front) shown.push_back(0);
  std::ranges::stable_sort(shown, [&](std::size_t a, std::size_t b) { return study.points[a].cpu.value < study.points[b].cpu.value; });
  for (const std::size_t i : shown) text += fmt::format("{:<24}{}  {}\n", with_interval(study.points[i].cpu), row(study.points[i].error), study.points[i].name);
  text += fmt::format("{:<24}{}  (the reference's sensors with other noise)\n\n", "", row(study.floor));
  for (const Recommendation& r : study.recommended)
    text += fmt::format("{:<9}{}: {}, CPU x {:.2f}, error {}; {}\n", r.name, r.file.string(), study.points[r.point].name, r.cpu_ratio, figure(r.error.total()),
                        r.verified ? "run: " + r.verdict + ", as the reference" : r.verdict.empty() ? "NOT run: the budget was over" : "run: " + r.verdict + ", NOT as the reference");
  for (const std::string& one : study.left_out) text += "note: " + one + "\n";
  return text;
}

Result<Done> write_tradeoff(const std::filesystem::path& folder, const Tradeoff& study) {
  if (auto done = write_file(folder / "tradeoff.csv", tradeoff_csv(study)); !done) return done;
  if (auto done = write_file(folder / "tradeoff.json", tradeoff_json(study)); !done) return done;
  const Sheet sheet = chart(study);
  if (auto done = sheet.write(folder / "tradeoff.png"); !done) return done;
  return sheet.write(folder / "tradeoff.svg");
}

}  // namespace thicket
