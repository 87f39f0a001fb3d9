#include "thicket/base/schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "thicket/base/text.hpp"

namespace thicket {
namespace {

std::string range_in_words(const Range& range) {
  const bool low = std::isfinite(range.minimum), high = std::isfinite(range.maximum);
  if (low && high) return fmt::format("{} {} and at most {}", range.above_minimum ? "above" : "at least", range.minimum, range.maximum);
  if (low) return fmt::format("{} {}", range.above_minimum ? "above" : "at least", range.minimum);
  if (high) return fmt::format("at most {}", range.maximum);
  return "";
}

std::string unit_in_words(const Key& key) {
  return key.unit.empty() ? "" : fmt::format(" in {}", key.unit);
}

std::string expectation(const Key& key) {
  const std::string range = range_in_words(key.range);
  const std::string limits = range.empty() ? "" : ", " + range;
  switch (key.kind) {
    case KeyKind::flag:
      return "true or false";
    case KeyKind::integer:
      return fmt::format("an integer{}{}", unit_in_words(key), limits);
    case KeyKind::number:
      return fmt::format("a number{}{}{}", unit_in_words(key), limits, key.word.empty() ? "" : ", or '" + key.word + "'");
    case KeyKind::text:
      return key.choices.empty() ? "a text in quotes" : fmt::format("one of '{}'", fmt::join(key.choices, "', '"));
    case KeyKind::numbers:
      if (key.length_min == key.length_max) return fmt::format("an array of {} numbers{}{}", key.length_min, unit_in_words(key), limits);
      if (key.length_min == 1) return fmt::format("a number or an array of at most {}{}{}", key.length_max, unit_in_words(key), limits);
      return fmt::format("an array of numbers{}{}", unit_in_words(key), limits);
    case KeyKind::points:
      return fmt::format("an array of [x, y{}] points{}{}", key.length_max != 3 ? "" : key.length_min == 3 ? ", z" : "] or [x, y, z", unit_in_words(key), limits);
  }
  return "";
}

/// A finite number in range, or a fault.
std::optional<double> read_number(const Node& node, const Key& key, Faults& faults) {
  double number = 0.0;
  if (const auto* integer = std::get_if<std::int64_t>(&node.content)) {
    number = static_cast<double>(*integer);
  } else if (const auto* real = std::get_if<double>(&node.content)) {
    number = *real;
  } else {
    const auto* text = std::get_if<std::string>(&node.content);
    faults.add(node.place, fmt::format("'{}' is {}{}, expected {}", key.name, node.kind_in_words(), text ? " ('" + *text + "')" : "", expectation(key)));
    return std::nullopt;
  }
  const bool finite_enough = std::isfinite(number) || (key.range.infinite && std::isinf(number));
  const bool in_range = (key.range.above_minimum ? number > key.range.minimum : number >= key.range.minimum) && number <= key.range.maximum;
  if (!finite_enough || !in_range) {
    faults.add(node.place, fmt::format("'{}' is {}, expected {}{}", key.name, number, expectation(key),
                                       finite_enough || std::isnan(number) ? "" : ", finite"));
    return std::nullopt;
  }
  return number;
}

std::optional<std::vector<double>> read_numbers(const Node& node, const Key& key, Faults& faults) {
  const auto* array = node.array();
  if (!array && key.length_min == 1 && key.length_max > 1) {
    const auto number = read_number(node, key, faults);
    if (!number) return std::nullopt;
    return std::vector<double>{*number};
  }
  if (!array || array->size() < key.length_min || array->size() > key.length_max) {
    const std::string found = array ? fmt::format("an array of length {}", array->size()) : node.kind_in_words();
    faults.add(node.place, fmt::format("'{}' has {}, expected {}", key.name, found, expectation(key)));
    return std::nullopt;
  }
  std::vector<double> numbers;
  for (const Node& item : *array) {
    const auto number = read_number(item, key, faults);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

std::optional<Value> read_points(const Node& node, const Key& key, Faults& faults) {
  const auto* array = node.array();
  if (!array) {
    faults.add(node.place, fmt::format("'{}' is {}, expected {}", key.name, node.kind_in_words(), expectation(key)));
    return std::nullopt;
  }
  std::vector<std::vector<double>> points;
  for (const Node& item : *array) {
    auto point = read_numbers(item, key, faults);
    if (!point) return std::nullopt;
    points.push_back(std::move(*point));
  }
  return points;
}

std::optional<Value> read_text(const Node& node, const Key& key, Faults& faults) {
  const auto* text = std::get_if<std::string>(&node.content);
  if (!text) {
    faults.add(node.place, fmt::format("'{}' is {}, expected {}", key.name, node.kind_in_words(), expectation(key)));
    return std::nullopt;
  }
  if (!key.choices.empty() && std::find(key.choices.begin(), key.choices.end(), *text) == key.choices.end()) {
    faults.add(node.place, fmt::format("'{}' is '{}', expected {}{}", key.name, *text, expectation(key), did_you_mean(*text, key.choices)));
    return std::nullopt;
  }
  return *text;
}

std::optional<Value> read_value(const Node& node, const Key& key, Faults& faults) {
  switch (key.kind) {
    case KeyKind::flag:
      if (const auto* flag = std::get_if<bool>(&node.content)) return *flag;
      break;
    case KeyKind::integer:
      if (const auto* integer = std::get_if<std::int64_t>(&node.content)) {
        if (!read_number(node, key, faults)) return std::nullopt;
        return *integer;
      }
      break;
    case KeyKind::number:
      if (const auto* text = std::get_if<std::string>(&node.content); text && !key.word.empty() && *text == key.word) return *text;
      if (const auto number = read_number(node, key, faults)) return *number;
      return std::nullopt;
    case KeyKind::text:
      return read_text(node, key, faults);
    case KeyKind::numbers:
      if (auto numbers = read_numbers(node, key, faults)) return std::move(*numbers);
      return std::nullopt;
    case KeyKind::points:
      return read_points(node, key, faults);
  }
  faults.add(node.place, fmt::format("'{}' is {}, expected {}", key.name, node.kind_in_words(), expectation(key)));
  return std::nullopt;
}

}  // namespace

const Key* Section::find(std::string_view key) const {
  for (const Key& k : keys)
    if (k.name == key) return &k;
  return nullptr;
}

void read_section(const Node& table, const Section& section, void* object, Faults& faults, const std::vector<std::string>& also) {
  const auto* members = table.table();
  if (!members) {
    faults.add(table.place, fmt::format("'{}' is {}, expected a table", section.name, table.kind_in_words()));
    return;
  }
  std::vector<std::string> known = also;
  for (const Key& key : section.keys) known.push_back(key.name);
  for (const auto& [name, node] : *members) {
    if (std::find(also.begin(), also.end(), name) != also.end()) continue;
    const Key* key = section.find(name);
    if (!key) {
      faults.add(node.key_place, fmt::format("unknown key '{}' in {}{}", name, section.name, did_you_mean(name, known)));
      continue;
    }
    if (auto value = read_value(node, *key, faults)) key->set(object, *value);
  }
  for (const Key& key : section.keys)
    if (key.required && !table.find(key.name))
      faults.add(table.place, fmt::format("{} lacks the key '{}', expected {}", section.name, key.name, expectation(key)));
}

std::string toml_string(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      quoted += fmt::format("\\u{:04X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

namespace {

std::string number_to_toml(double number) {
  const std::string digits = fmt::format("{}", number);
  const bool plain_integer = std::isfinite(number) && digits.find_first_of(".e") == std::string::npos;
  return plain_integer ? digits + ".0" : digits;
}

struct TomlWriter {
  std::string operator()(std::monostate) const { return ""; }
  std::string operator()(bool flag) const { return flag ? "true" : "false"; }
  std::string operator()(std::int64_t integer) const { return fmt::format("{}", integer); }
  std::string operator()(double number) const { return number_to_toml(number); }
  std::string operator()(const std::string& text) const { return toml_string(text); }
  template <class Item>
  std::string operator()(const std::vector<Item>& items) const {
    std::vector<std::string> words;
    for (const Item& item : items) words.push_back((*this)(item));
    return fmt::format("[{}]", fmt::join(words, ", "));
  }
};

}  // namespace

std::string to_toml(const Value& value) {
  return std::visit(TomlWriter{}, value);
}

std::string write_section(const Section& section, const void* object) {
  std::string text;
  for (const Key& key : section.keys) {
    const Value value = key.get(object);
    if (!std::holds_alternative<std::monostate>(value)) text += fmt::format("{} = {}\n", key.name, to_toml(value));
  }
  return text;
}

namespace {

std::string default_in_words(const Key& key, const void* defaults) {
  const std::string value = to_toml(key.get(defaults));
  return key.required ? "required" : value.empty() ? "not given" : "default " + value;
}

}  // namespace

std::string describe_section_in_markdown(const Section& section, const void* defaults) {
  std::string text = fmt::format("**`{}`**: {}\n\n| key | what | takes | |\n|---|---|---|---|\n", section.name, section.help);
  for (const Key& key : section.keys) text += fmt::format("| `{}` | {} | {} | {} |\n", key.name, key.help, expectation(key), default_in_words(key, defaults));
  return text;
}

std::string describe_section(const Section& section, const void* defaults) {
  std::string text = fmt::format("{}  {}\n", section.name, section.help);
  for (const Key& key : section.keys) {
    text += fmt::format("  {:<26} {}\n  {:<26}   {}; {}\n", key.name, key.help, "", expectation(key), default_in_words(key, defaults));
  }
  return text;
}

}  // namespace thicket
