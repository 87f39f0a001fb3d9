#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <exception>

#include "program.hpp"
#include "thicket/base/schema.hpp"
#include "thicket/sim/outputs.hpp"

namespace {

using thicket::Override;
using namespace thicket::cli;

/// "1,2,3" in `count` pieces (or fewer, as long as there are `least`); nothing if it is not so.
std::optional<std::vector<std::string>> split(const std::string& text, std::size_t least, std::size_t most) {
  std::vector<std::string> pieces = CLI::detail::split(text, ',');
  if (pieces.size() < least || pieces.size() > most) return std::nullopt;
  return pieces;
}

/// Flags that stand for mission keys.
struct MissionFlags {
  std::string world, start, goal, planner, map_image;
  std::optional<double> cell_size;
  std::vector<std::string> sets;
  std::optional<std::string> seed;

  void add_to(CLI::App& app) {
    app.add_option("--world", world, "world file or map_server YAML")->type_name("FILE");
    app.add_option("--map-image", map_image, "for a map_server world: an image instead of the one that it names")->type_name("FILE");
    app.add_option("--cell-size", cell_size, "for a MovingAI .map world: metres a cell")->type_name("M");
    app.add_option("--start", start, "where the vehicle starts: metres and degrees")->type_name("X,Y,YAW_DEG");
    app.add_option("--goal", goal, "where it is to go, metres")->type_name("X,Y");
    app.add_option("--planner", planner, "bug1, bug2 or waypoints")->type_name("NAME");
    app.add_option("--set", sets, "any key of `thicket help mission`, for example planner.clearance_m=0.5; may be given often")->type_name("KEY=VALUE")->allow_extra_args(false);
    app.add_option("--seed", seed, "seed of everything random")->type_name("N");
  }

  /// In the order that lets --set have the last word.
  std::optional<std::vector<Override>> overrides() const {
    std::vector<Override> list;
    const auto text = [&list](const char* key, const std::string& value, const char* flag) {
      if (!value.empty()) list.push_back({key, thicket::toml_string(value), flag});
    };
    text("world", world, "--world");
    text("world_image", map_image, "--map-image");
    if (cell_size) list.push_back({"world_cell_size_m", thicket::to_toml(*cell_size), "--cell-size"});
    text("planner.name", planner, "--planner");
    if (!start.empty()) {
      const auto pieces = split(start, 2, 3);
      if (!pieces) return fail("--start is '" + start + "', expected X,Y,YAW_DEG, for example 1.5,-2,90");
      const char* keys[] = {"start.x_m", "start.y_m", "start.yaw_deg"};
      for (std::size_t i = 0; i < pieces->size(); ++i) list.push_back({keys[i], (*pieces)[i], "--start"});
    }
    if (!goal.empty()) {
      if (!split(goal, 2, 2)) return fail("--goal is '" + goal + "', expected X,Y, for example 8,0");
      list.push_back({"planner.goal_m", "[" + goal + "]", "--goal"});
    }
    if (seed) list.push_back({"seed", *seed, "--seed"});
    for (const std::string& set : sets) {
      const auto equals = set.find('=');
      if (equals == std::string::npos) return fail("--set is '" + set + "', expected KEY=VALUE, for example planner.clearance_m=0.5");
      list.push_back({set.substr(0, equals), set.substr(equals + 1), "--set " + set.substr(0, equals)});
    }
    return list;
  }

  static std::nullopt_t fail(const std::string& what) {
    fmt::print(stderr, "{}\n", what);
    return std::nullopt;
  }
};

void add_truth(CLI::App& app, TruthArguments& a) {
  app.add_option("world", a.world, "world file, map_server YAML or MovingAI .map; shipped ones are found from any directory")->required()->type_name("FILE");
  app.add_option("--out", a.out, "map to write, FILE.yaml and FILE.pgm; a picture if it ends in .png")->required()->type_name("FILE");
  app.add_option("--resolution", a.resolution, "metres a cell")->capture_default_str();
  CLI::Option* grow = app.add_option("--grow", a.grow, "obstacles grown by so many metres: where the axis of a hull of this radius may not be")->check(CLI::NonNegativeNumber)->capture_default_str();
  app.add_option("--z-low", a.z_low, "from this height, metres")->capture_default_str();
  app.add_option("--z-high", a.z_high, "to this height, metres")->capture_default_str();
  app.add_option("--convention", a.convention, "overlap: a cell is occupied if it and matter share any area; centre: if its centre lies in matter")->capture_default_str()->excludes(grow);
  app.add_option("--bounds", a.bounds, "what to map, metres (default: the world's bounds_m, else all that is there and a metre around)")->type_name("X0,Y0,X1,Y1");
  app.add_option("--from", a.from, "with --to: tells whether there is a way over free cells, and how long the shortest is")->type_name("X,Y");
  app.add_option("--to", a.to, "where the way leads")->type_name("X,Y");
  app.add_option("--time", a.time, "the world as it stands at this time, seconds")->capture_default_str();
  app.add_flag("--all-matter", a.all_matter, "also matter that does not stop motion");
  app.add_option("--cell-size", a.cell_size, "of a MovingAI map, metres a cell; 1 if it is not given")->type_name("M");
  app.add_option("--map-image", a.map_image, "for a map_server world: an image instead of the one that it names")->type_name("FILE");
}

void add_convert(CLI::App& app, ConvertArguments& a) {
  app.add_option("in", a.in, "map_server YAML, .npy (NumPy), .ot or .bt (OctoMap), MovingAI .map, or a world file, which is mapped as by `thicket truth`; an OBJ file becomes a world (.toml) of its mesh")->required()->type_name("IN");
  app.add_option("out", a.out, "what to write: .yaml (and its .pgm, of --mode scale .png), .npy, .ot, .bt, .map, .toml (a world of one solid, with the .yaml and .pgm beside it), or .png: a picture with a legend, which is not read again")->required()->type_name("OUT");
  app.add_option("--mode", a.mode, "of a .yaml: trinary (occupied, free, unknown; the default), scale (probability as grey, unknown transparent), raw (percent)")->type_name("MODE");
  app.add_option("--cell-size", a.cell_size, "of a MovingAI map, metres a cell; 1 if it is not given. Of a .npy, which needs it")->type_name("M");
  app.add_option("--origin", a.origin, "of a .npy: its lower-left corner, metres; 0,0 if it is not given")->type_name("X,Y");
  app.add_option("--z", a.z, "of an .ot or .bt: the height of the layer to read or to write, metres; needed if there are several")->type_name("M");
  app.add_option("--resolution", a.resolution, "of a mapped world, metres a cell")->capture_default_str();
  app.add_option("--z-low", a.z_low, "a world is mapped from this height, metres")->capture_default_str();
  app.add_option("--z-high", a.z_high, "to this height, metres")->capture_default_str();
  app.add_option("--height", a.height, "height of the solid in a .toml, metres")->capture_default_str();
  app.add_option("--map-image", a.map_image, "for a map_server map: an image instead of the one that it names")->type_name("FILE");
}

void add_picture(CLI::App& app, PictureArguments& a) {
  app.add_option("world", a.world, "world file, map_server YAML, MovingAI .map or OBJ; shipped ones are found from any directory")->required()->type_name("FILE");
  app.add_option("--out", a.out, "picture to write, FILE.png")->required()->type_name("FILE");
  app.add_option("--from", a.from, "where the camera is, metres (default: south-west of it all and above, so that everything is seen)")->type_name("X,Y,Z");
  app.add_option("--at", a.at, "what is in the middle of the picture, metres (default: the middle of the world)")->type_name("X,Y,Z");
  app.add_option("--fov-deg", a.fov_deg, "horizontal opening, degrees")->capture_default_str();
  app.add_option("--size", a.size, "pixels")->capture_default_str()->type_name("WIDTHxHEIGHT");
  app.add_option("--time", a.time, "the world as it stands at this time, seconds")->capture_default_str();
  app.add_option("--hide", a.hide, "leave a solid out, by name; may be given often. A [ceiling] is left out if the camera is above it")->type_name("NAME")->allow_extra_args(false);
  app.add_option("--cell-size", a.cell_size, "of a MovingAI map, metres a cell; 1 if it is not given")->type_name("M");
  app.add_option("--map-image", a.map_image, "for a map_server world: an image instead of the one that it names")->type_name("FILE");
}

void add_generate(CLI::App& app, GenerateArguments& a) {
  app.add_option("name", a.name, "model (default: a list of them)")->type_name("NAME");
  app.add_option("--out", a.out, "OBJ file to write; the MTL file goes beside it")->type_name("FILE.obj");
  const auto size = [&](const char* flag, double& metres, const char* what) { app.add_option(flag, metres, std::string("of the hold, metres: ") + what)->check(CLI::PositiveNumber)->capture_default_str()->type_name("M"); };
  size("--length", a.hold.length, "inside");
  size("--breadth", a.hold.breadth, "inside");
  size("--depth", a.hold.depth, "from the tank top to the open deck");
  size("--plate", a.hold.plate, "thickness of all plates");
  size("--frame-spacing", a.hold.frame_spacing, "between web frames, at most");
  size("--frame-depth", a.hold.frame_depth, "of web frames, inward");
  size("--flange-width", a.hold.flange_width, "of the web frames' flanges");
  size("--stiffener-spacing", a.hold.stiffener_spacing, "between stiffeners, at most");
  size("--stiffener-depth", a.hold.stiffener_depth, "of stiffeners, inward");
  size("--deck-width", a.hold.deck_width, "of the strip of deck outside");
}

void add_scan(CLI::App& app, ScanArguments& a) {
  app.add_option("world", a.world, "world file, map_server YAML, MovingAI .map or OBJ; shipped ones are found from any directory")->type_name("FILE");
  app.add_option("--pose", a.pose, "where the sensor itself is (its mount on a vehicle is left out): metres, z above the world's zero, degrees, pitch nose down")->type_name("X,Y,Z,YAW_DEG[,PITCH_DEG]");
  app.add_option("--sensor", a.sensors, "sensor preset (`thicket sensors`) or file; may be given often")->type_name("NAME")->allow_extra_args(false);
  app.add_option("--compare", a.compared, "another one to hold against it, which --set KEY leaves as it is; may be given often")->type_name("NAME")->allow_extra_args(false);
  app.add_option("--set", a.sets, "any key of --sensor, for example range_max_m=20; NAME.KEY=VALUE for one sensor by name; may be given often")->type_name("KEY=VALUE")->allow_extra_args(false);
  app.add_option("--to", a.to, "with --steps: scans on the straight way from --pose to here")->type_name("X,Y,Z,YAW_DEG[,PITCH_DEG]");
  app.add_option("--steps", a.steps, "scans on the way to --to, both ends included")->type_name("N");
  app.add_option("--poses", a.poses, "scans at the poses of a table x_m,y_m,z_m,yaw_deg[,pitch_deg][,label]")->type_name("FILE.csv");
  app.add_option("--x-label", a.x_label, "draw over the column `label` of --poses, which is this: \"tilt, deg\"")->type_name("TEXT");
  app.add_option("--number", a.number, "number of the scan, of the first one on a way: another number, other noise")->capture_default_str()->type_name("N");
  app.add_option("--seed", a.seed, "seed of everything random")->capture_default_str()->type_name("N");
  app.add_option("--time", a.time, "the world as it stands at this time, seconds")->capture_default_str();
  app.add_option("--velocity", a.velocity, "of the sensor in the world, metres per second, for radial velocities")->type_name("VX,VY,VZ");
  app.add_option("--csv", a.csv, "a row for each echo, on a way for each pose; - is the terminal")->type_name("FILE");
  app.add_option("--json", a.json, "all of it, with the keys of the sensors; - is the terminal")->type_name("FILE");
  app.add_option("--profile-csv", a.profile_csv, "of a receiver: a row for each range bin; - is the terminal")->type_name("FILE");
  app.add_option("--png", a.png, "picture: what a scanning sensor saw around it, amplitude over range of a lobe, range over way")->type_name("FILE.png");
  app.add_option("--cell-size", a.cell_size, "of a MovingAI map, metres a cell; 1 if it is not given")->type_name("M");
  app.add_option("--map-image", a.map_image, "for a map_server world: an image instead of the one that it names")->type_name("FILE");
}

void add_reachability(CLI::App& app, ReachabilityArguments& a) {
  app.add_option("--families", a.families, "families of generated problems (default: all ten)")->delimiter(',')->type_name("A,B,...");
  app.add_option("--problems", a.problems, "problems of each family")->check(CLI::Range(1, 10000000))->capture_default_str()->type_name("N");
  app.add_option("--first", a.first, "number of the first problem of each family")->check(CLI::Range(std::int64_t{0}, std::int64_t{1} << 52))->capture_default_str()->type_name("N");
  CLI::Option* rooms = app.add_option("--rooms", a.rooms, "so many rooms of 14 x 14 m as McGuire et al. 2019 generate them, corner to corner")->check(CLI::Range(1, 10000000))->type_name("N");
  CLI::Option* maps = app.add_option("--maps", a.maps, "a map or world, or a folder of them: map_server, MovingAI (with its .scen), TOML")->type_name("PATH")->excludes(rooms);
  app.add_option("--per-map", a.per_map, "problems of each map")->check(CLI::Range(1, 10000000))->capture_default_str()->type_name("N");
  app.add_option("--cell-size", a.cell_size, "of MovingAI maps, metres a cell; 1 if it is not given")->check(CLI::PositiveNumber)->type_name("M");
  CLI::Option* world = app.add_option("--world", a.world, "one problem: the world, with --start and --goal")->type_name("FILE")->excludes(rooms)->excludes(maps);
  app.add_option("--start", a.start, "metres and degrees")->type_name("X,Y[,YAW_DEG]")->needs(world);
  app.add_option("--goal", a.goal, "metres")->type_name("X,Y")->needs(world);
  app.add_option("--planners", a.planners, "planners to run (default: bug1,bug2,tangent_bug)")->delimiter(',')->type_name("A,B,...");
  app.add_option("--hand", a.hand, "on the wall: left, right, both, or alternate: left for problems of an even number, right for others")->capture_default_str();
  app.add_option("--vehicle", a.vehicle, "vehicle preset or file (default: a P3-AT of 0.25 m radius)")->type_name("NAME");
  app.add_option("--radius", a.radius, "of the hull, metres (default: 0.25)")->check(CLI::PositiveNumber)->type_name("M");
  app.add_option("--clearance", a.clearance, "between hull and matter, metres (default: 0.4)")->check(CLI::PositiveNumber)->type_name("M");
  app.add_option("--noise", a.noise, "standard deviation of the ranges, metres (default: 0)")->check(CLI::NonNegativeNumber)->type_name("M");
  app.add_option("--rays", a.rays, "rays of the radar, all around (default: 180)")->check(CLI::Range(3, 36000))->type_name("N");
  app.add_option("--time-limit", a.time_limit, "of a run, simulated seconds (default: what 6 x the bound takes, and 10 minutes)")->check(CLI::PositiveNumber)->type_name("S");
  app.add_option("--set", a.sets, "any key of `thicket help mission`, for example planner.speed_m_s=0.35; may be given often")->type_name("KEY=VALUE")->allow_extra_args(false);
  app.add_option("--csv", a.csv, "a row for each run; - is the terminal, instead of the table")->type_name("FILE");
  app.add_option("--keep-failures", a.keep_failures, "folder for missions that repeat each wrong run with `thicket run`")->type_name("DIR");
  app.add_option("--jobs", a.jobs, "threads; the result does not depend on it (default: all cores)")->check(CLI::Range(1, 1024))->type_name("N");
  app.add_flag("--quiet", a.quiet, "no progress");
  app.footer("A run is right if its verdict is that of the world itself (free space grown by radius and clearance), without a collision; stopped is wrong. A problem whose verdict\n"
             "changes if the growth changes by 0.1 x clearance + a cell of 0.05 m + 3 x noise is ambiguous: there, only a collision is wrong. Over: longer than 1.05 x the\n"
             "theorem's bound + 2 m. Exit codes: 0 nothing is wrong or over, 2 bad usage or file, 4 interrupted, 6 something is wrong or over.");
}

void add_experiments(CLI::App& app, ExperimentsArguments& a) {
  app.add_option("names", a.names, "experiments to make (default: all)")->type_name("NAME");
  app.add_flag("--list", a.list, "list them, with the figures of the sources that they stand for");
  app.add_option("--out", a.out, "folder for the pictures (default: docs/experiments if called in the source tree, else thicket-out/experiments)")->type_name("DIR");
  app.add_option("--page", a.page, "page in which their sections are replaced or put (default: docs/experiments.md in the tree, else experiments.md beside the pictures)")->type_name("FILE.md");
  app.add_flag("--short", a.brief, "shorter drives and fewer scans: other numbers, for tests");
  app.add_flag("--quiet", a.quiet, "no progress");
}

void add_score(CLI::App& app, ScoreArguments& a) {
  app.add_option("run_dir", a.folder, "folder that `thicket run` has written; the run is simulated once more, since its files do not hold probabilities")->required()->type_name("RUN_DIR");
  app.add_option("--truth", a.truth, "when a cell is matter: cell_centre: its centre lies in it; any_overlap: it and matter share any area")->capture_default_str();
  app.add_option("--tolerance", a.tolerance, "how far a claimed cell may be from a surface and still be right, metres")->check(CLI::NonNegativeNumber)->capture_default_str()->type_name("M");
  app.add_flag("--json", a.json, "print all figures as JSON");
}

void add_sar(CLI::App& app, SarArguments& a) {
  app.add_option("input", a.input, "folder that `thicket run` has written, or a mission; it is simulated once more")->required()->type_name("RUN_DIR|MISSION");
  app.add_option("--method", a.method, "simple_sum or back_projection, which needs signal = \"iq\" (default: back_projection where it can be)")->type_name("NAME");
  app.add_option("--sensor", a.sensor, "name of the lobe radar (default: the first)")->type_name("NAME");
  app.add_option("--frame", a.frame, "world or line: across and along the way that the lobe looks at first")->type_name("NAME");
  app.add_option("--bounds", a.bounds, "of the image, metres (default: all that comes into the lobe)")->type_name("X0,Y0,X1,Y1");
  app.add_option("--resolution", a.resolution, "edge of a pixel, metres (default: 0.02)")->type_name("M");
  app.add_option("--floor-db", a.floor_db, "down to what is shown, against the brightest pixel (default: -40)")->type_name("DB");
  app.add_flag("--fuse", a.fuse, "also take cells off the map where the image has no return: map_fused.pgm, and how good the map is before and after");
  app.add_option("--out", a.out, "folder for sar.png, sar.npy and sar.json (default: RUN_DIR, of a mission thicket-out/NAME)")->type_name("DIR");
  app.add_flag("--json", a.json, "print sar.json instead of a few lines");
}

void add_gui(CLI::App& app, GuiArguments& a) {
  app.add_option("file", a.file, "mission or world file; shipped ones are found from any directory. Without one the window asks")->type_name("MISSION|WORLD");
  app.add_option("--report", a.report, "at the end, write how the session ended as JSON: file, mission, steps, time, goal, position, verdict, frames, milliseconds a frame, OpenGL errors")->type_name("FILE.json");
  app.footer("F1 in the window shows every key. It needs a screen (DISPLAY or WAYLAND_DISPLAY); `thicket render` needs none.\nExit codes: 0 closed, 2 bad usage or file, or no screen.");
}

void add_render(CLI::App& app, RenderArguments& a) {
  app.add_option("file", a.file, "mission or world file, or the folder of a run, which is simulated once more")->required()->type_name("MISSION|RUN_DIR");
  app.add_option("--view", a.view, "world, 3d, map, radar, sar, mission, edit, planner, plots, profiler, or all: the whole window")->capture_default_str()->type_name("NAME");
  app.add_option("--at", a.at, "simulated seconds (default: the end of the run, which also comes where it ends before)")->type_name("S");
  app.add_option("--out", a.out, "picture to write")->required()->type_name("FILE.png");
  app.add_option("--size", a.size, "pixels")->capture_default_str()->type_name("WIDTHxHEIGHT");
  app.add_flag("--light", a.light, "dark on light");
}

int dispatch(int argc, char** argv) {
  CLI::App app{"Thicket simulates robots that find their way by radar."};
  app.name("thicket");
  app.set_version_flag("--version", thicket::version());
  app.require_subcommand(1);
  app.footer("First steps:\n  thicket worlds\n  thicket run worlds/data/foliage_wall/bug2.toml    and look at path.png and map.png in thicket-out/bug2\n"
             "  thicket run bugs/bug1_success                      what Bug planners do; bugs/bug2_2012_wrong: where one goes wrong\n"
             "  thicket reachability --problems 5                  are they right?\n  thicket help mission\n"
             "Exit codes of run: 0 reached, 1 internal error, 2 bad usage or file, 3 unreachable, 4 stopped, 5 collided.");

  RunArguments arguments;
  MissionFlags run_flags, check_flags, gui_flags, render_flags;
  CLI::App& run = *app.add_subcommand("run", "run a mission and leave its results in a folder");
  run.add_option("mission", arguments.mission, "mission file; shipped ones are found from any directory. Without one: --world, --start, --goal, --planner")->type_name("FILE");
  run_flags.add_to(run);
  run.add_option("--out", arguments.out, "folder for the results (default: thicket-out/NAME)")->type_name("DIR");
  run.add_option("--realtime-factor", arguments.realtime_factor, "simulated seconds per second at most; 0 is as fast as possible")->check(CLI::NonNegativeNumber);
  run.add_option("--threads", arguments.threads, "threads to use; the result does not depend on it (default: all cores)")->check(CLI::Range(1, 1024));
  run.add_flag("--quiet", arguments.quiet, "no progress, no warnings, no summary");
  run.add_flag("--json", arguments.json, "print result.json instead of the summary");
  run.add_flag("--score", arguments.score, "judge the map by the world itself: score.json, and the headline in result.json; as [output] score = true");

  GuiArguments gui_arguments;
  CLI::App& gui = *app.add_subcommand("gui", "open the window: see what the robot sees, touch it, try again");
  add_gui(gui, gui_arguments);
  gui_flags.add_to(gui);
  RenderArguments render_arguments;
  CLI::App& render = *app.add_subcommand("render", "draw a view of the window as a picture, without a screen");
  add_render(render, render_arguments);
  render_flags.add_to(render);

  ScoreArguments score_arguments;
  CLI::App& score = *app.add_subcommand("score", "how good the map of a run is, judged by the world itself (exit code 6: the run gives another map than the one in its folder)");
  add_score(score, score_arguments);

  SarArguments sar_arguments;
  MissionFlags sar_flags;
  CLI::App& sar = *app.add_subcommand("sar", "the image of synthetic aperture of a run: what one lobe saw along its way, laid together");
  add_sar(sar, sar_arguments);
  sar_flags.add_to(sar);

  std::string topic;
  CheckArguments check_arguments;
  CLI::App& check = *app.add_subcommand("check", "tell what is wrong with a world or mission file, and what to beware of");
  check.add_option("file", check_arguments.file, "world (TOML, map_server YAML, MovingAI .map, OBJ) or mission file")->required();
  check_flags.add_to(check);
  check.add_option("--sensor", check_arguments.sensor, "of a world: the sensor preset that its matter should be seen by")->capture_default_str();
  TruthArguments truth_arguments;
  CLI::App& truth = *app.add_subcommand("truth", "what is really there: a world as a map at any resolution and height, and whether there is a way (exit code 3: there is none)");
  add_truth(truth, truth_arguments);
  ConvertArguments convert_arguments;
  CLI::App& convert = *app.add_subcommand("convert", "turn maps of one format into another: map_server, NumPy, OctoMap, MovingAI, world, picture");
  add_convert(convert, convert_arguments);
  PictureArguments picture_arguments;
  CLI::App& picture = *app.add_subcommand("picture", "draw what a world looks like, with the rays of the simulator");
  add_picture(picture, picture_arguments);
  GenerateArguments generate_arguments;
  CLI::App& generate = *app.add_subcommand("generate", "write a model that Thicket makes itself (a barge's hold, a car, a postbox, ...) as an OBJ file for worlds");
  add_generate(generate, generate_arguments);
  CLI::App& worlds = *app.add_subcommand("worlds", "list the worlds and missions that are shipped");
  MaterialsArguments materials_arguments;
  CLI::App& materials = *app.add_subcommand("materials", "print the shipped materials, or those of a world, as a radar of some frequency meets them");
  materials.add_option("world", materials_arguments.world, "world file (default: the shipped materials)")->type_name("FILE");
  materials.add_option("--frequency-ghz", materials_arguments.frequency_ghz, "frequency (default: 24)")->type_name("GHZ");
  materials.add_option("--thickness-m", materials_arguments.thickness_m, "also what a wall of this thickness reflects and lets through, at normal incidence")->type_name("M");
  ScanArguments scan_arguments;
  CLI::App& scan = *app.add_subcommand("scan", "what a sensor sees of a world from a pose or along a way: table, CSV, JSON, picture");
  add_scan(scan, scan_arguments);
  std::string sensor_name;
  CLI::App& sensors = *app.add_subcommand("sensors", "list the sensor presets that are shipped, or all keys of one");
  sensors.add_option("name", sensor_name, "sensor preset or file (default: a table of all)")->type_name("NAME");
  ReachabilityArguments reachability_arguments;
  CLI::App& reachability = *app.add_subcommand("reachability", "run planners on many problems and judge them by the world itself: verdicts, collisions, lengths (exit code 6: something is wrong)");
  add_reachability(reachability, reachability_arguments);
  ExperimentsArguments experiments_arguments;
  CLI::App& experiments = *app.add_subcommand("experiments", "make the experiments of Rozeboom 2012 and Billdal 2018: a page with pictures and tables, a section a figure");
  add_experiments(experiments, experiments_arguments);
  CLI::App& help = *app.add_subcommand("help", "explain every key of a mission or world file");
  help.add_option("topic", topic, "mission or world")->required();
  bool markdown = false;
  help.add_flag("--markdown", markdown, "of `world`: as docs/worlds.md has it");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? done : bad_input;
  }
  if (run.parsed()) {
    auto overrides = run_flags.overrides();
    if (!overrides) return bad_input;
    if (arguments.mission.empty() && run_flags.world.empty()) {
      fmt::print(stderr, "nothing to run: name a mission (`thicket worlds` lists them), or give --world, --start and --goal\n");
      return bad_input;
    }
    arguments.overrides = std::move(*overrides);
    if (arguments.score) arguments.overrides.push_back({"output.score", "true", "--score"});
    return run_mission(arguments);
  }
  if (gui.parsed() || render.parsed()) {
    auto overrides = (gui.parsed() ? gui_flags : render_flags).overrides();
    if (!overrides) return bad_input;
    gui_arguments.overrides = render_arguments.overrides = std::move(*overrides);
    return gui.parsed() ? open_window(gui_arguments) : render_views(render_arguments);
  }
  if (score.parsed()) return score_folder(score_arguments);
  if (sar.parsed()) {
    auto overrides = sar_flags.overrides();
    if (!overrides) return bad_input;
    sar_arguments.overrides = std::move(*overrides);
    return image_run(sar_arguments);
  }
  if (check.parsed()) {
    auto overrides = check_flags.overrides();
    if (!overrides) return bad_input;
    check_arguments.overrides = std::move(*overrides);
    check_arguments.map_image = check_flags.map_image;
    check_arguments.cell_size = check_flags.cell_size;
    return check_file(check_arguments);
  }
  if (truth.parsed()) return write_truth(truth_arguments);
  if (convert.parsed()) return convert_map(convert_arguments);
  if (picture.parsed()) return draw_picture(picture_arguments);
  if (generate.parsed()) {
    for (const CLI::Option* option : generate.get_options()) generate_arguments.hold_changed |= option->count() > 0 && option->get_name() != "--out" && option->get_name() != "name";
    return generate_model(generate_arguments);
  }
  if (worlds.parsed()) return list_worlds();
  if (materials.parsed()) return list_materials(materials_arguments);
  if (scan.parsed()) return measure_scans(scan_arguments);
  if (sensors.parsed()) return list_sensors(sensor_name);
  if (reachability.parsed()) return study_reachability(reachability_arguments);
  if (experiments.parsed()) return make_experiments(experiments_arguments);
  return help_topic(topic, markdown);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return dispatch(argc, argv);
  } catch (const std::exception& fault) {
    std::fprintf(stderr, "thicket: internal error: %s\n", fault.what());
    return internal_error;
  }
}
