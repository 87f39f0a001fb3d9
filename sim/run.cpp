#include "thicket/sim/run.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

namespace thicket {

double run(Simulation& simulation, Trajectory& trajectory, const RunOptions& options) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const auto elapsed = [start] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  const double simulated_start = simulation.time();
  trajectory.note(simulation);
  while (simulation.step()) {
    trajectory.note(simulation);
    if (options.interrupted && options.interrupted()) simulation.stop("interrupted");
    if (options.progress) options.progress(simulation);
    if (options.realtime_factor > 0.0) {
      const double due = (simulation.time() - simulated_start) / options.realtime_factor;
      // Slept in short pieces, so that an interruption is answered at once.
      while (elapsed() < due && !(options.interrupted && options.interrupted()))
        std::this_thread::sleep_for(std::chrono::duration<double>(std::min(0.05, due - elapsed())));
    }
  }
  trajectory.note(simulation);
  return elapsed();
}

}  // namespace thicket
