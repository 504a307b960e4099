#include "field/blend/strand_angles.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "field/blend/least_direction.h"
#include "field/math/elementary.h"

namespace marrow {
namespace {

constexpr double inf = Box3::inf;

// Of gamma = A c^8 + B, c = u_i . u_j, from how fast the directions turn. As these are of length 1, what turns one of
// them changes c by no more than the sine of the angle between them.   [Zanni et al. 2015, eq. 16]
MeanChange gamma_change(double span, double cosine, double sine, const MeanChange& a, const MeanChange& b) {
  const double slope = (a.slope + b.slope) * sine, bend = a.bend + b.bend + 2 * a.slope * b.slope;
  const double c6 = integer_power(cosine, 6);
  return {span * 8 * c6 * cosine * slope, span * 8 * c6 * (7 * slope * slope + cosine * bend)};
}

double span_of(const StrandBounds& s) { return s.angles.most - s.angles.least; }

// All strands but the strongest, as one that any of them could be.
struct Rest {
  double weight = 0, slope = 0, bend = 0, span = 0;
  MeanChange turn{};

  void add(const StrandBounds& s, double rho) {
    weight += s.weight.value;
    slope = std::max(slope, s.weight.term({}, rho).slope);
    bend = std::max(bend, s.weight.bend);
    span = std::max(span, std::fabs(span_of(s)));
    turn = {std::max(turn.slope, s.turn.slope), std::max(turn.bend, s.turn.bend)};
  }
};

// Each two strands as a term of the mean.
class Pairs {
 public:
  Pairs(double alpha, double widest, double rho) : alpha_(alpha), widest_(widest), rho_(rho) {}

  MeanChange change(const std::vector<StrandBounds>& strands) {
    constexpr std::size_t most_in_pairs = 12;
    const auto strongest = std::span(strands).first(std::min(strands.size(), most_in_pairs));
    Rest rest;
    for (const StrandBounds& s : std::span(strands).subspan(strongest.size())) rest.add(s, rho_);
    common_ = common_slope(strongest);
    for (std::size_t i = 0; i < strongest.size(); ++i) {
      for (std::size_t j = i + 1; j < strongest.size(); ++j) add(strongest[i], strongest[j]);
      if (rest.weight > 0) add(strongest[i], rest);
    }
    if (rest.weight > 0) add(rest);
    return mean_change(terms_, widest_, rho_);
  }

 private:
  // Of ln f_i f_j, in the mean.
  static Vec3d common_slope(std::span<const StrandBounds> strands) {
    Vec3d slopes{};
    double weights = 0;
    for (std::size_t i = 0; i < strands.size(); ++i)
      for (std::size_t j = i + 1; j < strands.size(); ++j) {
        const double w = strands[i].weight.value * strands[j].weight.value;
        slopes += (strands[i].weight.slope + strands[j].weight.slope) * w;
        weights += w;
      }
    return weights > 0 ? slopes / weights : Vec3d{};
  }

  void add(const StrandBounds& a, const StrandBounds& b) {
    const LogWeight pair{a.weight.value * b.weight.value, a.weight.slope + b.weight.slope,
                         a.weight.bend + b.weight.bend};
    const double span = 0.5 * (span_of(a) + span_of(b)), cosine = dot(a.u, b.u);
    const double gamma = span * integer_power(cosine, 8) + 0.5 * (a.angles.least + b.angles.least);
    MeanTerm term = pair.term(common_, rho_);
    term.apart = std::fabs(gamma - alpha_) + middle_is_off;
    const double turned = (a.turn.slope + b.turn.slope) * rho_ + middle_is_off;
    const double most_cosine = std::min(1.0, std::fabs(cosine) + turned);
    constexpr double root_of_rounding = 1e-7;
    const double most_sine = std::sqrt(std::max(0.0, 1 - cosine * cosine)) + root_of_rounding + turned;
    add(term, gamma_change(std::fabs(span), most_cosine, std::min(1.0, most_sine), a.turn, b.turn));
  }
  void add(const StrandBounds& a, const Rest& rest) {
    MeanTerm term = a.weight.term(common_, rho_);
    term.weight *= rest.weight;
    term.slope += rest.slope;
    term.bend += rest.bend;
    term.apart = widest_;
    add(term, gamma_change(0.5 * (std::fabs(span_of(a)) + rest.span), 1, 1, a.turn, rest.turn));
  }
  void add(const Rest& rest) {
    const MeanTerm term{.weight = 0.5 * rest.weight * rest.weight,
                        .slope = length(common_) + 2 * rest.slope,
                        .bend = 2 * rest.bend,
                        .apart = widest_};
    add(term, gamma_change(rest.span, 1, 1, rest.turn, rest.turn));
  }
  void add(MeanTerm term, const MeanChange& gamma) {
    term.value_slope = gamma.slope;
    term.value_bend = gamma.bend;
    terms_.push_back(term);
  }

  double alpha_, widest_, rho_;
  Vec3d common_{};
  std::vector<MeanTerm> terms_;
};

}  // namespace

void StrandTerms::add(const LogWeight& weight, const SkeletonDirection& direction) {
  if (!(weight.value > 0)) return;
  weight_ += weight.value;
  slopes_ += weight.slope * weight.value;
  direction_ += direction.mean * weight.value;
  all_.push_back({weight, direction});
}

// u = v / |v| of the mean direction v turns as that does:
//   |grad u| <= |grad v| / |v|,   |D^2 u| <= |D^2 v| / |v| + 3 |grad v|^2 / |v|^2.
StrandBounds StrandBounds::of(const StrandTerms& strand, const DirectionBounds& angles, double rho) {
  StrandBounds b{.weight = {.value = strand.weight_, .slope = strand.slopes_ / strand.weight_}, .angles = angles};
  const Vec3d mean = strand.direction_ / strand.weight_;
  std::vector<MeanTerm> terms;
  terms.reserve(strand.all_.size());
  bool has_direction = false;
  for (const auto& [weight, direction] : strand.all_) {
    MeanTerm term = weight.term(b.weight.slope, rho);
    term.apart = length(direction.mean - mean) + middle_is_off;
    term.value_slope = direction.turn.slope;
    term.value_bend = direction.turn.bend;
    terms.push_back(term);
    has_direction = has_direction || direction.mean != Vec3d{} || direction.turn.slope > 0;
  }
  b.weight.bend = terms.size() == 1 ? terms.front().bend : log_bend(terms, rho);
  if (!has_direction) return b;
  constexpr double widest = 2;  // of vectors no longer than 1
  const MeanChange v = mean_change(terms, widest, rho);
  const double shortest = length(mean) - v.slope * rho - middle_is_off;
  if (!(shortest > 2 * least_direction)) {
    b.turn = {inf, inf};
    return b;
  }
  b.u = normalize(mean).vec();
  b.turn.slope = v.slope / shortest;
  b.turn.bend = v.bend / shortest + 3 * b.turn.slope * b.turn.slope;
  return b;
}

MeanChange angle_change(const std::vector<StrandBounds>& strands, double alpha, double widest, double rho) {
  return Pairs(alpha, widest, rho).change(strands);
}

}  // namespace marrow
