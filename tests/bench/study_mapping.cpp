// The studies of mapping: tables for docs/mapping.md. Nothing here is a test; the figures, but for those of `size`, do not depend on the machine.
#include <CLI/CLI.hpp>

#include "study_mapping.hpp"

namespace thicket::study {

int call(int argc, char** argv) {
  CLI::App app{"Studies of mapping: tables for docs/mapping.md"};
  app.require_subcommand(1);
  QualityOptions quality;
  auto* quality_command = app.add_subcommand("quality", "how good the maps of one way through a hall are, ours and others");
  quality_command->add_option("--resolution", quality.resolution, "metres a cell")->check(CLI::Range(0.02, 1.0))->capture_default_str();
  quality_command->add_option("--tolerance", quality.tolerance, "of the F1, metres")->check(CLI::NonNegativeNumber)->capture_default_str();
  StillOptions still;
  auto* still_command = app.add_subcommand("still", "standing still for long: what is claimed that is not there, and whether a change is still seen");
  still_command->add_option("--scans", still.scans, "how many")->check(CLI::Range(10, 100000000))->capture_default_str();
  still_command->add_option("--every", still.every, "scans between looks for wrong claims")->check(CLI::Range(1, 100000))->capture_default_str();
  still_command->add_option("--most", still.most, "scans to wait for a change to be seen")->check(CLI::Range(1, 1000000))->capture_default_str();
  still_command->add_option("--clutter", still.clutter, "chance of a false return of a ray")->check(CLI::Range(0.0, 1.0))->capture_default_str();
  still_command->add_option("--resolution", still.resolution, "metres a cell")->check(CLI::Range(0.02, 1.0))->capture_default_str();
  still_command->add_option("--works", still.works, "radar4x58, lidar360, lidar1440, lobe2018, separated by commas")->delimiter(',')->check(CLI::IsMember({"radar4x58", "lidar360", "lidar1440", "lobe2018"}));
  auto* memory_command = app.add_subcommand("memory", "the bytes of maps, for each way to keep their cells");
  auto* found_command = app.add_subcommand("found", "what of a doorway, a window, a postbox and a stop sign is found in cells of which size");
  SizeOptions size;
  auto* size_command = app.add_subcommand("size", "whether a scan costs more in a map that is large already");
  size_command->add_option("--resolution", size.resolution, "metres a cell")->check(CLI::Range(0.02, 1.0))->capture_default_str();
  size_command->add_option("--places", size.places, "looks all over 5 x 5 km")->check(CLI::Range(1, 1000000))->capture_default_str();
  size_command->add_option("--pairs", size.pairs, "pairs of runs")->check(CLI::Range(3, 100000))->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  if (quality_command->parsed()) study_quality(quality);
  if (still_command->parsed()) study_still(still);
  if (found_command->parsed()) study_found();
  if (memory_command->parsed()) study_memory();
  if (size_command->parsed()) study_size(size);
  return 0;
}

}  // namespace thicket::study

int main(int argc, char** argv) { return thicket::study::call(argc, argv); }
