#include <fmt/format.h>

#include <algorithm>

#include "program.hpp"

namespace thicket::cli {

std::string aligned(const std::vector<Row>& rows, const std::vector<std::string>& words) {
  std::vector<std::size_t> widths(rows[0].size(), 0);
  for (const Row& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  std::string text;
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t c = 0; c + 1 < row.size(); ++c) {
      const bool left = c == 0 || std::find(words.begin(), words.end(), rows[0][c]) != words.end();
      line += left ? fmt::format("{:<{}}  ", row[c], widths[c]) : fmt::format("{:>{}}  ", row[c], widths[c]);
    }
    text += line + row.back() + "\n";
  }
  return text;
}

}  // namespace thicket::cli
