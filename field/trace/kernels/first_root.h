// The first root in a block: patch by patch along the ray. Part of block_kernels_<set>.cpp.

using V8 = float __attribute__((vector_size(32)));

inline V8 load8(const float* p) { return *static_cast<const V8*>(__builtin_assume_aligned(p, 32)); }
inline V8 smaller(V8 a, V8 b) { return a < b ? a : b; }
inline V8 larger(V8 a, V8 b) { return a > b ? a : b; }

// Directions that are 0 in an axis become very small: then no product is 0 times infinity.
inline float nonzero(float d) { return abs_of(d) > 1e-20F ? d : 1e-20F; }

inline void insert(Stretches& s, int octant) {
  int k = s.count++;
  for (; k > 0 && s.begin[s.order[k - 1]] > s.begin[octant]; --k) s.order[k] = s.order[k - 1];
  s.order[k] = octant;
}

using Index8 = int __attribute__((vector_size(32)));

// A bit for each lane that is set.
inline unsigned bits_of(Index8 lanes_set) {
  const Index8 weight{1, 2, 4, 8, 16, 32, 64, 128}, v = lanes_set & weight;
  const Index8 a = v | __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3);
  const Index8 b = a | __builtin_shufflevector(a, a, 2, 3, 0, 1, 2, 3, 0, 1);
  return static_cast<unsigned>(b[0] | b[1]);
}

void stretches(const OctantBoxes& boxes, const LocalRay& ray, float t0, float t1, Stretches& out) {
  V8 enter = V8{} + t0, leave = V8{} + t1;
  for (int k = 0; k < 3; ++k) {
    const float inverse = 1 / nonzero(ray.direction[k]), o = ray.origin[k];
    const V8 a = (load8(boxes.lower[k]) - o) * inverse, b = (load8(boxes.upper[k]) - o) * inverse;
    enter = larger(enter, smaller(a, b));
    leave = smaller(leave, larger(a, b));
  }
  out.count = 0;
  unsigned met = bits_of(enter <= leave) & boxes.present;
  if (met == 0) return;
  __builtin_memcpy(out.begin, &enter, sizeof out.begin);
  __builtin_memcpy(out.end, &leave, sizeof out.end);
  for (; met != 0; met &= met - 1) insert(out, __builtin_ctz(met));
}

// The stretch of a ray in the box and below the plane of a patch; false when there is none.
inline bool clip(const Patch& patch, const LocalRay& ray, float& t0, float& t1) {
  float slope = 0, height = patch.offset;
  for (int k = 0; k < 3; ++k) {
    const float inverse = 1 / nonzero(ray.direction[k]), o = ray.origin[k];
    const float a = (patch.lower[k] - o) * inverse, b = (patch.upper[k] - o) * inverse;
    t0 = max_of(t0, min_of(a, b));
    t1 = min_of(t1, max_of(a, b));
    slope += patch.normal[k] * ray.direction[k];
    height -= patch.normal[k] * o;
  }
  // normal . (o + t d) <= offset: up to this t, or from it on
  if (slope >= 0) t1 = min_of(t1, height / max_of(slope, 1e-20F));
  else t0 = max_of(t0, height / slope);
  return t0 <= t1;
}

// Where fine samples decide between t0, up to which all is certified outside, and t1.
inline Root decide_between(const BlockView& block, const LocalRay& ray, float t0, float t1, float guess, bool any) {
  Marcher fine(block, block.fine(), ray, t0, t1);
  Search close(fine, t0, t1);
  Root root = decide(close, min_of(max_of(guess, t0), t1), any);
  root.evaluations = fine.evaluations;
  return root;
}

// Without a useful polynomial: the coarse level finds where to look.
inline Root root_by_sources(const BlockView& block, const LocalRay& ray, float t0, float t1, bool any) {
  Marcher march(block, block.coarse, ray, t0, t1);
  Search search(march, t0, t1);
  Root root;
  float guess = t0;
  const Approach approached = approach(search, any, guess);
  root.evaluations = march.evaluations;
  if (approached == Approach::Missed) return root;
  if (approached == Approach::SurelyInside) {
    root.hit = true;
    root.t = search.inside.t;
    return root;
  }
  root = decide_between(block, ray, search.front, t1, guess, any);
  root.evaluations += march.evaluations;
  return root;
}

// What is known of a ray in a block so far. A patch can end where its polynomial does not tell; the sources are asked
// about that stretch together with what follows it, for most roots lie just behind.
struct BlockSearch {
  const BlockView& block;
  const LocalRay& ray;
  bool any;
  Root root;
  bool pending = false;  // [begin, end] is not decided, all before is
  float begin = 0, end = 0, guess = 0;

  // True when the ray is done. `front`: what comes next begins there, or nothing when it is infinite.
  bool settle(float front) {
    constexpr float near = 0.05F;
    if (!pending || front < end + near) return root.hit;
    pending = false;
    return add(decide_between(block, ray, begin, end, guess, any));
  }

  // Sources decide over a stretch, and what was left before it.
  bool decide_run(float t0, float t1, float root_guess) {
    const float from = pending ? begin : t0;
    pending = false;
    return add(decide_between(block, ray, from, t1, root_guess, any));
  }

  void leave(float t0, float t1, float root_guess) {
    if (!pending) {
      begin = t0;
      guess = root_guess;
    }
    end = t1;
    pending = true;
  }

  bool add(const Root& found) {
    root.evaluations += found.evaluations;
    root.undecided = min_of(root.undecided, found.undecided);
    if (found.hit && !(root.hit && root.t <= found.t)) {
      root.hit = true;
      root.t = found.t;
      root.enters_inside = found.enters_inside;
    }
    return root.hit;
  }
};

// The first run that is not cleared by looking at it more closely. `from` is moved to what is certified.
inline PatchRay::Run next_run(const PatchRay& polynomial, float& from) {
  PatchRay::Run run = polynomial.scan(from, 1);
  float end = 1;
  for (int zoom = 0; zoom < 3 && run.found && !run.crosses && run.end < 1; ++zoom) {
    end = run.end;
    run = polynomial.scan(run.begin, end);
  }
  from = run.found ? run.end : end;
  return run;
}

inline bool search_polynomial(BlockSearch& search, const Patch& patch, float t0, float t1) {
  const PatchRay polynomial(search.block, patch, search.ray, t0, t1);
  ++search.root.evaluations;
  constexpr int most_scans = 64;
  float from = -1;
  for (int scans = 0; from < 1; ++scans) {
    PatchRay::Run run{.found = true, .begin = from, .end = 1, .guess = from};
    if (scans < most_scans) run = next_run(polynomial, from);
    else from = 1;
    if (!run.found) continue;
    if (search.any && run.surely) {
      search.root.hit = true;
      search.root.t = polynomial.t_of(run.inside);
      return true;
    }
    const float begin = max_of(t0, polynomial.t_of(run.begin)), end = min_of(t1, polynomial.t_of(run.end));
    if (search.settle(begin)) return true;
    if (!run.crosses && run.end >= 1) search.leave(begin, t1, polynomial.t_of(run.guess));
    else if (search.decide_run(begin, end, polynomial.t_of(run.guess))) return true;
  }
  return false;
}

bool search_octants(BlockSearch& search, const Octants& octants, float t0, float t1);

inline bool search_patch(BlockSearch& search, const Patch& patch, float t0, float t1) {
  if (patch.kind == Patch::Kind::Empty || !clip(patch, search.ray, t0, t1)) return false;
  if (patch.kind == Patch::Kind::Divided) return search_octants(search, *patch.octants, t0, t1);
  if (patch.kind == Patch::Kind::Smooth) return search_polynomial(search, patch, t0, t1);
  if (search.settle(infinity)) return true;
  return search.add(root_by_sources(search.block, search.ray, t0, t1, search.any));
}

// Boxes overlap by roundings, so that one that begins before a hit may hold a nearer one.
bool search_octants(BlockSearch& search, const Octants& octants, float t0, float t1) {
  Stretches walk;
  stretches(octants.boxes, search.ray, t0, t1, walk);
  for (int i = 0; i < walk.count; ++i) {
    const int octant = walk.order[i];
    if (search.root.hit && (search.any || walk.begin[octant] > search.root.t)) break;
    search_patch(search, octants.patch(octants, octant), walk.begin[octant], walk.end[octant]);
  }
  return search.root.hit;
}

// Nearer to 1 than this, neighbouring blocks may differ about the side.
inline constexpr float clearly_inside = 2e-5F;

// Where a ray leaves that is inside at t0.
inline Root exit_root(const BlockView& block, const LocalRay& ray, const BlockKernels::Query& query) {
  Marcher march(block, block.fine(), ray, query.t0, query.t1);
  march.exits = true;
  Search search(march, query.t0, query.t1);
  search.record(march.sample(query.t0));
  Root root;
  if (!search.missed()) root = decide(search, search.guess(), query.any);
  root.evaluations = march.evaluations;
  return root;
}

inline Root root_at_entry(const BlockKernels::Query& query, int evaluations) {
  return {.t = query.t0, .hit = true, .evaluations = evaluations, .enters_inside = true};
}

// Whether a ray comes into the block inside. Asked only of what otherwise is a hit.
inline bool enters_inside(const BlockView& block, const LocalRay& ray, const BlockKernels::Query& query, Root& root) {
  if (!query.any && !root.enters_inside) return false;
  Marcher rough(block, block.coarse, ray, query.t0, query.t1);
  ++root.evaluations;
  if (rough.sample(query.t0).residual > 0) return false;
  Marcher march(block, block.fine(), ray, query.t0, query.t1);
  ++root.evaluations;
  return march.sample(query.t0).nominal < -clearly_inside;
}

Root first_root(const BlockView& block, const LocalRay& ray, const BlockKernels::Query& query) {
  if (query.leaving) return exit_root(block, ray, query);
  BlockSearch search{.block = block, .ray = ray, .any = query.any, .root = {}};
  float front = query.t0;
  if (query.from_surface) {  // too near for polynomials; one fine certificate leads away
    Marcher march(block, block.fine(), ray, query.t0, query.t1);
    Search start(march, query.t0, query.t1);
    const Sample first = march.sample(query.t0);
    if (first.nominal < -clearly_inside) return root_at_entry(query, march.evaluations);
    start.record(first);
    search.root.evaluations = march.evaluations;
    if (start.missed()) return search.root;
    front = start.front;
  }
  search_octants(search, *block.octants, front, query.t1);
  search.settle(infinity);
  if (search.root.hit && !query.from_surface && enters_inside(block, ray, query, search.root))
    return root_at_entry(query, search.root.evaluations);
  search.root.enters_inside = false;
  return search.root;
}
