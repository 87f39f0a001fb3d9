// Small helps with words.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace thicket {

/// The candidate nearest to `word` by edit distance (insert, delete, replace, swap neighbours), or nothing if none is near enough to be
/// a misspelling of it (more than a third of its letters wrong, at least one allowed).
std::optional<std::string> nearest_word(std::string_view word, const std::vector<std::string>& candidates);

/// ` (did you mean 'x'?)`, or nothing.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace thicket
