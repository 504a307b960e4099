// Typed tests over the kinds of a variant of nodes, which go by the names of scene files.
#pragma once

#include <string>
#include <variant>

#include <gtest/gtest.h>

#include "tests/tree/random_node.h"

namespace marrow::test {

template <class Variant>
struct KindsOf;
template <class... Kinds>
struct KindsOf<std::variant<Kinds...>> {
  using type = testing::Types<Kinds...>;
};

struct NameOfKind {
  template <class Kind>
  static std::string GetName(int) {
    return std::string(info_of_kind<Kind>().name);
  }
};

}  // namespace marrow::test
