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

std::vector<Variant> variants() {
  return {{"floor gate, 0.5 m/s", {}},
          {"no floor gate", {"sensor.floor_gate=false"}},
          {"multipath, 3 bounces", {"sensor.bounces_max=3"}},
          {"2 m/s", {"planner.speed_m_s=2.0"}},
          {"jitter of a hand, 0.3 m/s", {"vehicle.jitter_m_s=0.3"}},
          {"as 2018", as_2018()}};
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

/// Two rows, for the printed law has a scale of its own.
std::string draw(const ExperimentContext& context, const std::string& object, const std::vector<std::pair<std::string, Pass>>& passes) {
  const auto snapshot = [](const std::string& title) { return Plot{title, {"range, m", 0.0, 6.0, 1.0}, {"amplitude", 0.0, {}, 0.0}, {}}; };
  const auto sum = [](const std::string& title) { return Plot{title, {"range, m", 0.0, 6.0, 1.0}, {"amplitude, summed", 0.0, {}, 0.0}, {}}; };
  Plot ours = snapshot("Snapshot at y = 0"), ours_sum = sum("Sum of all amplitudes"), theirs = snapshot("As 2018: snapshot at y = 0"), theirs_sum = sum("As 2018: sum of all amplitudes");
  for (std::size_t i = 0; i < passes.size(); ++i) {
    const auto& [name, pass] = passes[i];
    const bool printed = name == "as 2018";
    (printed ? theirs : ours).series.push_back(curve(name, Series::Kind::line, i, pass, pass.profiles[pass.closest()]));
    (printed ? theirs_sum : ours_sum).series.push_back(curve(name, Series::Kind::line, i, pass, pass.sum()));
    if (i == 0 || printed) (printed ? theirs : ours).series.push_back(curve("threshold", Series::Kind::dashed, passes.size(), pass, pass.threshold));
  }
  Sheet sheet;
  sheet.title = fmt::format("Strafing past: {}", object);
  sheet.subtitles = {"X4M05 lobe, 30 x 30 rays, 1 m above the floor; the object is 3 m away at y = 0"};
  sheet.rows = {{240.0, {ours, ours_sum}}, {240.0, {theirs, theirs_sum}}};
  or_fail(sheet.write(context.file("profiles")));
  return context.picture("profiles", "Left a snapshot when the object is nearest, right the sum over the whole way; the lower row as the source's simulator made them. The dashed line is the threshold, above with the floor gate.");
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
                       "The top is where the source has it, at the plate's distance. Ours is as narrow as the pulse (1.5 GHz at -10 dB) and flashes: the plate stands out by a factor of 40 while the robot is before it, and the first echo is the plate's "
                       "in half of the scans, not in those farther along. *As 2018* it is weaker and lasts longer: the top of the sum lies at 3.06 m and drags on to 3.6 m, which is the diffuse plate seen from aslant. Three bounces change nothing here, "
                       "and what the measured amplitude has behind the wall is not in ours: there is no room around the plate, and way, plate and floor make no corner that the lobe looks into. Without the floor gate the first echo is never the "
                       "plate but the floor. Of a hand that shakes the vehicle comes tilt: it spoils the mirror, and the sum has its top at 3.22 m.");
       }},
      {"billdal2018/strafe_plate45", "Strafing past the plate at 45 degrees", "Billdal 2018, figure 6.4",
       std::string(pair_of_graphs) + "The simulated plate is nearly as strong as the one that faces the way; the measured one is far weaker.",
       [](ExperimentContext& c) {
         return strafe(c, "plate45", "A smooth plate at 45 degrees sends the wave away, and little of it back.",
                       "In the source the cosine of the angle is all that a tilt costs, and *as 2018* the sum has its top at the plate: a third of the plate that faces the way. Here the shipped steel has a roughness of 0.1 and mirrors the wave away: 50 times "
                       "weaker than the plate that faces the way, no stronger than the floor, and under the threshold that the floor gate makes. It is never the first echo. The hump from 2.7 to 3.4 m in the sum is the plate. That is what the "
                       "measured one shows (far weaker), and not what the simulated one does.");
       }},
      {"billdal2018/strafe_pole", "Strafing past a square steel pole", "Billdal 2018, figure 6.5", std::string(pair_of_graphs) + "Both have a top at the pole's range, and the floor's before it.",
       [](ExperimentContext& c) {
         return strafe(c, "pole", "The pole of 0.1 × 0.1 m shows one flat side to the way.", "The pole flashes as the plate does, for a tenth of the way: its side of 0.1 m is a mirror. The floor's top before it, from 1.9 m on, is there as in the source's graphs. With three bounces a second top stands 0.17 m behind the first: the corner of "
                       "pole and floor, by way of both (√(3² + 1²) = 3.16 m). It is the source's echo behind the object. *As 2018* the pole is in the sum alone; in single snapshots it is weaker than the noise that goes with the threshold.");
       }},
      {"billdal2018/strafe_wire", "Strafing past a steel wire", "Billdal 2018, figure 6.6",
       std::string(pair_of_graphs) + "There is a strong signal where the wire is, measured and simulated, and it is put down to the floor; besides, a ray that meets the wire answers like a plate of the rays' spacing.",
       [](ExperimentContext& c) {
         return strafe(c, "wire", "A wire of 4 mm is far below what the floor returns at its range.",
                       "Snapshot and sum are those of the floor: nothing stands at 3 m. In the sum of a run with three bounces there is a trace of it. What returns at the wire's range is the floor, as the source suspects of its own graphs; without the "
                       "floor gate the first echo is the floor's, at 1.9 m. The floor gate, which is the method that the source wishes for, takes it off, and then nothing is detected in 99 % of the scans. *As 2018* the wire is no stronger than noise "
                       "here: that it answers like a plate where a ray of the fixed grid meets it is shown, and counted, under *What the sources name as failures*.");
       }}};
}

const std::vector<std::string>& as_2018() {
  static const std::vector<std::string> sets = {"sensor.law=printed", "sensor.sampling=regular", "sensor.scattering=lambert", "sensor.floor_gate=false", "sensor.smoothing_bins=15", "sensor.threshold=0.004"};
  return sets;
}

std::vector<Experiment> billdal2018_experiments() {
  std::vector<Experiment> all;
  for (auto* part : {strafe_experiments2018, sar_experiments2018, room_experiments2018, cost_experiments2018})
    for (Experiment& experiment : part()) all.push_back(std::move(experiment));
  return all;
}

}  // namespace thicket
