// Problems of navigation: a world, a start, a goal. Made from a family's name and a number, or read from a folder of maps.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "thicket/base/pose.hpp"
#include "thicket/base/result.hpp"
#include "thicket/sim/vehicle.hpp"
#include "thicket/worlds/world.hpp"

namespace thicket {

/// Whose problem it is: widths of gaps and distances from walls follow from it.
struct Robot {
  VehicleSpec vehicle;
  double clearance_m = 0.4;  ///< that the planner keeps between hull and matter
  double goal_tolerance_m = 0.1;

  /// Distance of the robot's axis from matter.
  double keep() const { return vehicle.radius_m + clearance_m; }
};

struct Problem {
  std::string family;        ///< "maze"; of a map, its file's name
  std::uint64_t number = 0;  ///< seed of a generated one, place in the list of a folder's
  std::shared_ptr<const World> world;  ///< shared by all problems of one map
  std::filesystem::path world_file;    ///< of a map; empty: generated
  double cell_size_m = 0.0;            ///< of a MovingAI map; else 0
  Pose2 start;
  glm::dvec2 goal{0.0, 0.0};
  std::filesystem::path world_image = {};  ///< of a map whose YAML names an image that is not there: the one that was read instead; else empty
};

/// The ten families that a rigorous suite of worlds has, in the order in which they are told: convex, spiral, maze, comb, enclosed, goal, m_line, thin, twins, random.
const std::vector<std::string>& problem_families();

/// What a family's worlds are like, as a sentence without its stop; empty for an unknown one.
const std::string& family_in_words(const std::string& family);

/// The problem of a number in one of `problem_families`, or in "rooms2019" (rooms and corridors on 14 x 14 m as McGuire et al. 2019 generate them, corner to corner).
/// A function of its arguments alone: the same numbers wherever the mathematical library is the same. Matter is one opaque material, "wall", and stands from z = 0 to
/// above the hull. All widths follow from the robot: lengths without a need of their own scale with `keep()` and what is in doubt, so that the robot for which the worlds
/// are meant (radius 0.25 m, clearance 0.4 m) has them 8 to 12 m wide, the widest 14 m.
/// Start and goal are free after growth by `keep()` and `problem_doubt`, but where a family is about just that (goal, m_line). Errors: an unknown family (with the
/// nearest known one), a robot whose size is not finite or not greater than 0.
Result<Problem> make_problem(const std::string& family, std::uint64_t number, const Robot& robot);

/// What a problem of the family "twins" is to the one before it: numbers 2k and 2k + 1 are a pair, the same problem of another family and its twin. Mirrored: y has become
/// -y, so that the twin's left hand does what the first one's right hand does. Turned: about the origin, by any angle. Moved: by up to 1000 m along each axis.
enum class TwinChange : std::uint8_t { none, mirrored, turned, moved };
TwinChange twin_change(std::uint64_t number);  ///< none of an even number

/// By how much the growth of obstacles is in doubt, m: a verdict that changes within it is ambiguous. A tenth of the clearance, a cell of the oracle (0.05 m), and
/// three standard deviations of range noise (0.03 m).
double problem_doubt(const Robot& robot);

/// How problems are taken from maps.
struct MapProblems {
  std::size_t problems_per_map = 200;
  double cell_size_m = 1.0;  ///< of MovingAI maps, which do not tell it
  std::uint64_t seed = 1;    ///< of random starts and goals
};

/// What was read. `notices` tells what was passed over, a sentence each.
struct ReadProblems {
  std::vector<Problem> problems;
  std::vector<std::string> notices;
};

/// The problems of a map or world, or of all maps (map_server YAML, MovingAI `.map`) and world files (TOML) below a folder, in the order of their paths; missions are
/// passed over. Start and goal of a MovingAI map are those of the scenarios beside it (NAME.scen, NAME.map.scen, NAME-*.scen, the rows that name the map), spread evenly
/// over their list, but for those that are nearer to matter than `keep()`: they are counted in a notice. Where there are none or too few of them, starts and goals are
/// random places that are free after growth by `keep()` and `problem_doubt`, joined or not. A world that moves or has no room for the robot has no problems, and a notice.
/// Where the image that a YAML names cannot be read, one of the YAML's own name is taken (x.yaml: x.pgm, x.png). Errors name the file: what cannot be read, no map at all.
Result<ReadProblems> read_problems(const std::filesystem::path& folder_or_file, const MapProblems& how, const Robot& robot);

}  // namespace thicket
