// The share of the range of angles from the directions of strands [Zanni et al. 2015, eq. 15], at sixteen places of a
// cube. Part of block_kernels_<set>.cpp.

// sum f_i f_j over pairs, one strand after the other; and, where strands have angles of their own, of f_i f_j times
// what both have together where they cross.
template <bool Own>
struct PairsOfFields {
  Slopes16 before, sum;
  Slopes16 crossing_before{}, crossing_sum{};

  void add(const Slopes16& f, float crossing) {
    if constexpr (Own) {
      const Slopes16 own = f * crossing;
      crossing_sum = crossing_sum + own * before + f * crossing_before;
      crossing_before = crossing_before + own;
    }
    sum = sum + f * before;
    before = before + f;
  }
};

// Points are strands by themselves, without a direction.
template <bool Own>
inline void add_points(const FieldLevel& level, int degree, const Places16& at, PairsOfFields<Own>& pairs) {
  const float* group = point_sources(level);
  const float* crossing = level.strands->point_crossing;
  const float m = static_cast<float>(degree - 1);
  for (int k = 0; k < level.point_groups; ++k, group += floats_per_group)
    for (int i = 0; i < lanes; ++i) {
      if (!(group[48 + i] > 0)) continue;
      const V16 d[3] = {at.p[0] - group[i], at.p[1] - group[16 + i], at.p[2] - group[32 + i]};
      const V16 inv = 1.0F / (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
      Slopes16 f{field_of<0>(splat(group[48 + i]), splat(group[64 + i]), inv, degree - 1), {}};
      for (int e = 0; e < 3; ++e) f.slope[e] = -m * f.value * inv * d[e];
      pairs.add(f, Own ? crossing[k * lanes + i] : 0);
    }
}

// Adds N over pairs of a near strand and a far one, and its derivatives where the near ones stand still: these twice.
template <bool Own>
inline void add_turned_by_far(const Tensors16<Own>& near, const StrandLevel& seen, const Places16& at, Slopes16& sum) {
  const auto add = [&](V16 of_near, const Slopes16& of_far) {
    sum.value += of_near * of_far.value;
    for (int e = 0; e < 3; ++e) sum.slope[e] += 2.0F * of_near * of_far.slope[e];
  };
  for (int i = 0; i <= 8; ++i)
    for (int j = 0; i + j <= 8; ++j) {
      const int k = Tensor16::component(i, j);
      const float times = times_in_eighth.of[i][j];
      if constexpr (Own) {
        add(0.5F * times * near.weighted.of[k], at.quadratic(seen.far + k, tensor_floats));
        add(0.5F * times * near.plain.of[k], at.quadratic(seen.far_weighted + k, tensor_floats));
      } else {
        add(times * near.plain.of[k], at.quadratic(seen.far + k, tensor_floats));
      }
    }
}

// Adds twice N over pairs of near strands, and N over those with a far one; and twice its derivatives where the far
// ones stand still.
inline void add_turned(const Strand16& s, Slopes16& sum) {
  const V16 by_f = s.along(s.turn), by_u = 8.0F * s.f.value;
  sum.value += s.f.value * by_f;
  for (int e = 0; e < 3; ++e) {
    V16 by_turn{};
    for (int k = 0; k < 3; ++k) by_turn += s.turn[k] * s.u[k].slope[e];
    sum.slope[e] += 2.0F * (by_f * s.f.slope[e] + by_u * by_turn);
  }
}

template <bool Own>
inline Tensors16<Own> far_tensors(const StrandLevel& seen, const Places16& at) {
  Tensors16<Own> far;
  for (int k = 0; k < tensor_components; ++k) {
    far.plain.of[k] = at.quadratic(seen.far + k, tensor_floats).value;
    if constexpr (Own) far.weighted.of[k] = at.quadratic(seen.far_weighted + k, tensor_floats).value;
  }
  return far;
}

// Of angles that are sums over pairs, `above` over `below`.
inline void set_shares(const Slopes16& above, const Slopes16& below, StrandShares& out) {
  // One strand alone: any angle will do, see directional_alpha.h.
  const auto some = below.value > 1e-36F;
  const V16 inverse = select(some, 1.0F / below.value, V16{});
  const V16 share = select(some, smaller(splat(1), larger(V16{}, above.value * inverse)), splat(1));
  __builtin_memcpy(out.share, &share, sizeof share);
  for (int e = 0; e < 3; ++e) {
    const V16 slope = (above.slope[e] - share * below.slope[e]) * inverse;
    __builtin_memcpy(out.slope[e], &slope, sizeof slope);
  }
}

// From the strands that count one by one, found at these places, and all others.
template <bool Own>
inline void find_shares(const FieldLevel& level, int degree, const Places16& at, Strand16* strands, StrandShares& out) {
  const StrandLevel& seen = *level.strands;
  const StrandAngles<Own> angles{seen.angles};
  Tensors16<Own> near;
  find_turns(strands, seen.count, angles, far_tensors<Own>(seen, at), near);
  Slopes16 turned{};  // twice N over pairs of which one is among the near strands
  add_turned_by_far(near, seen, at, turned);
  PairsOfFields<Own> pairs{.before = at.quadratic(seen.far + far_sum, tensor_floats), .sum = {}};
  if constexpr (Own) pairs.crossing_before = at.quadratic(seen.far_weighted + far_sum, tensor_floats);
  for (int j = 0; j < seen.count; ++j) {
    pairs.add(strands[j].f, angles[j].crossing);
    add_turned(strands[j], turned);
  }
  add_points(level, degree, at, pairs);
  Slopes16 above = turned + at.quadratic(seen.far + far_turned_pairs, tensor_floats);
  if constexpr (Own) above = above + pairs.crossing_sum;
  set_shares(above, pairs.sum + pairs.sum + at.quadratic(seen.far + far_pairs, tensor_floats), out);
}

void strand_shares(const FieldLevel& level, int degree, const float (&center)[3], float half, float* memory,
                   StrandShares& out) {
  auto* const strands = static_cast<Strand16*>(static_cast<void*>(memory));
  const Places16 at(center, half);
  if (degree == 4) find_strands<4>(level, degree, at, strands);
  else find_strands<0>(level, degree, at, strands);
  if (level.strands->angles == nullptr) find_shares<false>(level, degree, at, strands, out);
  else find_shares<true>(level, degree, at, strands, out);
}
