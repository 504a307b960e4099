// The random numbers of Python's `random.Random(seed)`, for scenes that other programs generate in Python.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace marrow {

/// MT19937 seeded by an array of one word, with the floats of CPython's _randommodule.c.
/// [Matsumoto, Nishimura 1998; init_by_array of 2002]
class PythonRandom {
 public:
  explicit PythonRandom(std::uint32_t seed);

  /// In [0, 1), 53 bits.
  double next();
  double uniform(double low, double high) { return low + (high - low) * next(); }
  /// One of two, by two bits that are drawn again while they say neither: random.choice of a pair.
  bool choose_second();

 private:
  std::uint32_t word();
  void refill();

  std::array<std::uint32_t, 624> state_{};
  std::size_t used_ = 624;
};

}  // namespace marrow
