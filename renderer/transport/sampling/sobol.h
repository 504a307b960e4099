// Low-discrepancy samples: Sobol points with Owen scrambling.
#pragma once

#include <cstdint>

#include "materials/sample.h"

namespace marrow {

/// The order of the bits turned around.
constexpr std::uint32_t reverse_bits(std::uint32_t x) {
  x = (x << 16) | (x >> 16);
  x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
  x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
  return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}

/// A permutation in which each bit depends on lower bits only: on reversed numbers it is an Owen scramble.
/// [Laine & Karras 2011 for the idea; the constants are Vegdahl's of 2021, which pass more tests]
constexpr std::uint32_t scramble_reversed(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

/// The second Sobol coordinate of `index`, first digit in the lowest bit. Its generator matrix is Pascal's triangle
/// mod 2; by Lucas' theorem entry (i, j) is 1 where the bits of i are among those of j, so that the product is a sum
/// over supersets, done bit by bit of the position.
constexpr std::uint32_t sobol_second_reversed(std::uint32_t index) {
  index ^= (index >> 16) & 0x0000ffffu;
  index ^= (index >> 8) & 0x00ff00ffu;
  index ^= (index >> 4) & 0x0f0f0f0fu;
  index ^= (index >> 2) & 0x33333333u;
  return index ^ ((index >> 1) & 0x55555555u);
}

/// Spreads the bits of x; a bijection.   [constants: Stafford 2011, "Mix13"]
constexpr std::uint64_t mix_bits(std::uint64_t x) {
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9u;
  x ^= x >> 27;
  x *= 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// The samples of one pixel. Sample i of pair d is a function of (x, y, seed, i, d) alone. Each pair of dimensions is
/// the 2-D Sobol sequence in an order and with an Owen scramble of its own, so that every pair is well spread and pairs
/// are independent.   [Burley 2020, JCGT 9(4)]
class Sampler {
 public:
  /// Absolute pixel coordinates.
  Sampler(int x, int y, std::uint64_t seed)
      : pixel_(mix_bits(mix_bits(seed + 0x9e3779b97f4a7c15u) ^
                        ((std::uint64_t(std::uint32_t(x)) << 32) | std::uint32_t(y)))) {}

  /// Goes to the first dimension of a sample of this pixel.
  void start(std::uint32_t sample) {
    reversed_index_ = reverse_bits(sample);
    pair_ = 0;
  }
  Sample2 next_2d() {
    const std::uint64_t order = mix_bits(pixel_ + ++pair_ * golden), scrambles = mix_bits(order);
    const std::uint32_t index = reverse_bits(scramble_reversed(reversed_index_, std::uint32_t(order)));
    // The first coordinate is the index with its bits reversed: as a scramble works on reversed numbers, none is
    // needed.
    const std::uint32_t x = reverse_bits(scramble_reversed(index, std::uint32_t(scrambles)));
    const std::uint32_t y =
        reverse_bits(scramble_reversed(sobol_second_reversed(index), std::uint32_t(scrambles >> 32)));
    return {unit(x), unit(y)};
  }
  /// Instead of next_2d(), where nobody looks at the numbers: those that follow are the same.
  void skip_2d() { ++pair_; }
  double next_1d() {
    const std::uint64_t order = mix_bits(pixel_ + ++pair_ * golden);
    const std::uint32_t index = reverse_bits(scramble_reversed(reversed_index_, std::uint32_t(order)));
    return unit(reverse_bits(scramble_reversed(index, std::uint32_t(order >> 32))));
  }
  Sample3 next_3d() {
    const Sample2 xy = next_2d();
    return {xy, next_1d()};
  }

 private:
  static constexpr std::uint64_t golden = 0x9e3779b97f4a7c15u;  // 2^64 / golden ratio: no two pairs come close
  static constexpr double unit(std::uint32_t bits) { return bits * 0x1p-32; }

  std::uint64_t pixel_ = 0;
  std::uint32_t reversed_index_ = 0;
  std::uint64_t pair_ = 0;
};

}  // namespace marrow
