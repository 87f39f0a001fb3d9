#include "overrides.hpp"

#include <utility>

namespace thicket {
namespace {

void stamp(Node& node, const std::string& origin) {
  node.place = node.key_place = {origin, 0, 0};
  if (auto* items = std::get_if<Node::Array>(&node.content))
    for (Node& item : *items) stamp(item, origin);
}

}  // namespace

Node text_node(std::string text, const std::string& origin) {
  Node node;
  node.content = std::move(text);
  node.place = node.key_place = {origin, 0, 0};
  return node;
}

Node override_value(const Override& change) {
  const auto parsed = parse_document("value = " + change.value, change.origin);
  const Node* found = parsed ? parsed->find("value") : nullptr;
  Node node = found && parsed->table()->size() == 1 ? *found : text_node(change.value, change.origin);
  stamp(node, change.origin);
  return node;
}

Node& member(Node& table, const std::string& key) {
  auto* members = std::get_if<Node::Table>(&table.content);
  if (!members) members = &table.content.emplace<Node::Table>();
  for (auto& [name, node] : *members)
    if (name == key) return node;
  members->emplace_back(key, Node{});
  return members->back().second;
}

}  // namespace thicket
