// The first root in a block: stretch by stretch along the ray. Part of block_kernels_<set>.cpp.

// The coarse level finds where to look, the fine level decides.
template <bool Varied>
inline Root root_in(const BlockView& block, const LocalRay& ray, float t0, float t1, bool any) {
  Marcher<Varied> march(block, block.coarse(), ray);
  Search search(march, t0, t1);
  Root root;
  float guess = t0;
  const Approach approached = approach(search, any, guess);
  root.evaluations = march.evaluations;
  root.begins_outside = search.have_last;
  if (approached == Approach::Missed) return root;
  if (approached == Approach::SurelyInside) {
    root.hit = true;
    root.t = search.inside.t;
    return root;
  }
  Marcher<Varied> fine(block, block.fine(), ray);
  Search close(fine, search.front, t1);
  root = decide(close, min_of(max_of(guess, search.front), t1), any);
  root.evaluations = march.evaluations + fine.evaluations;
  root.begins_outside = search.have_last || close.have_last;
  return root;
}

// Where a ray leaves that is inside at t0.
template <bool Varied>
inline Root exit_in(const BlockView& block, const LocalRay& ray, float t0, float t1, bool any) {
  Marcher<Varied> march(block, block.fine(), ray);
  march.exits = true;
  Search search(march, t0, t1);
  search.record(march.sample(t0));
  Root root;
  if (!search.missed()) root = decide(search, search.guess(), any);
  root.evaluations = march.evaluations;
  return root;
}

// Nearer to 1 than this, neighbouring blocks may differ about the side.
inline constexpr float clearly_inside = 2e-5F;

// Whether the ray is inside at t, by the coarse level where that can tell.
template <bool Varied>
inline bool is_inside(const BlockView& block, const LocalRay& ray, float t, int& evaluations) {
  Marcher<Varied> rough(block, block.coarse(), ray);
  const SampleOf<Varied> p = rough.sample(t);
  ++evaluations;
  if (p.residual > 0) return false;
  if (p.nominal < -clearly_inside && rough.inside_at(p, 0)) return true;
  Marcher<Varied> march(block, block.fine(), ray);
  ++evaluations;
  return march.sample(t).nominal < -clearly_inside;
}

// The stretches of a ray in slots that may hold surface, octant by octant; neighbours are joined.
class Runs {
 public:
  Runs(const BlockView& block, const LocalRay& ray, float t0, float t1) : block_(block), ray_(ray) {
    for (int k = 0; k < 3; ++k) plane_[k] = -ray.origin[k] / nonzero(ray.direction[k]);
    cut_[0] = t0;
    for (int k = 0; k < 3; ++k) {
      int i = k;
      for (; i > 0 && cut_[i] > plane_[k]; --i) cut_[i + 1] = cut_[i];
      cut_[i + 1] = min_of(max_of(plane_[k], t0), t1);
    }
    cut_[4] = t1;
  }

  struct Run {
    float begin = 0, end = 0;
  };
  // The next run, or false.
  bool next(Run& run) {
    bool found = false;
    for (;; ++at_) {
      while (at_ == walk_.count)
        if (!next_octant()) return found;
      const float begin = 0.5F * walk_.begin[at_], end = 0.5F * walk_.end[at_];
      if (!found) run = {begin, end};
      else if (begin <= run.end) run.end = end;
      else return true;
      found = true;
    }
  }

 private:
  // Walks the next octant that the ray crosses; its coordinates are twice those of the block, from its own centre.
  bool next_octant() {
    while (part_ < 4) {
      const float begin = cut_[part_], end = cut_[part_ + 1];
      ++part_;
      if (!(begin < end)) continue;
      const float middle = 0.5F * (begin + end);
      LocalRay local = ray_;
      int octant = 0;
      for (int k = 0; k < 3; ++k) {
        const bool upper = (middle > plane_[k]) == (nonzero(ray_.direction[k]) > 0);
        octant |= upper ? 1 << k : 0;
        local.origin[k] = 2 * ray_.origin[k] - (upper ? 1.0F : -1.0F);
      }
      const std::uint64_t surface = block_.surface(octant);
      if (surface == 0) continue;
      walk(surface, local, 2 * begin, 2 * end, walk_);
      at_ = 0;
      if (walk_.count > 0) return true;
    }
    return false;
  }

  const BlockView& block_;
  const LocalRay& ray_;
  float plane_[3], cut_[5];
  int part_ = 0, at_ = 0;
  Walk walk_{.begin = {}, .end = {}, .slot = {}, .count = 0};
};

template <bool Varied>
inline Root first_root_of(const BlockView& block, const LocalRay& ray, const BlockKernels::Query& query) {
  Root root;
  root.begins_outside = query.from_outside;
  float front = query.t0;
  if (query.from_surface && !query.leaving) {  // too near for the coarse level; one fine certificate leads away
    Marcher<Varied> march(block, block.fine(), ray);
    Search start(march, query.t0, query.t1);
    const SampleOf<Varied> first = march.sample(query.t0);
    root.evaluations = march.evaluations;
    root.hit = first.nominal < -clearly_inside;
    root.enters_inside = root.hit && !query.any;
    root.t = query.t0;
    if (root.hit) return root;
    root.begins_outside = true;
    start.record(first);
    if (start.missed()) return root;
    front = start.front;
  }
  Runs runs(block, ray, front, query.t1);
  for (Runs::Run run; !root.hit && runs.next(run);) {
    const Root found = query.leaving ? exit_in<Varied>(block, ray, run.begin, run.end, query.any)
                                     : root_in<Varied>(block, ray, run.begin, run.end, query.any);
    root.hit = found.hit;
    root.t = found.t;
    root.undecided = min_of(root.undecided, found.undecided);
    root.evaluations += found.evaluations;
    root.begins_outside |= found.begins_outside;
    // Any root will do: a ray that begins inside meets one where it leaves.
    if (root.hit && !root.begins_outside && !query.leaving && !query.any)
      root.enters_inside = is_inside<Varied>(block, ray, run.begin, root.evaluations);
  }
  return root;
}

Root first_root(const BlockView& block, const LocalRay& ray, const BlockKernels::Query& query) {
  return block.row_count > 1 ? first_root_of<true>(block, ray, query) : first_root_of<false>(block, ray, query);
}
