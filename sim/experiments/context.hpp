// What experiments are written with: runs, pictures, tables. Private to sim/experiments.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <vector>

#include "ray_picture.hpp"
#include "thicket/sim/experiments.hpp"
#include "thicket/sim/scan_report.hpp"
#include "thicket/sim/simulation.hpp"
#include "thicket/sim/trajectory.hpp"
#include "thicket/sim/world_picture.hpp"

namespace thicket {

/// What ends an experiment; its text is for a person.
struct ExperimentFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The value of a result; throws ExperimentFailure in place of an error.
template <class T>
T or_fail(Result<T> result) {
  if (!result) throw ExperimentFailure(result.error().message);
  return std::move(*result);
}

/// What a run costs on this machine.
struct RunCost {
  double wall_s = 0.0, cpu_s = 0.0;  ///< of all threads
  double peak_mb = 0.0;              ///< most memory that the program held during the run, 10^6 bytes
  double map_s = 0.0;                ///< wall time that the map took of it
};

/// A mission at its end.
struct FinishedRun {
  Simulation simulation;
  Trajectory trajectory;
  RunCost cost;
};

using TableRow = std::vector<std::string>;

/// A table in Markdown; the first `words` columns to the left, the others, which are numbers, to the right.
std::string table(const TableRow& head, const std::vector<TableRow>& rows, std::size_t words = 1);
/// A number with so many decimals, "-" if it is not finite.
std::string fixed(double value, int decimals = 2);
/// A share 0...1 as "12.3 %".
std::string percent(double share);
/// A text that is not the same each time: it stands between marks that `without_measured` finds, under a line that tells so.
std::string measured(const std::string& text);
/// The costs of runs as such a table. Each row has as many names as `names`.
std::string cost_table(const TableRow& names, const std::vector<std::pair<TableRow, const FinishedRun*>>& runs);

class ExperimentContext {
 public:
  ExperimentContext(const Experiment& experiment, const ExperimentOptions& options);

  bool brief() const { return options_.brief; }
  /// One value for the page and another, cheaper one for tests.
  template <class T>
  T unless_brief(T full, T short_one) const {
    return options_.brief ? short_one : full;
  }

  // All of these throw ExperimentFailure.

  /// A shipped mission with changes, each as "key=value" (docs: `--set`), as it is before its first step.
  Simulation prepare(const std::string& mission, const std::vector<std::string>& sets = {}) const;
  /// The same, driven to its verdict.
  FinishedRun run(const std::string& mission, const std::vector<std::string>& sets = {}) const;
  /// A sensor preset with changes of its keys.
  SensorScans sensor(const std::string& title, const std::string& preset, const std::vector<std::string>& sets = {}) const;
  /// A shipped world, traceable.
  Scene scene(const std::string& world) const;

  /// Scans of a sensor that stands at a place (its mount left out), one after the other.
  std::vector<Scan> look(const Scene& scene, const SensorSpec& spec, const ScanPose& pose, int count = 1) const;

  /// Where a picture of this experiment goes.
  std::filesystem::path file(const std::string& name) const;
  /// The Markdown that shows it.
  std::string picture(const std::string& name, const std::string& caption) const;

  /// Pictures, as the Markdown that shows them.
  std::string map_picture(const std::string& name, const FinishedRun& run, const std::string& caption) const;
  std::string path_picture(const std::string& name, const FinishedRun& run, const std::string& caption) const;
  std::string ray_picture(const std::string& name, const RayPicture& picture, const std::string& caption) const;
  std::string scan_picture(const std::string& name, const ScanReport& report, const std::string& caption) const;
  std::string world_picture(const std::string& name, const Scene& scene, const PictureView& view, const std::string& caption) const;

 private:
  std::string stem_;
  ExperimentOptions options_;
};

// The files of this folder, in the order of the page.
std::vector<Experiment> rozeboom2012_experiments();
std::vector<Experiment> billdal2018_experiments();
std::vector<Experiment> failure_experiments();

}  // namespace thicket
