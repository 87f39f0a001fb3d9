// What docs/performance.md shows of costs: a chart over each thing that they depend on, and where the time of each shipped mission goes.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <map>

#include "or_exit.hpp"
#include "plot.hpp"
#include "study_charts.hpp"
#include "study_tables.hpp"
#include "thicket/base/files.hpp"
#include "thicket/sim/simulation.hpp"

namespace thicket::study {

double Case::cost() const { return quantile(values, wall_time ? 0.0 : 0.5); }

namespace {

namespace fs = std::filesystem;

struct Options {
  fs::path page = "docs/performance.md", into = "docs/performance";
  int rounds = 7;
  double least_s = 0.03;    ///< of a measurement
  double longest_s = 10.0;  ///< of a mission, simulated
  std::vector<std::string> parts;
};

double cpu_now() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}
double wall_now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }
double load() {
  double averages[1] = {0.0};
  return getloadavg(averages, 1) == 1 ? averages[0] : 0.0;
}

/// As often as it takes, s an item.
double measured(const Case& c, double least_s) {
  const auto now = [&c] { return c.wall_time ? wall_now() : cpu_now(); };
  const double begin = now();
  int calls = 0;
  do {
    c.work();
    ++calls;
  } while (now() - begin < least_s);
  return (now() - begin) / calls / c.items;
}

void draw(const Chart& chart, const Options& o, double load_before) {
  Plot plot;
  plot.x = {chart.x, {}, {}, 0.0, true};
  plot.y = {chart.y, {}, {}, 0.0, true};
  std::vector<std::string> names;
  for (const Case& c : chart.cases)
    if (std::find(names.begin(), names.end(), c.series) == names.end()) names.push_back(c.series);
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::vector<glm::dvec2> points;
    for (const Case& c : chart.cases)
      if (c.series == names[i]) points.emplace_back(std::log10(c.x), std::log10(c.cost() / chart.unit));
    plot.series.push_back({names[i], Series::Kind::line, plot_colour(i), points});
    plot.series.push_back({"", Series::Kind::points, plot_colour(i), std::move(points)});
  }
  std::vector<std::string> words = chart.words;
  words.push_back(fmt::format("{} of {} rounds in turn; load {:.1f} before and {:.1f} after", chart.cases.front().wall_time ? "the least" : "medians", chart.cases.front().values.size(), load_before, load()));
  or_exit(Sheet{chart.title, words, 900, {{360.0, {plot}}}}.write(o.into / (chart.name + ".png")));
}

/// Measures one chart, draws it, and returns its rows.
std::string study_chart(const ChartMaker& maker, const Options& o) {
  Chart chart = maker.make();
  const double before = load();
  for (Case& c : chart.cases) c.work();  // warm
  // Short looks, and many of them, at what must find both cores idle.
  const bool wall = chart.cases.front().wall_time;
  const int rounds = wall ? 10 * o.rounds : o.rounds;
  for (int round = 0; round < rounds; ++round)
    for (Case& c : chart.cases) c.values.push_back(measured(c, wall ? 0.1 * o.least_s : o.least_s));
  draw(chart, o, before);
  std::string rows;
  for (const Case& c : chart.cases) {
    const auto [least, most] = std::minmax_element(c.values.begin(), c.values.end());
    rows += fmt::format("{},\"{}\",\"{}\",{:g},\"{}\",{:.4g},{:.4g},{:.4g}\n", chart.name, c.series, chart.x, c.x, chart.y, c.cost() / chart.unit, *least / chart.unit, *most / chart.unit);
  }
  return rows;
}

std::vector<std::string> shipped_missions() {
  std::vector<std::string> names;
  const fs::path root = shipped_root() / "worlds" / "data";
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (entry.path().extension() != ".toml") continue;
    const auto document = read_document(entry.path());
    if (document && document->find("world") != nullptr) names.push_back(fs::relative(entry.path(), root).replace_extension().generic_string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// Where the time of missions goes, on one thread: of each the shares of its parts.
void study_phases(const Options& o) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const double before = load();
  std::vector<Row> rows;
  PhaseTimes all;
  double all_wall = 0.0;
  for (const std::string& name : shipped_missions()) {
    fmt::print(stderr, "{}\n", name);
    const Simulation start = or_exit(Simulation::create(or_exit(read_mission(find_shipped(name), {}))));
    // The repetition that others disturbed least: of missions that take a moment there are many.
    double wall = infinity, cpu = infinity, simulated = 0.0;
    PhaseTimes t;
    const double first = wall_now();
    for (int repetition = 0; repetition < 3 || (repetition < 60 && wall_now() - first < 1.5); ++repetition) {
      Simulation s = start;
      const double begin = wall_now(), cpu_begin = cpu_now();
      while (s.step() && s.time() < o.longest_s) {
      }
      cpu = std::min(cpu, cpu_now() - cpu_begin);
      if (wall_now() - begin >= wall) continue;
      wall = wall_now() - begin;
      t = s.phase_times();
      simulated = s.time();
    }
    const auto percent_of = [&](double part) { return fixed(100.0 * part / wall, 0); };
    rows.push_back({name, fixed(simulated, 1), fixed(simulated / cpu, simulated / cpu < 10.0 ? 1 : 0), percent_of(t.trace), percent_of(t.map), percent_of(t.plan), percent_of(t.contact),
                    percent_of(wall - t.trace - t.map - t.plan - t.contact)});
    // Each mission counts alike, however long it takes.
    all.trace += t.trace / wall, all.map += t.map / wall, all.plan += t.plan / wall, all.contact += t.contact / wall, all_wall += 1.0;
  }
  const auto mean = [&](double part) { return fixed(100.0 * part / all_wall, 0); };
  rows.push_back({"*mean of all*", "", "", mean(all.trace), mean(all.map), mean(all.plan), mean(all.contact), mean(all_wall - all.trace - all.map - all.plan - all.contact)});
  const std::string text = fmt::format("Percent of the wall time of the quickest of three runs or more, one thread, at most {:g} simulated seconds; load {:.1f} before and {:.1f} after.\n\n{}", o.longest_s, before, load(),
                                       markdown({"mission", "simulated, s", "simulated s per CPU s", "trace", "map", "plan", "contact", "rest"}, rows));
  const std::string page = or_exit(read_text_file(o.page));
  or_exit(write_file(o.page, or_exit(with_part(page, "phases", text))));
}

}  // namespace

int call(int argc, char** argv) {
  CLI::App app{"The charts of docs/performance.md and its table of phases: measurements, which depend on the machine"};
  Options o;
  std::vector<std::string> known = {"phases"};
  for (const ChartMaker& maker : chart_makers()) known.push_back(maker.name);
  app.add_option("parts", o.parts, "what to make: phases, or a chart (default: all)")->check(CLI::IsMember(known));
  app.add_option("--page", o.page, "page whose table of phases is replaced")->capture_default_str();
  app.add_option("--into", o.into, "folder for charts.csv and the pictures")->capture_default_str();
  app.add_option("--rounds", o.rounds, "of each chart")->check(CLI::Range(1, 1000))->capture_default_str();
  app.add_option("--longest", o.longest_s, "simulated seconds of a mission at most")->check(CLI::PositiveNumber)->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  if (o.parts.empty()) o.parts = known;
  const auto wanted = [&](const std::string& name) { return std::find(o.parts.begin(), o.parts.end(), name) != o.parts.end(); };
  // Rows of the charts that are made; those of the others stay.
  std::map<std::string, std::string> rows;
  const fs::path file = o.into / "charts.csv";
  if (const auto old = read_text_file(file)) {
    std::size_t at = old->find('\n') + 1;
    while (at < old->size()) {
      const std::size_t end = old->find('\n', at) + 1;
      if (end == 0) break;
      const std::string line = old->substr(at, end - at);
      rows[line.substr(0, line.find(','))] += line;
      at = end;
    }
  }
  for (const ChartMaker& maker : chart_makers()) {
    if (!wanted(maker.name)) continue;
    fmt::print(stderr, "{}\n", maker.name);
    rows[maker.name] = study_chart(maker, o);
    std::string text = "chart,curve,over,x,cost,shown,least,most\n";
    for (const ChartMaker& m : chart_makers()) text += rows[m.name];
    or_exit(write_file(file, text));
  }
  if (wanted("phases")) study_phases(o);
  return 0;
}

}  // namespace thicket::study

int main(int argc, char** argv) { return thicket::study::call(argc, argv); }
