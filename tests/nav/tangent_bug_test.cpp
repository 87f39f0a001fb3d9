// TangentBug, with the sensor of a real robot: 180 rays of 5 m, with noise.
#include <doctest/doctest.h>

#include "disc_world.hpp"

namespace thicket {
namespace {
const TestSensor sensor{180, 5.0, std::getenv("TRY_S") ? std::atof(std::getenv("TRY_S")) : 0.03};
}

TEST_CASE("random try") {
  const char* env = std::getenv("TRY_N");
  const char* names = std::getenv("TRY_P");
  if (!env) return;
  const int n = std::atoi(env), first = std::getenv("TRY_0") ? std::atoi(std::getenv("TRY_0")) : 0;
  const double density = std::getenv("TRY_D") ? std::atof(std::getenv("TRY_D")) : 0.15;
  int right = 0, wrong = 0, ambiguous = 0, unreachable = 0;
  double ratio = 0.0;
  for (int k = first; k < first + n; ++k) {
    const Random random(7, 0);
    LetterMap map;
    map.cell = std::getenv("TRY_C") ? std::atof(std::getenv("TRY_C")) : 1.5;
    for (int r = 0; r < 14; ++r) {
      std::string row;
      for (int c = 0; c < 20; ++c) row += r == 0 || r == 13 || c == 0 || c == 19 || random.uniform(k, r, RandomUse::sampling, c)[0] < density ? '#' : '.';
      map.rows.push_back(row);
    }
    map.rows[11][2] = 'S';
    map.rows[2][17] = 'T';
    if (map.clearance(map.find('S'), 1.0) < 0.7 || map.clearance(map.find('T'), 1.0) < 0.7) { ++ambiguous; continue; }
    const double narrow = shortest(map, 0.6 + 0.12, 0.15), wide = shortest(map, 0.6 - 0.12, 0.15);
    if (std::isfinite(narrow) != std::isfinite(wide) || (std::isinf(wide) && map.matter(int(map.find('S').x / map.cell) + 1, 2) && map.matter(int(map.find('S').x / map.cell), 3) && map.matter(1, 2) && map.matter(2, 1))) { ++ambiguous; continue; }
    const Run run = drive(map, names, k % 2 ? "left" : "right", sensor);
    const bool ok = run.last.outcome == (std::isfinite(narrow) ? Outcome::reached : Outcome::unreachable);
    if (!std::isfinite(narrow)) ++unreachable;
    if (ok) { ++right; if (std::isfinite(narrow)) ratio += run.length / wide; }
    else {
      ++wrong;
      MESSAGE(names, " ", k, " shortest ", narrow, " length ", run.length, " hits ", count(run.marks, "hit"), " ", run.last.state, " ", run.last.reason);
      if (std::getenv("TRY_MAP")) for (auto& m : run.marks) MESSAGE(m.label, " ", m.from.x, " ", m.from.y, " d ", glm::distance(m.from, map.find('T')));
      if (std::getenv("TRY_MAP")) for (auto& row : map.rows) MESSAGE(row);
    }
    if (run.least < 0.2) MESSAGE(k, " least ", run.least);
  }
  MESSAGE(names, " right ", right, " wrong ", wrong, " ambiguous ", ambiguous, " unreachable ", unreachable, " ratio ", ratio / std::max(1, right - unreachable));
}
}  // namespace thicket
