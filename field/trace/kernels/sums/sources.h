// Through the sources of one level, sixteen at a time. Part of block_kernels_<set>.cpp.

// As many sums, 12 or 16, over sources in lanes, one register of lanes after the other, so that accumulators stay in
// registers: add(group, nearest, a) adds the sources in the first of the lanes, and raises `nearest`.
template <int Count, class Add>
inline V16 sum_in_registers(const float* group, V16& nearest, const Add& add) {
  Native a[natives][Count], close[natives];
  split(nearest, close);
  for (int part = 0; part < natives; ++part) {
    Native of_part[Count];
#pragma GCC unroll 16
    for (int i = 0; i < Count; ++i) of_part[i] = Native{};
    add(group + part * native_lanes, close[part], of_part);
#pragma GCC unroll 16
    for (int i = 0; i < Count; ++i) a[part][i] = of_part[i];
  }
  nearest = joined(close);
  V16 whole[Count];
  for (int i = 0; i < Count; ++i) {
    Native parts[natives];
    for (int part = 0; part < natives; ++part) parts[part] = a[part][i];
    whole[i] = joined(parts);
  }
  return lane_sums(whole);
}

// Lane by lane, from a source to a place.
struct Away {
  Native x, y, z, inverse;  // and 1 / d^2

  Away(Native dx, Native dy, Native dz) : x(dx), y(dy), z(dz) { inverse = 1.0F / (x * x + y * y + z * z); }
};

// add(at, away) for `count` sources or groups of them, `stride` floats apart, with away(at). The division for the next
// one is under way while one is added: processors do not look as far ahead by themselves.
template <class AwayOf, class Add>
inline void for_each_source(const float* at, int count, int stride, const AwayOf& away, const Add& add) {
  if (count == 0) return;
  Away here = away(at);
  for (int k = 1; k < count; ++k, at += stride) {
    const Away next = away(at + stride);
    add(at, here);
    here = next;
  }
  add(at, here);
}

// What sources of this share and radius have there: w d^-m and w d^-(m+2), w tau d^-(m+2) and w tau d^-(m+4).
template <int Exponent>
struct Terms {
  Native w0, w2, k2, k4;

  Terms(Native share, Native radius, int exponent, const Away& d)
      : w0(field_of<Exponent>(share, radius, d.inverse, exponent)),
        w2(w0 * d.inverse),
        k2(w2 * radius),
        k4(k2 * d.inverse) {}
};

// for_each_source() of groups, sources in lanes: add(share, radius, away). The place: floats, or the same in all lanes.
template <class Place, class Add>
inline void for_each_group(const float* first, int groups, Place px, Place py, Place pz, const Add& add) {
  const auto away = [&](const float* group) {
    return Away(px - load_native(group), py - load_native(group + 16), pz - load_native(group + 32));
  };
  for_each_source(first, groups, floats_per_group, away,
                  [&](const float* group, const Away& d) { add(load_native(group + 48), load_native(group + 64), d); });
}

inline const float* point_sources(const FieldLevel& l) {
  return l.sources + static_cast<long>(l.curve_groups) * floats_per_group;
}

// An exponent that is known to the compiler; 0: only at run time.
template <int Exponent>
struct Known {
  static constexpr int exponent = Exponent;
};

template <class Add>
inline void with_exponent(int exponent, const Add& add) {
  switch (exponent) {
    case 2:
      return add(Known<2>{});
    case 3:
      return add(Known<3>{});
    case 4:
      return add(Known<4>{});
    case 5:
      return add(Known<5>{});
    default:
      add(Known<0>{});
  }
}

// The sources of one exponent.
struct SourceList {
  const float* groups;
  int count;
};
inline SourceList curves_of(const FieldLevel& l) { return {l.sources, l.curve_groups}; }
inline SourceList points_of(const FieldLevel& l) { return {point_sources(l), l.point_groups}; }

// Calls sums.add<Exponent>(groups, count, exponent) for the curves (exponent: the degree) and for the points (one
// less).
template <class Sums>
inline void for_each_list(const FieldLevel& l, int degree, const Sums& sums) {
  const auto add = [&](const SourceList& list, int exponent) {
    if (list.count == 0) return;
    with_exponent(exponent,
                  [&](auto known) { sums.template add<decltype(known)::exponent>(list.groups, list.count, exponent); });
  };
  add(curves_of(l), degree);
  add(points_of(l), degree - 1);
}
