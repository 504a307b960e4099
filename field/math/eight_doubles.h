// Eight doubles, the lanes of sums, taken by as many as a register holds: with AVX2 eight are two registers, and more
// than eight such totals do not stay in the sixteen that there are.
#pragma once

namespace marrow {

// Not by a number of lanes: an alias template does not keep a size that depends on it.
using Eight = double __attribute__((vector_size(64)));
using Four = double __attribute__((vector_size(32)));
using Two = double __attribute__((vector_size(16)));

/// How many a Part of the eight holds.
template <class Part>
inline constexpr int width = static_cast<int>(sizeof(Part) / sizeof(double));

}  // namespace marrow
