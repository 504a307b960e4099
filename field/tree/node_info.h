// What a kind of node tells about itself; the scene format, its schema, its documentation and validation follow it.
//
// A kind of node is a struct in a file of field/tree/nodes and a row of field/tree/any_node.h. It has
//   static constexpr NodeInfo info;                    name in scenes, one line of documentation, number of children
//   static void keys(auto&& key);                      its parameters: key(name, member, form, documentation) each
// and one of
//   X value(const Vec3<X>& p) const;                   a primitive
//   X value(std::span<const X> f) const;               an operator on the values of its children
//   Vec3<X> child_point(const Vec3<X>& p) const;       a warp: where its one child is asked
// as templates over the Number X. A field is 1 on its surface, above 1 inside, 0 where nothing is. Further
//   Box3 support() const                               of a primitive: 0 outside this box, which may be infinite
//   Box3 extent(double level) const                    of a primitive with an infinite support: below level > 0 outside
//   Box3 support(std::span<const Box3> children) const of an operator, from its children's; their hull when left out
//   Box3 support(const Box3& child) const              of a warp
//   static constexpr bool ignores_zeros                of an operator: a child with the value 0 may be left out
//   double child_level(double level, std::size_t n)    of an operator of n children: while all their values are below
//                                                      this, its own is below `level`; `level` when left out
//   std::size_t owner(std::span<const double> f) const of an operator that does not mix its children: the one whose
//                                                      material the value has; by contribution when left out
//   std::string problem(std::size_t children) const    what is wrong with its parameters together; empty: nothing
#pragma once

#include <cstddef>
#include <limits>
#include <string_view>

namespace marrow {

inline constexpr std::size_t any_number_of_children = std::numeric_limits<std::size_t>::max();

struct NodeInfo {
  std::string_view name, doc;
  std::size_t min_children = 0, max_children = 0;
};

/// Forms of parameters. Lengths and coordinates are bounded so that float boxes hold them.
namespace form {

inline constexpr double largest = 1e15;

struct Real {  ///< of a double
  double min = -largest, max = largest;
  bool min_open = false, required = false;
};
struct Whole {  ///< of an int
  int min = 0, max = 1000;
};
struct Switch {};  ///< of a bool
/// Of a double in radians; scenes write degrees.
struct Angle {
  double min_deg = 0, max_deg = 360;
};
struct Position {  ///< of a Vec3d
  bool required = false;
};
struct Direction {  ///< of a UnitVec3; scenes write any length but 0
  bool required = false;
};
struct Sizes {};  ///< of a Vec3d, all above 0
struct Points {   ///< of a std::vector<Vec3d>
  std::size_t min_count = 2;
};
/// Of a std::vector<double>: a number for all, or a list.
struct Reals {
  double min = -largest, max = largest;
  bool min_open = false, required = false;
};
struct Rows {  ///< of a std::vector<std::vector<double>>
  double min = -largest, max = largest;
};
/// Of any type that names its values: a static constexpr array `names` of pairs of name and value in T's traits.
struct Word {};
/// Of a type with its own keys, written as `{name: {...}}` or by its name alone: a std::variant of parameter structs.
struct OneOf {};

inline constexpr Real positive{.min = 0, .min_open = true};
inline constexpr Real fraction{.min = 0, .max = 1};

}  // namespace form

}  // namespace marrow
