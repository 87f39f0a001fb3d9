// The families of generated problems by name.
#include "thicket/sim/problem.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include <glm/geometric.hpp>

#include "problem_maker.hpp"
#include "thicket/base/text.hpp"

namespace thicket {
namespace {

constexpr double oracle_cell = 0.05, range_noise = 0.03;  // m
constexpr std::uint64_t most_attempts = 1000;

struct Family {
  const char* name;
  MakeFamily make;
  const char* words;
};

/// What is made here; the twins are made of the others. (The place of a family decides what its numbers give: new ones go to the end.)
constexpr Family families[] = {
    {"convex", make_convex, "convex obstacles, one to seven, that stay apart when they grow"},
    {"spiral", make_spiral, "U and spiral, of either sense, from inside and from outside, open and closed"},
    {"maze", make_maze, "mazes, with and without loops, and combs whose teeth the straight way crosses, open and closed"},
    {"enclosed", make_enclosed, "goal or start in a pen that is closed, or has a gap: far too narrow, wide enough, or in between"},
    {"goal", make_goal, "goal inside matter, nearer to it than the robot keeps, off a corner, or outside the arena; or the start nearer than that"},
    {"m_line", make_m_line, "the straight way tangent to an obstacle, through a corner, or along a wall; the start at an obstacle; start and goal as good as one"},
    {"thin", make_thin, "walls of millimetres, gaps too narrow, boxes that meet in a point, at the arena's edge or when they grow, posts of centimetres"},
    {"random", make_random, "three to twelve boxes, posts and walls at random, now and then a pen or a wall from side to side"},
    {"comb", make_comb, "combs: two in each other, where Bug1 is shorter than Bug2 on one hand at least, and one that stands free, where Bug2 is; some closed"},
    {"rooms2019", make_rooms2019, "rooms and corridors with doors, on 14 x 14 m, from corner to corner"},
};

const Family* find_family(const std::string& name) {
  for (const Family& family : families)
    if (name == family.name) return &family;
  return nullptr;
}

/// The angle that a file gives back, which holds it in degrees.
double as_in_a_file(double yaw) { return radians(degrees(yaw)); }

Problem problem_of(ProblemMaker& maker, const std::string& family, std::uint64_t number, std::string world_name) {
  Problem problem;
  problem.family = family;
  problem.number = number;
  problem.start = {maker.start.position, as_in_a_file(maker.start.yaw)};
  problem.goal = maker.goal;
  for (Solid& solid : maker.world.solids) solid.yaw = as_in_a_file(solid.yaw);
  maker.world.name = std::move(world_name);
  maker.world.source = fmt::format("thicket reachability: {}", family_in_words(family));
  problem.world = std::make_shared<const World>(std::move(maker.world));
  return problem;
}

Error no_place(const std::string& name, const Robot& robot) {
  return Error{fmt::format("problem '{}' has no place for a robot that keeps {} m from matter, expected a smaller one", name, robot.keep())};
}

bool build(const Family& family, ProblemMaker& maker) {
  for (std::uint64_t attempt = 0; attempt < most_attempts; ++attempt) {
    maker.begin(attempt);
    maker.start.yaw = maker.angle();
    family.make(maker);
    if ((!maker.start_is_free || maker.is_free(maker.start.position)) && (!maker.goal_is_free || maker.is_free(maker.goal))) return true;
  }
  return false;
}

/// Of twins: the families that they are of, none of which is to be added or moved, or all their numbers would change.
constexpr const char* families_of_twins[] = {"convex", "spiral", "maze", "comb", "enclosed", "goal", "m_line", "thin", "random"};
constexpr std::uint64_t count_of_those = std::size(families_of_twins);
constexpr std::uint16_t family_of_changes = 1000;  // the random numbers of changes are not those of any family

/// A maker that holds the first of a pair, and, for an odd number, what its twin is.
struct Twins {
  ProblemMaker maker;
  std::string name;
};

/// Numbers 2k and 2k + 1 are the same problem and its twin: mirrored (y becomes -y: the other hand follows what this one does), turned by any angle, or moved by up to
/// 1000 m along each axis.
Result<Twins> make_twins(std::uint64_t number, const Robot& robot) {
  const std::uint64_t pair = number / 2;
  const Family* family = find_family(families_of_twins[pair % count_of_those]);
  Twins twins{ProblemMaker(robot, static_cast<std::uint16_t>(family - families), pair / count_of_those), fmt::format("{} {}", family->name, pair / count_of_those)};
  if (!build(*family, twins.maker)) return no_place(twins.name, robot);
  if (number % 2 == 0) return twins;
  ProblemMaker change(robot, family_of_changes, pair);
  switch (twin_change(number)) {
    case TwinChange::mirrored:
      twins.maker.mirror();
      twins.name += ", mirrored";
      break;
    case TwinChange::turned:
      twins.maker.rotate(change.angle());
      twins.name += ", turned";
      break;
    default:
      twins.maker.translate(change.within({1000.0, 1000.0}));
      twins.name += ", moved";
  }
  return twins;
}

}  // namespace

TwinChange twin_change(std::uint64_t number) {
  if (number % 2 == 0) return TwinChange::none;
  // By turns, another one for every family.
  const std::uint64_t pair = number / 2;
  constexpr TwinChange changes[] = {TwinChange::mirrored, TwinChange::turned, TwinChange::moved};
  return changes[(pair + pair / count_of_those) % 3];
}

double problem_doubt(const Robot& robot) { return 0.1 * robot.clearance_m + oracle_cell + 3.0 * range_noise; }

const std::vector<std::string>& problem_families() {
  static const std::vector<std::string> names = {"convex", "spiral", "maze", "comb", "enclosed", "goal", "m_line", "thin", "twins", "random"};
  return names;
}

const std::string& family_in_words(const std::string& name) {
  static const std::vector<std::string> words = [] {
    std::vector<std::string> list;
    for (const Family& family : families) list.emplace_back(family.words);
    list.emplace_back("pairs of a problem of the other families and the same mirrored, turned or moved by up to 1000 m");
    return list;
  }();
  static const std::string none;
  if (name == "twins") return words.back();
  const Family* family = find_family(name);
  return family ? words[static_cast<std::size_t>(family - families)] : none;
}

Result<Problem> make_problem(const std::string& name, std::uint64_t number, const Robot& robot) {
  const double radius = robot.vehicle.radius_m, clearance = robot.clearance_m;
  if (!(radius > 0.0 && clearance >= 0.0 && std::isfinite(robot.keep())))
    return Error{fmt::format("the robot has a radius of {} m and a clearance of {} m, expected finite numbers, the first above 0, the second at least 0", radius, clearance)};
  const bool twins = name == "twins";
  const Family* family = find_family(name);
  if (!family && !twins) {
    std::vector<std::string> known = problem_families();
    known.emplace_back("rooms2019");
    return Error{fmt::format("there is no family of problems '{}', expected one of '{}'{}", name, fmt::join(known, "', '"), did_you_mean(name, known))};
  }
  const std::string words = fmt::format("{} {}", name, number);
  if (twins) {
    auto made = make_twins(number, robot);
    if (!made) return made.error();
    return problem_of(made->maker, name, number, fmt::format("{}: {}", words, made->name));
  }
  ProblemMaker maker(robot, static_cast<std::uint16_t>(family - families), number);
  if (!build(*family, maker)) return no_place(words, robot);
  return problem_of(maker, name, number, words);
}

}  // namespace thicket
