// A simulation on a thread of its own. The window sees snapshots of it and queues what the person wants; the simulation never waits for the window, and is the same with and without it.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "thicket/gui/samples.hpp"
#include "thicket/sim/mission.hpp"
#include "thicket/sim/simulation.hpp"

namespace thicket::gui {

// What a person can want. Each is done between two steps.

/// A mission file, or a world (then with the default mission in it, waiting for a goal). What cannot be read leaves what was open, with a message.
struct Open {
  std::filesystem::path file;
  std::vector<Override> overrides;
};
struct Play {};
struct Pause {};
/// So many steps forward or (negative) back; pauses.
struct StepBy {
  int steps = 1;
};
/// To a step that was; pauses.
struct SeekTo {
  std::uint64_t step = 0;
};
/// To the start of the mission as it is now (with what was changed).
struct Reset {};
/// Reads the files again, as they were opened, and begins anew.
struct Reload {};
/// Simulated over wall seconds; 0: as fast as possible.
struct SetSpeed {
  double factor = 1.0;
};
/// The mission with other keys; the run goes on under them (Simulation::changed).
struct ChangeMission {
  Mission mission;
};
/// The world with other solids; the run goes on in it.
struct ChangeWorld {
  World world;
};
/// The planner's goal. A planner that needs none becomes bug2.
struct SetGoal {
  glm::dvec2 goal{0.0, 0.0};
};
/// Puts the robot somewhere; the planner begins anew there.
struct MoveRobot {
  Pose2 pose;
};
/// Drives by hand; nothing: gives the wheel back.
struct Drive {
  std::optional<Command> command;
};
using Action = std::variant<Open, Play, Pause, StepBy, SeekTo, Reset, Reload, SetSpeed, ChangeMission, ChangeWorld, SetGoal, MoveRobot, Drive>;

struct Message {
  std::uint64_t number = 0;  ///< counts messages from 1; 0: there was none yet
  bool error = false;
  std::string text;
};

/// How things stand at one moment. Read-only, and safe to keep.
struct Snapshot {
  std::shared_ptr<const Simulation> simulation;  ///< null: nothing is open
  Samples samples;                               ///< of all steps up to the newest, those after `simulation`'s too
  std::uint64_t first_step = 0, newest_step = 0; ///< where `SeekTo` can go
  bool playing = false;
  double speed_wanted = 1.0;    ///< 0: as fast as possible
  double speed_achieved = 0.0;  ///< simulated over wall seconds, over the last half second; 0 while it stands
  std::filesystem::path file;   ///< as it was opened
  bool mission_changed = false, world_changed = false;  ///< since it was opened
  std::uint64_t world_revision = 0;  ///< another number: another world
  std::uint64_t run_revision = 0;    ///< another number: time may have gone back
  Message message;
};

class Runner {
 public:
  Runner();
  ~Runner();
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;

  void post(Action action);
  /// The newest there is; asks for a newer one, which is made between steps. Never null, never waits.
  std::shared_ptr<const Snapshot> snapshot();
  /// Waits until all that was posted is done (and does not wait for `Play` to end), and gives the state after it: for tests, and for pictures without a window.
  std::shared_ptr<const Snapshot> settled();
  /// Plays until the verdict and gives the state then.
  std::shared_ptr<const Snapshot> finished();

 private:
  struct Core;
  std::unique_ptr<Core> core_;
};

/// A mission that runs in a world by itself: its start in the open, the default robot, no goal yet.
Result<Mission> mission_in_world(const std::filesystem::path& world_file);

}  // namespace thicket::gui
