// Sixteen floats, the lanes of all sums: one register, or two halves where registers are narrower. (The compiler can
// take vectors of 64 bytes apart by itself, but does so lane by lane where they are compared or shuffled.) Part of
// block_kernels_<set>.cpp.

#if defined(__AVX512F__)
using V16 = Native;
using Index16 = NativeInt;

inline V16 splat(float s) { return V16{} + s; }
inline V16 load(const float* p) { return load_native(p); }
#else
template <class Half>
struct Pair {
  Half low, high;
};

#if defined(__AVX__)
using V8 = Native;
using Index8 = NativeInt;
#else
using V8 = Pair<Native>;
using Index8 = Pair<NativeInt>;
#endif
using V16 = Pair<V8>;
using Index16 = Pair<Index8>;

#define MARROW_ON_HALVES(op)                                                 \
  template <class Half>                                                      \
  inline auto operator op(const Pair<Half>& a, const Pair<Half>& b) {        \
    return Pair<decltype(a.low op b.low)>{a.low op b.low, a.high op b.high}; \
  }                                                                          \
  template <class Half>                                                      \
  inline auto operator op(const Pair<Half>& a, float b) {                    \
    return Pair<decltype(a.low op b)>{a.low op b, a.high op b};              \
  }                                                                          \
  template <class Half>                                                      \
  inline auto operator op(float a, const Pair<Half>& b) {                    \
    return Pair<decltype(a op b.low)>{a op b.low, a op b.high};              \
  }
MARROW_ON_HALVES(+)
MARROW_ON_HALVES(-)
MARROW_ON_HALVES(*)
MARROW_ON_HALVES(/)
MARROW_ON_HALVES(<)
MARROW_ON_HALVES(>)
MARROW_ON_HALVES(<=)
MARROW_ON_HALVES(>=)
MARROW_ON_HALVES(==)
#undef MARROW_ON_HALVES
template <class Half>
inline Pair<Half> operator&(const Pair<Half>& a, const Pair<Half>& b) {
  return {a.low & b.low, a.high & b.high};
}
template <class Half>
inline void operator+=(Pair<Half>& a, const Pair<Half>& b) {
  a.low += b.low;
  a.high += b.high;
}
template <class Half>
inline void operator-=(Pair<Half>& a, const Pair<Half>& b) {
  a.low -= b.low;
  a.high -= b.high;
}

template <class Half>
inline Pair<Half> larger(const Pair<Half>& a, const Pair<Half>& b) {
  return {larger(a.low, b.low), larger(a.high, b.high)};
}
template <class Half>
inline Pair<Half> smaller(const Pair<Half>& a, const Pair<Half>& b) {
  return {smaller(a.low, b.low), smaller(a.high, b.high)};
}
template <class Half>
inline Pair<Half> root_of(const Pair<Half>& v) {
  return {root_of(v.low), root_of(v.high)};
}
template <class HalfMask, class Half>
inline Pair<Half> select(const Pair<HalfMask>& mask, const Pair<Half>& a, const Pair<Half>& b) {
  return {select(mask.low, a.low, b.low), select(mask.high, a.high, b.high)};
}
template <class HalfMask>
inline unsigned lane_bits(const Pair<HalfMask>& mask) {
  constexpr int lanes_of_half = sizeof(HalfMask) / sizeof(int);
  return lane_bits(mask.low) | lane_bits(mask.high) << lanes_of_half;
}

#if defined(__AVX__)
inline V16 splat(float s) { return {Native{} + s, Native{} + s}; }
inline V16 load(const float* p) { return {load_native(p), load_native(p + 8)}; }
inline V4 low_half(V8 v) { return __builtin_ia32_ps_ps256(v); }
inline V4 high_half(V8 v) { return __builtin_ia32_vextractf128_ps256(v, 1); }
inline V8 joined(V4 low, V4 high) { return __builtin_ia32_vinsertf128_ps256(__builtin_ia32_ps256_ps(low), high, 1); }
inline V4 larger(V4 a, V4 b) { return __builtin_ia32_maxps(a, b); }
#else
inline V16 splat(float s) {
  const V8 half{Native{} + s, Native{} + s};
  return {half, half};
}
inline V16 load(const float* p) {
  return {{load_native(p), load_native(p + 4)}, {load_native(p + 8), load_native(p + 12)}};
}
inline V4 low_half(const V8& v) { return v.low; }
inline V4 high_half(const V8& v) { return v.high; }
inline V8 joined(V4 low, V4 high) { return {low, high}; }
#endif
#endif

// The registers that hold the sixteen, in order.
inline constexpr int natives = lanes / native_lanes;
#if defined(__AVX512F__)
inline V16 joined(const Native (&parts)[natives]) { return parts[0]; }
inline void split(V16 v, Native (&parts)[natives]) { parts[0] = v; }
#elif defined(__AVX__)
inline V16 joined(const Native (&parts)[natives]) { return {parts[0], parts[1]}; }
inline void split(const V16& v, Native (&parts)[natives]) { parts[0] = v.low, parts[1] = v.high; }
#else
inline V16 joined(const Native (&parts)[natives]) { return {{parts[0], parts[1]}, {parts[2], parts[3]}}; }
inline void split(const V16& v, Native (&parts)[natives]) {
  parts[0] = v.low.low, parts[1] = v.low.high, parts[2] = v.high.low, parts[3] = v.high.high;
}
#endif
