// An index that cannot be mistaken for an index of another kind.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>

namespace marrow {

template <class Tag>
struct Id {
  std::uint32_t value = UINT32_MAX;

  constexpr Id() = default;
  constexpr explicit Id(std::size_t index) : value(static_cast<std::uint32_t>(index)) {}
  constexpr bool valid() const { return value != UINT32_MAX; }
  constexpr std::size_t index() const { return value; }
  friend constexpr auto operator<=>(Id, Id) = default;
};

using ObjectId = Id<struct ObjectTag>;
using MaterialId = Id<struct MaterialTag>;

}  // namespace marrow
