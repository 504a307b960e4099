// The first root in a block: stretch by stretch along the ray. Part of block_kernels_<set>.cpp.

// As BlockKernels::Query.
template <class F>
struct QueryOf {
  F t0, t1;
  bool any, leaving;
  MaskOf<F> from_surface, from_outside;
};

// What gives the angle on a stretch of a ray.
template <Angle Rule, class F>
struct AngleOf {
  AngleSource<Rule, F> source;
  F end = all_lanes<F>(infinity);  // up to where

  // To find where the surface may be on a run: all that it may be there.
  explicit AngleOf(const Run<F>&) {}
  // From t on, of the field that is traced.
  AngleOf(const BlocksOf<F>&, const RayOf<F>&, F, MaskOf<F>) {}
};
template <class F>
struct AngleOf<Angle::Patched, F> {
  ShareOnRun<F> share;
  F end = all_lanes<F>(infinity);
  AngleSource<Angle::Patched, F> source{share};

  explicit AngleOf(const Run<F>& run) : share(run.share) {}
  AngleOf(const BlocksOf<F>& blocks, const RayOf<F>& ray, F t, MaskOf<F> rays) {
    const ShareInPatch<F> here(blocks, ray, t, rays);
    share = here.share;
    end = here.end;
  }
  AngleOf(const AngleOf&) = delete;
  AngleOf& operator=(const AngleOf&) = delete;
};

// Until it ends.
template <Angle Rule>
inline RootOf<float> decide(Search<Rule>& search, float guess, bool any_root) {
  Decision<Rule> decision(search, guess, any_root);
  while (decision.step(true)) {}
  RootOf<float> root;
  root.t = decision.t;
  root.hit = decision.hit;
  root.undecided = decision.undecided();
  return root;
}

// The coarse level finds where to look, the fine level decides. Where patches give the angle that is as far as a patch
// goes: then run.begin is where to go on.
template <Angle Rule>
inline RootOf<float> root_in(const BlockView& block, const LocalRay& ray, Run<float>& run, bool any_root) {
  RootOf<float> root;
  const LevelOf<float> coarse(block.coarse());
  const AngleOf<Rule, float> any_angle(run);
  Marcher<Rule> march(block, coarse, ray, any_angle.source);
  Search<Rule> search(march, run.begin, run.end);
  Approach<Rule> approach(search, any_root);
  while (approach.step(true)) {}
  run.begin = run.end;
  if (approach.near) {
    const AngleOf<Rule, float> angle(BlocksOf<float>{&block}, ray, search.front, true);
    run.begin = min_of(angle.end, run.end);
    const LevelOf<float> exact(block.fine());
    Marcher<Rule> fine(block, exact, ray, angle.source);
    Search<Rule> close(fine, search.front, run.begin);
    root = decide(close, min_of(max_of(approach.guess, search.front), run.begin), any_root);
    root.evaluations = fine.evaluations;
    root.begins_outside = close.have_last;
  } else if (approach.surely_inside) {
    root.hit = true;
    root.t = search.inside.t;
  }
  root.evaluations += march.evaluations;
  root.begins_outside |= search.have_last;
  return root;
}

// An estimate of the root, in a gap that is too short to decide, by Newton's method from there. A ray that leaves a
// body comes to the root from where several skeletons bend the scaled field, or across the kink of the curve, and
// estimates from where a certificate began were off by up to the whole gap.
template <Angle Rule>
inline float polished(Marcher<Rule>& march, const Search<Rule>& search, float root) {
  constexpr int most_steps = 3;
  constexpr float settled = 1e-7F;  // of the distance: as floats tell places
  for (int k = 0; k < most_steps; ++k) {
    const SampleOf<Rule> p = march.sample(root, true);
    const float step = p.newton_step();
    if (!(p.scaled_slope < 0) || !(abs_of(step) <= shortest_gap * p.distance)) break;
    root = max_of(search.front, root + step);
    if (abs_of(step) < settled * p.distance) break;
  }
  return root;
}

// Where a ray leaves that is inside at t0. What lies behind the run takes the ray to be outside already where it leaves
// at the very end: the search goes a few of the shortest gaps beyond it.
template <Angle Rule>
inline RootOf<float> exit_in(const BlockView& block, const LocalRay& ray, Run<float>& run) {
  constexpr float gaps_beyond = 4;
  const LevelOf<float> fine(block.fine());
  const AngleOf<Rule, float> angle(BlocksOf<float>{&block}, ray, run.begin, true);
  Marcher<Rule> march(block, fine, ray, angle.source);
  march.exits = true;
  const SampleOf<Rule> first = march.sample(run.begin, true);
  const float end = min_of(angle.end, run.end), distance_at_end = first.distance + (end - run.begin);
  Search<Rule> search(march, run.begin, end + gaps_beyond * shortest_gap * distance_at_end);
  run.begin = end;
  search.record(true, first);
  RootOf<float> root;
  if (!search.missed()) root = decide(search, search.guess(), false);
  if (root.hit) root.t = polished(march, search, root.t);
  root.evaluations = march.evaluations;
  return root;
}

// Nearer to 1 than this neighbouring blocks may differ about the side, as sums are off by up to 5e-6. What is taken to
// be outside for it is then no more than 1e-5 deep.
inline constexpr float clearly_inside = 5e-6F;

// Where the field rises along the ray by this much of what it would towards a source, a ray that begins on the surface,
// as summed on its inner side, is on its way in: all that comes behind will find it inside. A crossing that has just
// been left behind is not met again.
inline constexpr float surely_rising = 0.01F;
template <Angle Rule, class F>
inline MaskOf<F> goes_in(const SampleOf<Rule, F>& begin) {
  return (begin.nominal < 0.0F) & (begin.scaled_slope * begin.distance < -surely_rising);
}

// Whether the ray is inside at t, where a run begins, by the coarse level where that can tell. Where it is hardly so
// the exact field tells how the ray began.
template <Angle Rule>
inline bool is_inside(const BlockView& block, const LocalRay& ray, float t) {
  const AngleOf<Rule, float> angle(BlocksOf<float>{&block}, ray, t, true);
  const LevelOf<float> coarse(block.coarse());
  Marcher<Rule> rough(block, coarse, ray, angle.source);
  const SampleOf<Rule> p = rough.sample(t, true);
  if (p.residual > 0) return false;
  if (p.nominal < 0 && rough.inside_at(p, 0)) return true;
  const LevelOf<float> fine(block.fine());
  Marcher<Rule> march(block, fine, ray, angle.source);
  return march.sample(t, true).nominal < 0;
}

// A ray that begins at a surface is too near for the coarse level: one fine certificate leads away. Returns the rays
// that are to go on from `front`; those that end here have a hit, or nothing.
template <Angle Rule, class F>
inline MaskOf<F> leave_surface(const BlockView& block, const BlocksOf<F>& blocks, const LevelOf<F>& fine,
                               const RayOf<F>& ray, const AroundOf<F>& around, const QueryOf<F>& query, MaskOf<F> rays,
                               RootOf<F>& root, F& front) {
  using Mask = MaskOf<F>;
  const AngleOf<Rule, F> angle(blocks, ray, query.t0, rays);
  const F end = min_of(query.t1, angle.end);
  Marcher<Rule, F> march(block, fine, ray, angle.source);
  Mask departed{};
  if constexpr (Rule != Angle::Mean) departed = depart(march, ray, around, query.t0, end, rays, front);
  root.begins_outside = root.begins_outside | departed;
  const Mask away = departed & !(front >= query.t1);
  rays = rays & !departed;
  if (!any(rays)) return away;
  Search<Rule, F> start(march, query.t0, end);
  const SampleOf<Rule, F> first = march.sample(query.t0, rays);
  const Mask inside = rays & ((first.nominal < -clearly_inside) | goes_in(first)), outside = rays & !inside;
  root.hit = inside;
  root.enters_inside = inside;
  root.t = select(inside, query.t0, root.t);
  root.begins_outside = root.begins_outside | outside;
  start.record(outside, first);
  assign(outside, front, start.front);
  return away | (outside & !(start.front >= query.t1));
}

template <Angle Rule>
inline RootOf<float> first_root_of(const BlockView& block, const LocalRay& ray, const FieldAround* known_around,
                                   const QueryOf<float>& query) {
  RootOf<float> root;
  root.begins_outside = query.from_outside;
  float front = query.t0;
  if (!query.leaving && query.from_surface) {
    const LevelOf<float> fine(block.fine());
    const AroundOf<float> around = around_in(block, known_around);
    if (!leave_surface<Rule>(block, BlocksOf<float>{&block}, fine, ray, around, query, true, root, front)) return root;
  }
  const BlocksOf<float> itself{&block};
  Runs<Rule, float> runs(itself, SlotBits<float>(itself), Eighths<float>(itself), ray, front, query.t1);
  Run<float> run;
  while (!root.hit && (run.begin < run.end || runs.next(ray, true, run))) {
    const float begin = run.begin;
    const RootOf<float> found =
        query.leaving ? exit_in<Rule>(block, ray, run) : root_in<Rule>(block, ray, run, query.any);
    root.hit = found.hit;
    if (found.hit) root.t = found.t;
    root.undecided = min_of(root.undecided, found.undecided);
    if (root.evaluations == 0) root.searched_from = begin;
    root.evaluations += found.evaluations;
    root.begins_outside |= found.begins_outside;
    if (found.hit && !root.begins_outside && !query.leaving) root.enters_inside = is_inside<Rule>(block, ray, begin);
  }
  return root;
}

template <Angle Rule>
inline Root single_root(const BlockView& block, const LocalRay& ray, const BlockKernels::Query& q) {
  const QueryOf<float> query{q.t0, q.t1, q.any, q.leaving, q.from_surface, q.from_outside};
  const RootOf<float> root = first_root_of<Rule>(block, ray, q.around, query);
  return {
      root.t, root.hit, root.undecided, root.evaluations, root.searched_from, root.begins_outside, root.enters_inside};
}

Root first_root(const BlockView& block, const LocalRay& ray, const BlockKernels::Query& query) {
  if (block.parts != nullptr) return single_root<Angle::Patched>(block, ray, query);
  if (block.tables.count > 0) return single_root<Angle::Mean>(block, ray, query);
  return single_root<Angle::One>(block, ray, query);
}
