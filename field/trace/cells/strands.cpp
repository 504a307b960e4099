#include "field/trace/cells/strands.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "field/blend/blend_field.h"
#include "field/math/elementary.h"
#include "field/trace/cells/tile.h"
#include "field/trace/kernels/strand_places.h"
#include "field/trace/kernels/strand_tensor.h"
#include "field/trace/shares/strand_quadratics.h"
#include "field/trace/sources/quadrature.h"

namespace marrow {
namespace {

// Of the share of angles: what one strand may cause by being folded, or one piece of a near strand by being left to a
// quadratic. Shares near the surface of 20 random scenes are off by 1.2e-7 (median), 1.2e-5 (99 %) and 3.4e-5 at most.
constexpr double budget = 1e-5;
constexpr int nodes_per_piece = 2;  // of pieces that do not count one by one
// What comes nearer, in radii of the cube, counts one by one in any case: the series of what a quadratic leaves out
// begins with what is told of it.
constexpr double largest_ratio = 0.35;
// What the field of all strands but the strongest, which is some 1 near the surface, must be for floats: they end at
// 1e-38, and over a cell fields change by some powers of ten. At degree 20 that is 30 radii away.
constexpr double weakest = 1e-30;
// Of the share of angles: what all strands together may cause that the tiles around have folded, by an estimate that is
// some 20 times what it is off. 1e-4 instead took a first picture of 10,000 hairs 1.25 times as long as no limit, 5e-4
// 1.1 times.
constexpr double most_inherited = 1e-3;

// What a tensor is at each strand_place.
constexpr std::size_t values_of_tensor = static_cast<std::size_t>(strand_places) * tensor_floats;

}  // namespace

struct Strands::Cube {
  Vec3d center;
  double half;
  Vec3d place(std::size_t k) const { return center + place_in_cube(k) * half; }
};

struct Strands::Seen {
  std::uint32_t strand;
  StrandInMiddle middle;
};

Strands::Strands(const BlendField& blend, std::span<const Piece> pieces, const BlockKernels& kernels)
    : blend_(blend),
      pieces_(pieces),
      kernels_(kernels),
      degree_(blend.degree),
      range_(angle_range(blend).value_or(AngleRange{})) {
  find_own_angles();
  strands_.resize(blend.direction_bounds.size());
  strand_of_.resize(pieces.size());
  first_node_.resize(pieces.size());
  std::vector<std::vector<std::uint32_t>> members(strands_.size());
  for (std::uint32_t i = 0; i < pieces.size(); ++i) {
    const auto& strands = pieces[i].is_point() ? blend.points.strands : blend.segments.strands;
    strand_of_[i] = strands[pieces[i].primitive];
    members[strand_of_[i]].push_back(i);
  }
  for (std::size_t k = 0; k < strands_.size(); ++k) {
    Strand& s = strands_[k];
    s.first = groups_.size();
    if (members[k].empty()) continue;
    const Piece& one = pieces[members[k].front()];
    s.origin = one.middle();
    s.scale = 1 / one.radius;
    s.is_point = one.is_point();
    int lane = lanes;
    for (const std::uint32_t i : members[k]) {
      first_node_[i] = static_cast<std::uint32_t>((groups_.size() - s.first) * lanes + static_cast<std::size_t>(lane)) -
                       static_cast<std::uint32_t>(lanes);
      add_nodes(pieces[i], i, lane);
    }
    s.count = static_cast<int>(groups_.size() - s.first);
    s.pieces = std::move(members[k]);
  }
  is_alone_ = std::ranges::count_if(strands_, [](const Strand& s) { return s.count > 0; }) < 2;
}

// Not where all have the bounds of the range.
void Strands::find_own_angles() {
  const DirectionBounds all{range_.least, range_.most};
  if (std::ranges::all_of(blend_.direction_bounds, [&](const DirectionBounds& b) { return b == all; })) return;
  const double width = range_.most - range_.least;
  for (const DirectionBounds& b : blend_.direction_bounds)
    angles_.push_back({.crossing = static_cast<float>((b.least - range_.least) / width),
                       .added = static_cast<float>((b.most - b.least) / width)});
}

Vec3d Strands::direction(std::uint32_t piece) const {
  const Piece& p = pieces_[piece];
  return p.is_point() ? Vec3d{} : normalize(p.to - p.from).vec();
}

// Weights are those of quadrature nodes in units of the strand.
void Strands::add_nodes(const Piece& p, std::uint32_t index, int& lane) {
  const Strand& s = strands_[strand_of_[index]];
  const Vec3d u = direction(index);
  const auto add = [&](const Vec3d& at, double weight) {
    if (lane == lanes) {
      Group& g = groups_.emplace_back();
      g = {};
      for (auto& axis : g.at) std::fill(axis, axis + lanes, 1e9F);
      lane = 0;
    }
    Group& g = groups_.back();
    const Vec3d x = (at - s.origin) * s.scale;
    for (std::size_t k = 0; k < 3; ++k) {
      g.at[k][lane] = static_cast<float>(x[k]);
      g.direction[k][lane] = static_cast<float>(u[k]);
    }
    g.weight[lane] = static_cast<float>(weight);
    g.length[lane] = static_cast<float>(p.length * s.scale);
    g.taper[lane] = static_cast<float>(std::fabs(p.radius_to - p.radius_from) / p.radius);
    ++lane;
  };
  if (p.is_point()) {
    add(p.from, integer_power(p.radius * s.scale, degree_ - 1));
    return;
  }
  const GaussNodes rule = gauss_legendre(nodes_per_piece);
  const double unit = p.mass / integer_power(p.radius, degree_ - 1) * s.scale;  // L / N
  for (std::size_t k = 0; k < rule.positions.size(); ++k) {
    const double at = rule.positions[k], radius = p.radius_from + (p.radius_to - p.radius_from) * at;
    add(lerp(p.from, p.to, at), rule.weights[k] * unit * integer_power(radius * s.scale, degree_ - 1));
  }
}

StrandQuery Strands::query(std::uint32_t strand, const Cube& cube) const {
  const Strand& s = strands_[strand];
  const Vec3d c = (cube.center - s.origin) * s.scale;
  return {.groups = groups_[s.first].at[0],
          .count = s.count,
          .exponent = degree_ - (s.is_point ? 1 : 0),
          .center = {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)},
          .half = static_cast<float>(cube.half * s.scale),
          .largest_ratio = static_cast<float>(largest_ratio),
          .near = nullptr,
          .allowed = 0};
}

Strands::Seen Strands::see(std::uint32_t strand, const Cube& cube) const {
  Seen out{.strand = strand, .middle = {}};
  kernels_.strand_in_middle(query(strand, cube), out.middle);
  return out;
}

namespace {

double error_of(const StrandInMiddle& s) {
  return std::isfinite(s.error) ? static_cast<double>(s.error) : std::numeric_limits<double>::max();
}

// The strongest strand, and the field of all others, given that of those that are folded already.
template <class Seen>
void find_others(const std::vector<Seen>& seen, double folded, StrandView& view) {
  double strongest = folded;
  for (const Seen& s : seen) {
    const double f = std::min(1.0, static_cast<double>(s.middle.field));
    view.others += std::min(f, strongest);  // a difference of sums would be 0 where they are weak
    if (f > strongest) view.strongest = s.strand;
    strongest = std::max(f, strongest);
  }
}

}  // namespace

// Those that a quadratic tells well enough, and so many of the others, of least error, that no more than `most` are
// left: of equal ones the first. None where they are weak.
std::vector<bool> Strands::to_fold(const std::vector<Seen>& seen, double others, std::size_t most) const {
  std::vector<bool> chosen(seen.size(), false);
  if (is_weak(others)) return chosen;
  for (std::size_t i = 0; i < seen.size(); ++i)
    chosen[i] =
        static_cast<double>(seen[i].middle.ratio) <= largest_ratio && error_of(seen[i].middle) <= budget * others;
  if (seen.size() <= most) return chosen;
  std::vector<std::pair<double, std::size_t>> errors;
  for (std::size_t i = 0; i < seen.size(); ++i) errors.emplace_back(error_of(seen[i].middle), i);
  const auto kept = errors.begin() + static_cast<std::ptrdiff_t>(seen.size() - most);
  std::nth_element(errors.begin(), kept, errors.end());
  std::for_each(errors.begin(), kept, [&](const auto& e) { chosen[e.second] = true; });
  return chosen;
}

void Strands::add_to_tensors(std::uint32_t strand, const StrandSamples& samples, std::vector<float>& values) const {
  kernels_.add_strand(samples, TensorWeights{}, values.data());
  if (!have_own_angles()) return;
  const StrandAngle& angle = angles_[strand];
  kernels_.add_strand(samples, TensorWeights{.directed = angle.added, .all = angle.crossing},
                      values.data() + values_of_tensor);
}

// Folds what is far, beside what the tile has folded.
StrandView Strands::fold(const std::vector<Seen>& seen, const Cube& cube, const Tile* from, std::size_t most,
                         std::vector<float>& values) const {
  StrandView view;
  values.assign(tensor_count() * values_of_tensor, 0.0F);
  if (from != nullptr) {
    const StrandView& outer = around(*from);
    const Cube outer_cube{from->place().center, from->place().half};
    for (std::size_t tensor = 0; tensor < tensor_count(); ++tensor)
      for (std::size_t k = 0; k < strand_places; ++k)
        add_quadratics(outer.far.data() + tensor * quadratics_of_tensor, tensor_floats,
                       (cube.place(k) - outer_cube.center) / outer_cube.half,
                       values.data() + tensor * values_of_tensor + k * tensor_floats);
    view.error = outer.error;
  }
  find_others(seen, std::max(0.0, static_cast<double>(values[sum_of_f])), view);
  const std::vector<bool> is_folded = to_fold(seen, view.others, most);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const auto& [strand, middle] = seen[i];
    if (!is_folded[i]) {
      view.near.push_back(strand);
      continue;
    }
    StrandSamples samples;
    kernels_.strand_samples(query(strand, cube), samples);
    add_to_tensors(strand, samples, values);
    view.error += error_of(middle);
  }
  view.far.resize(tensor_count() * quadratics_of_tensor);
  for (std::size_t tensor = 0; tensor < tensor_count(); ++tensor)
    fit_quadratics(values.data() + tensor * values_of_tensor, tensor_floats,
                   view.far.data() + tensor * quadratics_of_tensor);
  return view;
}

// What is alone has the largest angle of all, unless the blend itself is asked for its own.
bool Strands::is_weak(double others) const { return others < weakest && (!is_alone_ || have_own_angles()); }

std::vector<Strands::Seen> Strands::seen_from(const Cube& cube, const StrandView* parent) const {
  std::vector<Seen> seen;
  if (parent != nullptr) {
    for (const std::uint32_t s : parent->near) seen.push_back(see(s, cube));
  } else {
    for (std::uint32_t s = 0; s < strands_.size(); ++s)
      if (strands_[s].count > 0) seen.push_back(see(s, cube));
  }
  return seen;
}

// From the smallest tile that has folded nothing that counts here: a tile judges by its middle, where other strands may
// be much stronger. Where all others are weak the blend itself tells the shares.
StrandView Strands::view_of(const Cube& cube, const Tile* around_it, std::size_t most,
                            std::vector<float>& values) const {
  for (const Tile* from = around_it;; from = from->place().parent) {
    const StrandView* outer = from != nullptr ? &around(*from) : nullptr;
    StrandView view = fold(seen_from(cube, outer), cube, from, most, values);
    if (outer == nullptr || is_weak(view.others) || outer->error <= most_inherited * view.others) return view;
  }
}

const StrandView& Strands::around(const Tile& tile) const {
  return tile.strands().get([&] {
    const TilePlace& place = tile.place();
    std::vector<float> values;
    return std::make_unique<const StrandView>(
        view_of({place.center, place.half}, place.parent, std::numeric_limits<std::size_t>::max(), values));
  });
}

namespace {

// Over pairs of folded strands at a place, each counted twice: f_i f_j (u_i . u_j)^8 from the tensor there.
double turned_pairs(const float* tensor) {
  return contracted(tensor, tensor) - static_cast<double>(tensor[sum_of_directed_squares]);
}
// The same times what being parallel adds to both, and f_i f_j times what they have where they cross.
double turned_pairs(const float* tensor, const float* weighted) {
  const auto number = [](const float* of, int i) { return static_cast<double>(of[i]); };
  return contracted(tensor, weighted) - number(weighted, sum_of_directed_squares) +
         (number(tensor, sum_of_f) * number(weighted, sum_of_f) - number(weighted, sum_of_squares));
}

// StrandLevel::far from the quadratic of the tensor and from its values, whose products are fitted themselves.
std::vector<float> far_rows(const std::vector<float>& quadratic, const std::vector<float>& values, bool have_own) {
  static_assert(static_cast<int>(far_sum) == static_cast<int>(sum_of_f));
  std::vector<float> rows = quadratic;
  float pairs[strand_places][2], fitted[quadratic_monomials][2];
  for (std::size_t k = 0; k < strand_places; ++k) {
    const float* v = values.data() + k * tensor_floats;
    const double f = static_cast<double>(v[sum_of_f]);
    pairs[k][0] = static_cast<float>(have_own ? turned_pairs(v, v + values_of_tensor) : turned_pairs(v));
    pairs[k][1] = static_cast<float>(f * f - static_cast<double>(v[sum_of_squares]));
  }
  fit_quadratics(pairs[0], 2, fitted[0]);
  for (std::size_t m = 0; m < quadratic_monomials; ++m)
    for (std::size_t i = 0; i < 2; ++i) rows[m * tensor_floats + far_turned_pairs + i] = fitted[m][i];
  return rows;
}

}  // namespace

NearStrand Strands::divided(std::uint32_t strand, const Cube& cube, StrandView& view) const {
  const Strand& s = strands_[strand];
  std::vector<unsigned short> near_nodes(static_cast<std::size_t>(s.count));
  StrandQuery q = query(strand, cube);
  q.near = near_nodes.data();
  q.allowed = static_cast<float>(budget * view.others);
  StrandInMiddle far;
  kernels_.strand_in_middle(q, far);
  NearStrand out;
  for (const std::uint32_t i : s.pieces)
    if (near_nodes[first_node_[i] / lanes] >> first_node_[i] % lanes & 1) out.listed.push_back(i);
  if (out.listed.size() == s.pieces.size()) return out;
  StrandSamples samples;
  kernels_.strand_samples(q, samples);
  fit_quadratics(samples.sums[0], 4, out.rest);
  view.error += error_of(far);
  return out;
}

CellStrands Strands::around(const Tile& tile, const Vec3d& center, double half) const {
  const Cube cube{center, half};
  std::vector<float> values;
  CellStrands cell{.view = view_of(cube, &tile, most_strands, values), .near = {}, .far = {}};
  cell.is_weak = is_weak(cell.view.others);
  if (cell.is_weak) cell.view.near.clear();
  for (const std::uint32_t strand : cell.view.near) cell.near.push_back(divided(strand, cube, cell.view));
  cell.far = far_rows(cell.view.far, values, have_own_angles());
  return cell;
}

double Strands::budget_of(const StrandView& view) { return budget * view.others; }

}  // namespace marrow
