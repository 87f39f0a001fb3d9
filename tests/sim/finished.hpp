// Runs that tests wait for.
#pragma once

#include <doctest/doctest.h>

#include "thicket/sim/simulation.hpp"

namespace thicket {

/// The simulation of a mission at its end.
inline Simulation finished(const Mission& mission) {
  auto simulation = Simulation::create(mission);
  if (!simulation) FAIL(simulation.error().message);
  while (simulation->step()) {
  }
  return *simulation;
}

}  // namespace thicket
