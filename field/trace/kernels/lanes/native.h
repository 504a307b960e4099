// Vectors as wide as a register of the instruction set: a ray of a packet, or a source, in each lane. Part of
// block_kernels_<set>.cpp, inside its namespace.
// Only builtins and functions of these files are used: an inline function of a library, compiled here for a
// large instruction set, could be the copy that the linker keeps for everybody.

#if defined(__AVX512F__)
inline constexpr int native_lanes = 16;
#elif defined(__AVX__)
inline constexpr int native_lanes = 8;
#else
inline constexpr int native_lanes = 4;
#endif
using Native = float __attribute__((vector_size(4 * native_lanes)));
using NativeInt = int __attribute__((vector_size(4 * native_lanes)));  // as a mask 0 or -1
using V4 = float __attribute__((vector_size(16)));

inline constexpr float infinity = __builtin_inff();
inline float max_of(float a, float b) { return a > b ? a : b; }
inline float min_of(float a, float b) { return a < b ? a : b; }
inline float abs_of(float a) { return __builtin_fabsf(a); }
inline float root_of(float a) { return __builtin_sqrtf(a); }

inline V4 load4(const float* p) {
  V4 v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}

#if defined(__AVX__)
using V8 = float __attribute__((vector_size(32)));
inline V8 load8(const float* p) {
  V8 v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}
#endif

inline Native load_native(const float* p) {
  return *static_cast<const Native*>(__builtin_assume_aligned(p, sizeof(Native)));
}
inline NativeInt load_native(const int* p) {
  return *static_cast<const NativeInt*>(__builtin_assume_aligned(p, sizeof(NativeInt)));
}

// a > b ? a : b and a < b ? a : b: what the instructions of all sets do, also where a lane is no number.
#if defined(__AVX512F__)
inline Native larger(Native a, Native b) { return a > b ? a : b; }
inline Native smaller(Native a, Native b) { return a < b ? a : b; }
inline Native root_of(Native v) {
  Native r;
  for (int i = 0; i < native_lanes; ++i) r[i] = __builtin_sqrtf(v[i]);
  return r;
}
#elif defined(__AVX__)
inline Native larger(Native a, Native b) { return __builtin_ia32_maxps256(a, b); }
inline Native smaller(Native a, Native b) { return __builtin_ia32_minps256(a, b); }
inline Native root_of(Native v) { return __builtin_ia32_sqrtps256(v); }
#else
inline Native larger(Native a, Native b) { return __builtin_ia32_maxps(a, b); }
inline Native smaller(Native a, Native b) { return __builtin_ia32_minps(a, b); }
inline Native root_of(Native v) { return __builtin_ia32_sqrtps(v); }
#endif

#if defined(__AVX512F__)
inline Native select(NativeInt mask, Native a, Native b) { return mask ? a : b; }
inline NativeInt select(NativeInt mask, NativeInt a, NativeInt b) { return mask ? a : b; }
#else
// By the sign of the mask alone: an expression would compare it to 0 first.
inline Native select(NativeInt mask, Native a, Native b) {
#if defined(__AVX__)
  return __builtin_ia32_blendvps256(b, a, reinterpret_cast<Native>(mask));
#else
  return __builtin_ia32_blendvps(b, a, reinterpret_cast<Native>(mask));
#endif
}
inline NativeInt select(NativeInt mask, NativeInt a, NativeInt b) {
  return reinterpret_cast<NativeInt>(select(mask, reinterpret_cast<Native>(a), reinterpret_cast<Native>(b)));
}
#endif

// A bit for each lane that is set.
inline unsigned lane_bits(NativeInt mask) {
#if defined(__AVX512DQ__)
  return static_cast<unsigned>(__builtin_ia32_cvtd2mask512(mask)) & 0xffffU;
#elif defined(__AVX__)
  return static_cast<unsigned>(__builtin_ia32_movmskps256(reinterpret_cast<Native>(mask)));
#else
  return static_cast<unsigned>(__builtin_ia32_movmskps(reinterpret_cast<Native>(mask)));
#endif
}
inline NativeInt mask_of(unsigned bits) {
#if defined(__AVX512F__)
  const NativeInt bit{1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768};
#elif defined(__AVX__)
  const NativeInt bit{1, 2, 4, 8, 16, 32, 64, 128};
#else
  const NativeInt bit{1, 2, 4, 8};
#endif
  return (bit & static_cast<int>(bits)) != 0;
}

// Within each four lanes: a0 b0 a1 b1, and a2 b2 a3 b3.
#if defined(__AVX512F__)
inline Native low_pairs(Native a, Native b) {
  return __builtin_shufflevector(a, b, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
}
inline Native high_pairs(Native a, Native b) {
  return __builtin_shufflevector(a, b, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31);
}
#elif defined(__AVX__)
inline Native low_pairs(Native a, Native b) { return __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13); }
inline Native high_pairs(Native a, Native b) { return __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15); }
#else
inline Native low_pairs(Native a, Native b) { return __builtin_shufflevector(a, b, 0, 4, 1, 5); }
inline Native high_pairs(Native a, Native b) { return __builtin_shufflevector(a, b, 2, 6, 3, 7); }
#endif

// Lane 4 k + j of column i is lane i of quarter k of row j.
inline void transpose_quarters(const Native (&rows)[4], Native (&columns)[4]) {
  const Native a = low_pairs(rows[0], rows[2]), b = low_pairs(rows[1], rows[3]), c = high_pairs(rows[0], rows[2]),
               d = high_pairs(rows[1], rows[3]);
  columns[0] = low_pairs(a, b);
  columns[1] = high_pairs(a, b);
  columns[2] = low_pairs(c, d);
  columns[3] = high_pairs(c, d);
}
