// The experiments of Billdal 2018: strafing past objects (figures 6.3 to 6.6).
#include <fmt/format.h>

#include <cmath>

#include "../plot.hpp"
#include "billdal2018.hpp"
#include "passes.hpp"

namespace thicket {
namespace {

struct Variant {
  std::string name;
  std::vector<std::string> sets;
};

/// What the source's simulator did, as far as keys can say it: eq. 4.2, the same rays each time, no floor gate, a moving average (of a length that it does not print).
const std::vector<std::string> as_2018 = {"sensor.law=printed", "sensor.sampling=regular", "sensor.scattering=lambert", "sensor.floor_gate=false", "sensor.smoothing_bins=15"};

std::vector<Variant> variants() {
  return {{"floor gate, 0.5 m/s", {}},
          {"no floor gate", {"sensor.floor_gate=false"}},
          {"multipath, 3 bounces", {"sensor.bounces_max=3"}},
          {"2 m/s", {"planner.speed_m_s=2.0"}},
          {"jitter of a hand, 0.3 m/s", {"vehicle.jitter_m_s=0.3"}},
          {"as 2018", as_2018}};
}

std::vector<std::string> shortened(const ExperimentContext& context, std::vector<std::string> sets) {
  if (context.brief()) sets.insert(sets.end(), {"start.y_m=-0.4", "planner.waypoints_m=[[0.0, 0.4]]"});
  return sets;
}

TableRow row_of(const std::string& name, const Pass& pass) {
  const Top object = pass.strongest(pass.closest(), 2.6, 3.6), all = pass.strongest(pass.closest(), 0.3, 9.8), sum = pass.strongest_of_sum(0.3, 9.8);
  return {name, std::to_string(pass.y.size()), fixed(pass.y[pass.closest()]), fixed(object.range), fixed(object.amplitude, 4), fixed(all.range), fixed(all.amplitude, 4), fixed(sum.range), percent(pass.found(3.0, 0.15))};
}

template <class Numbers>
Series curve(const std::string& name, Series::Kind kind, std::size_t colour, const Pass& pass, const Numbers& values) {
  Series series{name, kind, plot_colour(colour), {}};
  for (std::size_t bin = 0; bin < values.size(); bin += 2) {  // of two bins the larger, so that no top is lost
    const double second = bin + 1 < values.size() ? static_cast<double>(values[bin + 1]) : 0.0;
    series.points.emplace_back(pass.range(bin), std::max(static_cast<double>(values[bin]), second));
  }
  return series;
}

std::string draw(const ExperimentContext& context, const std::string& object, const std::vector<std::pair<std::string, Pass>>& passes) {
  Plot snapshot{"Snapshot at y = 0", {"range, m", 0.0, 6.0, 1.0}, {"amplitude", 0.0, {}, 0.0}, {}}, sum{"Sum of all amplitudes", {"range, m", 0.0, 6.0, 1.0}, {"amplitude, summed", 0.0, {}, 0.0}, {}};
  for (std::size_t i = 0; i < passes.size(); ++i) {
    const auto& [name, pass] = passes[i];
    snapshot.series.push_back(curve(name, Series::Kind::line, i, pass, pass.profiles[pass.closest()]));
    sum.series.push_back(curve(name, Series::Kind::line, i, pass, pass.sum()));
  }
  snapshot.series.push_back(curve("threshold", Series::Kind::dashed, passes.size(), passes.front().second, passes.front().second.threshold));
  Sheet sheet;
  sheet.title = fmt::format("Strafing past: {}", object);
  sheet.subtitles = {"X4M05 lobe, 30 x 30 rays, 1 m above the floor; the object is 3 m away at y = 0"};
  sheet.rows = {{300.0, {snapshot, sum}}};
  or_fail(sheet.write(context.file("profiles")));
  return context.picture("profiles", "Left a snapshot when the object is nearest, right the sum over the whole way. The dashed line is the threshold with the floor gate.");
}

std::string strafe(const ExperimentContext& context, const std::string& object, const std::string& words, const std::string& differs) {
  std::vector<TableRow> rows;
  std::vector<std::pair<std::string, Pass>> drawn;
  for (const Variant& variant : variants()) {
    Pass pass = fly_past(context.prepare("strafe/strafe_" + object, shortened(context, variant.sets)));
    rows.push_back(row_of(variant.name, pass));
    if (variant.sets.empty() || variant.name.starts_with("multipath") || variant.name == "as 2018") drawn.emplace_back(variant.sets.empty() ? "direct" : variant.name, std::move(pass));
  }
  return words + "\n\n" + draw(context, object, drawn) +
         table({"run", "scans", "nearest at y, m", "object's top at, m", "its amplitude", "strongest top at, m", "its amplitude", "strongest of the sum at, m", "first echo is the object's"}, rows) +
         "The object's top is the strongest bin from 2.6 to 3.6 m in the snapshot, whatever returns there; its first echo counts where it lies within 0.15 m of the distance of the object's middle. Amplitudes of *as 2018* have "
         "another scale.\n\n**What differs.** " + differs + "\n\n";
}

const char* pair_of_graphs = "Two pairs of graphs: a snapshot of amplitude over range and the sum of all amplitudes of the run, measured by Jablonski and simulated. ";

}  // namespace

std::vector<Experiment> strafe_experiments2018() {
  return {
      {"billdal2018/strafe_plate", "Strafing past a steel plate", "Billdal 2018, figure 6.3",
       std::string(pair_of_graphs) + "The tops are at the same ranges; the simulated ones are thicker and have fewer of them, and the measured amplitude drags on behind the wall, which is put down to multipath.",
       [](ExperimentContext& c) {
         return strafe(c, "plate", "A plate of 1 × 1 m that faces the way stands out of everything by far.",
                       "Ours is as narrow as the pulse (1.5 GHz at -10 dB), theirs as wide as the moving average. With three bounces there is what drags on behind the plate: ways by the floor, longer by decimetres. Nothing "
                       "stands behind the plate here, so that there is less of it than in their room.");
       }},
      {"billdal2018/strafe_plate45", "Strafing past the plate at 45 degrees", "Billdal 2018, figure 6.4",
       std::string(pair_of_graphs) + "The simulated plate is nearly as strong as the one that faces the way; the measured one is far weaker.",
       [](ExperimentContext& c) {
         return strafe(c, "plate45", "A smooth plate at 45 degrees sends the wave away, and little of it back.",
                       "In the source the cosine of the angle is all that a tilt costs (*as 2018*). Here the shipped steel has a roughness of 0.1, and the lobe of its reflection is narrow: seen from y = 0 the plate is hidden in what the floor returns, as the real one nearly was.");
       }},
      {"billdal2018/strafe_pole", "Strafing past a square steel pole", "Billdal 2018, figure 6.5", std::string(pair_of_graphs) + "Both have a top at the pole's range, and the floor's before it.",
       [](ExperimentContext& c) {
         return strafe(c, "pole", "The pole of 0.1 × 0.1 m shows one flat side to the way.", "The pole's amplitude follows its area and stays near the same mean for any number of rays, because their directions are drawn anew for each scan.");
       }},
      {"billdal2018/strafe_wire", "Strafing past a steel wire", "Billdal 2018, figure 6.6",
       std::string(pair_of_graphs) + "There is a strong signal where the wire is, measured and simulated, and it is put down to the floor; besides, a ray that meets the wire answers like a plate of the rays' spacing.",
       [](ExperimentContext& c) {
         return strafe(c, "wire", "A wire of 4 mm is far below what the floor returns at its range.",
                       "Without the floor gate the first echo is the floor's, at 1.9 m, as the source suspects of its own. What stands at the wire's range is the floor there; the floor gate takes off what an even floor returns, which is the method that the source wishes for.");
       }}};
}

std::vector<Experiment> billdal2018_experiments() {
  std::vector<Experiment> all;
  for (auto* part : {strafe_experiments2018, sar_experiments2018, room_experiments2018, cost_experiments2018})
    for (Experiment& experiment : part()) all.push_back(std::move(experiment));
  return all;
}

}  // namespace thicket
