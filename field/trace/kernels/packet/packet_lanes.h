// What is kept of the rays of a packet, and which of them is in which lane. Part of block_kernels_<set>.cpp.

// The rays of a packet on their ways through their blocks, in the coordinates of these.
struct BlockRays {
  alignas(64) float origin[3][packet_size], direction[3][packet_size];
  alignas(64) float from[packet_size], to[packet_size];
  alignas(64) float begin[packet_size], end[packet_size];    // of the run where each is
  alignas(64) float front[packet_size], guess[packet_size];  // where the fine level begins, and looks first
  alignas(64) float searched_from[packet_size];              // as in Root
  alignas(64) float t[packet_size], undecided[packet_size];
  alignas(64) int evaluations[packet_size];
  alignas(64) int cell[packet_size];
  const FieldAround* around[packet_size];  // of those that begin at a surface
  // Where patches give the angle: ShareLine of the run, and of the stretch that the fine level decides.
  alignas(64) float line[4][packet_size];
  alignas(64) float share[SharePatch::degree + 1][packet_size], fine_end[packet_size];
  LaneSet from_surface;                        // as in QueryOf
  LaneSet begins_outside, enters_inside, hit;  // as in RootOf
};

// Which ray of the packet is in which lane: when one has ended, another one takes its place.
class Lanes {
 public:
  // In as many free lanes as there are rays; takes these away from the set. Returns the lanes.
  PacketMask seat(LaneSet& waiting) {
    alignas(64) int at[packet_lanes];
    __builtin_memcpy(at, &at_, sizeof at);
    const unsigned all_free = ~taken_ & all_lane_bits;
    unsigned free = all_free;
    waiting.take(__builtin_popcount(free), [&](int ray) {
      at[__builtin_ctz(free)] = ray;
      free &= free - 1;
    });
    const unsigned seated = all_free & ~free;
    __builtin_memcpy(&at_, at, sizeof at_);
    taken_ |= seated;
    return PacketMask(seated);
  }
  void leave(PacketMask ended) { taken_ &= ~ended.bits(); }
  PacketMask taken() const { return PacketMask(taken_); }

  PacketFloat load(const float* of_packet) const { return gather(of_packet, at_); }
  PacketInt load(const int* of_packet) const { return gather(of_packet, at_); }
  void load(PacketMask which, const float* of_packet, PacketFloat& to) const { assign(which, to, load(of_packet)); }
#if defined(__AVX512F__)
  void store(PacketMask which, float* of_packet, PacketFloat v) const {
    __builtin_ia32_scattersiv16sf(of_packet, static_cast<unsigned short>(which.bits()), at_, v, 4);
  }
  void add(PacketMask which, int* of_packet, PacketInt v) const {
    const PacketInt sum = __builtin_ia32_gathersiv16si(NativeInt{}, of_packet, at_, -1, 4) + v;
    __builtin_ia32_scattersiv16si(of_packet, static_cast<unsigned short>(which.bits()), at_, sum, 4);
  }
#else
  void store(PacketMask which, float* of_packet, PacketFloat v) const {
    for_each(which, [&](int lane, int ray) { of_packet[ray] = v[lane]; });
  }
  void add(PacketMask which, int* of_packet, PacketInt v) const {
    for_each(which, [&](int lane, int ray) { of_packet[ray] += v[lane]; });
  }
#endif
  // The rays in these lanes.
  void add_to(LaneSet& rays, PacketMask which) const {
    for_each(which, [&](int, int ray) { rays.add(ray); });
  }

  // Calls visit(lane, ray).
  template <class Visit>
  void for_each(PacketMask which, const Visit& visit) const {
    for (unsigned left = which.bits(); left != 0; left &= left - 1) {
      const int lane = __builtin_ctz(left);
      visit(lane, at_[lane]);
    }
  }

 private:
  PacketInt at_{};
  unsigned taken_ = 0;
};
