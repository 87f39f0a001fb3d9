// Maps that nobody here made: every planner on every map of a folder, beside the exact point robot.
#include <map>

#include "study_runs.hpp"

namespace thicket::study {
namespace {

/// Length / D, median and 90th percentile, of an exact point robot on the map's own pixels, measured apart from this program.
struct Reference {
  const char *map, *planner;
  double median, p90;
};
constexpr Reference references[] = {
    {"warehouse-10-20-10-2-1", "bug1", 2.81, 5.91}, {"warehouse-10-20-10-2-1", "bug2", 1.96, 3.31}, {"Berlin_0_256", "bug1", 8.59, 30.3},
    {"Berlin_0_256", "bug2", 2.98, 19.2},           {"maze-32-32-4", "bug1", 33.3, 68.8},           {"maze-32-32-4", "bug2", 12.8, 39.0},
};

std::string reference_of(const std::string& map, const std::string& planner) {
  for (const Reference& r : references)
    if (map == r.map && planner == r.planner) return fmt::format("{:.3g} ({:.3g})", r.median, r.p90);
  return "";
}

/// A small and fast vehicle: ways through a maze are 33 times as long as the straight one, and nothing here asks how long they take.
Mission fast_mission() {
  return or_exit(lean_mission({{"vehicle.radius_m", "0.15", ""},
                               {"planner.clearance_m", "0.1", ""},
                               {"vehicle.speed_max_m_s", "2.0", ""},
                               {"vehicle.acceleration_m_s2", "4.0", ""},
                               {"vehicle.deceleration_m_s2", "4.0", ""},
                               {"vehicle.turn_rate_max_deg_s", "360.0", ""},
                               {"vehicle.turn_acceleration_deg_s2", "1440.0", ""}}));
}

}  // namespace

void study_maps(const Options& options) {
  const Mission lean = fast_mission();
  const ReadProblems read = or_exit(read_problems(options.maps, {options.problems, 1.0, 1}, robot_of(lean)));
  for (const std::string& notice : read.notices) fmt::print(stderr, "{}\n", notice);
  ReachabilityOptions how;
  how.planners = options.planners;
  how.jobs = options.jobs;
  Progress progress;
  how.progress = [&](const ReachabilityProgress& p) { progress.show(p.problems, p.of, p.simulated_s); };
  const auto attempts = or_exit(run_reachability(listed_problems(read.problems), lean, how));
  progress.end(attempts.size(), 3600.0 * hours({attempts}));

  std::map<std::pair<std::string, std::string>, std::vector<Attempt>> own;
  for (const Attempt& a : attempts) own[{a.family, a.planner}].push_back(a);
  std::vector<Row> rows;
  for (const ReachabilityTotals& t : total(attempts)) {
    const auto& list = t.family == "all" ? std::vector<Attempt>{} : own[{t.family, t.planner}];
    rows.push_back({t.family, t.planner, std::to_string(t.problems), std::to_string(t.unreachable), std::to_string(t.right), std::to_string(t.wrong), std::to_string(t.ambiguous),
                    std::to_string(t.collisions), fixed(t.ratio_median), median_and_p90(ratios(list, Over::straight)), reference_of(t.family, t.planner),
                    t.bound_use > 0.0 ? fixed(t.bound_use) : "-", fixed(t.least_clearance_m, 3)});
  }
  std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return (a[0] == "all") != (b[0] == "all") ? b[0] == "all" : a[0] < b[0]; });
  const Row head = {"map", "planner", "problems", "unreachable", "right", "wrong", "ambiguous", "collisions", "length / shortest", "length / D (p90)", "exact point robot", "length / bound, worst",
                    "clearance, m"};
  publish(options, "maps",
          made_by(options, fmt::format("{} runs, {:.0f} hours simulated; a hull of 0.15 m radius, a clearance of 0.1 m, MovingAI cells of 1 m, and a vehicle of 2 m/s, 4 m/s², 360 °/s "
                                       "and 1440 °/s² that is nobody's, so that long ways take less time.",
                                       attempts.size(), hours({attempts}))) +
              markdown(head, rows, 2));
}

}  // namespace thicket::study
