#include "field/trace/general/crossing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <boost/math/tools/toms748_solve.hpp>

#include "field/math/side.h"
#include "field/number/places_in.h"

namespace marrow {
namespace {

using OnRay = Jet<Interval, 1>;

// Bounds that do not shrink with the piece could be halved for ever. After the first so many evaluations, and again
// after each further so many, gaps count as short that are 16 times as long: what is left undecided is reported, and
// what lies behind it is still searched.
constexpr std::uint32_t first_evaluations = 2000, more_evaluations = 500;
constexpr double inf = std::numeric_limits<double>::infinity();

class Search {
 public:
  Search(const FieldTree& tree, std::uint32_t record, const Ray& ray, double body, bool any)
      : tree_(tree), record_(record), ray_(ray), nearby_(body), any_(any) {}

  CrossingSearch run(double begin, double end) {
    nearby_ = std::min(nearby_, std::max(max_component(abs(ray_.at(begin))), max_component(abs(ray_.at(end)))));
    // Pieces still to be searched, nearest last.
    open_.push_back({begin, end, Side::Unknown, Side::Unknown});
    while (!open_.empty() && !found_.t) {
      const Piece piece = open_.back();
      open_.pop_back();
      examine(piece);
    }
    // A gap that ends at the crossing is the crossing itself, as exactly as sums are known.
    if (found_.t && *found_.t - found_.undecided <= 16 * gap(*found_.t)) found_.undecided = inf;
    return found_;
  }

 private:
  struct Piece {
    double begin, end;
    Side at_begin, at_end;

    bool crosses() const { return at_begin != at_end; }
  };

  double at(double t) {
    ++found_.evaluations;
    return value(tree_, ray_.at(t), record_);
  }
  Side side(double t) { return at(t) >= 1 ? Side::Inside : Side::Outside; }
  void learn_sides(Piece& piece) {
    if (piece.at_begin == Side::Unknown) piece.at_begin = side(piece.begin);
    if (piece.at_end == Side::Unknown) piece.at_end = side(piece.end);
  }

  OnRay enclosure(const Interval& t) {
    ++found_.evaluations;
    return value(tree_, places_on(ray_, OnRay::variable(t, 0)), record_);
  }
  Interval enclosure_at(double t) {
    ++found_.evaluations;
    return value(tree_, places_on(ray_, Interval(t)), record_);
  }

  // Settles the piece, or puts back what remains of it.
  void examine(Piece piece) {
    const OnRay f = enclosure({piece.begin, piece.end});
    if (f.value.hi < 1 || f.value.lo >= 1) return;  // 1 is inside
    const Interval slope = f.slope[0];
    if (any_) {
      learn_sides(piece);
      if (piece.crosses()) {
        found_.t = piece.end;
        return;
      }
    }
    const bool known = std::isfinite(slope.lo) && std::isfinite(slope.hi);
    if (known && (slope.lo > 0 || slope.hi < 0)) {
      learn_sides(piece);
      if (piece.crosses()) found_.t = placed(piece);
      return;
    }
    if (found_.evaluations >= allowed_) {
      allowed_ += more_evaluations;
      coarseness_ *= 16;
    }
    // A piece that stays so near to 1, on one side at its ends, cannot be decided.
    if (length(piece) <= coarseness_ * gap(piece.end) || is_flat(f.value, piece, sums_are_off)) {
      give_up(piece);
      return;
    }
    const double middle = piece.begin + 0.5 * (piece.end - piece.begin);
    if (!known) {
      split(piece, middle, middle, Side::Unknown);
      return;
    }
    // The field moves from its value in the middle by no more than its slope allows: that clears the middle.
    const Interval center = enclosure_at(middle);
    if (center.contains(1)) {
      // As in a plane face that the ray runs in: rounding alone tells sides there, however short the piece.
      constexpr double rounding_of_few = 0x1p-46;
      const double half = 0.5 * length(piece) * (1 + 1e-12);
      if (is_flat(center + slope * Interval(-half, half), piece, rounding_of_few)) give_up(piece);
      else split(piece, middle, middle, side(middle));
      return;
    }
    const bool is_above = center.lo > 1;
    const double margin = (is_above ? center.lo - 1 : 1 - center.hi) * (1 - 1e-12);
    const double ahead = is_above ? -slope.lo : slope.hi, back = is_above ? slope.hi : -slope.lo;
    const auto reach = [&](double steepness) { return steepness > 0 ? margin / steepness * (1 - 1e-12) : inf; };
    split(piece, middle - reach(back), middle + reach(ahead), is_above ? Side::Inside : Side::Outside);
  }

  // Leaves what is before `left` and behind `right`; there and between the field is on one side.
  void split(const Piece& piece, double left, double right, Side between) {
    if (right < piece.end) open_.push_back({right, piece.end, between, piece.at_end});
    if (left > piece.begin) open_.push_back({piece.begin, left, piece.at_begin, between});
  }

  void give_up(Piece piece) {
    learn_sides(piece);
    if (!piece.crosses() || !is_short(piece)) {
      found_.undecided_until = std::max(piece.end, found_.undecided < inf ? found_.undecided_until : piece.end);
      found_.undecided = std::min(found_.undecided, piece.begin);
    }
    if (piece.crosses()) found_.t = placed(piece);
  }

  // Within `off` of 1, with both ends on one side.
  bool is_flat(const Interval& f, Piece& piece, double off) {
    if (!(1 - f.lo < off && f.hi - 1 < off)) return false;
    learn_sides(piece);
    return !piece.crosses();
  }

  // Sums of a blend are known to 3e-11 of themselves: pieces shorter than 2^-34 (6e-11) of the body, or of coordinates
  // there, say nothing new. It is far below the ulp of a float. Where the body, or the ray's origin, is far away,
  // places are rounded by more.
  double gap(double t) const { return std::max(0x1p-34 * nearby_, 0x1p-48 * ray_.size_at(t)); }
  static double length(const Piece& piece) { return piece.end - piece.begin; }
  bool is_short(const Piece& piece) const { return length(piece) <= gap(piece.end); }

  // The one change of side [Alefeld, Potra, Shi 1995]. The end on the far side is returned: t is never before the
  // surface.
  double placed(const Piece& piece) {
    constexpr double least = 1e-300, most = 1e100;  // 1 is inside; on skeletons the field is infinite
    const auto above = [&](double t) {
      const double f = at(t) - 1;
      return f == 0 ? least : std::min(f, most);
    };
    // As it was told before, though rounding may say otherwise now.
    const auto on_side = [&](double t, Side known) {
      const double off = std::clamp(std::fabs(at(t) - 1), least, most);
      return known == Side::Inside ? off : -off;
    };
    const auto near_enough = [&](double a, double b) { return b - a <= 16 * rounding::ulp * ray_.size_at(b); };
    if (near_enough(piece.begin, piece.end)) return piece.end;
    std::uintmax_t most_steps = 100;
    return boost::math::tools::toms748_solve(above, piece.begin, piece.end, on_side(piece.begin, piece.at_begin),
                                             on_side(piece.end, piece.at_end), near_enough, most_steps)
        .second;
  }

  const FieldTree& tree_;
  std::uint32_t record_;
  const Ray& ray_;
  double nearby_;  // the size of the body, or the largest coordinate on the stretch if that is less
  bool any_;
  std::uint32_t allowed_ = first_evaluations;
  double coarseness_ = 1;  // of what is short, over gap()
  std::vector<Piece> open_;
  CrossingSearch found_;
};

}  // namespace

CrossingSearch find_crossing(const FieldTree& tree, std::uint32_t record, const Ray& ray, double begin, double end,
                             double body, bool any) {
  return Search(tree, record, ray, body, any).run(begin, end);
}

}  // namespace marrow
