// The random numbers of Python's `random.Random(seed)`.
#include "renderer/bench/python_random.h"

namespace marrow {
namespace {

constexpr std::size_t size = 624, shift = 397;

}  // namespace

PythonRandom::PythonRandom(std::uint32_t seed) {
  auto& s = state_;
  s[0] = 19650218U;
  for (std::uint32_t i = 1; i < size; ++i) s[i] = 1812433253U * (s[i - 1] ^ (s[i - 1] >> 30)) + i;
  std::uint32_t i = 1;
  const auto wrap = [&] {
    if (++i < size) return;
    s[0] = s[size - 1];
    i = 1;
  };
  for (std::size_t k = 0; k < size; ++k) {
    s[i] = (s[i] ^ ((s[i - 1] ^ (s[i - 1] >> 30)) * 1664525U)) + seed;
    wrap();
  }
  for (std::size_t k = 1; k < size; ++k) {
    s[i] = (s[i] ^ ((s[i - 1] ^ (s[i - 1] >> 30)) * 1566083941U)) - i;
    wrap();
  }
  s[0] = 0x80000000U;
}

void PythonRandom::refill() {
  for (std::size_t i = 0; i < size; ++i) {
    const std::uint32_t y = (state_[i] & 0x80000000U) | (state_[(i + 1) % size] & 0x7fffffffU);
    state_[i] = state_[(i + shift) % size] ^ (y >> 1) ^ (y & 1 ? 0x9908b0dfU : 0U);
  }
  used_ = 0;
}

std::uint32_t PythonRandom::word() {
  if (used_ == size) refill();
  std::uint32_t y = state_[used_++];
  y ^= y >> 11;
  y ^= (y << 7) & 0x9d2c5680U;
  y ^= (y << 15) & 0xefc60000U;
  return y ^ (y >> 18);
}

double PythonRandom::next() {
  const double high = word() >> 5, low = word() >> 6;
  return (high * 0x1p26 + low) * 0x1p-53;
}

bool PythonRandom::choose_second() {
  for (;;)
    if (const std::uint32_t drawn = word() >> 30; drawn < 2) return drawn == 1;
}

}  // namespace marrow
