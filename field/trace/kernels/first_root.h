// The first root in a block: stretch by stretch along the ray. Part of block_kernels_<set>.cpp.

// As BlockKernels::Query.
template <class F>
struct QueryOf {
  F t0, t1;
  bool any, leaving;
  MaskOf<F> from_surface, from_outside;
};

// The coarse level finds where to look, the fine level decides.
template <bool Varied, class F>
inline RootOf<F> root_in(const BlockView& block, const RayOf<F>& ray, const Run<F>& run, bool any_root,
                         MaskOf<F> rays) {
  RootOf<F> root;
  Marcher<Varied, F> march(block, block.coarse(), ray);
  Search<Varied, F> search(march, run.begin, run.end);
  const Approach<F> approached = approach(search, any_root, rays);
  if (any(approached.near)) {
    Marcher<Varied, F> fine(block, block.fine(), ray);
    Search<Varied, F> close(fine, search.front, run.end);
    root = decide(close, min_of(max_of(approached.guess, search.front), run.end), any_root, approached.near);
    root.evaluations = fine.evaluations;
    root.begins_outside = close.have_last;
  }
  root.hit = root.hit | approached.surely_inside;
  root.t = select(approached.surely_inside, search.inside.t, root.t);
  root.evaluations = root.evaluations + march.evaluations;
  root.begins_outside = root.begins_outside | search.have_last;
  return root;
}

// Where a ray leaves that is inside at t0.
template <bool Varied>
inline RootOf<float> exit_in(const BlockView& block, const LocalRay& ray, const Run<float>& run, bool any_root) {
  Marcher<Varied> march(block, block.fine(), ray);
  march.exits = true;
  Search<Varied> search(march, run.begin, run.end);
  search.record(true, march.sample(run.begin, true));
  RootOf<float> root;
  if (!search.missed()) root = decide(search, search.guess(), any_root, true);
  root.evaluations = march.evaluations;
  return root;
}

// Nearer to 1 than this, neighbouring blocks may differ about the side.
inline constexpr float clearly_inside = 2e-5F;

// Whether the ray is inside at t, by the coarse level where that can tell.
template <bool Varied>
inline bool is_inside(const BlockView& block, const LocalRay& ray, float t, int& evaluations) {
  Marcher<Varied> rough(block, block.coarse(), ray);
  const SampleOf<Varied> p = rough.sample(t, true);
  ++evaluations;
  if (p.residual > 0) return false;
  if (p.nominal < -clearly_inside && rough.inside_at(p, 0)) return true;
  Marcher<Varied> march(block, block.fine(), ray);
  ++evaluations;
  return march.sample(t, true).nominal < -clearly_inside;
}

inline void find_sides(bool, const BlockView& block, const LocalRay& ray, float t, bool varied, RootOf<float>& root) {
  root.enters_inside =
      varied ? is_inside<true>(block, ray, t, root.evaluations) : is_inside<false>(block, ray, t, root.evaluations);
}

inline LocalRay ray_of_lane(const Ray16& rays, int lane) {
  LocalRay ray;
  for (int k = 0; k < 3; ++k) {
    ray.origin[k] = rays.origin[k][lane];
    ray.direction[k] = rays.direction[k][lane];
  }
  return ray;
}

inline void find_sides(Index16 asked, const BlockView& block, const Ray16& rays, V16 t, bool, RootOf<V16>& root) {
  for (unsigned left = lane_bits(asked); left != 0; left &= left - 1) {
    const int lane = __builtin_ctz(left);
    int evaluations = 0;
    root.enters_inside[lane] = is_inside<false>(block, ray_of_lane(rays, lane), t[lane], evaluations) ? -1 : 0;
    root.evaluations[lane] += evaluations;
  }
}

// A ray that begins at a surface is too near for the coarse level: one fine certificate leads away. Returns the rays
// that are to go on from `front`.
template <bool Varied, class F>
inline MaskOf<F> leave_surface(const BlockView& block, const RayOf<F>& ray, const QueryOf<F>& query, MaskOf<F> rays,
                               RootOf<F>& root, F& front) {
  using Mask = MaskOf<F>;
  Marcher<Varied, F> march(block, block.fine(), ray);
  Search<Varied, F> start(march, query.t0, query.t1);
  const SampleOf<Varied, F> first = march.sample(query.t0, rays);
  root.evaluations = march.evaluations;
  const Mask inside = rays & (first.nominal < -clearly_inside), outside = rays & !inside;
  root.hit = inside;
  if (!query.any) root.enters_inside = inside;
  root.t = select(inside, query.t0, root.t);
  root.begins_outside = root.begins_outside | outside;
  start.record(outside, first);
  assign(outside, front, start.front);
  return outside & !start.missed();
}

template <bool Varied, class F>
inline RootOf<F> first_root_of(const BlockView& block, const RayOf<F>& ray, const QueryOf<F>& query, MaskOf<F> open) {
  using Mask = MaskOf<F>;
  RootOf<F> root;
  root.begins_outside = open & query.from_outside;
  F front = query.t0;
  if (const Mask starts = open & query.from_surface; !query.leaving && any(starts)) {
    const Mask go_on = leave_surface<Varied>(block, ray, query, starts, root, front);
    open = open & (go_on | !starts);
  }
  Runs<F> runs(block, ray, front, query.t1);
  Run<F> run;
  while (any(open)) {
    open = open & runs.next(open, run);
    if (!any(open)) break;
    RootOf<F> found;
    if constexpr (sizeof(F) == sizeof(float))
      found = query.leaving ? exit_in<Varied>(block, ray, run, query.any)
                            : root_in<Varied, F>(block, ray, run, query.any, open);
    else found = root_in<Varied, F>(block, ray, run, query.any, open);
    const Mask hit = open & found.hit;
    root.hit = root.hit | hit;
    root.t = select(hit, found.t, root.t);
    root.undecided = select(open, min_of(root.undecided, found.undecided), root.undecided);
    root.evaluations = root.evaluations + found.evaluations;
    root.begins_outside = root.begins_outside | (open & found.begins_outside);
    // Any root will do: a ray that begins inside meets one where it leaves.
    const Mask unknown = hit & !root.begins_outside;
    if (!query.leaving && !query.any && any(unknown)) find_sides(unknown, block, ray, run.begin, Varied, root);
    open = open & !hit;
  }
  return root;
}

template <bool Varied>
inline Root single_root(const BlockView& block, const LocalRay& ray, const BlockKernels::Query& q) {
  const QueryOf<float> query{q.t0, q.t1, q.any, q.leaving, q.from_surface, q.from_outside};
  const RootOf<float> root = first_root_of<Varied, float>(block, ray, query, true);
  return {root.t, root.hit, root.undecided, root.evaluations, root.begins_outside, root.enters_inside};
}

Root first_root(const BlockView& block, const LocalRay& ray, const BlockKernels::Query& query) {
  return block.row_count > 1 ? single_root<true>(block, ray, query) : single_root<false>(block, ray, query);
}
