// What benches and studies do with a result.
#pragma once

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "thicket/base/result.hpp"

namespace thicket {

/// What was made or read, or the end of the program with the message of what went wrong.
template <class T>
T or_exit(Result<T> result) {
  if (result) return std::move(*result);
  std::fprintf(stderr, "%s: %s\n", program_invocation_short_name, result.error().message.c_str());
  std::exit(1);
}

}  // namespace thicket
