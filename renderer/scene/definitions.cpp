// Subtrees in the order of their needs, found without recursion over the chain of uses.
#include "renderer/scene/definitions.h"

#include <algorithm>
#include <span>
#include <utility>
#include <variant>

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

FieldNode moved_by(FieldNode moved, std::size_t offset) {
  const auto move_list = [&](std::vector<FieldNodeId>& of) {
    for (FieldNodeId& id : of) id = FieldNodeId{id.index() + offset};
  };
  const auto move_blend = [&](Blend& blend) {
    move_list(blend.of);
    if (auto* steered = std::get_if<AlphaFromField>(&blend.alpha))
      steered->field = FieldNodeId{steered->field.index() + offset};
  };
  std::visit(Overloaded{[](Primitive&) {}, [&](Blend& blend) { move_blend(blend); },
                        [&](Union& all) { move_list(all.of); }, [&](GeneralNode& node) { move_list(node.of); },
                        [&](Transform& transform) { transform.of = FieldNodeId{transform.of.index() + offset}; }},
             moved.what);
  return moved;
}

std::span<const FieldNodeId> children_of(const FieldNode& node) {
  return std::visit(Overloaded{[](const Primitive&) { return std::span<const FieldNodeId>(); },
                               [](const Transform& t) { return std::span(&t.of, 1); },
                               [](const auto& n) { return std::span<const FieldNodeId>(n.of); }},
                    node.what);
}

// Nodes that a walk from the root meets, each as often as it is placed; at most one more than a scene may have.
std::size_t visits(const FieldDescription& field) {
  std::vector<std::size_t> below;
  for (const FieldNode& node : field.nodes) {
    std::size_t count = 1;
    for (const FieldNodeId child : children_of(node))
      count = std::min(count + below[child.index()], Reader::max_nodes + 1);
    below.push_back(count);
  }
  return below[field.root.index()];
}

}  // namespace

std::vector<std::string> Definitions::names() const {
  std::vector<std::string> names;
  for (const auto& [name, fragment] : fragments_) names.push_back(name);
  return names;
}

void Definitions::read(const Value& defs, Reader& reader) {
  std::map<std::string, const Member*> by_name;
  for (const Member& member : defs.members) {
    by_name[member.key] = &member;
    states_[member.key] = State::Waiting;
    fragments_[member.key] = std::nullopt;
  }
  reader.nodes_left = max_nodes;
  for (const Member& member : defs.members)
    if (states_[member.key] == State::Waiting) read_after_its_parts(member, by_name, reader);
  reader.nodes_left = Reader::max_nodes;
}

// Depth first with a stack of our own: a subtree is read when all that it uses has been.
void Definitions::read_after_its_parts(const Member& first, const std::map<std::string, const Member*>& by_name,
                                       Reader& reader) {
  struct Step {
    const Member* member;
    std::vector<std::string> uses;
  };
  const auto step_into = [](const Member& member) {
    Step step{&member, {}};
    collect_uses(member.value, step.uses);
    return step;
  };

  states_[first.key] = State::Open;
  std::vector<Step> path{step_into(first)};
  while (!path.empty()) {
    Step& step = path.back();
    if (step.uses.empty()) {
      FieldDescription fragment;
      const Subject subject(reader, "`" + step.member->key + "`");
      if (read_field(step.member->value, reader, fragment)) fragments_[step.member->key] = std::move(fragment);
      states_[step.member->key] = State::Done;
      path.pop_back();
      continue;
    }
    const std::string next = std::move(step.uses.back());
    step.uses.pop_back();
    const auto found = by_name.find(next);
    if (found == by_name.end() || states_[next] == State::Done) continue;  // the unknown are reported by place()
    if (states_[next] == State::Waiting) {
      states_[next] = State::Open;
      path.push_back(step_into(*found->second));
      continue;
    }
    std::string circle = next;
    for (auto s = path.rbegin(); s != path.rend() && s->member->key != next; ++s)
      circle = s->member->key + " -> " + circle;
    reader.error(step.member->place, "`" + next + "` uses itself: " + next + " -> " + circle,
                 "a subtree can only use what does not lead back to it", step.member->key.size());
  }
}

std::optional<FieldNodeId> Definitions::place(const std::string& name, const Value& at, FieldDescription& field,
                                              Reader& reader) const {
  const auto found = fragments_.find(name);
  if (found == fragments_.end()) return reader.unknown("subtree", name, at.place, names());
  if (!found->second || !reader.spend_nodes(visits(*found->second), at.place)) return std::nullopt;
  if (const auto there = reader.placed.find(name); there != reader.placed.end()) return there->second;
  const FieldDescription& part = *found->second;
  const std::size_t offset = field.nodes.size();
  for (const FieldNode& node : part.nodes) field.nodes.push_back(moved_by(node, offset));
  return reader.placed[name] = FieldNodeId{part.root.index() + offset};
}

}  // namespace marrow
