#include "field/trace/material_search.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>

#include "field/blend/blend_field.h"
#include "field/math/elementary.h"
#include "field/skeleton/skeletons.h"

namespace marrow {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

MaterialSearch::MaterialSearch(const BlendField& blend, const SourceTree& tree) : tree_(tree), degree_(blend.degree) {
  if (blend.points.materials.empty() && blend.segments.materials.empty()) return;
  label_pieces(blend);
  if (materials_.size() > 1) label_nodes();
  else of_piece_ = {};
}

void MaterialSearch::label_pieces(const BlendField& blend) {
  std::map<MaterialId, Label> known;
  const auto label_of = [&](MaterialId material) {
    const auto [at, is_new] = known.try_emplace(material, static_cast<Label>(materials_.size()));
    if (is_new) materials_.push_back(material);
    return at->second;
  };
  std::vector<Label> points, segments;
  for (std::size_t i = 0; i < blend.points.size(); ++i) points.push_back(label_of(blend.points.material(i)));
  for (std::size_t i = 0; i < blend.segments.size(); ++i) segments.push_back(label_of(blend.segments.material(i)));
  for (const Piece& piece : tree_.pieces())
    of_piece_.push_back((piece.is_point() ? points : segments)[piece.primitive]);
}

// Children follow their parents.
void MaterialSearch::label_nodes() {
  of_node_.resize(tree_.nodes().size());
  for (std::size_t i = of_node_.size(); i-- > 0;) {
    const SourceNode& node = tree_.node(static_cast<std::uint32_t>(i));
    const auto first = of_piece_.begin() + node.begin, end = of_piece_.begin() + node.end;
    const bool is_one = node.is_leaf() ? std::find_if(first, end, [&](Label l) { return l != *first; }) == end
                                       : of_node_[i + 1] == of_node_[node.right];
    of_node_[i] = is_one ? *first : mixed;
    if (!node.is_leaf() && is_one) of_node_[i] = of_node_[i + 1];
  }
}

// As all of its length at its nearest place, and, no thicker than at its thin end, at its farthest.
MaterialSearch::Share MaterialSearch::share_of(std::uint32_t i, const Vec3d& p) const {
  const Piece& piece = tree_.piece(i);
  if (piece.is_point()) return exact_share_of(i, p);
  const double near = distance(piece, p), thin = std::min(piece.radius_from, piece.radius_to) / piece.radius;
  const double least_mass = thin < 1 ? piece.mass * integer_power(thin, degree_ - 1) : piece.mass;
  return {SourceRef::piece(i), of_piece_[i], least_mass * integer_power(1 / (near + piece.length), degree_),
          piece.mass * integer_power(1 / near, degree_)};
}

MaterialSearch::Share MaterialSearch::exact_share_of(std::uint32_t i, const Vec3d& p) const {
  const Piece& piece = tree_.piece(i);
  constexpr auto sums = Derivatives::ScaleInvariant;
  const double field =
      piece.is_point()
          ? point_field<sums>({piece.from, piece.radius}, p, degree_).value
          : segment_field<sums>({piece.from, piece.to, piece.radius_from, piece.radius_to}, p, degree_).value;
  return {SourceRef::piece(i), of_piece_[i], field, field};
}

// Of a group whose ball is nearer than two fifths of its radius bounds tell next to nothing.
void MaterialSearch::add(SourceRef source, const Vec3d& p, std::vector<Share>& shares) const {
  constexpr double clear = 1.4;
  if (source.is_piece()) {
    shares.push_back(share_of(source.index(), p));
    return;
  }
  const SourceNode& node = tree_.node(source.index());
  const double away = length(p - node.center);
  Share all{source, of_node_[source.index()], 0, 0};
  if (!(away > clear * node.radius)) {
    open(all, p, shares);
    return;
  }
  if (all.label != mixed) all.low = node.mass * integer_power(1 / (away + node.radius), node.exponent);
  all.high = node.mass * integer_power(1 / (away - node.radius), node.exponent);
  shares.push_back(all);
}

void MaterialSearch::open(const Share& share, const Vec3d& p, std::vector<Share>& shares) const {
  const std::uint32_t i = share.source.index();
  if (share.source.is_piece()) {
    shares.push_back(exact_share_of(i, p));
    return;
  }
  const SourceNode& node = tree_.node(i);
  if (node.is_leaf()) {
    for (std::uint32_t piece = node.begin; piece < node.end; ++piece) add(SourceRef::piece(piece), p, shares);
    return;
  }
  add(SourceRef::node(i + 1), p, shares);
  add(SourceRef::node(node.right), p, shares);
}

MaterialSearch::Verdict MaterialSearch::judge(const std::vector<Share>& shares) {
  constexpr double rounding = 1e-9;  // of bounds by sums of up to millions of masses
  struct Total {
    Label label;
    double low = 0, high = 0;
  };
  std::vector<Total> totals;
  double of_any = 0;  // what may be of any material
  for (const Share& s : shares) {
    if (s.label == mixed) {
      of_any += s.high;
      continue;
    }
    auto total = std::ranges::find(totals, s.label, &Total::label);
    if (total == totals.end()) total = totals.insert(total, Total{s.label});
    total->low += s.low;
    total->high += s.high;
  }
  if (totals.empty()) return {0, of_any};
  const auto lead = std::ranges::max_element(
      totals, [](const Total& a, const Total& b) { return a.low < b.low || (a.low == b.low && a.label > b.label); });
  if (lead->low == infinity) return {lead->label, -infinity};  // p is on a skeleton
  double most = 0;
  for (const Total& t : totals)
    if (t.label != lead->label) most = std::max(most, t.high);
  return {lead->label, most + of_any - lead->low * (1 - rounding)};
}

MaterialId MaterialSearch::at(const Vec3d& p) const {
  constexpr std::size_t usual_shares = 128;
  if (materials_.size() < 2) return materials_.empty() ? MaterialId{} : materials_.front();
  std::vector<Share> shares;
  shares.reserve(usual_shares);
  for (const SourceRef root : tree_.roots()) add(root, p, shares);
  for (;;) {
    const Verdict verdict = judge(shares);
    if (verdict.missing < 0) return materials_[verdict.lead];
    // What is most in doubt is opened, as much of it as has to go at least.
    double opened = 0;
    do {
      const auto most = std::ranges::max_element(shares, {}, &Share::doubt);
      if (!(most->doubt() > 0)) return materials_[judge(shares).lead];
      const Share share = *most;
      *most = shares.back();
      shares.pop_back();
      opened += share.doubt();
      open(share, p, shares);
    } while (!(opened > verdict.missing) && opened < infinity);
  }
}

}  // namespace marrow
