// Through the sources of one level, sixteen at a time. Part of block_kernels_<set>.cpp.

// Lane by lane, from a source to a place.
struct Away {
  Native x, y, z, inverse;  // and 1 / d^2

  Away(Native dx, Native dy, Native dz) : x(dx), y(dy), z(dz) { inverse = 1.0F / (x * x + y * y + z * z); }
};

// What is asked of all sources of a list is a kind of sums: how many there are (`count`), what of a source is made
// ready before it is added (`Ready`, an Away and what else takes long), and ready(share, radius, away) and add(ready,
// radius, into), which calls into(i, term) for each sum. Of every kind the largest 1 / d^2 is found, too.

// Calls begin(at, ready) for the first of `count` sources or groups of them, and add(at, ready) for the others, with
// ready(at); they are `stride` floats apart, and there is at least one. Processors do not look far enough ahead by
// themselves to be busy while they divide. With 32 registers the next source is made ready while one is added; with 16,
// which the sums need for themselves, some are before any is added.
template <class Ready, class Make, class Begin, class Add>
inline void for_each_source(const float* at, int count, int stride, const Make& ready, const Begin& begin,
                            const Add& add) {
#if defined(__AVX512F__)
  Ready here = ready(at);
  const auto take = [&](const auto& put) {
    at += stride;
    const Ready next = ready(at);
    put(at - stride, here);
    here = next;
  };
  if (count == 1) return begin(at, here);
  take(begin);
  for (int k = 2; k < count; ++k) take(add);
  add(at, here);
#else
  constexpr int most = 16;
  alignas(Ready) char memory[most * sizeof(Ready)];
  Ready* const made = reinterpret_cast<Ready*>(memory);
  const auto make = [&] {
    const int now = count < most ? count : most;
    const float* next = at;
    for (int k = 0; k < now; ++k, next += stride) made[k] = ready(next);
    count -= now;
    return now;
  };
  int now = make();
  begin(at, made[0]);
  at += stride;
  for (int k = 1; k < now; ++k, at += stride) add(at, made[k]);
  while (count > 0) {
    now = make();
    for (int k = 0; k < now; ++k, at += stride) add(at, made[k]);
  }
#endif
}

// The sums of a kind over groups of sources for one place, as their lanes were added by lane_sums(): one register of
// lanes after the other, so that they stay in registers. `nearest` is raised to the largest 1 / d^2, lane by lane.
template <class Kind>
inline V16 sum_groups(const float* group, int groups, const Native (&place)[3], const Kind& kind, V16& nearest) {
  constexpr int count = Kind::count > 12 ? 16 : 12;
  Native a[natives][count], close[natives];
  split(nearest, close);
  for (int part = 0; part < natives; ++part) {
    Native of_part[count], closest = close[part];
#pragma GCC unroll 16
    for (int i = Kind::count; i < count; ++i) of_part[i] = Native{};
    const auto put = [&](const typename Kind::Ready& source, const float* at, const auto& into) {
      kind.add(source, load_native(at + 64), into);
      closest = larger(closest, source.inverse);
    };
    for_each_source<typename Kind::Ready>(
        group + part * native_lanes, groups, floats_per_group,
        [&](const float* at) {
          return kind.ready(
              load_native(at + 48), load_native(at + 64),
              Away(place[0] - load_native(at), place[1] - load_native(at + 16), place[2] - load_native(at + 32)));
        },
        [&](const float* at, const auto& source) { put(source, at, [&](int i, Native term) { of_part[i] = term; }); },
        [&](const float* at, const auto& source) { put(source, at, [&](int i, Native term) { of_part[i] += term; }); });
    close[part] = closest;
#pragma GCC unroll 16
    for (int i = 0; i < count; ++i) a[part][i] = of_part[i];
  }
  nearest = joined(close);
  V16 whole[count];
  for (int i = 0; i < count; ++i) {
    Native parts[natives];
    for (int part = 0; part < natives; ++part) parts[part] = a[part][i];
    whole[i] = joined(parts);
  }
  return lane_sums(whole);
}

// The field of sources at a place, made ready: their way to it and w d^-m.
struct FieldReady : Away {
  Native field;
};

// What they add with this radius: w d^-(m+2), w tau d^-(m+2) and w tau d^-(m+4).
struct Terms {
  Native w2, k2, k4;

  Terms(const FieldReady& s, Native radius) : w2(s.field * s.inverse), k2(w2 * radius), k4(k2 * s.inverse) {}
};

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
