#include "thicket/base/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include <toml++/toml.h>

#include "thicket/base/files.hpp"
#include "thicket/base/float_traps.hpp"

namespace thicket {
namespace {

Place place_of(const toml::source_region& region, const std::string& file) {
  return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

Node convert(const toml::node& from, const std::string& file) {
  Node node;
  node.place = place_of(from.source(), file);
  if (const auto* table = from.as_table()) {
    Node::Table members;
    for (const auto& [key, value] : *table) {
      Node member = convert(value, file);
      member.key_place = place_of(key.source(), file);
      members.emplace_back(std::string(key.str()), std::move(member));
    }
    std::stable_sort(members.begin(), members.end(), [](const auto& a, const auto& b) {
      const Place &p = a.second.key_place, &q = b.second.key_place;
      return p.line != q.line ? p.line < q.line : p.column < q.column;
    });
    node.content = std::move(members);
  } else if (const auto* array = from.as_array()) {
    Node::Array items;
    for (const auto& item : *array) items.push_back(convert(item, file));
    node.content = std::move(items);
  } else if (const auto* text = from.as_string()) {
    node.content = text->get();
  } else if (const auto* integer = from.as_integer()) {
    node.content = integer->get();
  } else if (const auto* number = from.as_floating_point()) {
    node.content = number->get();
  } else if (const auto* flag = from.as_boolean()) {
    node.content = flag->get();
  }
  return node;  // dates and times stay empty: no key takes one
}

}  // namespace

std::string to_string(const Place& place) {
  return place.line > 0 ? fmt::format("{}:{}:{}", place.file, place.line, place.column) : place.file;
}

const Node* Node::find(std::string_view key) const {
  if (const Table* members = table())
    for (const auto& [name, value] : *members)
      if (name == key) return &value;
  return nullptr;
}

std::string Node::kind_in_words() const {
  static const char* const words[] = {"a date or time", "true or false", "an integer", "a number", "a text", "an array", "a table"};
  return words[content.index()];
}

namespace {

constexpr std::uintmax_t largest_document = std::uintmax_t{1} << 26;  // bytes; what describes a world or a mission is far smaller, and large data have files of their own
constexpr int deepest_key = 1000;
constexpr std::size_t most_faults_told = 100;  // nobody reads more

/// Where a dotted key is deeper than any that is meant: the parser goes down it by recursion, and would crash. (It limits nested arrays and tables itself.)
std::optional<Place> too_deep(std::string_view text, const std::string& name) {
  int line = 1, dots = 0;
  std::size_t line_start = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') {
      ++line;
      line_start = i + 1;
    }
    // Only what dots can join: in numbers, texts and comments something else comes between so many of them.
    const bool joins = c == '.' || c == ' ' || c == '\t' || c == '_' || c == '-' || c == '"' || c == '\'' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (!joins) dots = 0;
    else if (c == '.' && ++dots > deepest_key) return Place{name, line, static_cast<int>(i - line_start) + 1};
  }
  return std::nullopt;
}

}  // namespace

Result<Node> parse_document(std::string_view text, const std::string& name) {
  if (const auto place = too_deep(text, name)) return Error{fmt::format("{}: a key of more than {} parts joined by dots, expected fewer", to_string(*place), deepest_key)};
  const NoFloatTraps guard;  // 1e400 becomes infinity in the library, by an overflow: the keys judge it
  try {
    return convert(toml::parse(text, std::string_view(name)), name);
  } catch (const toml::parse_error& fault) {
    const bool open_text = fault.description().find("unescaped control characters") != std::string_view::npos;
    return Error{fmt::format("{}: {}{}", to_string(place_of(fault.source(), name)), fault.description(), open_text ? ": is a closing quote missing?" : "")};
  }
}

Result<Node> read_document(const std::filesystem::path& file) {
  std::error_code unknown;
  if (const auto size = std::filesystem::file_size(file, unknown); !unknown && size > largest_document)
    return Error{fmt::format("{}: is larger than {} bytes, expected a file that describes a world or a mission", file.string(), largest_document)};
  auto text = read_text_file(file);
  if (!text) return text.error();
  return parse_document(*text, file.string());
}

void Faults::add(const Place& place, std::string_view what) {
  messages_.push_back(fmt::format("{}: {}", to_string(place), what));
}

Error Faults::error() const {
  const std::size_t told = std::min(messages_.size(), most_faults_told);
  std::string text = fmt::format("{}", fmt::join(messages_.begin(), messages_.begin() + static_cast<std::ptrdiff_t>(told), "\n"));
  if (told < messages_.size()) text += fmt::format("\nand {} faults more", messages_.size() - told);
  return {std::move(text)};
}

}  // namespace thicket
