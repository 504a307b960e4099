// The rays of a packet on their runs, and what gives the angle there. Part of block_kernels_<set>.cpp.

inline void load_rays(const BlockRays& r, const Lanes& at, PacketMask which, PacketRays& rays) {
  for (int k = 0; k < 3; ++k) {
    at.load(which, r.origin[k], rays.origin[k]);
    at.load(which, r.direction[k], rays.direction[k]);
  }
}

// The angle for the rays in the lanes: on all of their runs, or where the fine level decides.
template <Angle Rule>
struct AngleOnRuns {
  AngleSource<Rule, PacketFloat> source;
  void load_run(const Lanes&, PacketMask, const BlockRays&) {}
  void load_share(const Lanes&, PacketMask, const BlockRays&) {}
};
template <>
struct AngleOnRuns<Angle::Patched> {
  ShareOnRun<PacketFloat> share;
  AngleSource<Angle::Patched, PacketFloat> source{share};
  AngleOnRuns() = default;
  AngleOnRuns(const AngleOnRuns&) = delete;
  AngleOnRuns& operator=(const AngleOnRuns&) = delete;
  void load_run(const Lanes& at, PacketMask which, const BlockRays& r) {
    const ShareOnRun<PacketFloat> any(
        ShareLine<PacketFloat>{at.load(r.line[0]), at.load(r.line[1]), at.load(r.line[2]), at.load(r.line[3])});
    assign(which, share.way.c[0], any.way.c[0]);
    assign(which, share.way.c[1], any.way.c[1]);
    assign(which, share.spread, any.spread);
  }
  void load_share(const Lanes& at, PacketMask which, const BlockRays& r) {
    at.load(which, r.front, share.from);
    for (int i = 0; i <= SharePatch::degree; ++i) at.load(which, r.share[i], share.way.c[i]);
  }
};

// Where patches give the angle: of rays that the fine level decides, from where they are.
inline void find_shares(const CellRays* cells, LaneSet waiting, BlockRays& r) {
  while (!waiting.empty()) {
    Lanes at;
    const PacketMask here = at.seat(waiting);
    PacketRays rays;
    load_rays(r, at, here, rays);
    const ShareInPatch<PacketFloat> found(BlocksOf<PacketFloat>{cells, at.load(r.cell)}, rays, at.load(r.front), here);
    for (int i = 0; i <= SharePatch::degree; ++i) at.store(here, r.share[i], found.share.way.c[i]);
    at.store(here, r.fine_end, min_of(found.end, at.load(r.end)));
  }
}

// Returns the rays of these that have not come to the end of their runs.
inline LaneSet go_on_behind_patches(const LaneSet& rays, BlockRays& r) {
  LaneSet left;
  rays.for_each([&](int ray) {
    if (!(r.fine_end[ray] < r.end[ray])) return;
    r.begin[ray] = r.fine_end[ray];
    left.add(ray);
  });
  return left;
}
