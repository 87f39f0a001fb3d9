// What a lean run costs, by planner. Wall times: unlike the other studies' results these depend on the machine.
#include "study_runs.hpp"

namespace thicket::study {

void study_cost(const Options& options) {
  const Mission lean = or_exit(lean_mission({{"sensor.range_noise_m", "0.03", ""}}));
  const auto problems = choose_of_all(options.problems, lean, options.jobs);
  std::vector<Variant> variants;
  for (const std::string& planner : options.planners) variants.push_back({lean, planner});
  const auto attempts = run_variants(problems, variants, options.jobs);
  std::vector<Row> rows;
  for (std::size_t v = 0; v < variants.size(); ++v) {
    double simulated = 0.0, decisions = 0.0, trace = 0.0, plan = 0.0, contact = 0.0;
    for (const Attempt& a : attempts[v]) {
      simulated += a.simulated_s;
      decisions += static_cast<double>(a.decisions);
      trace += a.times.trace;
      plan += a.times.plan;
      contact += a.times.contact;
    }
    const auto each = [&](double time) { return fixed(1e6 * time / decisions, 1); };
    rows.push_back({variants[v].planner, std::to_string(attempts[v].size()), fixed(simulated, 0), fixed(simulated / (trace + plan + contact), 0), each(trace), each(plan), each(contact)});
  }
  const Row head = {"planner", "runs", "simulated, s", "x real time", "scan, µs", "decision, µs", "contact, µs"};
  publish(options, "cost",
          made_by(options, fmt::format("{} problems, {} of each of the ten families; 180 rays, 8 bumpers, ten decisions a second, range noise 0.03 m, one thread. A decision is contour, bumpers and planner.", problems.size(),
                                       options.problems)) +
              markdown(head, rows));
}

}  // namespace thicket::study
