// Families of problems made on cells: mazes and combs, rooms with doors.
#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "problem_maker.hpp"

namespace thicket {
namespace {

/// Cells with walls between them; passages lead through some of the walls.
class Cells {
 public:
  Cells(int columns, int rows) : columns_(columns), rows_(rows), east_(static_cast<std::size_t>(columns * rows), 0), north_(east_) {}

  int count() const { return columns_ * rows_; }
  int cell(int column, int row) const { return row * columns_ + column; }

  /// The walls between two cells, as pairs of them.
  std::vector<std::pair<int, int>> borders() const {
    std::vector<std::pair<int, int>> list;
    for (int c = 0; c < count(); ++c) {
      if (c % columns_ + 1 < columns_) list.emplace_back(c, c + 1);
      if (c + columns_ < count()) list.emplace_back(c, c + columns_);
    }
    return list;
  }
  bool passable(int a, int b) const { return passage(std::min(a, b), std::max(a, b)); }
  void set(int a, int b, bool open) { const_cast<char&>(passage(std::min(a, b), std::max(a, b))) = open; }

  /// The cell from which each was reached first, walking from `from` (itself for that); -1: not reached.
  std::vector<int> reached_from(int from) const {
    std::vector<int> before(static_cast<std::size_t>(count()), -1), open = {from};
    before[static_cast<std::size_t>(from)] = from;
    for (std::size_t i = 0; i < open.size(); ++i)
      for (const auto& [a, b] : borders()) {
        if ((a != open[i] && b != open[i]) || !passable(a, b)) continue;
        const int next = a == open[i] ? b : a;
        if (before[static_cast<std::size_t>(next)] >= 0) continue;
        before[static_cast<std::size_t>(next)] = open[i];
        open.push_back(next);
      }
    return before;
  }

  /// The middle of a cell where they are `size` wide and centred about the origin.
  glm::dvec2 middle(int c, double size) const { return size * (glm::dvec2(c % columns_, c / columns_) + 0.5 - 0.5 * glm::dvec2(columns_, rows_)); }

  /// Walls that stand in one line are one.
  void build(ProblemMaker& m, double size, double thickness) const {
    const glm::dvec2 corner = -0.5 * size * glm::dvec2(columns_, rows_);
    const auto lines = [&](int count_of_lines, int length, const auto& stands, const auto& at) {
      for (int line = 0; line <= count_of_lines; ++line)
        for (int i = 0; i < length;) {
          int end = i;
          while (end < length && stands(line, end)) ++end;
          const double over = 0.5 * thickness;  // so that corners are full
          if (end > i) m.wall({corner + at(line * size, i * size - over), corner + at(line * size, end * size + over)}, thickness);
          i = std::max(end, i + 1);
        }
    };
    lines(columns_, rows_, [&](int line, int i) { return line == 0 || line == columns_ || !passable(cell(line - 1, i), cell(line, i)); },
          [](double across, double along) { return glm::dvec2(across, along); });
    lines(rows_, columns_, [&](int line, int i) { return line == 0 || line == rows_ || !passable(cell(i, line - 1), cell(i, line)); },
          [](double across, double along) { return glm::dvec2(along, across); });
  }

 private:
  const char& passage(int low, int high) const { return high == low + 1 ? east_[static_cast<std::size_t>(low)] : north_[static_cast<std::size_t>(low)]; }

  int columns_, rows_;
  std::vector<char> east_, north_;  ///< whether a passage leads from a cell to the next one there
};

/// Passages such that one way, and no other, leads between any two cells: Kruskal's algorithm with walls in a random order.
void carve(ProblemMaker& m, Cells& cells) {
  auto walls = cells.borders();
  for (std::size_t i = walls.size(); i > 1; --i) std::swap(walls[i - 1], walls[static_cast<std::size_t>(m.whole(0, static_cast<int>(i) - 1))]);
  for (const auto& [a, b] : walls)
    if (cells.reached_from(a)[static_cast<std::size_t>(b)] < 0) cells.set(a, b, true);
}

/// Closes a passage on the way between two cells, which must be the only one.
void close_way(ProblemMaker& m, Cells& cells, int from, int to) {
  const auto before = cells.reached_from(from);
  std::vector<int> way = {to};
  while (way.back() != from) way.push_back(before[static_cast<std::size_t>(way.back())]);
  const auto at = static_cast<std::size_t>(m.whole(1, static_cast<int>(way.size()) - 1));
  cells.set(way[at - 1], way[at], false);
}

/// Opens some walls between cells that are joined already: loops, and obstacles that stand alone.
void add_loops(ProblemMaker& m, Cells& cells, int loops) {
  const auto walls = cells.borders();
  for (int i = 0; i < loops; ++i) {
    const auto& [a, b] = walls[static_cast<std::size_t>(m.whole(0, static_cast<int>(walls.size()) - 1))];
    if (cells.reached_from(a)[static_cast<std::size_t>(b)] >= 0) cells.set(a, b, true);
  }
}

/// Columns that are joined at their ends: at the north end all of them (a comb), or by turns at either (two combs, one in the other).
void carve_comb(Cells& cells, int columns, int rows, bool by_turns) {
  for (int c = 0; c < columns; ++c) {
    for (int r = 0; r + 1 < rows; ++r) cells.set(cells.cell(c, r), cells.cell(c, r + 1), true);
    if (c + 1 < columns) cells.set(cells.cell(c, by_turns && c % 2 ? 0 : rows - 1), cells.cell(c + 1, by_turns && c % 2 ? 0 : rows - 1), true);
  }
}

/// A wall of a line (x or y constant) between two ends, with a door.
void wall_with_door(ProblemMaker& m, const glm::dvec2& from, const glm::dvec2& to, double thickness) {
  const double reach = glm::length(to - from), door = m.open + m.length(0.05, 0.6);
  const glm::dvec2 along = (to - from) / reach;
  const bool none = m.chance(0.06);
  const double at = m.uniform(0.2 * m.unit, std::max(0.2 * m.unit, reach - door - 0.2 * m.unit));
  if (none || reach < door + 0.4 * m.unit) return m.wall({from, to}, thickness);
  m.wall({from, from + at * along}, thickness);
  m.wall({from + (at + door) * along, to}, thickness);
}

/// Divides a rectangle by walls with doors, now and then by two with a corridor between them, and its parts again.
void divide(ProblemMaker& m, const glm::dvec2& low, const glm::dvec2& high, int depth) {
  const glm::dvec2 size = high - low;
  const bool across = size.x > size.y;  // the longer side is cut
  const double reach = across ? size.x : size.y, thickness = 0.12 * m.unit, least = m.open + 0.8 * m.unit;
  const double corridor = m.chance(0.4) ? m.open + thickness + m.length(0.05, 0.4) : 0.0;
  if (reach < 2.0 * least + corridor || depth == 0) return;
  const double cut = m.uniform(least, reach - corridor - least);
  const auto at = [&](double along, double side) { return across ? glm::dvec2{low.x + along, side} : glm::dvec2{side, low.y + along}; };
  const double first = across ? low.y : low.x, last = across ? high.y : high.x;
  wall_with_door(m, at(cut, first), at(cut, last), thickness);
  if (corridor > 0.0) wall_with_door(m, at(cut + corridor, first), at(cut + corridor, last), thickness);
  divide(m, low, at(cut, last), depth - 1);
  divide(m, at(cut + corridor, first), high, depth - 1);
}

}  // namespace

void make_maze(ProblemMaker& m) {
  const bool closed = m.number % 10 >= 7;
  const bool comb = m.number % 3 == 2;
  const int columns = m.whole(comb ? 4 : 3, 5), rows = m.whole(comb ? 2 : 3, comb ? 3 : 5);
  Cells cells(columns, rows);
  if (comb) {
    carve_comb(cells, columns, rows, m.chance(0.7));
  } else {
    carve(m, cells);
  }
  // Of a comb the ends are in the rows where the straight way crosses all teeth.
  const int from = cells.cell(0, comb ? m.whole(0, rows - 1) : 0), to = cells.cell(columns - 1, comb ? m.whole(0, rows - 1) : m.whole(0, rows - 1));
  if (closed) close_way(m, cells, from, to);
  if (!comb) add_loops(m, cells, m.whole(0, 3));
  const double thickness = m.length(0.02, 0.25), size = m.open + thickness + m.length(0.05, 0.4), slack = 0.5 * (size - thickness - m.open);
  cells.build(m, size, thickness);
  m.start.position = cells.middle(from, size) + m.within({slack, slack});
  m.goal = cells.middle(to, size) + m.within({slack, slack});
  if (m.chance(0.5)) std::swap(m.start.position, m.goal);
  if (m.chance(0.5)) m.mirror();
  m.rotate(m.chance(0.5) ? m.angle() : 0.5 * pi * m.whole(0, 3));
}

namespace {

/// Two combs, one in the other, in an outer wall; the straight way crosses all teeth in their middles. At every second tooth (those of the
/// one comb or of the other, by its hand) Bug2 goes back round nearly the whole contour before it is behind the tooth, so its way grows with the square of the number of
/// teeth; Bug1 goes round once, and back half of it at most. Measured: from four teeth on Bug1 is shorter on one of the two hands, with six on either.
void make_two_combs(ProblemMaker& m, bool closed) {
  const int columns = m.whole(5, 7), rows = 3;
  Cells cells(columns, rows);
  carve_comb(cells, columns, rows, true);
  const int from = cells.cell(0, 1), to = cells.cell(columns - 1, 1);
  if (closed) close_way(m, cells, from, to);
  const double thickness = m.length(0.02, 0.2), size = m.open + thickness + m.length(0.02, 0.2);
  cells.build(m, size, thickness);
  m.start.position = cells.middle(from, size);
  m.goal = cells.middle(to, size);
}

/// One comb that stands free, its teeth to the east. The straight way leads through its back into a gap between teeth, or out of it, or across the teeth: Bug2 leaves
/// after a part of its contour, Bug1 goes round all of it first. `closed`: the goal is in a gap whose mouth is closed.
void make_free_comb(ProblemMaker& m, bool closed) {
  const double free = m.keep + m.doubt + 0.01, thickness = m.length(0.05, 0.25), pitch = m.open + thickness + m.length(0.05, 0.4);
  const int teeth = m.whole(3, 4);
  const double tall = pitch * (teeth - 1), deep = std::max(2.0 * free, m.length(1.5, 3.5));
  const glm::dvec2 foot(-0.5 * deep, -0.5 * tall);
  m.wall({foot - glm::dvec2(0.0, 0.5 * thickness), foot + glm::dvec2(0.0, tall + 0.5 * thickness)}, thickness);
  for (int i = 0; i < teeth; ++i) m.wall({foot + glm::dvec2(0.0, pitch * i), foot + glm::dvec2(deep, pitch * i)}, thickness);
  const int gap = m.whole(0, teeth - 2);
  const double middle = foot.y + pitch * (gap + 0.5), outside = 0.5 * deep + 0.5 * thickness + free + m.length(0.0, 1.0);
  m.start.position = {-outside, middle};
  m.goal = {outside, middle};
  const int kind = m.whole(0, 2);
  if (closed || kind == 0) {  // into a gap
    m.goal.x = -0.5 * deep + 0.5 * thickness + free;
    const glm::dvec2 mouth(foot.x + deep - 0.5 * thickness, foot.y + pitch * gap);
    if (closed) m.wall({mouth, mouth + glm::dvec2(0.0, pitch)}, thickness);
  } else if (kind == 1) {  // across the teeth
    const double across = 0.5 * tall + 0.5 * thickness + free + m.length(0.0, 1.0), x = m.uniform(-0.2, 0.4) * deep;
    m.start.position = {x, -across};
    m.goal = {x + m.uniform(-0.2, 0.2) * deep, across};
  }
  const double farthest = std::max({outside, 0.5 * (tall + thickness), std::abs(m.start.position.y)});
  if (m.chance(0.4)) m.arena(farthest + m.open + m.length(0.0, 0.4));
  if (m.chance(0.5) && !closed) std::swap(m.start.position, m.goal);
}

}  // namespace

void make_comb(ProblemMaker& m) {
  const bool closed = m.number % 10 >= 8;
  if (m.number % 2 == 0) {
    make_two_combs(m, closed);
  } else {
    make_free_comb(m, closed);
  }
  if (m.chance(0.5)) m.mirror();
  m.rotate(m.chance(0.5) ? m.angle() : 0.5 * pi * m.whole(0, 3));
}

void make_rooms2019(ProblemMaker& m) {
  const double half = 7.0 * m.unit, reach = half - m.keep - m.doubt - 0.01;
  m.arena(half);
  divide(m, {-half, -half}, {half, half}, m.whole(3, 5));
  // Opposite corners, a little off.
  m.start.position = {-reach + m.length(0.0, 0.8), -reach + m.length(0.0, 0.8)};
  m.goal = {reach - m.length(0.0, 0.8), reach - m.length(0.0, 0.8)};
  if (m.chance(0.5)) m.mirror();
}

}  // namespace thicket
