// A packet of rays, each in its block: those that need the same go together, whatever their blocks, as many at a time
// as a register has lanes. Part of block_kernels_<set>.cpp.

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
      own_->slots[i].take_known(*cells[i].block);
      if constexpr (Rule == Angle::Patched) ask_for_eight(cells[i].block->parts);
    }
  }

  // As first_root() of each of these rays.
  void run(LaneSet open) {
    BlockRays& r = *rays_;
    r.enters_inside = r.hit = {};
    open.for_each_group<packet_lanes>([&](int first) {
      store(all_lanes<PacketFloat>(infinity), r.undecided + first);
      store(PacketFloat{}, r.t + first);
      const PacketInt none{};
      __builtin_memcpy(r.evaluations + first, &none, sizeof none);
    });
    const LaneSet asked = open;
    go_apart_ = asked.count() < few_in_a_cell * cell_count_;
    open &=
        ~in_levels<&BlockView::fine>(open & r.from_surface, [&](const LaneSet& rays) { return leave_surfaces(rays); });
    start_runs(open);
    open = next_runs(open);
    asked.for_each_group<packet_lanes>(
        [&](int first) { store(load_native(r.begin + first), r.searched_from + first); });
    while (!open.empty()) {
      surely_inside_ = {};
      const LaneSet near = in_levels<&BlockView::coarse>(open, [&](const LaneSet& rays) { return approach_all(rays); });
      if constexpr (Rule == Angle::Patched) find_shares(cells_, near, r);
      const LaneSet met =
          surely_inside_ | in_levels<&BlockView::fine>(near, [&](const LaneSet& rays) { return decide_all(rays); });
      r.hit |= met;
      find_sides(met & ~r.begins_outside);
      open &= ~met;
      LaneSet in_next_patch;
      if constexpr (Rule == Angle::Patched) in_next_patch = go_on_behind_patches(near & open, r);
      open = in_next_patch | next_runs(open & ~in_next_patch);
    }
  }

 private:
  static constexpr int groups = packet_size / packet_lanes;
  static constexpr int few_in_a_cell = 4;  // where there are more, what rays need has just been used by others

  // Of as many rays as there are lanes; made in place.
  struct RunsOfGroup : Runs<Rule, PacketFloat> {
    using Runs<Rule, PacketFloat>::Runs;
    static void* operator new(std::size_t, void* place) noexcept { return place; }
  };

  // What is kept of the rays beside BlockRays.
  struct Own {
    RunsOfGroup runs[groups];
    SlotWords slots[packet_size];  // of each cell
    PacketLevels levels;
  };

  static void store(PacketFloat v, float* to) { __builtin_memcpy(to, &v, sizeof v); }

  // search(rays), of as many of the rays at a time as have levels that stay good together; joins what it returns.
  template <const FieldLevel& (BlockView::*Make)() const, class Find>
  LaneSet in_levels(LaneSet rays, const Find& search) {
    LaneSet found;
    while (!rays.empty()) {
      const LaneSet ready = own_->levels.template make<Make>(cells_, rays_->cell, rays);
      found |= search(ready);
      rays &= ~ready;
    }
    return found;
  }

  const FieldLevel& level_of(int ray) const { return own_->levels[rays_->cell[ray]]; }
  const FieldLevel& any_level(const LaneSet& rays) const { return level_of(rays.lowest()); }

  // Those that wait, in free lanes.
  PacketMask seat(Lanes& at, LaneSet& waiting, PacketRays& rays, LevelOf<PacketFloat>& level) const {
    const PacketMask seated = at.seat(waiting);
    load_rays(*rays_, at, seated, rays);
    at.for_each(seated, [&](int lane, int ray) { level.set(lane, level_of(ray), rays_->cell[ray]); });
    return seated;
  }

  void load_around(const Lanes& at, PacketMask which, AroundOf<PacketFloat>& to) const {
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
    to.known = PacketMask(known);
    if (known == 0) return;
    PacketFloat columns[around_numbers];
    find_columns(rows, columns);
    set_numbers(columns, to);
    for (int k = 0; k < 3; ++k) to.place[k] = load_native(place[k]);
  }

  // Returns the rays that end here.
  LaneSet leave_surfaces(LaneSet leaving) {
    BlockRays& r = *rays_;
    LaneSet ended;
    PacketRays rays{{}, {}, &memory_};
    LevelOf<PacketFloat> level(any_level(leaving));
    while (!leaving.empty()) {
      Lanes at;
      const PacketMask here = seat(at, leaving, rays, level);
      const QueryOf<PacketFloat> query{at.load(r.from), at.load(r.to), any_root_, false, here, PacketMask{}};
      RootOf<PacketFloat> root;
      PacketFloat front = query.t0;
      AroundOf<PacketFloat> around;
      load_around(at, here, around);
      const PacketMask go_on = leave_surface<Rule>(block_, BlocksOf<PacketFloat>{cells_, at.load(r.cell)}, level, rays,
                                                   around, query, here, root, front);
      at.store(here, r.from, front);
      at.store(here & root.hit, r.t, root.t);
      at.add_to(r.hit, root.hit);
      at.add_to(r.begins_outside, root.begins_outside);
      at.add_to(r.enters_inside, root.enters_inside);
      at.add_to(ended, here & !go_on);
    }
    return ended;
  }

  PacketRays rays_of_group(int first) const {
    PacketRays rays;
    for (int k = 0; k < 3; ++k) {
      rays.origin[k] = load_native(rays_->origin[k] + first);
      rays.direction[k] = load_native(rays_->direction[k] + first);
    }
    rays.memory = &memory_;
    return rays;
  }

  ShareLine<PacketFloat> line_of_group(int first) const {
    const auto number = [&](int k) { return load_native(rays_->line[k] + first); };
    return {number(0), number(1), number(2), number(3)};
  }

  void start_runs(const LaneSet& open) {
    const BlockRays& r = *rays_;
    open.for_each_group<packet_lanes>([&](int first) {
      const PacketRays ray = rays_of_group(first);
      const BlocksOf<PacketFloat> blocks{cells_, load_native(r.cell + first)};
      const PacketMask rays(open.group<packet_lanes>(first));
      const SlotBits<PacketFloat> slots(blocks, own_->slots, rays);
      const Eighths<PacketFloat> eighths(blocks, rays);
      new (&own_->runs[first / packet_lanes])
          RunsOfGroup(blocks, slots, eighths, ray, load_native(r.from + first), load_native(r.to + first));
    });
  }

  // Returns the rays that have one.
  LaneSet next_runs(const LaneSet& open) {
    LaneSet found;
    open.for_each_group<packet_lanes>([&](int first) {
      const PacketMask asked = PacketMask(open.group<packet_lanes>(first));
      Run<PacketFloat> run{load_native(rays_->begin + first), load_native(rays_->end + first)};
      if constexpr (Rule == Angle::Patched) run.share = line_of_group(first);
      found.add_group(first, own_->runs[first / packet_lanes].next(rays_of_group(first), asked, run).bits());
      store(run.begin, rays_->begin + first);
      store(run.end, rays_->end + first);
      if constexpr (Rule == Angle::Patched) {
        const PacketFloat line[4] = {run.share.at, run.share.slope, run.share.low, run.share.high};
        for (int k = 0; k < 4; ++k) store(line[k], rays_->line[k] + first);
      }
    });
    return found;
  }

  // Returns the rays whose runs the fine level has to decide.
  LaneSet approach_all(LaneSet waiting) {
    BlockRays& r = *rays_;
    LaneSet near;
    PacketRays rays{{}, {}, &memory_};
    LevelOf<PacketFloat> level(any_level(waiting));
    AngleOnRuns<Rule> angle;
    Marcher<Rule, PacketFloat> march(block_, level, rays, angle.source);
    Search<Rule, PacketFloat> search(march, PacketFloat{}, PacketFloat{});
    Approach<Rule, PacketFloat> approach(search, any_root_);
    Lanes at;
    RaysAhead ahead(go_apart_ ? waiting : LaneSet{}, [&](int ray) { return &level_of(ray); });
    for (;;) {
      if (!waiting.empty()) {
        const PacketMask seated = seat(at, waiting, rays, level);
        ahead.ask(__builtin_popcount(seated.bits()));
        angle.load_run(at, seated, r);
        const PacketFloat begin = at.load(r.begin), end = at.load(r.end);
        search.restart(seated, begin, end);
        march.evaluations = select(seated, PacketInt{}, march.evaluations);
        approach.next = select(seated, 0.5F * (begin + end), approach.next);
        approach.near = approach.near & !seated;
        approach.surely_inside = approach.surely_inside & !seated;
      }
      const PacketMask open = at.taken();
      if (!any(open)) return near;
      const PacketMask ended = open & !approach.step(open);
      if (!any(ended)) continue;
      const PacketMask now_near = ended & approach.near, inside = ended & approach.surely_inside;
      at.store(now_near, r.front, search.front);
      at.store(now_near, r.guess, approach.guess);
      at.store(inside, r.t, search.inside.t);
      at.add(ended, r.evaluations, march.evaluations);
      at.add_to(r.begins_outside, ended & search.have_last);
      at.add_to(near, now_near);
      at.add_to(surely_inside_, inside);
      at.leave(ended);
    }
  }

  // Returns the rays that have met the surface.
  LaneSet decide_all(LaneSet waiting) {
    BlockRays& r = *rays_;
    LaneSet met;
    PacketRays rays{{}, {}, &memory_};
    LevelOf<PacketFloat> level(any_level(waiting));
    AngleOnRuns<Rule> angle;
    Marcher<Rule, PacketFloat> march(block_, level, rays, angle.source);
    Search<Rule, PacketFloat> search(march, PacketFloat{}, PacketFloat{});
    Decision<Rule, PacketFloat> decision(search, PacketFloat{}, any_root_);
    Lanes at;
    RaysAhead ahead(go_apart_ ? waiting : LaneSet{}, [&](int ray) { return &level_of(ray); });
    for (;;) {
      if (!waiting.empty()) {
        const PacketMask seated = seat(at, waiting, rays, level);
        ahead.ask(__builtin_popcount(seated.bits()));
        angle.load_share(at, seated, r);
        const PacketFloat front = at.load(r.front), end = at.load(Rule == Angle::Patched ? r.fine_end : r.end);
        search.restart(seated, front, end);
        decision.guess = select(seated, min_of(max_of(at.load(r.guess), front), end), decision.guess);
        decision.samples = select(seated, PacketInt{}, decision.samples);
        decision.hit = decision.hit & !seated;
      }
      const PacketMask open = at.taken();
      if (!any(open)) return met;
      const PacketMask ended = open & !decision.step(open);
      if (!any(ended)) continue;
      const PacketMask hit = ended & decision.hit;
      at.store(hit, r.t, decision.t);
      at.store(ended, r.undecided, min_of(at.load(r.undecided), decision.undecided()));
      at.add(ended, r.evaluations, decision.samples);
      at.add_to(r.begins_outside, ended & search.have_last);
      at.add_to(met, hit);
      at.leave(ended);
    }
  }

  // A ray that begins inside meets a root where it leaves.
  void find_sides(const LaneSet& asked) {
    BlockRays& r = *rays_;
    asked.for_each([&](int lane) {
      LocalRay ray;
      for (int k = 0; k < 3; ++k) {
        ray.origin[k] = r.origin[k][lane];
        ray.direction[k] = r.direction[k][lane];
      }
      const BlockView& block = *cells_[r.cell[lane]].block;
      if (is_inside<Rule>(block, ray, r.begin[lane])) r.enters_inside.add(lane);
    });
  }

  const CellRays* cells_;
  const int cell_count_;
  const BlockView& block_;  // of the first cell
  const bool any_root_;
  PacketMemory& memory_;
  BlockRays* rays_;
  Own* own_;
  LaneSet surely_inside_;
  bool go_apart_ = false;  // few rays share a cell: memory has to be asked ahead
};
