// A packet of rays in one block: those that need the same go together, sixteen at a time. Part of
// block_kernels_avx512.cpp.

// The rays of a packet on their way through a block, in its coordinates.
struct BlockRays {
  alignas(64) float origin[3][packet_size], direction[3][packet_size];
  alignas(64) float from[packet_size], to[packet_size];
  alignas(64) float begin[packet_size], end[packet_size];    // of the run where each is
  alignas(64) float front[packet_size], guess[packet_size];  // where the fine level begins, and looks first
  alignas(64) float searched_from[packet_size];              // as in Root
  alignas(64) float t[packet_size], undecided[packet_size];
  alignas(64) int evaluations[packet_size];
  alignas(64) float share[SharePatch::degree + 1][packet_size];  // ShareOnRun of the run, where patches give the angle
  std::uint64_t from_surface;                                    // as in QueryOf
  std::uint64_t begins_outside, enters_inside, hit;              // as in RootOf
};

inline Index16 mask_of(unsigned bits) {
  const Index16 bit{1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768};
  return (bit & static_cast<int>(bits)) != 0;
}

// Which ray of the packet is in which lane: when one has ended, another one takes its place.
class Lanes {
 public:
  // In as many free lanes as there are rays; takes these away from the set. Returns the lanes.
  Index16 seat(std::uint64_t& waiting) {
    unsigned seated = 0;
    alignas(64) int at[lanes];
    __builtin_memcpy(at, &at_, sizeof at);
    for (unsigned free = ~taken_ & 0xffff; free != 0 && waiting != 0; free &= free - 1, waiting &= waiting - 1) {
      at[__builtin_ctz(free)] = __builtin_ctzll(waiting);
      seated |= free & -free;
    }
    __builtin_memcpy(&at_, at, sizeof at_);
    taken_ |= seated;
    return mask_of(seated);
  }
  void leave(Index16 ended) { taken_ &= ~lane_bits(ended); }
  Index16 taken() const { return mask_of(taken_); }

  V16 load(const float* of_packet) const { return gather(of_packet, at_); }
  void load(Index16 which, const float* of_packet, V16& to) const { assign(which, to, load(of_packet)); }
  void store(Index16 which, float* of_packet, V16 v) const {
    __builtin_ia32_scattersiv16sf(of_packet, static_cast<unsigned short>(lane_bits(which)), at_, v, 4);
  }
  void add(Index16 which, int* of_packet, Index16 v) const {
    const Index16 sum = __builtin_ia32_gathersiv16si(Index16{}, of_packet, at_, -1, 4) + v;
    __builtin_ia32_scattersiv16si(of_packet, static_cast<unsigned short>(lane_bits(which)), at_, sum, 4);
  }
  // As bits of the packet.
  std::uint64_t in_packet(Index16 which) const {
    std::uint64_t bits = 0;
    for (unsigned left = lane_bits(which); left != 0; left &= left - 1)
      bits |= std::uint64_t{1} << at_[__builtin_ctz(left)];
    return bits;
  }

 private:
  Index16 at_{};
  unsigned taken_ = 0;
};

// The angle on the runs of sixteen rays.
template <Angle Rule>
struct AngleOnRuns {
  AngleSource<Rule, V16> source;
  void load(const Lanes&, Index16, const BlockRays&) {}
};
template <>
struct AngleOnRuns<Angle::Patched> {
  ShareOnRun<V16> run;
  AngleSource<Angle::Patched, V16> source{run};
  AngleOnRuns() = default;
  AngleOnRuns(const AngleOnRuns&) = delete;
  AngleOnRuns& operator=(const AngleOnRuns&) = delete;
  void load(const Lanes& at, Index16 which, const BlockRays& r) {
    at.load(which, r.begin, run.from);
    for (int i = 0; i <= SharePatch::degree; ++i) at.load(which, r.share[i], run.way.c[i]);
  }
};

template <Angle Rule>
class BlockSearch {
 public:
  BlockSearch(const BlockView& block, bool any_root, PacketMemory& memory)
      : block_(block), any_root_(any_root), memory_(memory) {
    static_assert(sizeof(typename Islands<Rule, V16>::Island[Islands<Rule, V16>::most]) <= PacketMemory::of_search);
    static_assert(sizeof(BlockRays) + sizeof(Runs<Rule, V16>[groups]) <= PacketMemory::of_rays);
    rays_ = reinterpret_cast<BlockRays*>(memory.rays);
    runs_ = reinterpret_cast<Runs<Rule, V16>*>(memory.rays + sizeof(BlockRays));
  }

  // As first_root() of each of these rays.
  void run(std::uint64_t open) {
    BlockRays& r = *rays_;
    r.enters_inside = r.hit = 0;
    for (int first = 0; first < packet_size; first += lanes) {
      store(all_lanes<V16>(infinity), r.undecided + first);
      store(V16{}, r.t + first);
      const Index16 none{};
      __builtin_memcpy(r.evaluations + first, &none, sizeof none);
    }
    open = leave_surfaces(open);
    start_runs(open);
    open &= next_runs(open);
    __builtin_memcpy(r.searched_from, r.begin, sizeof r.begin);
    while (open != 0) {
      const std::uint64_t met = decide_all(approach_all(open)) | surely_inside_;
      r.hit |= met;
      const std::uint64_t unknown = met & ~r.begins_outside;
      if (unknown != 0) find_sides(unknown);
      open &= ~met;
      open &= next_runs(open);
    }
  }

 private:
  static constexpr int groups = packet_size / lanes;

  static void store(V16 v, float* to) { __builtin_memcpy(to, &v, sizeof v); }
  void load_rays(const Lanes& at, Index16 which, Ray16& rays) const {
    for (int k = 0; k < 3; ++k) {
      at.load(which, rays_->origin[k], rays.origin[k]);
      at.load(which, rays_->direction[k], rays.direction[k]);
    }
  }

  // Those that wait, in free lanes.
  Index16 seat(Lanes& at, std::uint64_t& waiting, Ray16& rays, AngleOnRuns<Rule>& angle) const {
    const Index16 seated = at.seat(waiting);
    load_rays(at, seated, rays);
    angle.load(at, seated, *rays_);
    return seated;
  }

  // Returns the rays that are to go on.
  std::uint64_t leave_surfaces(std::uint64_t open) {
    BlockRays& r = *rays_;
    Ray16 rays{{}, {}, &memory_};
    for (std::uint64_t left = open & r.from_surface; left != 0;) {
      Lanes at;
      const Index16 here = at.seat(left);
      load_rays(at, here, rays);
      const QueryOf<V16> query{at.load(r.from), at.load(r.to), any_root_, false, here, Index16{}};
      RootOf<V16> root;
      V16 front = query.t0;
      const Index16 go_on = leave_surface<Rule>(block_, rays, query, here, root, front);
      at.store(here, r.from, front);
      at.store(here & root.hit, r.t, root.t);
      r.hit |= at.in_packet(root.hit);
      r.begins_outside |= at.in_packet(root.begins_outside);
      r.enters_inside |= at.in_packet(root.enters_inside);
      open &= ~at.in_packet(here & !go_on);
    }
    return open;
  }

  Ray16 rays_of_group(int group) const {
    Ray16 rays;
    for (int k = 0; k < 3; ++k) {
      rays.origin[k] = load(rays_->origin[k] + lanes * group);
      rays.direction[k] = load(rays_->direction[k] + lanes * group);
    }
    rays.memory = &memory_;
    return rays;
  }

  // Of runs that were found now; others keep theirs, as their patches do.
  void store_shares(Runs<Rule, V16>& runs, const Ray16& rays, V16 begin, int first) {
    const ShareOnRun<V16> share(runs.patches, rays, begin);
    for (int i = 0; i <= SharePatch::degree; ++i) store(share.way.c[i], rays_->share[i] + first);
  }

  void start_runs(std::uint64_t open) {
    const BlockRays& r = *rays_;
    for (int i = 0; i < groups; ++i) {
      if (!(open >> (lanes * i) & 0xffff)) continue;
      const Ray16 ray = rays_of_group(i);
      runs_[i] = Runs<Rule, V16>(block_, ray, load(r.from + lanes * i), load(r.to + lanes * i));
    }
  }

  // Returns the rays that have one.
  std::uint64_t next_runs(std::uint64_t open) {
    std::uint64_t found = 0;
    for (int i = 0; i < groups; ++i) {
      const auto of_group = static_cast<unsigned>(open >> (lanes * i) & 0xffff);
      if (of_group == 0) continue;
      Run<V16> run{load(rays_->begin + lanes * i), load(rays_->end + lanes * i)};
      found |= static_cast<std::uint64_t>(lane_bits(runs_[i].next(mask_of(of_group), run))) << (lanes * i);
      store(run.begin, rays_->begin + lanes * i);
      store(run.end, rays_->end + lanes * i);
      if constexpr (Rule == Angle::Patched) store_shares(runs_[i], rays_of_group(i), run.begin, lanes * i);
    }
    return found;
  }

  // Returns the rays whose runs the fine level has to decide.
  std::uint64_t approach_all(std::uint64_t waiting) {
    BlockRays& r = *rays_;
    std::uint64_t near = 0;
    surely_inside_ = 0;
    Ray16 rays{{}, {}, &memory_};
    AngleOnRuns<Rule> angle;
    Marcher<Rule, V16> march(block_, block_.coarse(), rays, angle.source);
    Search<Rule, V16> search(march, V16{}, V16{});
    Approach<Rule, V16> approach(search, any_root_);
    Lanes at;
    for (;;) {
      if (waiting != 0) {
        const Index16 seated = seat(at, waiting, rays, angle);
        const V16 begin = at.load(r.begin), end = at.load(r.end);
        search.restart(seated, begin, end);
        march.evaluations = select(seated, Index16{}, march.evaluations);
        approach.next = select(seated, 0.5F * (begin + end), approach.next);
        approach.near = approach.near & !seated;
        approach.surely_inside = approach.surely_inside & !seated;
      }
      const Index16 open = at.taken();
      if (!any(open)) return near;
      const Index16 ended = open & !approach.step(open);
      if (!any(ended)) continue;
      const Index16 now_near = ended & approach.near, inside = ended & approach.surely_inside;
      at.store(now_near, r.front, search.front);
      at.store(now_near, r.guess, min_of(max_of(approach.guess, search.front), search.end));
      at.store(inside, r.t, search.inside.t);
      at.add(ended, r.evaluations, march.evaluations);
      r.begins_outside |= at.in_packet(ended & search.have_last);
      near |= at.in_packet(now_near);
      surely_inside_ |= at.in_packet(inside);
      at.leave(ended);
    }
  }

  // Returns the rays that have met the surface.
  std::uint64_t decide_all(std::uint64_t waiting) {
    BlockRays& r = *rays_;
    std::uint64_t met = 0;
    if (waiting == 0) return met;
    Ray16 rays{{}, {}, &memory_};
    AngleOnRuns<Rule> angle;
    Marcher<Rule, V16> march(block_, block_.fine(), rays, angle.source);
    Search<Rule, V16> search(march, V16{}, V16{});
    Decision<Rule, V16> decision(search, V16{}, any_root_);
    Lanes at;
    for (;;) {
      if (waiting != 0) {
        const Index16 seated = seat(at, waiting, rays, angle);
        search.restart(seated, at.load(r.front), at.load(r.end));
        at.load(seated, r.guess, decision.guess);
        decision.samples = select(seated, Index16{}, decision.samples);
        decision.hit = decision.hit & !seated;
      }
      const Index16 open = at.taken();
      if (!any(open)) return met;
      const Index16 ended = open & !decision.step(open);
      if (!any(ended)) continue;
      const Index16 hit = ended & decision.hit;
      at.store(hit, r.t, decision.t);
      at.store(ended, r.undecided, min_of(at.load(r.undecided), decision.undecided()));
      at.add(ended, r.evaluations, decision.samples);
      r.begins_outside |= at.in_packet(ended & search.have_last);
      met |= at.in_packet(hit);
      at.leave(ended);
    }
  }

  // A ray that begins inside meets a root where it leaves.
  void find_sides(std::uint64_t asked) {
    BlockRays& r = *rays_;
    for (; asked != 0; asked &= asked - 1) {
      const int lane = __builtin_ctzll(asked);
      LocalRay ray;
      for (int k = 0; k < 3; ++k) {
        ray.origin[k] = r.origin[k][lane];
        ray.direction[k] = r.direction[k][lane];
      }
      AngleOf<Rule, float> angle;
      if constexpr (Rule == Angle::Patched) {
        angle.run.from = r.begin[lane];
        for (int i = 0; i <= SharePatch::degree; ++i) angle.run.way.c[i] = r.share[i][lane];
      }
      if (is_inside<Rule>(block_, ray, r.begin[lane], angle.source)) r.enters_inside |= std::uint64_t{1} << lane;
    }
  }

  const BlockView& block_;
  const bool any_root_;
  PacketMemory& memory_;
  BlockRays* rays_;
  Runs<Rule, V16>* runs_;  // of each sixteen
  std::uint64_t surely_inside_ = 0;
};
