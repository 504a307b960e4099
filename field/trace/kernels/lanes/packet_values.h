// A number, or a yes or no, of each ray of a packet. Part of block_kernels_<set>.cpp.
//
// They are classes, and not vectors themselves, for their comparisons: those of vectors give vectors again, but AVX-512
// compares into registers of a bit for each lane, and selects by these.

// As many rays as a register has lanes.
inline constexpr int packet_lanes = native_lanes;
inline constexpr unsigned all_lane_bits = (1U << packet_lanes) - 1;

class PacketMask {
 public:
  PacketMask() = default;  // of none

#if defined(__AVX512F__)
  explicit PacketMask(unsigned bits) : lanes_(static_cast<unsigned short>(bits)) {}
  unsigned bits() const { return lanes_; }
  friend PacketMask operator&(PacketMask a, PacketMask b) { return PacketMask(a.bits() & b.bits()); }
  friend PacketMask operator|(PacketMask a, PacketMask b) { return PacketMask(a.bits() | b.bits()); }
  PacketMask operator!() const { return PacketMask(~bits()); }
  Native picked(Native a, Native b) const { return __builtin_ia32_blendmps_512_mask(b, a, lanes_); }
  NativeInt picked(NativeInt a, NativeInt b) const { return __builtin_ia32_blendmd_512_mask(b, a, lanes_); }

 private:
  unsigned short lanes_ = 0;  // a bit for each
#else
  explicit PacketMask(unsigned bits) : lanes_(mask_of(bits)) {}
  explicit PacketMask(NativeInt lanes) : lanes_(lanes) {}
  unsigned bits() const { return lane_bits(lanes_); }
  friend PacketMask operator&(PacketMask a, PacketMask b) { return PacketMask(a.lanes_ & b.lanes_); }
  friend PacketMask operator|(PacketMask a, PacketMask b) { return PacketMask(a.lanes_ | b.lanes_); }
  PacketMask operator!() const { return PacketMask(~lanes_); }
  Native picked(Native a, Native b) const { return select(lanes_, a, b); }
  NativeInt picked(NativeInt a, NativeInt b) const { return select(lanes_, a, b); }

 private:
  NativeInt lanes_{};  // 0 or -1
#endif
};

class PacketFloat {
 public:
  PacketFloat() = default;
  PacketFloat(Native lanes) : lanes_(lanes) {}
  PacketFloat(float all) : lanes_(all - Native{}) {}  // to subtract 0 changes nothing, so that no instruction does it
  operator Native() const { return lanes_; }
  float operator[](int lane) const { return lanes_[lane]; }
  PacketFloat operator-() const { return -lanes_; }

 private:
  Native lanes_;
};

class PacketInt {
 public:
  PacketInt() = default;
  PacketInt(NativeInt lanes) : lanes_(lanes) {}
  PacketInt(int all) : lanes_(NativeInt{} + all) {}
  operator NativeInt() const { return lanes_; }
  int operator[](int lane) const { return lanes_[lane]; }
  PacketInt operator-() const { return -lanes_; }

 private:
  NativeInt lanes_;
};

#define MARROW_IN_LANES(Packet, Vector, op)                                                                  \
  inline Packet operator op(Packet a, Packet b) { return static_cast<Vector>(a) op static_cast<Vector>(b); } \
  inline Packet& operator op##=(Packet& a, Packet b) { return a = a op b; }
MARROW_IN_LANES(PacketFloat, Native, +)
MARROW_IN_LANES(PacketFloat, Native, -)
MARROW_IN_LANES(PacketFloat, Native, *)
MARROW_IN_LANES(PacketFloat, Native, /)
MARROW_IN_LANES(PacketInt, NativeInt, +)
MARROW_IN_LANES(PacketInt, NativeInt, -)
MARROW_IN_LANES(PacketInt, NativeInt, *)
MARROW_IN_LANES(PacketInt, NativeInt, /)
MARROW_IN_LANES(PacketInt, NativeInt, &)
MARROW_IN_LANES(PacketInt, NativeInt, |)
MARROW_IN_LANES(PacketInt, NativeInt, <<)
MARROW_IN_LANES(PacketInt, NativeInt, >>)
#undef MARROW_IN_LANES

// With the instruction's number of the comparison of floats, and of whole numbers. Of lanes that are no numbers all but
// != are false.
#if defined(__AVX512F__)
inline constexpr int current_rounding = 4;  // that an instruction without one of its own goes by
#define MARROW_COMPARISON(op, of_floats, of_ints)                                                                \
  inline PacketMask operator op(PacketFloat a, PacketFloat b) {                                                  \
    return PacketMask(__builtin_ia32_cmpps512_mask(a, b, of_floats, all_lane_bits, current_rounding) & 0xffffU); \
  }                                                                                                              \
  inline PacketMask operator op(PacketInt a, PacketInt b) {                                                      \
    return PacketMask(__builtin_ia32_cmpd512_mask(a, b, of_ints, all_lane_bits) & 0xffffU);                      \
  }
#else
#define MARROW_COMPARISON(op, of_floats, of_ints)                              \
  inline PacketMask operator op(PacketFloat a, PacketFloat b) {                \
    return PacketMask(static_cast<Native>(a) op static_cast<Native>(b));       \
  }                                                                            \
  inline PacketMask operator op(PacketInt a, PacketInt b) {                    \
    return PacketMask(static_cast<NativeInt>(a) op static_cast<NativeInt>(b)); \
  }
#endif
MARROW_COMPARISON(==, 0, 0)
MARROW_COMPARISON(<, 1, 1)
MARROW_COMPARISON(<=, 2, 2)
MARROW_COMPARISON(!=, 4, 4)
MARROW_COMPARISON(>=, 13, 5)
MARROW_COMPARISON(>, 14, 6)
#undef MARROW_COMPARISON

// The columns of rows of sixteen.
inline void find_columns(const V16 (&rows)[packet_lanes], PacketFloat (&columns)[lanes]) {
  Native found[lanes];
  find_columns(rows, found);
  for (int i = 0; i < lanes; ++i) columns[i] = found[i];
}

inline PacketFloat select(PacketMask mask, PacketFloat a, PacketFloat b) { return mask.picked(a, b); }
inline PacketInt select(PacketMask mask, PacketInt a, PacketInt b) { return mask.picked(a, b); }
