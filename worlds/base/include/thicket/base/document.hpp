// A TOML file as a tree that remembers where everything stands. toml++ parses; this is the only view of it that the other rooms have.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "thicket/base/result.hpp"

namespace thicket {

/// A place in a file; line and column count from 1, 0 is "not in a file" (a default, a flag).
struct Place {
  std::string file;
  int line = 0;
  int column = 0;
};

/// `file:line:column`, or just the file or flag where there is no line.
std::string to_string(const Place& place);

/// One value, array or table of a document.
struct Node {
  using Array = std::vector<Node>;
  using Table = std::vector<std::pair<std::string, Node>>;  // in the order of the file

  std::variant<std::monostate, bool, std::int64_t, double, std::string, Array, Table> content;
  Place place;      ///< of the value
  Place key_place;  ///< of its key, where it has one

  const Table* table() const { return std::get_if<Table>(&content); }
  const Array* array() const { return std::get_if<Array>(&content); }
  const Node* find(std::string_view key) const;
  /// "a table", "a number", ... for messages
  std::string kind_in_words() const;
};

/// Parses TOML text; `name` stands in messages as the file.
Result<Node> parse_document(std::string_view text, const std::string& name);
Result<Node> read_document(const std::filesystem::path& file);

/// Faults found while reading; reading goes on after one, so that a file's mistakes are all told at once.
class Faults {
 public:
  void add(const Place& place, std::string_view what);
  bool none() const { return messages_.empty(); }
  Error error() const;
  void take(const Error& error) { messages_.push_back(error.message); }

 private:
  std::vector<std::string> messages_;
};

}  // namespace thicket
