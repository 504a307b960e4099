// Vectors of doubles as wide as a register, and of half as many floats. Part of block_kernels_<set>.cpp, and of
// the kernels of renderer/geometry.

// A register of doubles, half as many as floats, and as many floats as these.
inline constexpr int double_lanes = native_lanes / 2;
using Doubles = double __attribute__((vector_size(8 * double_lanes)));
using DoubleMask = long long __attribute__((vector_size(8 * double_lanes)));
using Floats = float __attribute__((vector_size(4 * double_lanes)));

inline constexpr unsigned all_double_bits = (1U << double_lanes) - 1;

template <class V, class T>
inline V load_as(const T* p) {
  return *static_cast<const V*>(__builtin_assume_aligned(p, sizeof(V)));
}
inline Doubles load(const double* p) { return load_as<Doubles>(p); }
inline Floats load_floats(const float* p) { return load_as<Floats>(p); }
template <class V, class T>
inline void store(V v, T* p) {
  *static_cast<V*>(__builtin_assume_aligned(p, sizeof(V))) = v;
}
// Which of two equal or unordered ones is returned is as with std::min and std::max.
inline Doubles first_min(Doubles a, Doubles b) { return b < a ? b : a; }
inline Doubles first_max(Doubles a, Doubles b) { return a < b ? b : a; }
inline Floats first_min(Floats a, Floats b) { return b < a ? b : a; }
inline Floats first_max(Floats a, Floats b) { return a < b ? b : a; }
inline Floats narrowed(Doubles v) { return __builtin_convertvector(v, Floats); }
inline Doubles widened(Floats v) { return __builtin_convertvector(v, Doubles); }
inline DoubleMask double_mask(unsigned bits) {
#if defined(__AVX512F__)
  const DoubleMask bit{1, 2, 4, 8, 16, 32, 64, 128};
#elif defined(__AVX__)
  const DoubleMask bit{1, 2, 4, 8};
#else
  const DoubleMask bit{1, 2};
#endif
  return (bit & static_cast<long long>(bits)) != 0;
}
inline unsigned bits_of_mask(DoubleMask mask) {
#if defined(__AVX512DQ__)
  return static_cast<unsigned>(__builtin_ia32_cvtq2mask512(mask)) & all_double_bits;
#elif defined(__AVX__)
  return static_cast<unsigned>(__builtin_ia32_movmskpd256(reinterpret_cast<Doubles>(mask)));
#else
  return static_cast<unsigned>(__builtin_ia32_movmskpd(reinterpret_cast<Doubles>(mask)));
#endif
}
