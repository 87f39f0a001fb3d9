// That the tests of this room run with floating-point exceptions trapped.
#include <doctest/doctest.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cmath>
#include <thread>

#include "thicket/base/float_traps.hpp"

namespace thicket {

#if defined(__GLIBC__)
TEST_CASE("extremes: floating-point exceptions are trapped in tests: here, in threads of TBB and in threads that are started here") {
  CHECK(float_exceptions_trapped());
  std::atomic<int> without{0};
  tbb::parallel_for(0, 10000, [&](int) { without += !float_exceptions_trapped(); });
  CHECK(without == 0);
  std::thread([&] { without += !float_exceptions_trapped(); }).join();
  CHECK(without == 0);
  {
    const NoFloatTraps guard;
    CHECK_FALSE(float_exceptions_trapped());
    volatile double zero = 0.0;
    CHECK(std::isinf(1.0 / zero));
  }
  CHECK(float_exceptions_trapped());
}
#endif

}  // namespace thicket
