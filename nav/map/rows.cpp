#include "rows.hpp"

#include <array>
#include <cmath>
#include <cstring>

namespace thicket {
namespace {

// Vectors of the compiler: it makes of them what the machine has. The functions below are compiled for three kinds of it, and the widest that runs is chosen when the program starts.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define THICKET_WIDEST __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define THICKET_WIDEST
#endif
#define THICKET_INLINE inline __attribute__((always_inline))

using Bytes = std::uint8_t __attribute__((vector_size(tile_size)));
template <class Cell>
struct Vector;
template <>
struct Vector<std::int8_t> {
  using Of = std::int8_t __attribute__((vector_size(64)));
  using Codes = std::uint8_t __attribute__((vector_size(64)));
};
template <>
struct Vector<std::int16_t> {
  using Of = std::int16_t __attribute__((vector_size(64)));
  using Codes = std::uint8_t __attribute__((vector_size(32)));
};

template <class V>
THICKET_INLINE void load(V& to, const void* from) {
  std::memcpy(&to, from, sizeof(V));
}

/// As many cells as a vector has. Nothing overflows on the way: a value is held to where the evidence leaves it between the clamps, before the evidence is added.
template <class Cell, bool limit>
THICKET_INLINE void change(Cell* values, const Code* codes, int low_clamp, int high_clamp) {
  using V = typename Vector<Cell>::Of;
  constexpr Cell scale = static_cast<Cell>(Units<Cell>::per_nat / evidence_per_nat);
  typename Vector<Cell>::Codes code;
  V value;
  load(code, codes);
  load(value, values);
  const V zero{}, low = zero + static_cast<Cell>(low_clamp), high = zero + static_cast<Cell>(high_clamp);
  V evidence;
  if constexpr (sizeof(Cell) == 1) evidence = reinterpret_cast<V>(code ^ Code{no_evidence});
  else evidence = (__builtin_convertvector(code, V) - static_cast<Cell>(no_evidence)) * scale;
  V untouched;  // all bits, or none
  if constexpr (sizeof(Cell) == 1) untouched = reinterpret_cast<V>(code == 0);
  else untouched = __builtin_convertvector(code, V) == 0;
  V next = value == unknown_cell<Cell> ? zero : value;
  if constexpr (limit) {
    // From the other side of 0 by a step, else to the evidence itself; never back.
    const V below = next > 0 ? next : zero, above = next < 0 ? next : zero;
    const V fallen = next > evidence ? below + evidence : next, risen = next < evidence ? above + evidence : next;
    next = evidence < 0 ? fallen : evidence > 0 ? risen : next;
    next = next < low ? low : next;
    next = next > high ? high : next;
  } else {
    const V down = evidence < 0 ? evidence : zero, up = evidence > 0 ? evidence : zero, lowest = low - down, highest = high - up;
    next = (next < lowest ? lowest : next) + down;
    next = (next > highest ? highest : next) + up;
  }
  next = untouched ? value : next;
  std::memcpy(values, &next, sizeof next);
}

template <class Cell, bool limit>
THICKET_INLINE Taken take(Cell* values, Code* codes, std::int64_t stride, int low, int high) {
  constexpr int at_once = 64 / static_cast<int>(sizeof(Cell));
  Bytes any{}, count{};
  for (int row = 0; row < block_size; ++row, values += tile_size, codes += stride) {
    Bytes code;
    load(code, codes);
    any |= code;
    count -= reinterpret_cast<Bytes>(code != 0);
    for (int i = 0; i < tile_size; i += at_once) change<Cell, limit>(values + i, codes + i, low, high);
    code = Bytes{};
    std::memcpy(codes, &code, sizeof code);
  }
  Taken taken;
  for (int block = 0; block < blocks_per_side; ++block) {
    std::uint64_t of_block, counts;
    std::memcpy(&of_block, reinterpret_cast<const char*>(&any) + 8 * block, 8);
    std::memcpy(&counts, reinterpret_cast<const char*>(&count) + 8 * block, 8);
    taken.in_block[static_cast<std::size_t>(block)] = of_block != 0;
    taken.cells += static_cast<int>((counts * 0x0101010101010101u) >> 56);  // the sum of eight bytes, 64 at most
  }
  return taken;
}

THICKET_WIDEST Taken add_8(std::int8_t* values, Code* codes, std::int64_t stride, int low, int high) { return take<std::int8_t, false>(values, codes, stride, low, high); }
THICKET_WIDEST Taken add_16(std::int16_t* values, Code* codes, std::int64_t stride, int low, int high) { return take<std::int16_t, false>(values, codes, stride, low, high); }
THICKET_WIDEST Taken limit_8(std::int8_t* values, Code* codes, std::int64_t stride, int low, int high) { return take<std::int8_t, true>(values, codes, stride, low, high); }
THICKET_WIDEST Taken limit_16(std::int16_t* values, Code* codes, std::int64_t stride, int low, int high) { return take<std::int16_t, true>(values, codes, stride, low, high); }

/// A bit for each byte of eight that is not 0.
std::uint64_t not_zero(std::uint64_t eight) {
  constexpr std::uint64_t low = 0x7f7f7f7f7f7f7f7fu, high = 0x8080808080808080u;
  const std::uint64_t tops = (((eight & low) + low) | eight) & high;
  return ((tops >> 7) * 0x0102040810204080u) >> 56;
}

}  // namespace

THICKET_WIDEST void raise_all(Code* codes, std::int64_t count, Code to) {
  for (std::int64_t i = 0; i < count; ++i) codes[i] = codes[i] < to ? to : codes[i];
}

THICKET_WIDEST void add_piece(Arc& arc, float along, float square, int count, Piece& piece) {
  using Floats = float __attribute__((vector_size(4 * piece_size)));
  using Whole = std::int32_t __attribute__((vector_size(4 * piece_size)));
  constexpr Floats number = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  constexpr Whole place = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  const Floats x = along + number, squares = x * x + square;
  float at[piece_size], before[piece_size];
  std::memcpy(at, &squares, sizeof at);
  for (float& square_of : at) square_of = std::sqrt(square_of);
  for (int i = 0; i < piece_size; ++i) before[i] = arc.odds[piece.levels[i]];
  Floats distance, odds;
  load(distance, at);
  load(odds, before);
  const Floats off = (distance - arc.radius) * arc.per_spread;
  // exp(-off^2 / 2) by its series about exp(-1): to 3e-5 where off is 2 at most.
  const Floats t = 1.0f - 0.5f * off * off;
  const Floats bell = 0.36787944f * (1.0f + t * (1.0f + t * (1.0f / 2 + t * (1.0f / 6 + t * (1.0f / 24 + t * (1.0f / 120 + t * (1.0f / 720 + t / 5040)))))));
  // 1 at `count` places and 0 at the others: of comparisons of whole numbers the compiler would make scalars.
  static constexpr auto ones = [] {
    std::array<float, 2 * piece_size> values{};
    for (std::size_t i = 0; i < piece_size; ++i) values[i] = 1.0f;
    return values;
  }();
  Floats used;
  load(used, ones.data() + piece_size - count);
  Floats likelihood = odds * bell * used;
  likelihood = t >= -1.001f ? likelihood : Floats{};
  Floats sums;
  std::memcpy(&sums, arc.sums.data(), sizeof sums);
  sums += likelihood;
  std::memcpy(arc.sums.data(), &sums, sizeof sums);
  std::memcpy(piece.likelihood.data(), &likelihood, sizeof likelihood);
  Floats greatest = likelihood;
  for (const int half : {8, 4, 2, 1}) {
    const Floats other = __builtin_shuffle(greatest, place ^ half);
    greatest = greatest > other ? greatest : other;
  }
  piece.greatest = greatest[0];
}

THICKET_WIDEST bool any_code(const Code* codes, std::int64_t stride) {
  Bytes any{};
  for (int row = 0; row < block_size; ++row, codes += stride) {
    Bytes code;
    load(code, codes);
    any |= code;
  }
  std::uint64_t eight[8], all = 0;
  std::memcpy(eight, &any, sizeof any);
  for (const std::uint64_t e : eight) all |= e;
  return all != 0;
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

Taken take_rows(std::int8_t* values, Code* codes, std::int64_t stride, const Rule& rule) { return (rule.limit ? limit_8 : add_8)(values, codes, stride, rule.low, rule.high); }
Taken take_rows(std::int16_t* values, Code* codes, std::int64_t stride, const Rule& rule) { return (rule.limit ? limit_16 : add_16)(values, codes, stride, rule.low, rule.high); }

}  // namespace thicket
