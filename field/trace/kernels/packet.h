// Sixteen rays at once. Part of block_kernels_<set>.cpp.

inline Index16 mask_of(unsigned bits) {
  Index16 mask;
  for (int lane = 0; lane < lanes; ++lane) mask[lane] = (bits >> lane & 1) != 0 ? -1 : 0;
  return mask;
}

inline V16 loaded(const float (&v)[lanes]) { return load(v); }

// Where the angle varies each ray goes its own way: its sums are most of the work.
inline void one_by_one(const BlockView& block, const LocalRays& rays, const BlockKernels::PacketQuery& query,
                       Roots& out) {
  for (unsigned left = query.active; left != 0; left &= left - 1) {
    const int lane = __builtin_ctz(left);
    const unsigned bit = 1U << lane;
    LocalRay ray;
    for (int k = 0; k < 3; ++k) {
      ray.origin[k] = rays.origin[k][lane];
      ray.direction[k] = rays.direction[k][lane];
    }
    const Root root = first_root(block, ray,
                                 {.t0 = query.t0[lane],
                                  .t1 = query.t1[lane],
                                  .any = query.any,
                                  .from_surface = (query.from_surface & bit) != 0,
                                  .from_outside = (query.from_outside & bit) != 0});
    out.t[lane] = root.t;
    out.undecided[lane] = root.undecided;
    out.evaluations[lane] = root.evaluations;
    out.hit |= root.hit ? bit : 0;
    out.begins_outside |= root.begins_outside ? bit : 0;
    out.enters_inside |= root.enters_inside ? bit : 0;
  }
}

void first_roots(const BlockView& block, const LocalRays& rays, const BlockKernels::PacketQuery& query, Roots& out) {
  out.hit = out.begins_outside = out.enters_inside = 0;
  if (block.row_count > 1) return one_by_one(block, rays, query, out);
  Ray16 ray;
  for (int k = 0; k < 3; ++k) {
    ray.origin[k] = loaded(rays.origin[k]);
    ray.direction[k] = loaded(rays.direction[k]);
  }
  const QueryOf<V16> all{loaded(query.t0),           loaded(query.t1), query.any, false, mask_of(query.from_surface),
                         mask_of(query.from_outside)};
  const RootOf<V16> root = first_root_of<false, V16>(block, ray, all, mask_of(query.active));
  __builtin_memcpy(out.t, &root.t, sizeof out.t);
  __builtin_memcpy(out.undecided, &root.undecided, sizeof out.undecided);
  __builtin_memcpy(out.evaluations, &root.evaluations, sizeof out.evaluations);
  out.hit = lane_bits(root.hit);
  out.begins_outside = lane_bits(root.begins_outside);
  out.enters_inside = lane_bits(root.enters_inside);
}
