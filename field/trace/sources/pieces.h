// Skeletons cut into pieces that are short against their radius: what cells list.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "field/math/box3.h"
#include "field/math/vec3.h"

namespace marrow {

struct BlendField;

/// A straight stretch of one segment, or a point (from == to). Its field is 1/N int tau^(n-1) d^-n ds, or
/// (tau/d)^(n-1) for a point: the inverse kernel of degree n, with tau linear along the stretch
/// [SCALIS: Zanni et al. 2013].
struct Piece {
  Vec3d from, to;
  double radius_from = 0, radius_to = 0;
  double length = 0;            ///< 0 for a point
  double mass = 0;              ///< f <= mass d^-exponent at distance d: L tau_max^(n-1) / N, or tau^(n-1) for a point
  double share = 0;             ///< mass / radius^exponent, the exponent being n - 1 for a point: L / (N radius), or 1
  double factor = 1;            ///< its sources count this times at most; in mass and share already
  double lean = 0;              ///< of the factor, from -1 to 1: they count weight_at() times as much
  double radius = 0;            ///< the larger of the two
  double inside_distance = 0;   ///< every p nearer than this to the piece is inside, by its own field alone
  std::uint32_t primitive = 0;  ///< index into the blend's segments, or its points

  bool is_point() const { return length == 0; }
  /// At a share of the way from `from` to `to`: linear, and 1 at one end or at both.
  double weight_at(double s) const { return lean > 0 ? 1 - lean + lean * s : 1 + lean * s; }
  /// With sources that count so many times at both ends, linear between; not both 0. Of a piece that does not lean.
  Piece scaled(double at_from, double at_to) const {
    Piece p = *this;
    const double most = std::max(at_from, at_to);
    p.factor *= most;
    p.mass *= most;
    p.share *= most;
    p.lean = (at_to - at_from) / most;
    return p;
  }
  Vec3d middle() const { return (from + to) * 0.5; }
  Box3 box() const {
    Box3 b;
    b.include(from);
    b.include(to);
    return b;
  }
};

/// From p to the stretch or the point itself, not to a surface.
double distance(const Piece&, const Vec3d& p);

/// Cuts the skeletons of one blend.
class PieceCutter {
 public:
  /// `critical_field`: the f from which on the corrected field is above 1 whatever the gradient.
  PieceCutter(int degree, double critical_field);

  /// All pieces of a blend; segments are cut so that no piece is longer than three times its larger radius.
  std::vector<Piece> cut(const BlendField&) const;
  /// The part of a piece between two parameters in [0, 1]; it keeps the whole piece's inside_distance.
  Piece part(const Piece&, double begin, double end) const;

 private:
  Piece segment_piece(const Vec3d& from, const Vec3d& to, double radius_from, double radius_to) const;
  double inside_distance(double smallest_radius, double length) const;

  int degree_;
  double normalisation_, critical_field_;
};

}  // namespace marrow
