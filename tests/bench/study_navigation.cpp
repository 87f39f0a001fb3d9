// The studies of navigation: what docs/navigation_study.md shows. Nothing here is a test; but for wall times the same numbers on any number of threads.
#include <CLI/CLI.hpp>

#include "study_runs.hpp"

namespace thicket::study {
namespace {

/// One subcommand, with what it takes and does by default.
struct Study {
  const char *name, *help;
  void (*run)(const Options&);
  std::size_t problems, closed;  ///< closed 0: it does not ask
  std::vector<std::string> planners;
};
const std::vector<Study>& studies() {
  static const std::vector<Study> list = {
      {"maps", "every map of a folder, beside the exact point robot", study_maps, 10, 0, {"bug1", "bug2", "tangent_bug"}},
      {"rooms", "rooms like those of 2019, beside what was published", study_rooms, 30, 8, {"bug1", "bug2", "bug2_2012", "tangent_bug", "alg1", "alg2", "com", "i_bug", "dist_bug"}},
      {"drift", "the same with odometry that drifts", study_drift, 8, 2, {"bug1", "bug2", "alg1", "alg2", "com", "i_bug", "tangent_bug"}},
      {"trade", "bumpers, rules and rays against wrong verdicts", study_trade, 2, 0, {"bug2"}},
      {"cost", "wall time of lean runs", study_cost, 5, 0, {"bug1", "bug2", "tangent_bug"}},
  };
  return list;
}

/// As it was called, but for where things lie.
std::string command_of(const Study& study, const Options& options) {
  std::string text = fmt::format("study_navigation {}{} --problems {}", study.name, study.run == study_maps ? " FOLDER" : "", options.problems);
  if (study.closed) text += fmt::format(" --closed {}", options.closed);
  if (options.planners != study.planners) text += fmt::format(" --planners {}", fmt::join(options.planners, ","));
  return text;
}

}  // namespace

int call(int argc, char** argv) {
  CLI::App app{"Studies of navigation: tables and plots for docs/navigation_study.md"};
  app.require_subcommand(1);
  std::vector<Options> options(studies().size());
  for (std::size_t i = 0; i < studies().size(); ++i) {
    const Study& study = studies()[i];
    Options& o = options[i];
    o.problems = study.problems;
    o.closed = study.closed;
    o.planners = study.planners;
    o.into = "docs/navigation_study";
    auto* command = app.add_subcommand(study.name, study.help);
    if (study.run == study_maps) command->add_option("FOLDER", o.maps, "a folder of maps, or one")->required();
    command->add_option("--problems", o.problems, study.closed ? "rooms whose goal can be reached" : "per map or family")->capture_default_str();
    if (study.closed) command->add_option("--closed", o.closed, "rooms whose goal cannot be reached")->capture_default_str();
    command->add_option("--planners", o.planners, "by name, separated by commas")->delimiter(',')->capture_default_str();
    command->add_option("--jobs", o.jobs, "threads; 0: as many as there are cores")->capture_default_str();
    command->add_option("--into", o.into, "folder of tables and plots")->capture_default_str();
    command->add_option("--page", o.page, "page whose part is replaced, for example docs/navigation_study.md");
  }
  CLI11_PARSE(app, argc, argv);
  for (std::size_t i = 0; i < studies().size(); ++i) {
    if (!app.got_subcommand(studies()[i].name)) continue;
    options[i].command = command_of(studies()[i], options[i]);
    studies()[i].run(options[i]);
  }
  return 0;
}

}  // namespace thicket::study

int main(int argc, char** argv) { return thicket::study::call(argc, argv); }
