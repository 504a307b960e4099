// Subtrees in the order of their needs, found without recursion over the chain of uses.
#include "renderer/scene/definitions.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <variant>
#include <vector>

#include "field/base/overloaded.h"
#include "renderer/scene/field_forms.h"
#include "renderer/scene/reader.h"

namespace marrow {
namespace {

// Every `use: name` of a subtree. Recursion ends at the document's own depth limit.
void collect_uses(const Value& value, std::vector<std::string>& uses) {
  for (const Value& item : value.items) collect_uses(item, uses);
  for (const Member& member : value.members) {
    if (member.key == "use" && member.value.is_scalar()) uses.push_back(member.value.text);
    else collect_uses(member.value, uses);
  }
}

// All nodes that a node refers to: its children, and the field that steers its angles.
template <class Node, class Visit>
void for_each_reference(Node& node, const Visit& visit) {
  std::visit(
      [&](auto& what) {
        if constexpr (requires { what.of.begin(); }) std::for_each(what.of.begin(), what.of.end(), visit);
        else if constexpr (requires { what.of; }) visit(what.of);
        if constexpr (requires { what.alpha.index(); })
          if (auto* steered = std::get_if<AlphaFromField>(&what.alpha)) visit(steered->field);
      },
      node.what);
}

// What a subtree needs of the library and `placed` does not hold yet, children before parents.
std::vector<std::size_t> missing_below(FieldNodeId root, const FieldDescription& library,
                                       const std::unordered_map<std::size_t, FieldNodeId>& placed) {
  std::vector<std::size_t> missing;
  std::unordered_set<std::size_t> seen;
  std::vector<FieldNodeId> open{root};
  while (!open.empty()) {
    const std::size_t index = open.back().index();
    open.pop_back();
    if (placed.contains(index) || !seen.insert(index).second) continue;
    missing.push_back(index);
    for_each_reference(library.nodes[index], [&](FieldNodeId id) { open.push_back(id); });
  }
  std::sort(missing.begin(), missing.end());
  return missing;
}

}  // namespace

std::vector<std::string> Definitions::names() const {
  std::vector<std::string> names;
  for (const auto& [name, definition] : known_) names.push_back(name);
  return names;
}

void Definitions::read(const Value& defs, Reader& reader) {
  for (const Member& member : defs.members) known_[member.key].written = &member;
  for (const Member& member : defs.members)
    if (Definition& d = known_[member.key]; d.state == State::Waiting) read_after_its_parts(d, reader);
  reader.nodes_left = Reader::max_nodes;
}

// Depth first with a stack of our own: a subtree is read when all that it uses has been.
void Definitions::read_after_its_parts(Definition& first, Reader& reader) {
  struct Step {
    Definition* definition;
    std::vector<std::string> uses;
  };
  std::vector<Step> path;
  const auto step_into = [&](Definition& d) {
    d.state = State::Open;
    path.push_back({&d, {}});
    collect_uses(d.written->value, path.back().uses);
  };

  step_into(first);
  while (!path.empty()) {
    Step& step = path.back();
    if (step.uses.empty()) {
      read_one(*step.definition, reader);
      path.pop_back();
      continue;
    }
    const std::string next = std::move(step.uses.back());
    step.uses.pop_back();
    const auto found = known_.find(next);
    if (found == known_.end() || found->second.state == State::Done) continue;  // place() reports the unknown
    if (found->second.state == State::Waiting) {
      step_into(found->second);
      continue;
    }
    const Member& here = *step.definition->written;
    std::string circle = next;
    for (auto s = path.rbegin(); s != path.rend() && s->definition->written->key != next; ++s)
      circle = s->definition->written->key + " -> " + circle;
    reader.error(here.place, "`" + next + "` uses itself: " + next + " -> " + circle,
                 "a subtree can only use what does not lead back to it", here.key.size());
  }
}

// Each has the whole budget of visits: what stands in the library is bounded by the text.
void Definitions::read_one(Definition& d, Reader& reader) {
  const Subject subject(reader, "`" + d.written->key + "`");
  reader.nodes_left = Reader::max_nodes;
  if (read_field(d.written->value, reader, library_)) d.root = library_.root;
  d.visits = Reader::max_nodes - reader.nodes_left;
  d.state = State::Done;
}

std::optional<FieldNodeId> Definitions::place(const std::string& name, const Value& at, FieldDescription& field,
                                              Reader& reader) const {
  const auto found = known_.find(name);
  if (found == known_.end()) return reader.unknown("subtree", name, at.place, names());
  const Definition& definition = found->second;
  if (!definition.root || !reader.spend_nodes(definition.visits, at.place)) return std::nullopt;
  if (&field == &library_) return definition.root;
  for (const std::size_t index : missing_below(*definition.root, library_, reader.placed)) {
    FieldNode node = library_.nodes[index];
    for_each_reference(node, [&](FieldNodeId& id) { id = reader.placed.at(id.index()); });
    node.shared = index + 1;
    reader.placed[index] = field.add(std::move(node));
  }
  return reader.placed.at(definition.root->index());
}

}  // namespace marrow
