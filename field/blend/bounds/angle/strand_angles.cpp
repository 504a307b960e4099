#include "field/blend/bounds/angle/strand_angles.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "field/blend/angle/least_direction.h"
#include "field/math/elementary.h"

namespace marrow {
namespace {

constexpr double inf = Box3::inf;

// Of gamma = A c^8 + B, c = u_i . u_j, from how fast the directions turn. As these are of length 1, what turns one of
// them changes c by no more than the sine of the angle between them.   [Zanni et al. 2015, eq. 16]
MeanChange gamma_change(double span, double cosine, double sine, const MeanChange& a, const MeanChange& b) {
  if (span == 0) return {};
  const double slope = (a.slope + b.slope) * sine, bend = a.bend + b.bend + 2 * a.slope * b.slope;
  const double c6 = integer_power(cosine, 6);
  return {span * 8 * c6 * cosine * slope, span * 8 * c6 * (7 * slope * slope + cosine * bend)};
}

double span_of(const StrandBounds& s) { return s.angles.most - s.angles.least; }

void add_weight(MeanTerm& sum, const MeanTerm& w) {
  sum.weight += w.weight;
  sum.slope += w.slope;
  sum.bend += w.bend;
}

// All strands but the strongest, as one that any of them could be.
struct Rest {
  MeanTerm plain{}, divided{};  // their fields, and these with the common factor taken out
  double span = 0;
  MeanChange turn{};

  void add(const StrandBounds& s, const Vec3d& common, double rho) {
    add_weight(plain, s.weight.term({}, rho));
    add_weight(divided, s.weight.term(common, rho));
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
    common_ = common_slope(strands, strongest);
    Rest rest;
    for (const StrandBounds& s : std::span(strands).subspan(strongest.size())) rest.add(s, common_, rho_);
    for (std::size_t i = 0; i < strongest.size(); ++i) {
      for (std::size_t j = i + 1; j < strongest.size(); ++j) add(strongest[i], strongest[j]);
      if (rest.plain.weight.hi > 0) add(strongest[i], rest);
    }
    if (rest.plain.weight.hi > 0) add(rest);
    return mean_change(terms_, widest_, rho_);
  }

 private:
  // Of ln f_i f_j, in the mean; 0 where not all of them are known.
  static Vec3d common_slope(std::span<const StrandBounds> all, std::span<const StrandBounds> strongest) {
    if (!std::ranges::all_of(all, [](const StrandBounds& s) { return s.weight.log.has_value(); })) return {};
    Vec3d slopes{};
    double weights = 0;
    for (std::size_t i = 0; i < strongest.size(); ++i)
      for (std::size_t j = i + 1; j < strongest.size(); ++j) {
        const FieldWeight &a = strongest[i].weight, &b = strongest[j].weight;
        slopes += (a.log->slope + b.log->slope) * (a.value * b.value);
        weights += a.value * b.value;
      }
    return weights > 0 ? slopes / weights : Vec3d{};
  }

  MeanTerm weight_of_both(const FieldWeight& a, const FieldWeight& b) const {
    if (!(a.log && b.log)) return product(a.term({}, rho_), b.term({}, rho_));
    const LogWeight both{a.log->slope + b.log->slope, a.log->bend + b.log->bend};
    return FieldWeight{.value = a.value * b.value, .log = both}.term(common_, rho_);
  }
  void add(const StrandBounds& a, const StrandBounds& b) {
    MeanTerm term = weight_of_both(a.weight, b.weight);
    const double span = 0.5 * (span_of(a) + span_of(b)), cosine = dot(a.u, b.u);
    const double gamma = span * integer_power(cosine, 8) + 0.5 * (a.angles.least + b.angles.least);
    term.apart = std::fabs(gamma - alpha_) + middle_is_off;
    const double turned = (a.turn.slope + b.turn.slope) * rho_ + middle_is_off;
    const double most_cosine = std::min(1.0, std::fabs(cosine) + turned);
    constexpr double root_of_rounding = 1e-7;
    const double most_sine = std::sqrt(std::max(0.0, 1 - cosine * cosine)) + root_of_rounding + turned;
    add(term, gamma_change(std::fabs(span), most_cosine, std::min(1.0, most_sine), a.turn, b.turn));
  }
  void add(const StrandBounds& a, const Rest& rest) {
    MeanTerm term = product(a.weight.term(common_, rho_), rest.plain);
    term.apart = widest_;
    add(term, gamma_change(0.5 * (std::fabs(span_of(a)) + rest.span), 1, 1, a.turn, rest.turn));
  }
  // Each two of them: half of the square but for what is each one's own, which may be all of it.
  void add(const Rest& rest) {
    MeanTerm term = product(rest.divided, rest.plain);
    term.weight = {0, 0.5 * term.weight.hi};
    term.slope *= 0.5;
    term.bend *= 0.5;
    term.apart = widest_;
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

void StrandTerms::add(const SumBounds::Part& part, const SkeletonDirection& direction) {
  FieldWeight weight = weight_of(part, rho_);
  if (!weight.log && weight.f.hi == 0) return;
  value_ += weight.value;
  is_log_ = is_log_ && weight.log;
  all_.push_back({&part, std::move(weight), direction});
}

Vec3d StrandTerms::common_slope() const {
  if (!is_log_) return {};
  Vec3d slopes{};
  for (const Item& item : all_) slopes += item.weight.log->slope * item.weight.value;
  return slopes / value_;
}

FieldWeight StrandTerms::weight(const Vec3d& common, const std::vector<MeanTerm>& terms) const {
  if (is_log_) return {.value = value_, .log = log_of_sum(common, terms)};
  MeanTerm all{};
  for (const MeanTerm& term : terms) add_weight(all, term);
  return {.value = value_, .f = all.weight, .steepest = all.slope, .bent = all.bend};
}

bool StrandTerms::is_straight() const {
  return std::ranges::all_of(all_, [&](const Item& item) {
    return item.direction.range == 0 && item.direction.turn == 0 && item.direction.mean == all_.front().direction.mean;
  });
}

// Of v = sum f_s u_s / sum f_s, from the weights f_s.
MeanChange StrandTerms::turn_of(const Vec3d& mean, std::vector<MeanTerm> terms) const {
  constexpr double widest = 2;  // of vectors no longer than 1
  for (std::size_t i = 0; i < all_.size(); ++i) {
    const auto& [part, weight, direction] = all_[i];
    if (!weight.log && direction.range > 0) {
      terms[i] = term_of_all(*part);
      terms[i].apart = widest;
      continue;
    }
    terms[i].apart = length(direction.mean - mean) + middle_is_off;
    if (direction.turn > 0) {
      terms[i].value_slope = direction.turn;
      terms[i].value_bend = inf;
      continue;
    }
    const MeanChange within = mean_within(*part, direction.range, rho_);
    terms[i].value_slope = within.slope;
    terms[i].value_bend = within.bend;
  }
  return mean_change(terms, widest, rho_);
}

// u = v / |v| turns as v does:
//   |grad u| <= |grad v| / |v|,   |D^2 u| <= |D^2 v| / |v| + 3 |grad v|^2 / |v|^2.
StrandBounds StrandBounds::of(const StrandTerms& strand, const DirectionBounds& angles) {
  const auto& all = strand.all_;
  StrandBounds b{.weight = all.front().weight, .u = all.front().direction.mean, .angles = angles};
  std::vector<MeanTerm> terms;
  if (all.size() > 1) {
    const Vec3d common = strand.common_slope();
    terms.reserve(all.size());
    for (const auto& item : all) terms.push_back(item.weight.term(common, strand.rho_));
    b.weight = strand.weight(common, terms);
  } else {
    terms.push_back(b.weight.term(strand.common_slope(), strand.rho_));
  }
  if (strand.is_straight()) return b;
  b.turn = {inf, inf};
  Vec3d mean{};
  for (const auto& item : all) mean += item.direction.mean * item.weight.value;
  if (!(strand.value_ > 0)) return b;
  mean = mean / strand.value_;
  const MeanChange v = strand.turn_of(mean, std::move(terms));
  const double shortest = length(mean) - v.slope * strand.rho_ - middle_is_off;
  if (!(shortest > 2 * least_direction)) return b;
  b.u = normalize(mean).vec();
  b.turn.slope = v.slope / shortest;
  b.turn.bend = v.bend / shortest + 3 * b.turn.slope * b.turn.slope;
  return b;
}

MeanChange angle_change(const std::vector<StrandBounds>& strands, double alpha, double widest, double rho) {
  return Pairs(alpha, widest, rho).change(strands);
}

}  // namespace marrow
