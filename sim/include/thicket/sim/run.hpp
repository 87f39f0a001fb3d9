// Drives a simulation to its verdict.
#pragma once

#include <functional>

#include "thicket/sim/simulation.hpp"
#include "thicket/sim/trajectory.hpp"

namespace thicket {

struct RunOptions {
  double realtime_factor = 0.0;  ///< simulated seconds per wall second at most; 0: as fast as possible
  std::function<bool()> interrupted;                 ///< asked after every step; true ends the run with the verdict stopped
  std::function<void(const Simulation&)> progress;   ///< called after every step
};

/// Steps until the verdict, paced if asked; notes every decision. Returns the wall time, s.
double run(Simulation& simulation, Trajectory& trajectory, const RunOptions& options);

}  // namespace thicket
