// What bumpers, their rule and the rays behind them are worth: every combination on the same problems.
#include <map>

#include "plot.hpp"
#include "study_runs.hpp"
#include "thicket/base/files.hpp"

namespace thicket::study {
namespace {

constexpr int bumper_counts[] = {4, 6, 8, 12, 16, 36}, ray_counts[] = {36, 72, 180, 360};

/// A rule of the bumpers, and who follows the boundary.
struct Rule {
  std::string name;
  std::vector<Override> changes;
};
const std::vector<Rule>& rules() {
  static const std::vector<Rule> list = {{"any", {{"bumpers.rule", "\"any\"", ""}}},
                                         {"all", {{"bumpers.rule", "\"all\"", ""}}},
                                         {"quantile 0.25", {{"bumpers.rule", "\"quantile\"", ""}, {"bumpers.quantile", "0.25", ""}}},
                                         {"band2012", {{"bumpers.rule", "\"band2012\"", ""}}},
                                         {"any, rules2012", {{"bumpers.rule", "\"any\"", ""}, {"planner.follower", "\"rules2012\"", ""}}}};
  return list;
}

/// What one combination, or several together, came to.
struct Sum {
  std::size_t runs = 0, wrong = 0, collisions = 0;
  std::vector<double> lengths;
  double think_s = 0.0, simulated_s = 0.0;

  void add(const std::vector<Attempt>& attempts) {
    const auto own = ratios(attempts, Over::shortest);
    lengths.insert(lengths.end(), own.begin(), own.end());
    for (const Attempt& a : attempts) {
      ++runs;
      wrong += a.score == Score::wrong;
      collisions += a.collided();
      think_s += a.times.trace + a.times.plan;
      simulated_s += a.simulated_s;
    }
  }
  double cost() const { return think_s / simulated_s; }
};

struct Combination {
  std::size_t rule;
  int bumpers, rays;
};

Row row_of(const Row& words, const Sum& sum, double cost) {
  Row row = words;
  row.insert(row.end(), {std::to_string(sum.runs), percent(sum.wrong, sum.runs), std::to_string(sum.collisions), fixed(quantile(sum.lengths, 0.5)), fixed(sum.cost() / cost)});
  return row;
}

/// Wrong shares of the rules, over numbers of bumpers or rays up to `high`.
Plot curves(const std::string& title, const std::string& label, double high, const std::map<std::pair<std::size_t, int>, Sum>& sums) {
  Plot plot;
  plot.title = title;
  plot.x.label = label;
  plot.x.low = 0.0;
  plot.x.high = high;
  plot.y = {"wrong verdicts, %", -2.0, 102.0};
  for (std::size_t r = 0; r < rules().size(); ++r) {
    std::vector<glm::dvec2> points;
    for (const auto& [key, sum] : sums)
      if (key.first == r) points.emplace_back(key.second, 100.0 * share(sum.wrong, sum.runs));
    plot.series.push_back({rules()[r].name, Series::Kind::line, plot_colour(r), points});
    plot.series.push_back({"", Series::Kind::points, plot_colour(r), std::move(points)});
  }
  return plot;
}

std::string csv(const std::vector<Combination>& combinations, const std::vector<std::vector<Attempt>>& attempts) {
  std::string text = "rule,bumpers,rays,problems,wrong,collisions,length_over_shortest_median\n";
  for (std::size_t v = 0; v < combinations.size(); ++v) {
    Sum sum;
    sum.add(attempts[v]);
    text += fmt::format("\"{}\",{},{},{},{},{},{}\n", rules()[combinations[v].rule].name, combinations[v].bumpers, combinations[v].rays, sum.runs, sum.wrong, sum.collisions,
                        fixed(quantile(sum.lengths, 0.5), 4));
  }
  return text;
}

}  // namespace

void study_trade(const Options& options) {
  std::vector<Combination> combinations;
  std::vector<Variant> variants;
  for (std::size_t r = 0; r < rules().size(); ++r)
    for (const int bumpers : bumper_counts)
      for (const int rays : ray_counts) {
        std::vector<Override> changes = {{"sensor.range_noise_m", "0.03", ""}, {"bumpers.count", std::to_string(bumpers), ""}, {"sensor.step_deg", fmt::format("{:.1f}", 360.0 / rays), ""}};
        changes.insert(changes.end(), rules()[r].changes.begin(), rules()[r].changes.end());
        combinations.push_back({r, bumpers, rays});
        variants.push_back({or_exit(lean_mission(changes)), options.planners.front()});
      }
  const auto problems = choose_of_all(options.problems, variants.front().lean, options.jobs);
  const auto attempts = run_variants(problems, variants, options.jobs);

  std::map<std::pair<std::size_t, int>, Sum> by_rays, by_bumpers;
  double standard = 0.0;  // cost of 8 bumpers, 180 rays, any
  for (std::size_t v = 0; v < combinations.size(); ++v) {
    const Combination& c = combinations[v];
    by_rays[{c.rule, c.rays}].add(attempts[v]);
    by_bumpers[{c.rule, c.bumpers}].add(attempts[v]);
    if (c.rule != 0 || c.bumpers != 8 || c.rays != 180) continue;
    Sum sum;
    sum.add(attempts[v]);
    standard = sum.cost();
  }
  std::vector<Row> rows_of_rays, rows_of_bumpers;
  for (const auto& [key, sum] : by_rays) rows_of_rays.push_back(row_of({rules()[key.first].name, std::to_string(key.second)}, sum, standard));
  for (const auto& [key, sum] : by_bumpers) rows_of_bumpers.push_back(row_of({rules()[key.first].name, std::to_string(key.second)}, sum, standard));

  const std::string words = fmt::format("{} with {} problems, {} of each of the ten families, range noise 0.03 m", options.planners.front(), problems.size(), options.problems);
  const Sheet sheet{"Bumpers, rules and rays",
                    {words},
                    1100,
                    {{340.0, {curves("All numbers of bumpers together", "rays per scan", 370.0, by_rays)}}, {340.0, {curves("All numbers of rays together", "bumpers", 37.0, by_bumpers)}}}};
  or_exit(sheet.write(options.into / "trade.png"));
  or_exit(write_file(options.into / "trade.csv", csv(combinations, attempts)));
  publish(options, "trade",
          made_by(options, words + fmt::format("; every number of bumpers (4, 6, 8, 12, 16, 36) with every rule and every number of rays (36, 72, 180, 360), each combination a row of "
                                               "[trade.csv](navigation_study/trade.csv); {:.0f} hours simulated. *Cost* is wall time of scanning and deciding per simulated second, over that of "
                                               "8 bumpers, `any` and 180 rays.",
                                               hours(attempts))) +
              "![Wrong verdicts over rays and bumpers](navigation_study/trade.png)\n\n" +
              markdown({"rule", "rays", "runs", "wrong", "collisions", "length / shortest", "cost"}, rows_of_rays) + "\n" +
              markdown({"rule", "bumpers", "runs", "wrong", "collisions", "length / shortest", "cost"}, rows_of_bumpers));
}

}  // namespace thicket::study
