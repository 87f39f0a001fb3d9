// The declared schema behind every TOML file: from one list of keys come parsing, error messages, `thicket help`, the written-out resolved
// file and, later, the window's form.
//
// A section of a file is read into a plain struct whose members hold the values in the file's units: a member whose name ends in `_deg` is in
// degrees, so that a resolved file reads back to the same bits. Code converts where it uses them.
#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "thicket/base/document.hpp"
#include "thicket/base/result.hpp"

namespace thicket {

/// A key's value. Points are arrays of two or three numbers; `monostate` is "not given" of an optional key.
using Value = std::variant<std::monostate, bool, std::int64_t, double, std::string, std::vector<double>, std::vector<std::vector<double>>>;

enum class KeyKind { flag, integer, number, text, numbers, points };

/// Which numbers a key takes, ends included unless `above_minimum`. Infinity must be allowed by an infinite `maximum` together with `infinite`; NaN never is.
struct Range {
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  bool above_minimum = false;
  bool infinite = false;
};

inline Range at_least(double minimum) { return {minimum}; }
inline Range above(double minimum) { return {minimum, std::numeric_limits<double>::infinity(), true}; }
inline Range between(double minimum, double maximum) { return {minimum, maximum}; }
inline Range or_infinite(Range range) {
  range.infinite = true;
  return range;
}
inline Range above_up_to(double minimum, double maximum) { return {minimum, maximum, true}; }

/// One key of a section.
struct Key {
  std::string name;
  KeyKind kind = KeyKind::number;
  std::string unit;  ///< "m", "deg", "dB", ...; empty without one
  Range range;       ///< of each number
  std::size_t length_min = 0, length_max = 0;  ///< of `numbers`, and of each of `points`
  std::vector<std::string> choices;            ///< of a text; empty: any text
  std::string word;                            ///< that a number may be instead; empty: none
  bool required = false;
  std::string help;
  std::function<Value(const void*)> get;
  std::function<void(void*, const Value&)> set;
};

/// The keys of one section.
struct Section {
  std::string name;  ///< as it stands in messages, with its brackets: "[planner]"
  std::string help;
  std::vector<Key> keys;

  const Key* find(std::string_view key) const;
};

/// Builds a `Section` from the members of `S`.
template <class S>
class SectionOf : public Section {
 public:
  SectionOf(std::string section_name, std::string section_help) : Section{std::move(section_name), std::move(section_help), {}} {}

  template <class M, class Owner>  // Owner: S or a base of it
  SectionOf& key(std::string key_name, M Owner::*member, std::string unit, Range range, std::string key_help) {
    return add(std::move(key_name), [member](S& s) -> M& { return s.*member; }, std::move(unit), range, std::move(key_help));
  }
  template <class M, class Owner>
  SectionOf& key(std::string key_name, M Owner::*member, std::string key_help) {
    return key(std::move(key_name), member, "", Range{}, std::move(key_help));
  }
  template <class Owner>
  SectionOf& choice(std::string key_name, std::string Owner::*member, std::vector<std::string> choices, std::string key_help) {
    key(std::move(key_name), member, std::move(key_help));
    keys.back().choices = std::move(choices);
    return *this;
  }
  /// The number that was declared last may be a word instead ("auto"): then `chosen` is set and the number stays as it is; a number clears it.
  template <class Owner>
  SectionOf& or_word(std::string word, bool Owner::*chosen) {
    Key& k = keys.back();
    k.word = word;
    k.get = [get = k.get, chosen, word](const void* object) -> Value { return static_cast<const S*>(object)->*chosen ? Value(word) : get(object); };
    k.set = [set = k.set, chosen](void* object, const Value& value) {
      static_cast<S*>(object)->*chosen = std::holds_alternative<std::string>(value);
      if (!std::holds_alternative<std::string>(value)) set(object, value);
    };
    return *this;
  }
  /// How many numbers the array that was declared last takes; where one is enough, it may stand without brackets.
  SectionOf& lengths(std::size_t least, std::size_t most) {
    keys.back().length_min = least;
    keys.back().length_max = most;
    return *this;
  }
  SectionOf& required() {
    keys.back().required = true;
    return *this;
  }

  /// For members of members: `access` gives the value inside an `S`.
  template <class Access>
  SectionOf& add(std::string key_name, Access access, std::string unit, Range range, std::string key_help);
};

/// Reads the members of `table` that `section` declares into `object` (a struct of the type that the section was built from). Every fault goes to
/// `faults`: unknown keys with the nearest known one, wrong types, values out of range, required keys that are missing. Keys in `also` are
/// the caller's own and passed over.
void read_section(const Node& table, const Section& section, void* object, Faults& faults, const std::vector<std::string>& also = {});

/// `key = value` lines of an object; "not given" optionals are left out.
std::string write_section(const Section& section, const void* object);

/// The keys with unit, range, default (from `defaults`) and help, as text for a terminal.
std::string describe_section(const Section& section, const void* defaults);

/// The same as a table in Markdown.
std::string describe_section_in_markdown(const Section& section, const void* defaults);

/// A value as TOML: shortest digits that read back to the same bits.
std::string to_toml(const Value& value);
std::string toml_string(std::string_view text);

namespace schema_detail {

template <class M>
struct Optional {
  using Inner = M;
  static constexpr bool is = false;
};
template <class M>
struct Optional<std::optional<M>> {
  using Inner = M;
  static constexpr bool is = true;
};

template <class Point>
std::vector<double> coordinates(const Point& p) {
  std::vector<double> list;
  for (int i = 0; i < Point::length(); ++i) list.push_back(p[i]);
  return list;
}
template <class Point>
Point point(const std::vector<double>& list) {
  Point p{};
  for (int i = 0; i < Point::length(); ++i) p[i] = list[static_cast<std::size_t>(i)];
  return p;
}
/// A point type of one's own: it says how many numbers it takes, is made of them and gives them.
template <class P>
concept OwnPoint = requires(const P& p, const std::vector<double>& list) {
  { p.coordinates() } -> std::same_as<std::vector<double>>;
  { P::of(list) } -> std::same_as<P>;
  { P::length_min + P::length_max } -> std::convertible_to<std::size_t>;
};
template <class M>
struct OwnPointList {
  static constexpr bool is = false;
};
template <OwnPoint P>
struct OwnPointList<std::vector<P>> {
  static constexpr bool is = true;
};

template <class M>
inline constexpr bool is_point = std::is_same_v<M, glm::dvec2> || std::is_same_v<M, glm::dvec3> || std::is_same_v<M, glm::dvec4>;
template <class M>
inline constexpr bool is_point_list = std::is_same_v<M, std::vector<glm::dvec2>> || std::is_same_v<M, std::vector<glm::dvec3>>;

template <class M>
Value to_value(const M& member) {
  if constexpr (is_point<M>) {
    return coordinates(member);
  } else if constexpr (is_point_list<M>) {
    std::vector<std::vector<double>> list;
    for (const auto& p : member) list.push_back(coordinates(p));
    return list;
  } else if constexpr (OwnPointList<M>::is) {
    std::vector<std::vector<double>> list;
    for (const auto& p : member) list.push_back(p.coordinates());
    return list;
  } else if constexpr (std::is_integral_v<M> && !std::is_same_v<M, bool>) {
    return static_cast<std::int64_t>(member);
  } else {
    return member;
  }
}
template <class M>
M from_value(const Value& value) {
  if constexpr (is_point<M>) {
    return point<M>(std::get<std::vector<double>>(value));
  } else if constexpr (is_point_list<M>) {
    M list;
    for (const auto& p : std::get<std::vector<std::vector<double>>>(value)) list.push_back(point<typename M::value_type>(p));
    return list;
  } else if constexpr (OwnPointList<M>::is) {
    M list;
    for (const auto& p : std::get<std::vector<std::vector<double>>>(value)) list.push_back(M::value_type::of(p));
    return list;
  } else if constexpr (std::is_integral_v<M> && !std::is_same_v<M, bool>) {
    return static_cast<M>(std::get<std::int64_t>(value));
  } else {
    return std::get<M>(value);
  }
}
template <class M>
void describe_kind(Key& key) {
  if constexpr (is_point<M>) {
    key.kind = KeyKind::numbers;
    key.length_min = key.length_max = static_cast<std::size_t>(M::length());
  } else if constexpr (is_point_list<M>) {
    key.kind = KeyKind::points;
    key.length_min = key.length_max = static_cast<std::size_t>(M::value_type::length());
  } else if constexpr (OwnPointList<M>::is) {
    key.kind = KeyKind::points;
    key.length_min = M::value_type::length_min;
    key.length_max = M::value_type::length_max;
  } else if constexpr (std::is_same_v<M, std::vector<double>>) {
    key.kind = KeyKind::numbers;
    key.length_max = std::numeric_limits<std::size_t>::max();
  } else if constexpr (std::is_same_v<M, bool>) {
    key.kind = KeyKind::flag;
  } else if constexpr (std::is_integral_v<M>) {
    key.kind = KeyKind::integer;
  } else if constexpr (std::is_same_v<M, std::string>) {
    key.kind = KeyKind::text;
  } else {
    static_assert(std::is_same_v<M, double>, "no key holds this type");
    key.kind = KeyKind::number;
  }
}

}  // namespace schema_detail

template <class S>
template <class Access>
SectionOf<S>& SectionOf<S>::add(std::string key_name, Access access, std::string unit, Range range, std::string key_help) {
  using Member = std::remove_reference_t<decltype(access(std::declval<S&>()))>;
  using Inner = typename schema_detail::Optional<Member>::Inner;
  Key k;
  k.name = std::move(key_name);
  k.unit = std::move(unit);
  k.range = range;
  k.help = std::move(key_help);
  schema_detail::describe_kind<Inner>(k);
  k.get = [access](const void* object) -> Value {
    const Member& member = access(*const_cast<S*>(static_cast<const S*>(object)));
    if constexpr (schema_detail::Optional<Member>::is) {
      if (!member) return std::monostate{};
      return schema_detail::to_value(*member);
    } else {
      return schema_detail::to_value(member);
    }
  };
  k.set = [access](void* object, const Value& value) { access(*static_cast<S*>(object)) = schema_detail::from_value<Inner>(value); };
  keys.push_back(std::move(k));
  return *this;
}

}  // namespace thicket
