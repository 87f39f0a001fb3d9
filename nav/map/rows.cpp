#include "rows.hpp"

#include <cstring>

namespace thicket {
namespace {

/// A bit for each byte of eight that is not 0.
std::uint64_t not_zero(std::uint64_t eight) {
  constexpr std::uint64_t low = 0x7f7f7f7f7f7f7f7fu, high = 0x8080808080808080u;
  const std::uint64_t tops = (((eight & low) + low) | eight) & high;
  return ((tops >> 7) * 0x0102040810204080u) >> 56;
}

std::uint64_t touched_of(const Code* codes) {
  std::uint64_t touched = 0;
  for (int i = 0; i < tile_size; i += 8) {
    std::uint64_t eight;
    std::memcpy(&eight, codes + i, 8);
    touched |= not_zero(eight) << i;
  }
  return touched;
}

// The compiler makes a loop over vectors of each of these, for the widest registers that the machine has.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define THICKET_WIDEST __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define THICKET_WIDEST
#endif

template <class Cell>
inline __attribute__((always_inline)) void add_row(Cell* values, const Code* codes, int low, int high) {
  constexpr int scale = static_cast<int>(Units<Cell>::per_nat / evidence_per_nat);
  for (int i = 0; i < tile_size; ++i) {
    const int code = codes[i], value = values[i], known = value == unknown_cell<Cell> ? 0 : value;
    int next = known + (code - no_evidence) * scale;
    next = next < low ? low : next > high ? high : next;
    values[i] = static_cast<Cell>(code == 0 ? value : next);
  }
}

template <class Cell>
inline __attribute__((always_inline)) void limit_row(Cell* values, const Code* codes, int low, int high) {
  constexpr int scale = static_cast<int>(Units<Cell>::per_nat / evidence_per_nat);
  for (int i = 0; i < tile_size; ++i) {
    const int code = codes[i], value = values[i], known = value == unknown_cell<Cell> ? 0 : value, evidence = (code - no_evidence) * scale;
    int next = evidence > 0 ? (known > evidence ? known : evidence) : (known < evidence ? known : evidence);
    next = next < low ? low : next > high ? high : next;
    values[i] = static_cast<Cell>(code == 0 ? value : next);
  }
}

THICKET_WIDEST void add_8(std::int8_t* values, const Code* codes, int low, int high) { add_row(values, codes, low, high); }
THICKET_WIDEST void add_16(std::int16_t* values, const Code* codes, int low, int high) { add_row(values, codes, low, high); }
THICKET_WIDEST void limit_8(std::int8_t* values, const Code* codes, int low, int high) { limit_row(values, codes, low, high); }
THICKET_WIDEST void limit_16(std::int16_t* values, const Code* codes, int low, int high) { limit_row(values, codes, low, high); }

template <class Cell, class Change>
std::uint64_t take(Cell* values, Code* codes, const Rule& rule, Change* change) {
  const std::uint64_t touched = touched_of(codes);
  if (touched == 0) return 0;
  change(values, codes, rule.low, rule.high);
  std::memset(codes, 0, tile_size);
  return touched;
}

}  // namespace

std::uint64_t take_row(std::int8_t* values, Code* codes, const Rule& rule) { return take(values, codes, rule, rule.limit ? limit_8 : add_8); }
std::uint64_t take_row(std::int16_t* values, Code* codes, const Rule& rule) { return take(values, codes, rule, rule.limit ? limit_16 : add_16); }

}  // namespace thicket
