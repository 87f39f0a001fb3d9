// Floating-point exceptions that end a program, for tests: an invalid operation, a division by zero or an overflow is found where it happens, and not where its NaN comes to light.
#pragma once

#include <cfenv>

namespace thicket {

#if defined(__GLIBC__)
/// What is trapped: a result that is inexact or below the smallest number is no fault.
inline constexpr int trapped_exceptions = FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW;
/// Traps them in this thread, and in all that it starts from now on.
inline void trap_float_exceptions() { feenableexcept(trapped_exceptions); }
inline bool float_exceptions_trapped() { return (fegetexcept() & trapped_exceptions) == trapped_exceptions; }

/// While it lives, this thread traps nothing: around calls of libraries that count on what IEEE 754 says of infinities and NaN. Where nothing is trapped it does nothing.
class NoFloatTraps {
 public:
  NoFloatTraps() : trapped_(fegetexcept()) {
    if (trapped_ != 0) fedisableexcept(trapped_);
  }
  NoFloatTraps(const NoFloatTraps&) = delete;
  NoFloatTraps& operator=(const NoFloatTraps&) = delete;
  ~NoFloatTraps() {
    if (trapped_ == 0) return;
    std::feclearexcept(FE_ALL_EXCEPT);
    feenableexcept(trapped_);
  }

 private:
  int trapped_;
};
#else
inline void trap_float_exceptions() {}
inline bool float_exceptions_trapped() { return false; }
struct NoFloatTraps {
  NoFloatTraps() {}
};
#endif

}  // namespace thicket
