// The commands of the program, one function each; main.cpp parses the command line and calls them. Each returns the program's exit code.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "thicket/sim/mission.hpp"
#include "thicket/worlds/models.hpp"

namespace thicket::cli {

/// 0 reached (or way-points done), 1 internal error, 2 bad usage or file, 3 unreachable, 4 stopped (limit, stuck, interrupted), 5 collided, 6 a study found wrong runs.
enum ExitCode { done = 0, internal_error = 1, bad_input = 2, unreachable = 3, stopped = 4, collided = 5, wrong = 6 };

struct RunArguments {
  std::string mission;
  std::vector<Override> overrides;
  std::string out;  ///< empty: `thicket-out/NAME`
  double realtime_factor = 0.0;
  int threads = 0;  ///< 0: as many as there are cores
  bool quiet = false;
  bool json = false;
  bool score = false;  ///< as [output] score = true
};

struct ScoreArguments {
  std::string folder;                ///< of a run
  std::string truth = "cell_centre"; ///< or "any_overlap"
  double tolerance = 0.2;            ///< m
  bool json = false;
};

struct SarArguments {
  std::string input;  ///< folder of a run, or mission
  std::string method, sensor, frame, bounds, out;  ///< empty: as the mission has it
  std::optional<double> resolution, floor_db;      ///< m, dB
  bool fuse = false, json = false;
  std::vector<Override> overrides;
};

struct TruthArguments {
  std::string world, out, map_image;
  double resolution = 0.05, grow = 0.0, z_low = 0.0, z_high = 0.5, time = 0.0;  ///< m, s
  std::optional<double> cell_size;                                              ///< m, of a MovingAI map
  std::string convention = "overlap";                                           ///< or "centre"
  std::string bounds, from, to;                                                 ///< X0,Y0,X1,Y1 and X,Y; empty: not given
  bool all_matter = false;
};

struct ConvertArguments {
  std::string in, out, map_image;
  std::string mode;                 ///< of a map_server map: trinary (or empty), scale, raw
  std::string origin;               ///< X,Y of a .npy; empty: not given
  std::optional<double> cell_size;  ///< m, of a MovingAI map or a .npy
  std::optional<double> z;          ///< m, which layer of a tree of OctoMap
  double resolution = 0.05, z_low = 0.0, z_high = 0.5, height = 2.5;  ///< m
};

struct CheckArguments {
  std::string file;
  std::vector<Override> overrides;  ///< of a mission; what --map-image and --cell-size gave is among them
  std::string map_image;
  std::optional<double> cell_size;
  std::string sensor = "usarsim2012";  ///< preset that a world's matter is held against
};
int run_mission(const RunArguments& arguments);
/// Runs what a folder holds once more and scores its map: 0, or 6 if that is not the map in the folder.
int score_folder(const ScoreArguments& arguments);
/// Simulates a run once more and writes its image.
int image_run(const SarArguments& arguments);
int check_file(const CheckArguments& arguments);
/// A world as a map or a picture, and whether there is a way: 0 if there is, 3 if not.
int write_truth(const TruthArguments& arguments);
int convert_map(const ConvertArguments& arguments);
int list_worlds();

struct MaterialsArguments {
  std::string world;  ///< empty: the shipped materials
  double frequency_ghz = 24.0;
  std::optional<double> thickness_m;
};
int list_materials(const MaterialsArguments& arguments);

struct GenerateArguments {
  std::string name, out;       ///< of a model; empty: list them
  HoldSpec hold;
  bool hold_changed = false;   ///< a size of the hold was given
};
int generate_model(const GenerateArguments& arguments);

struct PictureArguments {
  std::string world, out, map_image;
  std::string from, at, size = "960x600";  ///< X,Y,Z, not given if empty; WIDTHxHEIGHT
  double fov_deg = 50.0, time = 0.0;
  std::vector<std::string> hide;
  std::optional<double> cell_size;  ///< m, of a MovingAI map
};
int draw_picture(const PictureArguments& arguments);

struct ScanArguments {
  std::string world, map_image;
  std::optional<double> cell_size;  ///< m, of a MovingAI map
  std::vector<std::string> sensors, compared, sets;
  std::string pose, to, poses, velocity;  ///< X,Y,Z,YAW_DEG[,PITCH_DEG] twice, a file, VX,VY,VZ; empty: not given
  std::optional<int> steps;
  std::int64_t number = 0, seed = 1;
  double time = 0.0;
  std::string csv, json, profile_csv, png;  ///< files; empty: none, "-": the terminal
  std::string x_label;
};
int measure_scans(const ScanArguments& arguments);
/// The shipped presets; with a name, the keys of one.
int list_sensors(const std::string& name);

struct ReachabilityArguments {
  std::vector<std::string> families;  ///< empty: all ten
  std::optional<int> rooms;           ///< so many rooms of the 2019 study instead
  std::string maps, world, start, goal;
  std::optional<double> cell_size;    ///< m, of MovingAI maps
  int per_map = 200, problems = 10;
  std::int64_t first = 0;
  std::vector<std::string> planners, sets;
  std::string hand = "alternate", vehicle;
  std::optional<double> noise, radius, clearance, time_limit;
  std::optional<int> rays;
  std::string csv, keep_failures;
  int jobs = 0;
  bool quiet = false;
};
/// 0: nothing is wrong, 6: something is.
int study_reachability(const ReachabilityArguments& arguments);

struct ExperimentsArguments {
  std::vector<std::string> names;  ///< empty: all
  std::string out, page;           ///< empty: docs/experiments in the tree, else thicket-out/experiments
  bool list = false, brief = false, quiet = false;
};
int make_experiments(const ExperimentsArguments& arguments);

struct GuiArguments {
  std::string file;  ///< mission or world; empty: the window asks
  std::vector<Override> overrides;
  std::string report;  ///< JSON; empty: none
};
/// Until the person closes it. A build without THICKET_GUI says so.
int open_window(const GuiArguments& arguments);

struct RenderArguments {
  std::string file, view = "world", out, size = "1280x800";  ///< WIDTHxHEIGHT
  std::vector<Override> overrides;
  std::optional<double> at;  ///< s; nothing: the end
  bool light = false;
};
int render_views(const RenderArguments& arguments);

int help_topic(const std::string& topic, bool markdown);

// --- what commands share

/// Prints the error; returns bad_input.
int complain(const Error& error);
/// Why `find_input` found nothing of that name.
std::string missing_input(const std::string& name);
/// The file of a world by its name; an error if there is none, or a mission.
Result<std::filesystem::path> find_world(const std::string& name);

using Row = std::vector<std::string>;

/// A table, its heads in the first row, with columns as wide as their widest entry: the first, the last and those named here to the left, others, numbers, to the right.
std::string aligned(const std::vector<Row>& rows, const std::vector<std::string>& words);

/// "1,2.5" as exactly `count` finite numbers.
template <std::size_t count>
std::optional<std::array<double, count>> numbers(const std::string& text) {
  std::array<double, count> values{};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0 && (at == end || *at++ != ',')) return std::nullopt;
    const auto [stop, failure] = std::from_chars(at, end, values[i]);
    if (failure != std::errc{} || !std::isfinite(values[i])) return std::nullopt;
    at = stop;
  }
  return at == end ? std::optional(values) : std::nullopt;
}

}  // namespace thicket::cli
