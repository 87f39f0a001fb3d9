#include "thicket/base/schema.hpp"
#include "thicket/worlds/scene.hpp"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

using namespace thicket;

namespace {


struct Base {
  std::string word = "some";
};
struct Inner {
  double depth = 2.0;
};
struct Everything : Base {
  bool flag = false;
  int small = 0;
  std::int64_t large = 0;
  double number = 0.0;
  std::optional<double> perhaps;
  std::vector<double> list;
  glm::dvec2 two{0.0};
  glm::dvec3 three{0.0};
  std::optional<glm::dvec4> four;
  std::vector<glm::dvec2> line;
  std::string choice = "north";
  Inner inner;
};

SectionOf<Everything> everything(Range range = or_infinite(Range{})) {
  SectionOf<Everything> section("[everything]", "one key of each kind");
  section.key("word", &Everything::word, "a word of a base")
      .key("flag", &Everything::flag, "a flag")
      .key("small", &Everything::small, "", between(-1e9, 1e9), "an integer")
      .key("large", &Everything::large, "", Range{}, "a long integer")
      .key("number", &Everything::number, "m", range, "a number")
      .key("perhaps", &Everything::perhaps, "s", range, "a number or none")
      .key("list", &Everything::list, "", range, "numbers")
      .key("two", &Everything::two, "m", range, "a point")
      .key("three", &Everything::three, "m", range, "a place")
      .key("four", &Everything::four, "m", range, "a rectangle or none")
      .key("line", &Everything::line, "m", range, "points")
      .choice("choice", &Everything::choice, {"north", "south"}, "one of two");
  section.add(
      "depth", [](Everything& e) -> double& { return e.inner.depth; }, "m", range, "a member of a member");
  return section;
}

bool same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
template <class Point>
bool same_point(const Point& a, const Point& b) {
  for (int i = 0; i < Point::length(); ++i)
    if (!same(a[i], b[i])) return false;
  return true;
}
template <class List, class Same>
bool same_list(const List& a, const List& b, Same&& each) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!each(a[i], b[i])) return false;
  return true;
}
bool same(const Everything& a, const Everything& b) {
  if (a.perhaps.has_value() != b.perhaps.has_value() || (a.perhaps && !same(*a.perhaps, *b.perhaps))) return false;
  if (a.four.has_value() != b.four.has_value() || (a.four && !same_point(*a.four, *b.four))) return false;
  return a.word == b.word && a.flag == b.flag && a.small == b.small && a.large == b.large && same(a.number, b.number) &&
         same_list(a.list, b.list, [](double x, double y) { return same(x, y); }) && same_point(a.two, b.two) &&
         same_point(a.three, b.three) &&
         same_list(a.line, b.line, [](const glm::dvec2& p, const glm::dvec2& q) { return same_point(p, q); }) && a.choice == b.choice &&
         same(a.inner.depth, b.inner.depth);
}

struct Reading {
  Everything object;
  std::string faults;
};
Reading read(const std::string& text, const Section& section = everything()) {
  Reading reading;
  const auto document = parse_document(text, "f");
  if (!document) return {{}, document.error().message};
  Faults faults;
  read_section(*document, section, &reading.object, faults);
  if (!faults.none()) reading.faults = faults.error().message;
  return reading;
}
std::string faults_of(const std::string& text, Range range = or_infinite(Range{})) {
  return read(text, everything(range)).faults;
}

/// Any double but NaN: bit patterns, and the ones that are hard to write.
double any_double() {
  const double hard = *rc::gen::element(0.0, -0.0, 0.1, 1.0 / 3.0, 5e-324, 2.2250738585072014e-308, 1.7976931348623157e308, 1e22, 1e23,
                                        9007199254740993.0, -123456789012345680.0, 1e15, 1e16, 1e17, infinity, -infinity);
  const double patterned = std::bit_cast<double>(*rc::gen::arbitrary<std::uint64_t>());
  return *rc::gen::arbitrary<bool>() || std::isnan(patterned) ? hard : patterned;
}

}  // namespace

TEST_CASE("what is written reads back to the same bits") {
  const Section section = everything();
  CHECK(rc::check("write_section and read_section", [&] {
    Everything e;
    // ASCII with all its control characters, and what is awkward to quote.
    for (const int code : *rc::gen::container<std::vector<int>>(rc::gen::inRange(1, 128))) e.word += static_cast<char>(code);
    e.word += *rc::gen::element<std::string>("", "\u00e9", "\u6f22\u5b57", "\"\\\"", "#", "'''", "\"\"\"", "\r\n\t");
    e.flag = *rc::gen::arbitrary<bool>();
    e.small = *rc::gen::inRange(-1000000000, 1000000001);
    e.large = *rc::gen::arbitrary<std::int64_t>();
    e.number = any_double();
    if (*rc::gen::arbitrary<bool>()) e.perhaps = any_double();
    for (int i = *rc::gen::inRange(0, 5); i > 0; --i) e.list.push_back(any_double());
    e.two = {any_double(), any_double()};
    e.three = {any_double(), any_double(), any_double()};
    if (*rc::gen::arbitrary<bool>()) e.four = glm::dvec4(any_double(), any_double(), any_double(), any_double());
    for (int i = *rc::gen::inRange(0, 5); i > 0; --i) e.line.emplace_back(any_double(), any_double());
    e.choice = *rc::gen::element<std::string>("north", "south");
    e.inner.depth = any_double();

    const std::string text = write_section(section, &e);
    const Reading back = read(text);
    RC_ASSERT(back.faults == "");
    RC_ASSERT(same(back.object, e));
    RC_ASSERT(write_section(section, &back.object) == text);
  }));
}

TEST_CASE("numbers as TOML have the fewest digits, and a point or an exponent") {
  CHECK(to_toml(1.0) == "1.0");
  CHECK(to_toml(-0.0) == "-0.0");
  CHECK(to_toml(0.1) == "0.1");
  CHECK(to_toml(0.1 + 0.2) == "0.30000000000000004");
  CHECK(to_toml(1e22) == "1e+22");
  CHECK(to_toml(5e-324) == "5e-324");
  CHECK(to_toml(1.7976931348623157e308) == "1.7976931348623157e+308");
  CHECK(to_toml(123456.0) == "123456.0");
  CHECK(to_toml(infinity) == "inf");
  CHECK(to_toml(-infinity) == "-inf");
}

TEST_CASE("other values as TOML") {
  CHECK(to_toml(true) == "true");
  CHECK(to_toml(std::int64_t{-7}) == "-7");
  CHECK(to_toml(std::numeric_limits<std::int64_t>::min()) == "-9223372036854775808");
  CHECK(to_toml(std::vector<double>{1.0, 0.5}) == "[1.0, 0.5]");
  CHECK(to_toml(std::vector<double>{}) == "[]");
  CHECK(to_toml(std::vector<std::vector<double>>{{0.0, 1.0}, {2.0, 3.0}}) == "[[0.0, 1.0], [2.0, 3.0]]");
  CHECK(to_toml(std::string("a \"b\" \\ c\n")) == R"("a \"b\" \\ c\u000A")");
  CHECK(to_toml(std::monostate{}) == "");
}

TEST_CASE("what was not given is not written, and keeps its default when read") {
  const Everything e;
  CHECK(write_section(everything(), &e).find("perhaps") == std::string::npos);
  CHECK(write_section(everything(), &e).find("four") == std::string::npos);
  const Reading nothing = read("");
  CHECK(nothing.faults == "");
  CHECK(same(nothing.object, Everything{}));
  CHECK(nothing.object.inner.depth == 2.0);
}

TEST_CASE("an integer is a number, a number is no integer") {
  const Reading reading = read("number = 3\nthree = [1, 2.5, -3]\nsmall = -4\n");
  CHECK(reading.faults == "");
  CHECK(reading.object.number == 3.0);
  CHECK(reading.object.three == glm::dvec3(1.0, 2.5, -3.0));
  CHECK(reading.object.small == -4);
  CHECK(faults_of("small = 3.0") == "f:1:9: 'small' is a number, expected an integer, at least -1000000000 and at most 1000000000");
  CHECK(faults_of("large = true") == "f:1:9: 'large' is true or false, expected an integer");
  CHECK(faults_of("small = 2000000000").find("f:1:9: 'small' is 2000000000, expected an integer, at least") == 0);
}

TEST_CASE("wrong types and lengths") {
  CHECK(faults_of("flag = 1") == "f:1:8: 'flag' is an integer, expected true or false");
  CHECK(faults_of("word = 1") == "f:1:8: 'word' is an integer, expected a text in quotes");
  CHECK(faults_of("number = \"1\"") == "f:1:10: 'number' is a text ('1'), expected a number in m");
  CHECK(faults_of("number = 2020-01-01") == "f:1:10: 'number' is a date or time, expected a number in m");
  CHECK(faults_of("number = {}") == "f:1:10: 'number' is a table, expected a number in m");
  CHECK(faults_of("two = [1]") == "f:1:7: 'two' has an array of length 1, expected an array of 2 numbers in m");
  CHECK(faults_of("two = 5") == "f:1:7: 'two' has an integer, expected an array of 2 numbers in m");
  CHECK(faults_of("three = [1, 2, \"c\"]") == "f:1:16: 'three' is a text ('c'), expected an array of 3 numbers in m");
  CHECK(faults_of("line = [[1, 2], [3]]") == "f:1:17: 'line' has an array of length 1, expected an array of [x, y] points in m");
  CHECK(faults_of("line = [1, 2]") == "f:1:9: 'line' has an integer, expected an array of [x, y] points in m");
  CHECK(faults_of("line = \"x\"") == "f:1:8: 'line' is a text, expected an array of [x, y] points in m");
  CHECK(faults_of("choice = \"nort\"") == "f:1:10: 'choice' is 'nort', expected one of 'north', 'south' (did you mean 'north'?)");
  CHECK(faults_of("choice = \"elsewhere\"") == "f:1:10: 'choice' is 'elsewhere', expected one of 'north', 'south'");
}

TEST_CASE("ranges, their ends, infinity and NaN") {
  CHECK(faults_of("number = -1", at_least(0.0)) == "f:1:10: 'number' is -1, expected a number in m, at least 0");
  CHECK(faults_of("number = 0", at_least(0.0)) == "");
  CHECK(faults_of("number = 0", above(0.0)) == "f:1:10: 'number' is 0, expected a number in m, above 0");
  CHECK(faults_of("number = 5e-324", above(0.0)) == "");
  CHECK(faults_of("number = 1.5", between(-1.0, 1.0)) == "f:1:10: 'number' is 1.5, expected a number in m, at least -1 and at most 1");
  CHECK(faults_of("number = 1", between(-1.0, 1.0)) == "");
  CHECK(faults_of("number = -1", between(-1.0, 1.0)) == "");
  CHECK(faults_of("number = 2", above_up_to(0.0, 1.0)) == "f:1:10: 'number' is 2, expected a number in m, above 0 and at most 1");
  CHECK(faults_of("number = inf", at_least(0.0)) == "f:1:10: 'number' is inf, expected a number in m, at least 0, finite");
  CHECK(faults_of("number = inf", or_infinite(at_least(0.0))) == "");
  CHECK(faults_of("number = -inf", or_infinite(at_least(0.0))) == "f:1:10: 'number' is -inf, expected a number in m, at least 0");
  CHECK(faults_of("number = nan", or_infinite(at_least(0.0))) == "f:1:10: 'number' is nan, expected a number in m, at least 0");
  CHECK(faults_of("number = nan", Range{}) == "f:1:10: 'number' is nan, expected a number in m");
  CHECK(faults_of("three = [0, nan, 0]", between(-1.0, 1.0)).find("f:1:13: 'three' is nan") == 0);
  CHECK(faults_of("perhaps = -2", at_least(0.0)).find("f:1:11: 'perhaps' is -2, expected a number in s") == 0);
  // A fault leaves the default, and what else is in the file is read.
  CHECK(read("depth = -1\nnumber = 4", everything(at_least(0.0))).object.inner.depth == 2.0);
  CHECK(read("depth = -1\nnumber = 4", everything(at_least(0.0))).object.number == 4.0);
}

TEST_CASE("unknown keys, with what may have been meant, and keys that are missing") {
  CHECK(faults_of("nunber = 1") == "f:1:1: unknown key 'nunber' in [everything] (did you mean 'number'?)");
  CHECK(faults_of("\n  something_else = 1") == "f:2:3: unknown key 'something_else' in [everything]");
  SectionOf<Everything> strict("[strict]", "");
  strict.key("number", &Everything::number, "m", at_least(0.0), "a number").required();
  strict.key("word", &Everything::word, "a word");
  CHECK(read("word = \"x\"", strict).faults == "f:1:1: [strict] lacks the key 'number', expected a number in m, at least 0");
  CHECK(read("number = 1", strict).faults == "");
  // A required key that is there but wrong is told once.
  CHECK(read("number = \"x\"", strict).faults == "f:1:10: 'number' is a text ('x'), expected a number in m, at least 0");

  // Keys that are the caller's own are passed over.
  const auto document = parse_document("a = 1\nnumber = 2", "f");
  REQUIRE(document);
  Everything e;
  Faults faults;
  read_section(*document, strict, &e, faults, {"a"});
  CHECK(faults.none());
  CHECK(e.number == 2.0);
  Faults not_a_table;
  read_section(*document->find("a"), strict, &e, not_a_table);
  CHECK(not_a_table.error().message == "f:1:5: '[strict]' is an integer, expected a table");
}

TEST_CASE("all faults are told, in the order of the file") {
  CHECK(faults_of("small = true\nwhat_is_it = 1\nflag = 0\n") ==
        "f:1:9: 'small' is true or false, expected an integer, at least -1000000000 and at most 1000000000\n"
        "f:2:1: unknown key 'what_is_it' in [everything]\n"
        "f:3:8: 'flag' is an integer, expected true or false");
}

TEST_CASE("a section describes itself") {
  const Everything e;
  const std::string text = describe_section(everything(between(0.0, 5.0)), &e);
  CHECK(text.find("[everything]  one key of each kind\n") == 0);
  for (const char* part : {"a number in m, at least 0 and at most 5; default 0.0", "not given",
                           "one of 'north', 'south'; default \"north\"", "true or false; default false"}) {
    CAPTURE(std::string(part));
    CHECK(text.find(part) != std::string::npos);
  }
}

TEST_CASE("documents keep the order and the places of the file") {
  const auto document = parse_document("b = 1\n\n[a]\n  x = [1, 2]\n[[c]]\ny = 'text'\n[[c]]\n", "name.toml");
  REQUIRE(document);
  REQUIRE(document->table());
  std::vector<std::string> keys;
  for (const auto& [key, node] : *document->table()) keys.push_back(key);
  CHECK(keys == std::vector<std::string>{"b", "a", "c"});
  const Node* x = document->find("a")->find("x");
  REQUIRE(x);
  CHECK(to_string(x->place) == "name.toml:4:7");
  CHECK(to_string(x->key_place) == "name.toml:4:3");
  CHECK(to_string(x->array()->at(1).place) == "name.toml:4:11");
  CHECK(document->find("c")->array()->size() == 2);
  CHECK(document->find("nothing") == nullptr);
  CHECK(x->find("nothing") == nullptr);
  CHECK(x->kind_in_words() == "an array");

  const auto broken = parse_document("a = 1\nb = = 2\n", "name.toml");
  REQUIRE_FALSE(broken);
  CHECK(broken.error().message.find("name.toml:2:5: ") == 0);
}
