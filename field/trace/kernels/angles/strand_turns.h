// What turns the strands of a level, pair by pair or all others through a tensor. Part of block_kernels_<set>.cpp.

// The symmetric tensor sum f u^8 over strands (strand_tensor.h), whose components are those of StrandLevel::far.
struct Tensor16 {
  V16 of[tensor_components] = {};

  static constexpr int component(int i, int j) { return i * (19 - i) / 2 + j; }

  Tensor16& operator+=(const Tensor16& b) {
    for (int k = 0; k < tensor_components; ++k) of[k] += b.of[k];
    return *this;
  }
};

// Of the direction of a strand: the powers of its components.
template <int Degree>
struct DirectionPowers {
  V16 of[3][Degree + 1];

  explicit DirectionPowers(const Strand16& s) {
    for (int k = 0; k < 3; ++k) {
      of[k][0] = splat(1);
      for (int i = 1; i <= Degree; ++i) of[k][i] = of[k][i - 1] * s.u[k].value;
    }
  }
};

inline void add_strand(const Strand16& s, Tensor16& to) {
  const DirectionPowers<8> u(s);
  for (int i = 0; i <= 8; ++i) {
    const V16 first = s.f.value * u.of[0][i];
    for (int j = 0; i + j <= 8; ++j) to.of[Tensor16::component(i, j)] += first * u.of[1][j] * u.of[2][8 - i - j];
  }
}

// Adds sum f_j (u_j . u)^7 u_j over the strands of a tensor to the turn of one.
inline void turn_by(const Tensor16& t, Strand16& s) {
  const DirectionPowers<7> u(s);
  for (int i = 0; i <= 7; ++i)
    for (int j = 0; i + j <= 7; ++j) {
      const V16 product = times_in_seventh.of[i][j] * u.of[0][i] * u.of[1][j] * u.of[2][7 - i - j];
      s.turn[0] += product * t.of[Tensor16::component(i + 1, j)];
      s.turn[1] += product * t.of[Tensor16::component(i, j + 1)];
      s.turn[2] += product * t.of[Tensor16::component(i, j)];
    }
}

// Of the strands of a level: all alike, or each its own.
template <bool Own>
struct StrandAngles {
  const StrandAngle* of;

  StrandAngle operator[](int strand) const {
    if constexpr (Own) return of[strand];
    else return {};
  }
  float added_to_pair(int i, int j) const { return 0.5F * ((*this)[i].added + (*this)[j].added); }
};

// Sums of f u^8 over strands and, where they have angles of their own, of f u^8 times what being parallel adds to them:
// through both a strand meets all others in a time linear in their number.
template <bool Own>
struct Tensors16 {
  Tensor16 plain;

  void add(const Strand16& s, const StrandAngle&) { add_strand(s, plain); }
  Tensors16& operator+=(const Tensors16& b) {
    plain += b.plain;
    return *this;
  }
  // Adds to the turn of one.
  void turn(Strand16& s, const StrandAngle&) const { turn_by(plain, s); }
};
template <>
struct Tensors16<true> {
  Tensor16 plain, weighted;

  void add(const Strand16& s, const StrandAngle& angle) {
    Tensor16 own;
    add_strand(s, own);
    for (int k = 0; k < tensor_components; ++k) {
      plain.of[k] += own.of[k];
      weighted.of[k] += angle.added * own.of[k];
    }
  }
  Tensors16& operator+=(const Tensors16& b) {
    plain += b.plain;
    weighted += b.weighted;
    return *this;
  }
  void turn(Strand16& s, const StrandAngle& angle) const {
    Tensor16 mean;
    for (int k = 0; k < tensor_components; ++k) mean.of[k] = 0.5F * (angle.added * plain.of[k] + weighted.of[k]);
    turn_by(mean, s);
  }
};

// The strands that are the strongest at some place.
struct Strongest {
  int of[lanes], count = 0;

  Strongest(const Strand16* strands, int all) {
    V16 most{}, which = splat(-1);
    for (int j = 0; j < all; ++j) {
      const auto stronger = strands[j].f.value > most;
      which = select(stronger, splat(static_cast<float>(j)), which);
      most = select(stronger, strands[j].f.value, most);
    }
    alignas(64) float at_places[lanes];
    __builtin_memcpy(at_places, &which, sizeof which);
    for (const float at : at_places)
      if (at >= 0 && !holds(static_cast<int>(at))) of[count++] = static_cast<int>(at);
  }
  bool holds(int strand) const {
    for (int i = 0; i < count; ++i)
      if (of[i] == strand) return true;
    return false;
  }
};

// Finds what turns each strand: all others by one tensor, less its own part, where that is not most of it at any place,
// so that no digits are lost.
template <bool Own>
inline void find_turns(Strand16* strands, int count, const StrandAngles<Own>& angles, Tensors16<Own> others,
                       Tensors16<Own>& near) {
  const Strongest strongest(strands, count);
  Tensors16<Own> strong;
  near = {};
  for (int j = 0; j < count; ++j) (strongest.holds(j) ? strong : near).add(strands[j], angles[j]);
  others += near;
  for (int i = 0; i < strongest.count; ++i) {
    const int of = strongest.of[i];
    others.turn(strands[of], angles[of]);
    for (int j = 0; j < strongest.count; ++j)
      if (j != i) strands[strongest.of[j]].turn_other(strands[of], angles.added_to_pair(of, strongest.of[j]));
  }
  others += strong;
  near += strong;
  for (int j = 0; j < count; ++j) {
    if (strongest.holds(j)) continue;
    Strand16& s = strands[j];
    others.turn(s, angles[j]);
    for (int k = 0; k < 3; ++k) s.turn[k] -= angles[j].added * s.f.value * s.u[k].value;
  }
}
