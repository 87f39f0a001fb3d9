#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>
#include <tbb/parallel_for.h>

#include "thicket/base/float_traps.hpp"

// Every test of worlds, radar and nav runs with floating-point exceptions trapped: docs/extremes.md.
int main(int argc, char** argv) {
  doctest::Context context(argc, argv);
#ifndef THICKET_NO_FLOAT_TRAPS
  thicket::trap_float_exceptions();
#endif
  // TBB's tasks run with the settings that their arena was made with: it is made here, before a library makes it without traps.
  tbb::parallel_for(0, 1, [](int) {});
  return context.run();
}
