// What is written once for one ray and for a packet of several: F is float, or PacketFloat with a ray in each lane.
// Part of block_kernels_<set>.cpp.
//
// A lane of a packet goes through the operations of a single ray in the same order, so both give the same bits,
// however many lanes there are. What one ray does behind an `if`, a packet does for all lanes when any of them needs
// it, and keeps where a mask is set.

// Such rays in the coordinates of a block, and memory for one search on them at a time.
struct PacketRays {
  PacketFloat origin[3], direction[3];
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
struct PerRay<PacketFloat> {
  using Mask = PacketMask;
  using Int = PacketInt;
  using Ray = PacketRays;
};
template <class F>
using MaskOf = typename PerRay<F>::Mask;
template <class F>
using IntOf = typename PerRay<F>::Int;
template <class F>
using RayOf = typename PerRay<F>::Ray;

inline bool any(bool mask) { return mask; }
inline bool any(PacketMask mask) { return mask.bits() != 0; }

template <class T>
inline T select(bool mask, const T& a, const T& b) {
  return mask ? a : b;
}

// to = from where the mask is set.
template <class T>
inline void assign(bool mask, T& to, const T& from) {
  if (mask) to = from;
}
inline void assign(PacketMask mask, PacketFloat& to, PacketFloat from) { to = select(mask, from, to); }
inline void assign(PacketMask mask, PacketInt& to, PacketInt from) { to = select(mask, from, to); }
inline void assign(PacketMask mask, PacketMask& to, PacketMask from) { to = (mask & from) | (to & !mask); }

inline void count(bool mask, int& number) { number += mask ? 1 : 0; }
inline void count(PacketMask mask, PacketInt& number) { number = select(mask, number + 1, number); }

inline PacketFloat max_of(PacketFloat a, PacketFloat b) { return larger(a, b); }
inline PacketFloat max_of(PacketFloat a, float b) { return larger(a, PacketFloat(b)); }
inline PacketFloat max_of(float a, PacketFloat b) { return larger(PacketFloat(a), b); }
inline PacketFloat min_of(PacketFloat a, PacketFloat b) { return smaller(a, b); }
inline PacketFloat min_of(PacketFloat a, float b) { return smaller(a, PacketFloat(b)); }
inline PacketFloat min_of(float a, PacketFloat b) { return smaller(PacketFloat(a), b); }
inline PacketFloat abs_of(PacketFloat a) {
  return reinterpret_cast<Native>(reinterpret_cast<NativeInt>(static_cast<Native>(a)) & 0x7fffffff);
}

template <class F>
inline F all_lanes(float v) {
  return v;
}

// Towards 0.
inline int whole_part(float v) { return static_cast<int>(v); }
inline PacketInt whole_part(PacketFloat v) { return __builtin_convertvector(static_cast<Native>(v), NativeInt); }
inline float to_float(int v) { return static_cast<float>(v); }
inline PacketFloat to_float(PacketInt v) { return __builtin_convertvector(static_cast<NativeInt>(v), Native); }

// With AVX2 lane by lane, too: on processors that have no AVX-512 its gathers take 1.5 to 2 times as long.
inline float gather(const float* table, int index) { return table[index]; }
template <class V, class T>
inline V gather_lanes(const T* table, PacketInt index) {
  V v;
  for (int i = 0; i < packet_lanes; ++i) v[i] = table[index[i]];
  return v;
}
inline PacketFloat gather(const float* table, PacketInt index) {
#if defined(__AVX512F__)
  return __builtin_ia32_gathersiv16sf(Native{}, table, index, -1, 4);
#else
  return gather_lanes<Native>(table, index);
#endif
}
inline PacketInt gather(const int* table, PacketInt index) {
#if defined(__AVX512F__)
  return __builtin_ia32_gathersiv16si(NativeInt{}, table, index, -1, 4);
#else
  return gather_lanes<NativeInt>(table, index);
#endif
}
// Of four bytes each, `offset` bytes behind those of a lane; 0 in lanes that are not asked.
#if defined(__AVX2__)
using LongLanes = long long __attribute__((vector_size(4 * packet_lanes)));  // of half the lanes
using HalfInt = int __attribute__((vector_size(2 * packet_lanes)));
inline HalfInt gather_half(const unsigned char* const* bytes, HalfInt offset, unsigned asked) {
  LongLanes base;
  __builtin_memcpy(&base, bytes, sizeof base);
  const LongLanes place = base + __builtin_convertvector(offset, LongLanes);
#if defined(__AVX512F__)
  return __builtin_ia32_gatherdiv16si(HalfInt{}, nullptr, place, static_cast<char>(asked), 1);
#else
  const HalfInt bit{1, 2, 4, 8}, mask = (bit & static_cast<int>(asked)) != 0;
  return __builtin_ia32_gatherdiv4si256(HalfInt{}, nullptr, place, mask, 1);
#endif
}
#endif
inline PacketInt gather_from(const unsigned char* const (&bytes)[packet_lanes], PacketInt offset, PacketMask asked) {
#if defined(__AVX2__)
  constexpr int half = packet_lanes / 2;
  const NativeInt at = offset;
#if defined(__AVX512F__)
  const HalfInt low = __builtin_shufflevector(at, at, 0, 1, 2, 3, 4, 5, 6, 7),
                high = __builtin_shufflevector(at, at, 8, 9, 10, 11, 12, 13, 14, 15);
#else
  const HalfInt low = __builtin_shufflevector(at, at, 0, 1, 2, 3), high = __builtin_shufflevector(at, at, 4, 5, 6, 7);
#endif
  const HalfInt a = gather_half(bytes, low, asked.bits()), b = gather_half(bytes + half, high, asked.bits() >> half);
#if defined(__AVX512F__)
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#else
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
#endif
#else
  NativeInt found{};
  for (unsigned left = asked.bits(); left != 0; left &= left - 1) {
    const int lane = __builtin_ctz(left);
    int four;
    __builtin_memcpy(&four, bytes[lane] + offset[lane], sizeof four);
    found[lane] = four;
  }
  return found;
#endif
}
// An entry of a table, and the next one.
template <class F>
struct Neighbours {
  F low, high;
};
inline Neighbours<float> neighbours_at(const float* table, int index) { return {table[index], table[index + 1]}; }
// Both together, as one number of twice the size: it is loaded in the same time.
#if defined(__AVX512F__)
inline Neighbours<PacketFloat> neighbours_at(const float* table, PacketInt at) {
  using Pairs = double __attribute__((vector_size(64)));
  const NativeInt index = at;
  const auto pairs = [&](auto of) {
    return reinterpret_cast<Native>(__builtin_ia32_gathersiv8df(Pairs{}, table, of, -1, 4));
  };
  const Native a = pairs(__builtin_shufflevector(index, index, 0, 1, 2, 3, 4, 5, 6, 7)),
               b = pairs(__builtin_shufflevector(index, index, 8, 9, 10, 11, 12, 13, 14, 15));
  return {__builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30),
          __builtin_shufflevector(a, b, 1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31)};
}
#elif defined(__AVX2__)
inline Neighbours<PacketFloat> neighbours_at(const float* table, PacketInt at) {
  using Pairs = double __attribute__((vector_size(32)));
  const auto pair = [&](int lane) {
    double both;
    __builtin_memcpy(&both, table + at[lane], sizeof both);
    return both;
  };
  const Native a = reinterpret_cast<Native>(Pairs{pair(0), pair(1), pair(4), pair(5)}),
               b = reinterpret_cast<Native>(Pairs{pair(2), pair(3), pair(6), pair(7)});
  return {__builtin_shufflevector(a, b, 0, 2, 8, 10, 4, 6, 12, 14),
          __builtin_shufflevector(a, b, 1, 3, 9, 11, 5, 7, 13, 15)};
}
#else
inline Neighbours<PacketFloat> neighbours_at(const float* table, PacketInt index) {
  return {gather(table, index), gather(table + 1, index)};
}
#endif
// Of sixteen numbers.
inline int picked(const int (&table)[16], int index) { return table[index]; }
template <class V, class T>
inline V picked_lanes(const T* table, PacketInt index) {
#if defined(__AVX512F__)
  V all;
  __builtin_memcpy(&all, table, sizeof all);
  return __builtin_shuffle(all, static_cast<NativeInt>(index));
#elif defined(__AVX2__)
  V low, high;
  __builtin_memcpy(&low, table, sizeof low);
  __builtin_memcpy(&high, table + packet_lanes, sizeof high);
  return __builtin_shuffle(low, high, static_cast<NativeInt>(index));
#else
  return gather_lanes<V>(table, index);
#endif
}
inline PacketInt picked(const int (&table)[16], PacketInt index) { return picked_lanes<NativeInt>(table, index); }
inline PacketFloat picked(const float* table, PacketInt index) { return picked_lanes<Native>(table, index); }

inline int bits_of(float v) {
  int bits;
  __builtin_memcpy(&bits, &v, sizeof bits);
  return bits;
}
inline PacketInt bits_of(PacketFloat v) { return reinterpret_cast<NativeInt>(static_cast<Native>(v)); }
inline float from_bits(int bits) {
  float v;
  __builtin_memcpy(&v, &bits, sizeof v);
  return v;
}
inline PacketFloat from_bits(PacketInt bits) { return reinterpret_cast<Native>(static_cast<NativeInt>(bits)); }

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
