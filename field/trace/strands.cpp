#include "field/trace/strands.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "field/blend/blend_field.h"
#include "field/math/elementary.h"
#include "field/trace/quadrature.h"
#include "field/trace/strand_axes.h"
#include "field/trace/strand_places.h"
#include "field/trace/strand_quadratics.h"
#include "field/trace/tile.h"

namespace marrow {
namespace {

// Of the share of angles, that one strand may cause by being folded. See error_of().
constexpr double fold_budget = 1e-4;
// Far pieces: at seven times their length two nodes are off by 1e-4 of a field of some 1e-5.
constexpr int nodes_per_piece = 2;
// Strands that come nearer, in radii of the cube, count one by one in any case.
constexpr double largest_ratio = 0.35;

}  // namespace

struct Strands::Cube {
  Vec3d center;
  double half;
  Vec3d place(std::size_t k) const { return center + place_in_cube(k) * half; }
};

struct Strands::Probed {
  std::uint32_t strand;
  StrandSamples samples;
};

Strands::Strands(const BlendField& blend, std::span<const Piece> pieces, const BlockKernels& kernels)
    : pieces_(pieces), kernels_(kernels), degree_(blend.degree) {
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
  }
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

Strands::Probed Strands::probe(std::uint32_t strand, const Cube& cube, std::span<const std::uint32_t> left_out) const {
  const Strand& s = strands_[strand];
  Probed out{.strand = strand, .samples = {}};
  std::vector<unsigned short> bits(left_out.empty() ? 0 : static_cast<std::size_t>(s.count));
  for (const std::uint32_t piece : left_out)
    for (std::uint32_t k = 0; k < nodes_per_piece; ++k) {
      const std::uint32_t node = first_node_[piece] + k;
      bits[node / lanes] = static_cast<unsigned short>(bits[node / lanes] | 1U << node % lanes);
    }
  const Vec3d c = (cube.center - s.origin) * s.scale;
  const StrandQuery query{.groups = groups_[s.first].at[0],
                          .count = s.count,
                          .exponent = degree_ - (s.is_point ? 1 : 0),
                          .left_out = bits.empty() ? nullptr : bits.data(),
                          .center = {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)},
                          .half = static_cast<float>(cube.half * s.scale)};
  kernels_.strand_samples(query, out.samples);
  return out;
}

namespace {

// The quadratic of degree 2 of f leaves binom(n + 2, 3) q^3 of each of its sources [tracing.md B5], which a fit over
// the cube halves and more; f u^8 bends some eight times as much where strands turn.
double error_of(const StrandSamples& s) {
  return std::isfinite(s.error) ? 10 * static_cast<double>(s.error) : std::numeric_limits<double>::max();
}

double field_at_center(const StrandSamples& s) { return std::min(1.0, static_cast<double>(s.sums[0][0])); }

}  // namespace

// The strands of least error that must be folded so that no more than `most` are left: of equal ones the first.
std::vector<bool> Strands::forced(const std::vector<Probed>& probed, std::size_t most) {
  std::vector<bool> chosen(probed.size(), false);
  if (probed.size() <= most) return chosen;
  std::vector<std::pair<double, std::size_t>> errors;
  for (std::size_t i = 0; i < probed.size(); ++i) errors.emplace_back(error_of(probed[i].samples), i);
  const auto kept = errors.begin() + static_cast<std::ptrdiff_t>(probed.size() - most);
  std::nth_element(errors.begin(), kept, errors.end());
  std::for_each(errors.begin(), kept, [&](const auto& e) { chosen[e.second] = true; });
  return chosen;
}

// Folds what is far. alpha is a mean over pairs, and what one strand may be off counts against the field of all strands
// but the strongest.
StrandView Strands::fold(std::vector<Probed>& probed, const Cube& cube, const StrandView* parent,
                         const Cube& parent_cube, std::size_t most, std::vector<float>& values) const {
  StrandView view;
  values.assign(static_cast<std::size_t>(strand_places) * tensor_floats, 0.0F);
  if (parent != nullptr)
    for (std::size_t k = 0; k < strand_places; ++k)
      add_quadratics(parent->far.data(), tensor_floats, (cube.place(k) - parent_cube.center) / parent_cube.half,
                     values.data() + k * tensor_floats);
  const double inherited = std::max(0.0, static_cast<double>(values[sum_of_f]));
  double others = inherited, strongest = inherited;
  for (const Probed& p : probed) {
    others += field_at_center(p.samples);
    strongest = std::max(strongest, field_at_center(p.samples));
  }
  others -= strongest;
  if (parent != nullptr) view.error = parent->error;
  const std::vector<bool> must = forced(probed, most);
  std::vector<Probed> near;
  for (std::size_t i = 0; i < probed.size(); ++i) {
    const StrandSamples& s = probed[i].samples;
    const double error = error_of(s);
    if (!must[i] && (static_cast<double>(s.ratio) > largest_ratio || error > fold_budget * others)) {
      near.push_back(probed[i]);
      continue;
    }
    kernels_.add_strand(s, values.data());
    view.error += others > 0 ? error / others : 0;
  }
  probed = std::move(near);
  view.far.resize(static_cast<std::size_t>(quadratic_monomials) * tensor_floats);
  fit_quadratics(values.data(), tensor_floats, view.far.data());
  for (const Probed& p : probed) view.near.push_back(p.strand);
  return view;
}

const StrandView& Strands::around(const Tile& tile) const {
  return tile.strands().get([&] {
    const TilePlace& place = tile.place();
    const Cube cube{place.center, place.half};
    std::vector<Probed> probed;
    const StrandView* parent = place.parent != nullptr ? &around(*place.parent) : nullptr;
    if (parent != nullptr) {
      for (const std::uint32_t s : parent->near) probed.push_back(probe(s, cube, {}));
    } else {
      for (std::uint32_t s = 0; s < strands_.size(); ++s)
        if (strands_[s].count > 0) probed.push_back(probe(s, cube, {}));
    }
    const Cube outer = parent != nullptr ? Cube{place.parent->place().center, place.parent->place().half} : cube;
    std::vector<float> values;
    return std::make_unique<const StrandView>(fold(probed, cube, parent, outer, probed.size(), values));
  });
}

namespace {

// StrandLevel::far from the quadratic of the tensor and from its values, whose products are fitted themselves.
std::vector<float> far_rows(const std::vector<float>& quadratic, const std::vector<float>& values) {
  std::vector<float> rows(quadratic.size());
  for (std::size_t m = 0; m < quadratic_monomials; ++m) {
    weights_of_tensor(quadratic.data() + m * tensor_floats, rows.data() + m * tensor_floats);
    rows[m * tensor_floats + far_sum] = quadratic[m * tensor_floats + sum_of_f];
  }
  float pairs[strand_places][2], fitted[quadratic_monomials][2];
  for (std::size_t k = 0; k < strand_places; ++k) {
    const float* v = values.data() + k * tensor_floats;
    const double f = static_cast<double>(v[sum_of_f]);
    pairs[k][0] = static_cast<float>(contracted_with_itself(v) - static_cast<double>(v[sum_of_directed_squares]));
    pairs[k][1] = static_cast<float>(f * f - static_cast<double>(v[sum_of_squares]));
  }
  fit_quadratics(pairs[0], 2, fitted[0]);
  for (std::size_t m = 0; m < quadratic_monomials; ++m)
    for (std::size_t i = 0; i < 2; ++i) rows[m * tensor_floats + far_turned_pairs + i] = fitted[m][i];
  return rows;
}

}  // namespace

CellStrands Strands::around(const Tile& tile, const Vec3d& center, double half,
                            std::span<const std::uint32_t> near) const {
  const StrandView& parent = around(tile);
  const Cube cube{center, half};
  // Where the pieces of each strand begin.
  const auto pieces_of = [&](std::uint32_t strand) {
    const auto [first, last] =
        std::ranges::equal_range(near, strand, {}, [&](std::uint32_t p) { return strand_of_[p]; });
    return std::span(first, last);
  };
  std::vector<Probed> probed;
  std::vector<std::uint32_t> points;
  for (const std::uint32_t s : parent.near) {
    const auto listed = pieces_of(s);
    if (strands_[s].is_point && !listed.empty()) points.push_back(listed.front());
    else probed.push_back(probe(s, cube, {}));
  }
  std::vector<float> values;
  CellStrands cell{.view = fold(probed, cube, &parent, {tile.place().center, tile.place().half}, most_strands, values),
                   .points = std::move(points),
                   .rest = {},
                   .far = {}};
  for (Probed& p : probed) {
    if (const auto listed = pieces_of(p.strand); !listed.empty()) p = probe(p.strand, cube, listed);
    StrandRest& rest = cell.rest.emplace_back(StrandRest{p.strand, {}});
    fit_quadratics(p.samples.sums[0], 4, rest.sums);
  }
  cell.far = far_rows(cell.view.far, values);
  return cell;
}

}  // namespace marrow
