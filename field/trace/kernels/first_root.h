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

// The first run that is not cleared by looking at it more closely. `from` is moved to what is certified.
inline PatchRay::Run next_run(const PatchRay& polynomial, float& from) {
  PatchRay::Run run = polynomial.scan(from, 1);
  float end = 1;
  for (int zoom = 0; zoom < 3 && run.found && !run.crosses; ++zoom) {
    end = run.end;
    run = polynomial.scan(run.begin, end);
  }
  from = run.found ? run.end : end;
  return run;
}

inline Root root_by_polynomial(const BlockView& block, const Patch& patch, const LocalRay& ray, float t0, float t1, bool any) {
  const PatchRay polynomial(block, patch, ray, t0, t1);
  Root all;
  all.evaluations = 1;
  constexpr int most_scans = 64;
  float from = -1;
  for (int scans = 0; from < 1; ++scans) {
    PatchRay::Run run{.found = true, .begin = from, .end = 1, .guess = from};
    if (scans < most_scans) run = next_run(polynomial, from);
    else from = 1;
    if (!run.found) continue;
    if (any && run.surely) {
      all.hit = true;
      all.t = polynomial.t_of(run.inside);
      return all;
    }
    const Root root = decide_between(block, ray, max_of(t0, polynomial.t_of(run.begin)),
                                     min_of(t1, polynomial.t_of(run.end)), polynomial.t_of(run.guess), any);
    all.evaluations += root.evaluations;
    all.undecided = min_of(all.undecided, root.undecided);
    if (!root.hit) continue;
    all.hit = true;
    all.t = root.t;
    return all;
  }
  return all;
}

Root root_in(const BlockView& block, const Octants& octants, const LocalRay& ray, float t0, float t1, bool any);

inline Root root_in_patch(const BlockView& block, const Patch& patch, const LocalRay& ray, float t0, float t1, bool any) {
  if (patch.kind == Patch::Kind::Empty || !clip(patch, ray, t0, t1)) return {};
  if (patch.kind == Patch::Kind::Divided) return root_in(block, *patch.octants, ray, t0, t1, any);
  if (patch.kind == Patch::Kind::Sources) return root_by_sources(block, ray, t0, t1, any);
  return root_by_polynomial(block, patch, ray, t0, t1, any);
}

// Boxes overlap by roundings, so that one that begins before a hit may hold a nearer one.
Root root_in(const BlockView& block, const Octants& octants, const LocalRay& ray, float t0, float t1, bool any) {
  Stretches walk;
  stretches(octants.boxes, ray, t0, t1, walk);
  Root root;
  for (int i = 0; i < walk.count; ++i) {
    const int octant = walk.order[i];
    if (root.hit && walk.begin[octant] > root.t) break;
    const Root found =
        root_in_patch(block, octants.patch(octants, octant), ray, walk.begin[octant], walk.end[octant], any);
    root.evaluations += found.evaluations;
    root.undecided = min_of(root.undecided, found.undecided);
    if (!found.hit || (root.hit && root.t <= found.t)) continue;
    root.hit = true;
    root.t = found.t;
    if (any) break;
  }
  return root;
}

Root first_root(const BlockView& block, const LocalRay& ray, const BlockKernels::Query& query) {
  if (!query.from_surface) return root_in(block, *block.octants, ray, query.t0, query.t1, query.any);
  // Too near for polynomials; one fine certificate leads away.
  Marcher march(block, block.fine(), ray, query.t0, query.t1);
  Search start(march, query.t0, query.t1);
  start.record(march.sample(query.t0));
  Root root;
  if (!start.missed()) root = root_in(block, *block.octants, ray, start.front, query.t1, query.any);
  root.evaluations += march.evaluations;
  return root;
}
