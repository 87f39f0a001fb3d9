// Rooms like those of McGuire, de Croon and Tuyls 2019, from corner to corner, beside what they published.
#include "study_rooms.hpp"

namespace thicket::study {
namespace {

/// From the repository that belongs to the paper: noise 0, 200 rooms, 3000 steps of 0.1 s.
struct Published {
  const char* planner;
  double reached_percent, length;
};
constexpr Published published[] = {{"com", 61.5, 1.68}, {"bug2", 89.0, 2.05}, {"alg1", 88.0, 2.30}, {"alg2", 95.0, 1.72}, {"i_bug", 88.5, 1.71}};

constexpr double time_limit = 300.0;  // s

Row row_of(const std::string& planner, const std::vector<Attempt>& attempts) {
  std::size_t reachable = 0, in_time = 0, reached = 0, right = 0, right_closed = 0, collisions = 0;
  std::vector<Attempt> quick;
  for (const Attempt& a : attempts) {
    const bool open = a.expected == Expected::reachable, fine = a.score == Score::right;
    reachable += open;
    reached += open && fine;
    right += fine;
    right_closed += !open && fine;
    collisions += a.collided();
    if (!open || !fine || a.simulated_s > time_limit) continue;
    ++in_time;
    quick.push_back(a);
  }
  Row row = {planner, percent(in_time, reachable), fixed(quantile(ratios(quick, Over::shortest), 0.5)), percent(reached, reachable), median_and_p90(ratios(attempts, Over::shortest)),
             percent(right_closed, attempts.size() - reachable), percent(right, attempts.size()), std::to_string(collisions)};
  for (const Published& p : published)
    if (planner == p.planner) row.insert(row.end(), {fmt::format("{:.1f} %", p.reached_percent), fixed(p.length)});
  row.resize(10);
  return row;
}

}  // namespace

std::vector<Judged> rooms(const Options& options, const Mission& lean, std::string& words) {
  std::size_t open = 0, closed = 0, looked_at = 0;
  const auto wants = [&](Expected expected) {
    if (expected == Expected::reachable) return open < options.problems && ++open;
    return expected == Expected::unreachable && closed < options.closed && ++closed;
  };
  auto chosen = choose("rooms2019", options.problems + options.closed, lean, options.jobs, wants, &looked_at);
  words = fmt::format("the first {} rooms whose goal can be reached and {} where it cannot, of the numbers 0 to {}", open, closed, looked_at - 1);
  return chosen;
}

Mission room_mission(const std::vector<Override>& changes) {
  std::vector<Override> list = {{"planner.speed_m_s", "0.35", ""}};
  list.insert(list.end(), changes.begin(), changes.end());
  return or_exit(lean_mission(list));
}

void study_rooms(const Options& options) {
  const Mission lean = room_mission({});
  std::string words;
  const auto problems = rooms(options, lean, words);
  std::vector<Variant> variants;
  for (const std::string& planner : options.planners) variants.push_back({lean, planner});
  // A run with the time limit is the same run, cut off.
  const auto attempts = run_variants(problems, variants, options.jobs);
  std::vector<Row> rows;
  for (std::size_t v = 0; v < variants.size(); ++v) rows.push_back(row_of(variants[v].planner, attempts[v]));
  const Row head = {"planner", "reached in 300 s", "length / A*", "reached", "length / A* (p90)", "right where closed", "right of all", "collisions", "2019: reached in 300 s", "2019: length / A*"};
  publish(options, "rooms", made_by(options, words + fmt::format(", at 0.35 m/s; {:.0f} hours simulated.", hours(attempts))) + markdown(head, rows));
}

}  // namespace thicket::study
