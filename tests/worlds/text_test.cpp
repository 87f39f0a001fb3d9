#include "thicket/base/text.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <random>

using namespace thicket;

namespace {

const std::vector<std::string> keys = {"image", "resolution", "origin", "mode"};

std::string nearest(std::string_view word, const std::vector<std::string>& candidates = keys) {
  return nearest_word(word, candidates).value_or("-");
}

// The definition, letter by letter from the end, and far too slow for anything but a test.
std::size_t slow_distance(std::string_view a, std::string_view b) {
  if (a.empty() || b.empty()) return a.size() + b.size();
  const auto shorter_a = a.substr(0, a.size() - 1), shorter_b = b.substr(0, b.size() - 1);
  std::size_t least = std::min({slow_distance(shorter_a, b) + 1, slow_distance(a, shorter_b) + 1,
                                slow_distance(shorter_a, shorter_b) + (a.back() == b.back() ? 0 : 1)});
  if (a.size() > 1 && b.size() > 1 && a.back() == b[b.size() - 2] && a[a.size() - 2] == b.back()) {
    least = std::min(least, slow_distance(a.substr(0, a.size() - 2), b.substr(0, b.size() - 2)) + 1);
  }
  return least;
}

}  // namespace

TEST_CASE("a misspelt word finds its candidate") {
  CHECK(nearest("image") == "image");
  CHECK(nearest("imag") == "image");             // one letter missing
  CHECK(nearest("imagee") == "image");           // one too many
  CHECK(nearest("imxge") == "image");            // one replaced
  CHECK(nearest("iamge") == "image");            // two neighbours swapped: one edit, not two
  CHECK(nearest("resoltuoin") == "resolution");  // two swaps of ten letters
  CHECK(nearest("resolutions") == "resolution");
}

TEST_CASE("a third of the letters may be wrong, at least one, and no more") {
  CHECK(nearest("mo") == "-");  // two missing, one allowed
  CHECK(nearest("mod") == "mode");
  CHECK(nearest("mxxe") == "-");         // two of four
  CHECK(nearest("orixxn") == "origin");  // two of six
  CHECK(nearest("orxxxn") == "-");       // three of six
  CHECK(nearest("x", {"y"}) == "y");
  CHECK(nearest("", {"y"}) == "y");
  CHECK(nearest("", {"yz"}) == "-");
  CHECK(nearest("frequency") == "-");
  CHECK(nearest("image", {}) == "-");
}

TEST_CASE("the nearest wins, and of equals the first") {
  CHECK(nearest("bug", {"bugs", "bug", "bog"}) == "bug");
  CHECK(nearest("bug3", {"bug1", "bug2"}) == "bug1");
  CHECK(nearest("bug3", {"bug2", "bug1"}) == "bug2");
}

TEST_CASE("a word of a megabyte is no trouble") {
  CHECK(nearest(std::string(1 << 20, 'x')) == "-");
}

TEST_CASE("the suggestion reads as part of a message") {
  CHECK(did_you_mean("resolutoin", keys) == " (did you mean 'resolution'?)");
  CHECK(did_you_mean("colour", keys) == "");
}

TEST_CASE("the distance is the one of the definition, on random words") {
  std::mt19937 random(7);
  const auto word = [&] {
    std::string letters(random() % 7, 'a');
    for (char& letter : letters) letter = static_cast<char>('a' + static_cast<char>(random() % 3));
    return letters;
  };
  for (int i = 0; i < 2000; ++i) {
    const std::string from = word(), to = word();
    CAPTURE(from);
    CAPTURE(to);
    const std::size_t allowed = std::max<std::size_t>(1, from.size() / 3);
    CHECK(nearest_word(from, {to}).has_value() == (slow_distance(from, to) <= allowed));
  }
}
