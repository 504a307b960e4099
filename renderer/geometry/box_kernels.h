// Sixteen rays among boxes, side by side: made ready for Embree, and the nearest boxes ahead of each.
//
// Compiled once for each instruction set (box_kernels_<set>.cpp); all give the same bits, those of a ray alone.
#pragma once

#include <limits>

namespace marrow {

/// Boxes are told by the keys of their parts (PartEntry).
struct RaysAmongBoxes {
  static constexpr int count = 16;
  static constexpr int most = 4;  ///< a hit is found in the second part that a ray comes into, on average
  static constexpr long long nobody = std::numeric_limits<long long>::max();

  alignas(64) double origin[3][count];
  alignas(64) double direction[3][count];
  alignas(64) double t_min[count], last[count];  ///< what lies behind `last` does not matter; below t_min: no ray here
  /// What comes before this entry, and the entry itself, has been taken.
  alignas(64) double taken_enter[count];
  alignas(64) long long taken_key[count];

  // By start()
  alignas(64) double inverse[3][count];  ///< of the direction
  alignas(64) double t_start[count];     ///< where the search begins
  alignas(64) double late[count];        ///< floats may come into a box, or out of it, by so much off from doubles

  // By note()
  alignas(64) double enter[most][count];   ///< of the nearest boxes, by `enter`, then by key
  alignas(64) long long key[most][count];  ///< `nobody` behind the last one
};

/// Where Embree reads of them, as floats.
struct FloatRays {
  float *origin[3], *direction[3], *t_near, *t_far;
};

struct BoxKernels {
  struct Bounds {
    double lower[3], upper[3];
    double middle[3];  ///< Embree's origin
    double margin;     ///< that Embree's boxes are padded by
  };
  struct Started {
    unsigned in_bounds;  ///< a bit for each ray that comes into the bounds; others get an empty interval
    bool neighbours;     ///< all go within some 8 degrees of the first one
  };
  /// Makes rays ready, which begin at the bounds for Embree. Nothing is noted yet.
  Started (*start)(const Bounds&, RaysAmongBoxes&, const FloatRays&);
  /// Notes a box for those of the rays that are asked for (-1, else 0) and come into it. Where there is no room behind
  /// the farthest of the noted ones, what lies behind that need not be searched: t_far is shortened.
  void (*note)(const double (&lower)[3], const double (&upper)[3], long long key, const int* asked, RaysAmongBoxes&,
               float* t_far);
};

/// For as many lanes of floats as Embree goes by, 16, 8 or else, if this machine has them.
const BoxKernels& box_kernels(int lanes);

/// Of components of directions below it Embree, whose packets go wrong by -1e-18, is told that they are 0.
inline constexpr double smallest_component = 1.01e-18;
/// Embree's t of a place is behind the place itself by this share, and less by it in front of it.
inline constexpr double float_share = 1e-6;

}  // namespace marrow
