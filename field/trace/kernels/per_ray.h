// What is written once for one ray and for a packet of sixteen: F is float, or V16 with a ray in each lane. Part of
// block_kernels_<set>.cpp.
//
// A lane of a packet goes through the operations of a single ray in the same order, so both give the same bits. What
// one ray does behind an `if`, a packet does for all lanes when any of them needs it, and keeps where a mask is set.

// Sixteen rays in the coordinates of a block, and memory for one search on them at a time.
struct Ray16 {
  V16 origin[3], direction[3];
  PacketMemory* memory;
};

template <class F>
struct PerRay;
template <>
struct PerRay<float> {
  using Mask = bool;
  using Int = int;
  using Ray = LocalRay;
};
template <>
struct PerRay<V16> {
  using Mask = Index16;  // 0 or -1
  using Int = Index16;
  using Ray = Ray16;
};
template <class F>
using MaskOf = typename PerRay<F>::Mask;
template <class F>
using IntOf = typename PerRay<F>::Int;
template <class F>
using RayOf = typename PerRay<F>::Ray;

// A bit for each lane that is set.
inline unsigned lane_bits(Index16 mask) {
#if defined(__AVX512DQ__)
  return static_cast<unsigned>(__builtin_ia32_cvtd2mask512(mask)) & 0xffffU;
#else
  const V16 signs = reinterpret_cast<V16>(mask);
  unsigned bits = 0;
  for (int k = 0; k < 4; ++k) {
    V4 part;
    __builtin_memcpy(&part, reinterpret_cast<const char*>(&signs) + 16 * k, sizeof part);
    bits |= static_cast<unsigned>(__builtin_ia32_movmskps(part)) << (4 * k);
  }
  return bits;
#endif
}
inline bool any(bool mask) { return mask; }
inline bool any(Index16 mask) { return lane_bits(mask) != 0; }

template <class T>
inline T select(bool mask, const T& a, const T& b) {
  return mask ? a : b;
}
inline V16 select(Index16 mask, V16 a, V16 b) { return mask ? a : b; }
inline Index16 select(Index16 mask, Index16 a, Index16 b) { return mask ? a : b; }

// to = from where the mask is set.
template <class T>
inline void assign(bool mask, T& to, const T& from) {
  if (mask) to = from;
}
inline void assign(Index16 mask, V16& to, V16 from) { to = mask ? from : to; }
inline void assign(Index16 mask, Index16& to, Index16 from) { to = mask ? from : to; }

inline void count(bool mask, int& number) { number += mask ? 1 : 0; }
inline void count(Index16 mask, Index16& number) { number -= mask; }

inline V16 max_of(V16 a, V16 b) { return larger(a, b); }
inline V16 max_of(V16 a, float b) { return larger(a, splat(b)); }
inline V16 max_of(float a, V16 b) { return larger(splat(a), b); }
inline V16 min_of(V16 a, V16 b) { return smaller(a, b); }
inline V16 min_of(V16 a, float b) { return smaller(a, splat(b)); }
inline V16 min_of(float a, V16 b) { return smaller(splat(a), b); }
inline V16 abs_of(V16 a) { return reinterpret_cast<V16>(reinterpret_cast<Index16>(a) & 0x7fffffff); }

template <class F>
inline F all_lanes(float v) {
  return F{} + v;
}

// Towards 0.
inline int whole_part(float v) { return static_cast<int>(v); }
inline Index16 whole_part(V16 v) { return __builtin_convertvector(v, Index16); }
inline float to_float(int v) { return static_cast<float>(v); }
inline V16 to_float(Index16 v) { return __builtin_convertvector(v, V16); }

inline float gather(const float* table, int index) { return table[index]; }
template <class V, class T>
inline V gather_lanes(const T* table, Index16 index) {
  V v;
  for (int i = 0; i < lanes; ++i) v[i] = table[index[i]];
  return v;
}
inline V16 gather(const float* table, Index16 index) {
#if defined(__AVX512F__)
  return __builtin_ia32_gathersiv16sf(V16{}, table, index, -1, 4);
#else
  return gather_lanes<V16>(table, index);
#endif
}
// Of sixteen numbers.
inline int picked(const int (&table)[16], int index) { return table[index]; }
inline Index16 picked(const int (&table)[16], Index16 index) {
  Index16 all;
  __builtin_memcpy(&all, table, sizeof all);
  return __builtin_shuffle(all, index);
}

inline int bits_of(float v) {
  int bits;
  __builtin_memcpy(&bits, &v, sizeof bits);
  return bits;
}
inline Index16 bits_of(V16 v) { return reinterpret_cast<Index16>(v); }
inline float from_bits(int bits) {
  float v;
  __builtin_memcpy(&v, &bits, sizeof v);
  return v;
}
inline V16 from_bits(Index16 bits) { return reinterpret_cast<V16>(bits); }

// q^(-1/k) for q > 0 to some 1e-5: a guess from the exponent bits, then Newton's iteration y (1 + (1 - q y^k) / k).
// Root 0 in the template means known only at run time.
template <int Root, class F>
inline F inverse_root(F q, int root) {
  const int k = Root > 0 ? Root : root;
  constexpr int one = 127 << 23;  // the bits of 1.0F
  F y = from_bits(one + one / k - bits_of(q) / k);
  const float step = 1 / static_cast<float>(k);
  for (int i = 0; i < 3; ++i) {
    F power = q;
    for (int j = 0; j < k; ++j) power *= y;
    y += y * (1 - power) * step;
  }
  return y;
}
template <class F>
inline F inverse_root(F q, int k) {
  return k == 3 ? inverse_root<3>(q, k) : inverse_root<0>(q, k);
}

// Directions that are 0 in an axis become very small: then no product is 0 times infinity.
template <class F>
inline F nonzero(F d) {
  return select(abs_of(d) > 1e-20F, d, all_lanes<F>(1e-20F));
}
