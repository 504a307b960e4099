// Subtrees that a scene names under `defs:` and places with `use:`.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "field/description/field_node.h"
#include "renderer/scene/document.h"

namespace marrow {

class Reader;

/// Each subtree is read once and stands once in each field that uses it, so its mistakes are reported once, no chain
/// of uses is too long for the stack, uses of uses cost no memory, and a bomb of them meets a budget of visits.
class Definitions {
 public:
  /// Of all subtrees with what they use; less than a scene may have, since they are kept beside it.
  static constexpr std::size_t max_nodes = 1'000'000;

  /// `defs` is the map of the scene. Reports what is unknown or used in a circle.
  void read(const Value& defs, Reader&);
  bool knows(const std::string& name) const { return fragments_.contains(name); }
  std::vector<std::string> names() const;
  /// The subtree in `field`, which is reader.field; added by the first use. Nothing when the subtree has mistakes,
  /// which are reported, or the budget is spent.
  std::optional<FieldNodeId> place(const std::string& name, const Value& at, FieldDescription& field, Reader&) const;

 private:
  void read_after_its_parts(const Member& first, const std::map<std::string, const Member*>& by_name, Reader&);

  enum class State { Waiting, Open, Done };
  std::map<std::string, State> states_;
  std::map<std::string, std::optional<FieldDescription>> fragments_;
};

}  // namespace marrow
