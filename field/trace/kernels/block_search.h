// A packet of rays, each in its block: those that need the same go together, whatever their blocks, as many at a time
// as a register has lanes. Part of block_kernels_<set>.cpp.

// The angle on the runs of the rays in the lanes.
template <Angle Rule>
struct AngleOnRuns {
  AngleSource<Rule, PacketFloat> source;
  void load(const Lanes&, PacketInt, const BlockRays&) {}
};
template <>
struct AngleOnRuns<Angle::Patched> {
  ShareOnRun<PacketFloat> run;
  AngleSource<Angle::Patched, PacketFloat> source{run};
  AngleOnRuns() = default;
  AngleOnRuns(const AngleOnRuns&) = delete;
  AngleOnRuns& operator=(const AngleOnRuns&) = delete;
  void load(const Lanes& at, PacketInt which, const BlockRays& r) {
    at.load(which, r.begin, run.from);
    for (int i = 0; i <= SharePatch::degree; ++i) at.load(which, r.share[i], run.way.c[i]);
  }
};

template <Angle Rule>
class BlockSearch {
 public:
  BlockSearch(const CellRays* cells, int count, bool any_root, PacketMemory& memory)
      : cells_(cells), cell_count_(count), block_(*cells[0].block), any_root_(any_root), memory_(memory) {
    static_assert(sizeof(typename Islands<Rule, PacketFloat>::Island[Islands<Rule, PacketFloat>::most]) <=
                  PacketMemory::of_search);
    static_assert(sizeof(BlockRays) + sizeof(Own) <= PacketMemory::of_rays);
    rays_ = reinterpret_cast<BlockRays*>(memory.rays);
    own_ = reinterpret_cast<Own*>(memory.rays + sizeof(BlockRays));
    for (int i = 0; i < count; ++i) {
      own_->slots[i].known = 0;
      own_->level[i] = nullptr;
    }
  }

  // As first_root() of each of these rays.
  void run(std::uint64_t open) {
    BlockRays& r = *rays_;
    r.enters_inside = r.hit = 0;
    for (int first = 0; first < packet_size; first += packet_lanes) {
      store(all_lanes<PacketFloat>(infinity), r.undecided + first);
      store(PacketFloat{}, r.t + first);
      const PacketInt none{};
      __builtin_memcpy(r.evaluations + first, &none, sizeof none);
    }
    open &=
        ~in_levels<&BlockView::fine>(open & r.from_surface, [&](std::uint64_t rays) { return leave_surfaces(rays); });
    start_runs(open);
    open &= next_runs(open);
    __builtin_memcpy(r.searched_from, r.begin, sizeof r.begin);
    while (open != 0) {
      surely_inside_ = 0;
      const std::uint64_t near =
          in_levels<&BlockView::coarse>(open, [&](std::uint64_t rays) { return approach_all(rays); });
      const std::uint64_t met =
          surely_inside_ | in_levels<&BlockView::fine>(near, [&](std::uint64_t rays) { return decide_all(rays); });
      r.hit |= met;
      const std::uint64_t unknown = met & ~r.begins_outside;
      if (unknown != 0) find_sides(unknown);
      open &= ~met;
      open &= next_runs(open);
    }
  }

 private:
  static constexpr int groups = packet_size / packet_lanes;

  // What is kept of the rays beside BlockRays.
  struct Own {
    Runs<Rule, PacketFloat> runs[groups];  // of as many rays as there are lanes
    SlotWords slots[packet_size];          // of each cell
    const FieldLevel* level[packet_size];  // of each cell, in which its rays are searched now
  };

  static void store(PacketFloat v, float* to) { __builtin_memcpy(to, &v, sizeof v); }
  void load_rays(const Lanes& at, PacketInt which, PacketRays& rays) const {
    for (int k = 0; k < 3; ++k) {
      at.load(which, rays_->origin[k], rays.origin[k]);
      at.load(which, rays_->direction[k], rays.direction[k]);
    }
  }

  // search(rays), of as many of the rays at a time as have levels that stay good together; joins what it returns. Two
  // cells whose levels are not kept may be given the same memory for them, the later one last.
  template <const FieldLevel& (BlockView::*Make)() const, class Find>
  std::uint64_t in_levels(std::uint64_t rays, const Find& search) {
    std::uint64_t found = 0;
    while (rays != 0) {
      std::uint64_t ready = 0;
      for (int i = 0; i < cell_count_; ++i) {
        if (!(cells_[i].rays & rays)) continue;
        own_->level[i] = &(cells_[i].block->*Make)();
        for (int k = 0; k < i; ++k)
          if (own_->level[k] == own_->level[i]) ready &= ~cells_[k].rays;
        ready |= cells_[i].rays & rays;
      }
      found |= search(ready);
      rays &= ~ready;
    }
    return found;
  }

  const FieldLevel& level_of(int ray) const { return *own_->level[rays_->cell[ray]]; }
  const FieldLevel& any_level(std::uint64_t rays) const { return level_of(__builtin_ctzll(rays)); }

  // Those that wait, in free lanes.
  PacketInt seat(Lanes& at, std::uint64_t& waiting, PacketRays& rays, LevelOf<PacketFloat>& level) const {
    const PacketInt seated = at.seat(waiting);
    load_rays(at, seated, rays);
    at.for_each(seated, [&](int lane, int ray) { level.set(lane, level_of(ray), rays_->cell[ray]); });
    return seated;
  }

  void load_around(const Lanes& at, PacketInt which, AroundOf<PacketFloat>& to) const {
    V16 rows[packet_lanes] = {};
    alignas(64) float place[3][packet_lanes] = {};
    unsigned known = 0;
    at.for_each(which, [&](int lane, int ray) {
      const FieldAround* const around = rays_->around[ray];
      if (around == nullptr || around->block != cells_[rays_->cell[ray]].block->owner) return;
      known |= 1U << lane;
      __builtin_memcpy(&rows[lane], &around->field, sizeof rows[lane]);
      for (int k = 0; k < 3; ++k) place[k][lane] = around->place[k];
    });
    to.known = mask_of(known);
    if (known == 0) return;
    PacketFloat columns[around_numbers];
    find_columns(rows, columns);
    set_numbers(columns, to);
    for (int k = 0; k < 3; ++k) to.place[k] = load_native(place[k]);
  }

  // Returns the rays that end here.
  std::uint64_t leave_surfaces(std::uint64_t leaving) {
    BlockRays& r = *rays_;
    std::uint64_t ended = 0;
    PacketRays rays{{}, {}, &memory_};
    LevelOf<PacketFloat> level(any_level(leaving));
    while (leaving != 0) {
      Lanes at;
      const PacketInt here = seat(at, leaving, rays, level);
      const QueryOf<PacketFloat> query{at.load(r.from), at.load(r.to), any_root_, false, here, PacketInt{}};
      RootOf<PacketFloat> root;
      PacketFloat front = query.t0;
      AroundOf<PacketFloat> around;
      load_around(at, here, around);
      const PacketInt go_on = leave_surface<Rule>(block_, BlocksOf<PacketFloat>{cells_, at.load(r.cell)}, level, rays,
                                                  around, query, here, root, front);
      at.store(here, r.from, front);
      at.store(here & root.hit, r.t, root.t);
      r.hit |= at.in_packet(root.hit);
      r.begins_outside |= at.in_packet(root.begins_outside);
      r.enters_inside |= at.in_packet(root.enters_inside);
      ended |= at.in_packet(here & !go_on);
    }
    return ended;
  }

  PacketRays rays_of_group(int group) const {
    PacketRays rays;
    for (int k = 0; k < 3; ++k) {
      rays.origin[k] = load_native(rays_->origin[k] + packet_lanes * group);
      rays.direction[k] = load_native(rays_->direction[k] + packet_lanes * group);
    }
    rays.memory = &memory_;
    return rays;
  }

  // Of runs that were found now; others keep theirs, as their patches do.
  void store_shares(Runs<Rule, PacketFloat>& runs, const PacketRays& rays, PacketFloat begin, int first) {
    const ShareOnRun<PacketFloat> share(runs.patches, rays, begin);
    for (int i = 0; i <= SharePatch::degree; ++i) store(share.way.c[i], rays_->share[i] + first);
  }

  void start_runs(std::uint64_t open) {
    const BlockRays& r = *rays_;
    for (int i = 0; i < groups; ++i) {
      if (!(open >> (packet_lanes * i) & all_lane_bits)) continue;
      const PacketRays ray = rays_of_group(i);
      PacketInt cell;
      __builtin_memcpy(&cell, r.cell + packet_lanes * i, sizeof cell);
      const BlocksOf<PacketFloat> blocks{cells_, cell};
      own_->runs[i] =
          Runs<Rule, PacketFloat>(blocks, SlotBits<PacketFloat>(blocks, own_->slots), ray,
                                  load_native(r.from + packet_lanes * i), load_native(r.to + packet_lanes * i));
    }
  }

  // Returns the rays that have one.
  std::uint64_t next_runs(std::uint64_t open) {
    std::uint64_t found = 0;
    for (int i = 0; i < groups; ++i) {
      const auto of_group = static_cast<unsigned>(open >> (packet_lanes * i) & all_lane_bits);
      if (of_group == 0) continue;
      Run<PacketFloat> run{load_native(rays_->begin + packet_lanes * i), load_native(rays_->end + packet_lanes * i)};
      found |= static_cast<std::uint64_t>(lane_bits(own_->runs[i].next(mask_of(of_group), run))) << (packet_lanes * i);
      store(run.begin, rays_->begin + packet_lanes * i);
      store(run.end, rays_->end + packet_lanes * i);
      if constexpr (Rule == Angle::Patched) store_shares(own_->runs[i], rays_of_group(i), run.begin, packet_lanes * i);
    }
    return found;
  }

  // Returns the rays whose runs the fine level has to decide.
  std::uint64_t approach_all(std::uint64_t waiting) {
    BlockRays& r = *rays_;
    std::uint64_t near = 0;
    PacketRays rays{{}, {}, &memory_};
    LevelOf<PacketFloat> level(any_level(waiting));
    AngleOnRuns<Rule> angle;
    Marcher<Rule, PacketFloat> march(block_, level, rays, angle.source);
    Search<Rule, PacketFloat> search(march, PacketFloat{}, PacketFloat{});
    Approach<Rule, PacketFloat> approach(search, any_root_);
    Lanes at;
    for (;;) {
      if (waiting != 0) {
        const PacketInt seated = seat(at, waiting, rays, level);
        angle.load(at, seated, r);
        const PacketFloat begin = at.load(r.begin), end = at.load(r.end);
        search.restart(seated, begin, end);
        march.evaluations = select(seated, PacketInt{}, march.evaluations);
        approach.next = select(seated, 0.5F * (begin + end), approach.next);
        approach.near = approach.near & !seated;
        approach.surely_inside = approach.surely_inside & !seated;
      }
      const PacketInt open = at.taken();
      if (!any(open)) return near;
      const PacketInt ended = open & !approach.step(open);
      if (!any(ended)) continue;
      const PacketInt now_near = ended & approach.near, inside = ended & approach.surely_inside;
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
    PacketRays rays{{}, {}, &memory_};
    LevelOf<PacketFloat> level(any_level(waiting));
    AngleOnRuns<Rule> angle;
    Marcher<Rule, PacketFloat> march(block_, level, rays, angle.source);
    Search<Rule, PacketFloat> search(march, PacketFloat{}, PacketFloat{});
    Decision<Rule, PacketFloat> decision(search, PacketFloat{}, any_root_);
    Lanes at;
    for (;;) {
      if (waiting != 0) {
        const PacketInt seated = seat(at, waiting, rays, level);
        angle.load(at, seated, r);
        search.restart(seated, at.load(r.front), at.load(r.end));
        at.load(seated, r.guess, decision.guess);
        decision.samples = select(seated, PacketInt{}, decision.samples);
        decision.hit = decision.hit & !seated;
      }
      const PacketInt open = at.taken();
      if (!any(open)) return met;
      const PacketInt ended = open & !decision.step(open);
      if (!any(ended)) continue;
      const PacketInt hit = ended & decision.hit;
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
      const BlockView& block = *cells_[r.cell[lane]].block;
      if (is_inside<Rule>(block, ray, r.begin[lane], angle.source)) r.enters_inside |= std::uint64_t{1} << lane;
    }
  }

  const CellRays* cells_;
  const int cell_count_;
  const BlockView& block_;  // of the first cell
  const bool any_root_;
  PacketMemory& memory_;
  BlockRays* rays_;
  Own* own_;
  std::uint64_t surely_inside_ = 0;
};
