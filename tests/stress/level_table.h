// On which side of a level the correction operator is, mostly without asking it.
#pragma once

#include <cstddef>
#include <vector>

#include "field/blend/correction/correction.h"

namespace marrow::test {

/// C grows with G, and over an interval of f at a given G it is largest at an end (of which it is the upper one for
/// alpha >= 0). So the values of G where C(f, G) is at the level, at both ends of a step of f, decide for most G and
/// all f between them; for others the operator is asked. Ends are looked for when first needed, by one thread.
class LevelTable {
 public:
  LevelTable(const Correction&, double level);

  /// Only where C(f, G) is below the level. For alpha >= 0 wherever it is.
  bool is_below(double f, double G) const;
  /// C(f, G) > `other`, which is less than the level. For alpha >= 0.
  bool is_above(double other, double f, double G) const;

 private:
  /// C is below the level at `below`, which is negative where there is no such G, and not at `above`, which is infinite
  /// where there is none.
  struct Bracket {
    double below, above;
    bool is_made = false;
  };
  Bracket made(double f) const;
  const Bracket& at_end(std::size_t) const;
  /// The lesser and the larger one of both ends of the step around f, which is in the table.
  Bracket around(double f) const;

  Correction correction_;
  double level_;
  mutable std::vector<Bracket> ends_;  ///< of steps of equal length, from f = 0
};

}  // namespace marrow::test
