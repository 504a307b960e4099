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

/// Each subtree is read once into one library that all of them share, so its mistakes are reported once, a chain of
/// uses may be as long as memory allows, uses of uses cost no memory, and a bomb of them meets a budget of visits. Each
/// field that uses a subtree gets a copy of what it needs of the library, once.
class Definitions {
 public:
  /// `defs` is the map of the scene. Reports what is unknown or used in a circle.
  void read(const Value& defs, Reader&);
  std::vector<std::string> names() const;
  /// The subtree in `field`, which is reader.field; added by the first use. Nothing when the subtree has mistakes,
  /// which are reported, or the budget is spent.
  std::optional<FieldNodeId> place(const std::string& name, const Value& at, FieldDescription& field, Reader&) const;

 private:
  enum class State { Waiting, Open, Done };
  struct Definition {
    const Member* written;  ///< while defs are read
    State state = State::Waiting;
    std::optional<FieldNodeId> root;  ///< in the library; nothing before it is read, and where it has mistakes
    std::size_t visits = 0;           ///< nodes that a walk from its root meets, each as often as it is placed
  };
  void read_after_its_parts(Definition& first, Reader&);
  void read_one(Definition&, Reader&);

  std::map<std::string, Definition> known_;
  FieldDescription library_;
};

}  // namespace marrow
