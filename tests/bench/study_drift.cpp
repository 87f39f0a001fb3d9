// What odometry that drifts does to the verdicts: the sweep of McGuire, de Croon and Tuyls 2019, in rooms like theirs.
#include "plot.hpp"
#include "study_rooms.hpp"

namespace thicket::study {
namespace {

constexpr double sigmas[] = {0.0, 0.05, 0.1, 0.15, 0.2, 0.25};
constexpr double time_limit = 900.0;  // s, three times that of 2019: who has lost himself may go on for ever
constexpr double slack = 1.0;  // m beyond the goal's tolerance, within which a goal that was believed to be reached counts as reached

struct Curves {
  Plot plot;
  explicit Curves(const char* title) {
    plot.title = title;
    plot.x = {"σ of the noise on measured speed (m/s) and turn rate (rad/s), ten times a second", 0.0, 0.255, 0.05};
    plot.y = {"share of the runs, %", -2.0, 102.0};
  }
  void add(const std::string& planner, std::size_t index, std::vector<glm::dvec2> points) {
    plot.series.push_back({planner, Series::Kind::line, plot_colour(index), points});
    plot.series.push_back({"", Series::Kind::points, plot_colour(index), std::move(points)});
  }
};

}  // namespace

void study_drift(const Options& options) {
  std::string words;
  const auto problems = rooms(options, room_mission({}), words);
  std::vector<Variant> variants;
  for (const std::string& planner : options.planners)
    for (const double sigma : sigmas) {
      const std::string value = fmt::format("{}", sigma);
      variants.push_back({room_mission({{"odometry.speed_noise_m_s", value, ""}, {"odometry.turn_noise_rad_s", value, ""}, {"limits.time_s", fmt::format("{}", time_limit), ""}}), planner});
    }
  const auto attempts = run_variants(problems, variants, options.jobs);

  Curves failure("False failure: said unreachable, or stopped, though the goal can be reached"), success("False success: said reached, more than 1.1 m away");
  std::vector<Row> rows;
  for (std::size_t p = 0; p < options.planners.size(); ++p) {
    std::vector<glm::dvec2> failures, successes;
    for (std::size_t s = 0; s < std::size(sigmas); ++s) {
      const std::size_t v = p * std::size(sigmas) + s;
      const DriftTally t = drift_tally(attempts[v], variants[v].lean.planner.goal_tolerance_m, slack);
      failures.emplace_back(sigmas[s], 100.0 * share(t.false_failure, t.reachable));
      successes.emplace_back(sigmas[s], 100.0 * share(t.false_success, t.runs));
      rows.push_back({options.planners[p], fmt::format("{}", sigmas[s]), percent(t.success, t.reachable),
                      percent(t.false_failure, t.reachable), percent(t.stopped, t.reachable), percent(t.false_success, t.runs), std::to_string(t.collisions)});
    }
    failure.add(options.planners[p], p, std::move(failures));
    success.add(options.planners[p], p, std::move(successes));
  }
  const Sheet sheet{"Odometry that drifts", {words + ", at 0.35 m/s"}, 1100, {{380.0, {failure.plot}}, {380.0, {success.plot}}}};
  or_exit(sheet.write(options.into / "drift.png"));
  const Row head = {"planner", "σ", "reached", "false failure", "of it stopped", "false success", "collisions"};
  publish(options, "drift",
          made_by(options, words + fmt::format(", at 0.35 m/s, {:.0f} s at most; {:.0f} hours simulated. *Reached*: of those that can be, said so and within 1.1 m of the goal. "
                                               "*False failure*: of those that can be. *False success*: of all.",
                                               time_limit, hours(attempts))) +
              "![Curves of false failure and false success](navigation_study/drift.png)\n\n" + markdown(head, rows));
}

}  // namespace thicket::study
