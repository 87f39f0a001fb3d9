// The studies of mapping: what each of them is called with, one function each.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "or_exit.hpp"

namespace thicket::study {

struct QualityOptions {
  double resolution = 0.1;  ///< m a cell
  double tolerance = 0.2;   ///< m
};
/// Our map and others after one way through the hall, against the truth by both conventions.
void study_quality(const QualityOptions& options);

struct StillOptions {
  std::size_t scans = 100000;
  std::size_t every = 100;  ///< scans between looks for cells that are wrongly claimed
  std::size_t most = 1000;  ///< scans to wait for a change to be seen
  double clutter = 0.02;
  double resolution = 0.1;  ///< m a cell
  std::vector<std::string> works = {"radar4x58"};
};
/// Standing still for long, with noise that is fresh or always the same; and whether a change is still seen after it.
void study_still(const StillOptions& options);

/// The bytes of maps, for each way to keep their cells; and of a hold that is nearly empty what the quadtree saves and costs.
void study_memory();
/// What of worlds/data/findings is found in cells of four sizes, by a beam radar and by four lobes.
void study_found();

struct SizeOptions {
  double resolution = 0.05;  ///< m a cell
  int places = 2000, pairs = 40;
};
/// Whether a scan costs more in a map that is large already.
void study_size(const SizeOptions& options);

}  // namespace thicket::study
