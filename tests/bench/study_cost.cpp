// What a lean run costs, by planner. Wall times: unlike the other studies' results these depend on the machine.
#include <ctime>

#include "study_runs.hpp"

namespace thicket::study {

void study_cost(const Options& options) {
  const Mission lean = or_exit(lean_mission({{"sensor.range_noise_m", "0.03", ""}}));
  const auto problems = choose_of_all(options.problems, lean, options.jobs);
  std::vector<Row> rows;
  for (const std::string& planner : options.planners) {
    const std::clock_t before = std::clock();
    const auto attempts = run_variants(problems, {{lean, planner}}, options.jobs).front();
    const double cpu = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
    double simulated = 0.0, decisions = 0.0, trace = 0.0, plan = 0.0, contact = 0.0;
    for (const Attempt& a : attempts) {
      simulated += a.simulated_s;
      decisions += static_cast<double>(a.decisions);
      trace += a.times.trace;
      plan += a.times.plan;
      contact += a.times.contact;
    }
    const auto each = [&](double time) { return fixed(1e6 * time / decisions, 1); };
    rows.push_back({planner, std::to_string(attempts.size()), fixed(simulated, 0), fixed(simulated / cpu, 0), each(trace), each(plan), each(contact)});
  }
  const Row head = {"planner", "runs", "simulated, s", "simulated s per CPU s", "scan, µs", "decision, µs", "contact, µs"};
  publish(options, "cost",
          made_by(options, fmt::format("{} problems, {} of each of the ten families; 180 rays, 8 bumpers, ten decisions a second, range noise 0.03 m. CPU time is that of everything, worlds made "
                                       "traceable too; scan, decision and contact are wall time, each per decision, which others on the machine make longer. A decision is contour, bumpers and planner.",
                                       problems.size(), options.problems)) +
              markdown(head, rows));
}

}  // namespace thicket::study
