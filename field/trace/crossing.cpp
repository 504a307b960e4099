#include "field/trace/crossing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace marrow {
namespace {

using OnRay = Jet<Interval, 1>;

// Bounds that do not shrink with the piece could be halved for ever. What is left then is reported as undecided.
constexpr std::uint32_t most_evaluations = 2000;
constexpr double inf = std::numeric_limits<double>::infinity();

class Search {
 public:
  Search(const FieldTree& tree, std::uint32_t record, const Ray& ray, bool any)
      : tree_(tree), record_(record), ray_(ray), any_(any) {}

  CrossingSearch run(double begin, double end) {
    const bool starts_inside = inside(begin), ends_inside = inside(end);
    if (any_ && starts_inside != ends_inside) {
      found_.t = end;
      return found_;
    }
    // Halves still to be searched, nearest last; each knows the side of both of its ends.
    std::array<Piece, 80> open;
    std::size_t count = 0;
    open[count++] = {begin, end, starts_inside, ends_inside};
    while (count > 0 && !found_.t) {
      const Piece piece = open[--count];
      if (const auto middle = examine(piece)) {
        const bool middle_inside = inside(*middle);
        open[count++] = {*middle, piece.end, middle_inside, piece.ends_inside};
        open[count++] = {piece.begin, *middle, piece.starts_inside, middle_inside};
      }
    }
    // A gap that ends at the crossing is the crossing itself, as exactly as sums are known.
    if (found_.t && *found_.t - found_.undecided <= 16 * gap(*found_.t)) found_.undecided = inf;
    return found_;
  }

 private:
  struct Piece {
    double begin, end;
    bool starts_inside, ends_inside;
  };

  double at(double t) {
    ++found_.evaluations;
    return value(tree_, ray_.at(t), record_);
  }
  bool inside(double t) { return at(t) >= 1; }

  OnRay enclosure(const Interval& t) {
    ++found_.evaluations;
    const OnRay along = OnRay::variable(t, 0);
    const Vec3d& o = ray_.origin;
    const Vec3d& d = ray_.direction;
    return value(
        tree_,
        Vec3<OnRay>{OnRay(o.x) + along * OnRay(d.x), OnRay(o.y) + along * OnRay(d.y), OnRay(o.z) + along * OnRay(d.z)},
        record_);
  }

  // Where to divide the piece, or nothing when it is settled.
  std::optional<double> examine(const Piece& piece) {
    const OnRay f = enclosure({piece.begin, piece.end});
    if (!f.value.contains(1)) return {};
    const double middle = piece.begin + 0.5 * (piece.end - piece.begin);
    const Interval slope = f.slope[0];
    if (std::isfinite(slope.lo) && std::isfinite(slope.hi)) {
      // The field moves from its value in the middle by no more than its slope allows.
      const Interval center = enclosure({middle, middle}).value;
      const Interval moved = center + slope * (Interval(piece.begin, piece.end) - Interval(middle));
      if (!moved.contains(1)) return {};
      if (slope.lo > 0 || slope.hi < 0) {
        if (piece.starts_inside != piece.ends_inside) found_.t = placed(piece);
        return {};
      }
    }
    if (!is_short(piece) && found_.evaluations < most_evaluations) return middle;
    if (!is_short(piece) && piece.starts_inside != piece.ends_inside) {
      found_.undecided = std::min(found_.undecided, piece.begin);
      found_.t = placed(piece);
      return {};
    }
    if (piece.starts_inside != piece.ends_inside) found_.t = piece.end;
    else found_.undecided = std::min(found_.undecided, piece.begin);
    return {};
  }

  // Of t, or of the coordinates that the ray runs through.
  double size(double t) const { return std::max(std::fabs(t), max_component(abs(ray_.origin))); }
  // Sums of a blend are known to 3e-11 of themselves: shorter pieces than 2^-34 (6e-11) say nothing new. It is far
  // below the ulp of a float.
  double gap(double t) const { return 0x1p-34 * size(t); }
  bool is_short(const Piece& piece) const { return piece.end - piece.begin <= gap(piece.end); }

  // The one change of side, by regula falsi that halves the weight of an end that stays (the Illinois rule), with
  // halving where that is slow. The end on the far side is returned: t is never before the surface.
  double placed(Piece piece) {
    double a = piece.begin, b = piece.end, fa = at(a) - 1, fb = at(b) - 1;
    int stays = 0;
    for (int step = 0; step < 200 && b - a > 16 * rounding::ulp * size(b); ++step) {
      double t = step % 4 == 3 ? a + 0.5 * (b - a) : b - fb * (b - a) / (fb - fa);
      if (!(t > a && t < b)) t = a + 0.5 * (b - a);
      if (!(t > a && t < b)) break;
      const double ft = at(t) - 1;
      if ((ft >= 0) == piece.starts_inside) {
        a = t, fa = ft;
        if (stays < 0) fb *= 0.5;
        stays = -1;
      } else {
        b = t, fb = ft;
        if (stays > 0) fa *= 0.5;
        stays = 1;
      }
    }
    return b;
  }

  const FieldTree& tree_;
  std::uint32_t record_;
  const Ray& ray_;
  bool any_;
  CrossingSearch found_;
};

}  // namespace

CrossingSearch find_crossing(const FieldTree& tree, std::uint32_t record, const Ray& ray, double begin, double end,
                             bool any) {
  return Search(tree, record, ray, any).run(begin, end);
}

}  // namespace marrow
