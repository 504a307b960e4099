// The nodes of pieces, written lane by lane. Part of block_kernels_<set>.cpp.

inline Native load_anywhere(const float* p) {
  Native v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}

// The number of each lane of a register of the sixteen.
inline NativeInt lane_numbers(int part) {
  NativeInt v;
  for (int i = 0; i < native_lanes; ++i) v[i] = part * native_lanes + i;
  return v;
}

// x y z share radius of a register of lanes, of a group that is not full yet.
struct NodesInLanes {
  Native of[5];
};

inline NodesInLanes nodes_of(const CurvePiece& piece, Native position, Native weight) {
  NodesInLanes n;
  for (int k = 0; k < 3; ++k) n.of[k] = piece.from[k] + piece.along[k] * position;
  n.of[4] = piece.radius + piece.taper * position;
  n.of[3] = weight * piece.unit / n.of[4];
  return n;
}

inline void store_nodes(const NodesInLanes (&group)[natives], float* to) {
  for (int part = 0; part < natives; ++part)
    for (int k = 0; k < 5; ++k)
      __builtin_memcpy(to + k * lanes + part * native_lanes, &group[part].of[k], sizeof(Native));
}

// All sixteen lanes are found as if the piece began at `lane` and went on in front of it: those in front are the first
// of the next group, if it comes so far.
void write_nodes(const CurvePiece* pieces, int count, const NodeTable& table, float* groups) {
  NodesInLanes group[natives] = {};
  int lane = 0;
  for (int i = 0; i < count; ++i) {
    const CurvePiece& piece = pieces[i];
    const float* const positions = table.positions[piece.nodes] + lanes - lane;
    const float* const weights = table.weights[piece.nodes] + lanes - lane;
    NodesInLanes here[natives];
    for (int part = 0; part < natives; ++part) {
      here[part] =
          nodes_of(piece, load_anywhere(positions + part * native_lanes), load_anywhere(weights + part * native_lanes));
      const NativeInt from_lane = lane_numbers(part) >= lane;
      for (int k = 0; k < 5; ++k) group[part].of[k] = select(from_lane, here[part].of[k], group[part].of[k]);
    }
    lane += piece.nodes;
    if (lane < lanes) continue;
    store_nodes(group, groups);
    groups += floats_per_group;
    lane -= lanes;
    for (int part = 0; part < natives; ++part) group[part] = here[part];
  }
  if (lane == 0) return;
  for (int part = 0; part < natives; ++part) {
    const NativeInt unused = lane_numbers(part) >= lane;
    for (int k = 0; k < 5; ++k)
      group[part].of[k] = select(unused, Native{} + (k < 3 ? unused_place : 0.0F), group[part].of[k]);
  }
  store_nodes(group, groups);
}
