// Powers of vectors, and sums over their lanes in one fixed order. Part of block_kernels_<set>.cpp.

// a^k for k > 0, of a float or a vector.
template <class T>
inline T power_of(T a, int k) {
  for (; !(k & 1); k >>= 1) a = a * a;
  T power = a;
  while (k >>= 1) {
    a = a * a;
    if (k & 1) power = power * a;
  }
  return power;
}

// inv^(m/2) = d^-m. Exponent 0 in the template means known only at run time.
template <int Exponent, class V>
inline V inverse_power(V inv, int exponent) {
  const int m = Exponent > 0 ? Exponent : exponent;
  V power = (m & 1) ? root_of(inv) : V{} + 1.0F;
  for (int k = m / 2; k > 0; --k) power = power * inv;
  return power;
}

// share (tau / d)^m: the weight share tau^m alone could overflow beside a far smaller source.
template <int Exponent, class V>
inline V field_of(V share, V tau, V inv, int exponent) {
  return share * inverse_power<Exponent>(tau * tau * inv, exponent);
}

// Sums over 16 lanes of 12 or 16 accumulators at once, in as many lanes, as a tree: halves, quarters, pairs, single
// lanes.
#if defined(__AVX512F__)
template <int Count>
inline V16 lane_sums(const V16 (&a)[Count]) {
  static_assert(Count == 12 || Count == 16);
  V16 b[Count / 2], c[4] = {}, d[2];
  for (int i = 0; i < Count / 2; ++i)
    b[i] =
        __builtin_shufflevector(a[2 * i], a[2 * i + 1], 0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23) +
        __builtin_shufflevector(a[2 * i], a[2 * i + 1], 8, 9, 10, 11, 12, 13, 14, 15, 24, 25, 26, 27, 28, 29, 30, 31);
  for (int i = 0; i < Count / 4; ++i)
    c[i] = __builtin_shufflevector(b[2 * i], b[2 * i + 1], 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27) +
           __builtin_shufflevector(b[2 * i], b[2 * i + 1], 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31);
  for (int i = 0; i < 2; ++i) {
    const V16 lo = c[2 * i], hi = c[2 * i + 1];
    d[i] = __builtin_shufflevector(lo, hi, 0, 1, 4, 5, 8, 9, 12, 13, 16, 17, 20, 21, 24, 25, 28, 29) +
           __builtin_shufflevector(lo, hi, 2, 3, 6, 7, 10, 11, 14, 15, 18, 19, 22, 23, 26, 27, 30, 31);
  }
  return __builtin_shufflevector(d[0], d[1], 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30) +
         __builtin_shufflevector(d[0], d[1], 1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31);
}
#else
// Of the quarters, by halves.
inline V4 sum_of_quarters(const V16& v) {
  const auto half = v.low + v.high;
  return low_half(half) + high_half(half);
}
// Of each of four vectors.
inline V4 sums_of_four(const V16* v) {
  const V4 a = sum_of_quarters(v[0]), b = sum_of_quarters(v[1]), c = sum_of_quarters(v[2]), d = sum_of_quarters(v[3]);
  const V4 ab = __builtin_shufflevector(a, b, 0, 1, 4, 5) + __builtin_shufflevector(a, b, 2, 3, 6, 7);
  const V4 cd = __builtin_shufflevector(c, d, 0, 1, 4, 5) + __builtin_shufflevector(c, d, 2, 3, 6, 7);
  return __builtin_shufflevector(ab, cd, 0, 2, 4, 6) + __builtin_shufflevector(ab, cd, 1, 3, 5, 7);
}
template <int Count>
inline V16 lane_sums(const V16 (&a)[Count]) {
  static_assert(Count == 12 || Count == 16);
  V4 last{};
  if constexpr (Count == 16) last = sums_of_four(a + 12);
  return {joined(sums_of_four(a), sums_of_four(a + 4)), joined(sums_of_four(a + 8), last)};
}
#endif
template <int Count>
inline void sum_lanes(const V16 (&a)[Count], float (&sums)[16]) {
  const V16 s = lane_sums(a);
  __builtin_memcpy(sums, &s, sizeof s);
}

#if defined(__AVX512F__)
inline float largest_lane(V16 v) {
  v = larger(v, __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5, 6, 7));
  const V4 low = __builtin_shufflevector(v, v, 0, 1, 2, 3), high = __builtin_shufflevector(v, v, 4, 5, 6, 7);
  const V4 m = low > high ? low : high, n = __builtin_shufflevector(m, m, 2, 3, 0, 1), k = m > n ? m : n;
  return max_of(k[0], k[1]);
}

// The last lane becomes the largest one of `v`.
inline V16 with_largest_last(V16 lanes_of, V16 v) {
  v = larger(v, __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5, 6, 7));
  v = larger(v, __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9, 10, 11));
  v = larger(v, __builtin_shufflevector(v, v, 2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13));
  v = larger(v, __builtin_shufflevector(v, v, 1, 0, 3, 2, 5, 4, 7, 6, 9, 8, 11, 10, 13, 12, 15, 14));
  return __builtin_shufflevector(lanes_of, v, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 31);
}
#else
// The largest lane, in each of four.
inline V4 largest_in_four(const V16& v) {
  const auto half = larger(v.low, v.high);
  V4 m = larger(low_half(half), high_half(half));
  m = larger(m, __builtin_shufflevector(m, m, 2, 3, 0, 1));
  return larger(m, __builtin_shufflevector(m, m, 1, 0, 3, 2));
}
inline float largest_lane(const V16& v) { return largest_in_four(v)[0]; }
inline V16 with_largest_last(V16 lanes_of, const V16& v) {
  const V4 last = __builtin_shufflevector(high_half(lanes_of.high), largest_in_four(v), 0, 1, 2, 7);
  return {lanes_of.low, joined(low_half(lanes_of.high), last)};
}
#endif

// The columns of rows of 16, as many as a register has lanes.
#if defined(__AVX512F__)
// Four times, each row is woven with the one eight below.
inline void find_columns(const V16 (&rows)[16], V16 (&columns)[16]) {
  __builtin_memcpy(columns, rows, sizeof rows);
  for (int round = 0; round < 4; ++round) {
    V16 b[16];
    for (int i = 0; i < 8; ++i) {
      b[2 * i] =
          __builtin_shufflevector(columns[i], columns[i + 8], 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
      b[2 * i + 1] = __builtin_shufflevector(columns[i], columns[i + 8], 8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29,
                                             14, 30, 15, 31);
    }
    for (int i = 0; i < 16; ++i) columns[i] = b[i];
  }
}
#elif defined(__AVX__)
inline void find_columns(const V16 (&rows)[8], Native (&columns)[16]) {
  for (int half = 0; half < 2; ++half) {
    Native upper[4], lower[4], a[4], b[4];
    for (int i = 0; i < 4; ++i) {
      upper[i] = half == 0 ? rows[i].low : rows[i].high;
      lower[i] = half == 0 ? rows[i + 4].low : rows[i + 4].high;
    }
    transpose_quarters(upper, a);
    transpose_quarters(lower, b);
    for (int i = 0; i < 4; ++i) {
      columns[8 * half + i] = joined(low_half(a[i]), low_half(b[i]));
      columns[8 * half + 4 + i] = joined(high_half(a[i]), high_half(b[i]));
    }
  }
}
#else
inline void find_columns(const V16 (&rows)[4], Native (&columns)[16]) {
  Native parts[4][4];
  for (int i = 0; i < 4; ++i) split(rows[i], parts[i]);
  for (int k = 0; k < 4; ++k) {
    const Native of_rows[4] = {parts[0][k], parts[1][k], parts[2][k], parts[3][k]};
    Native found[4];
    transpose_quarters(of_rows, found);
    for (int i = 0; i < 4; ++i) columns[4 * k + i] = found[i];
  }
}
#endif
