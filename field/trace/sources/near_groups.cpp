#include "field/trace/sources/near_groups.h"

#include <algorithm>

#include "field/base/ask_for.h"
#include "field/math/elementary.h"

namespace marrow {

NearGroups::NearGroups(const SourceTree& tree, std::span<const SourceRef> near, const Vec3d& center, double half)
    : center_(center), scale_(1 / half) {
  groups_.reserve(near.size() / lanes + 2);
  for (const bool points : {false, true}) {
    used_ = lanes;  // the next source begins a group
    for (const SourceRef ref : near) {
      if (ref.is_piece()) {
        if (tree.piece(ref.index()).is_point() == points) add(tree.piece(ref.index()));
      } else if (tree.node(ref.index()).is_point == points) {
        add(tree.node(ref.index()));
      }
    }
    if (!points) curve_groups_ = static_cast<int>(groups_.size());
  }
}

NearGroups::NearGroups(std::span<const Piece> pieces, std::span<const std::uint32_t> near, bool points,
                       const Vec3d& center, double half)
    : center_(center), scale_(1 / half), used_(lanes) {
  groups_.reserve(near.size() / lanes + 1);
  constexpr std::size_t ahead = 8;  // pieces of large blends are in no cache
  for (std::size_t i = 0; i < near.size(); ++i) {
    if (i + ahead < near.size()) ask_for_lines<3>(&pieces[near[i + ahead]]);
    if (pieces[near[i]].is_point() == points) add(pieces[near[i]]);
  }
  if (!points) curve_groups_ = count();
}

NearGroups::Lane NearGroups::next_lane() {
  if (used_ == lanes) {
    Group& g = groups_.emplace_back();
    g = {};
    for (auto& axis : g.from) std::fill(axis, axis + lanes, 1e3F);
    used_ = 0;
  }
  return {groups_.back(), static_cast<std::size_t>(used_++)};
}

void NearGroups::add(const Piece& p) {
  const auto [g, lane] = next_lane();
  const Vec3d from = (p.from - center_) * scale_, along = (p.to - p.from) * scale_;
  for (std::size_t k = 0; k < 3; ++k) {
    g.from[k][lane] = static_cast<float>(from[k]);
    g.along[k][lane] = static_cast<float>(along[k]);
  }
  // Shorter than any rounding, a piece is the point where it begins.
  const double length2 = length_squared(along), shortest2 = 1e-24;
  g.inverse_length2[lane] = static_cast<float>(length2 > shortest2 ? 1 / length2 : 0);
  g.share[lane] = static_cast<float>(p.share);
  g.taper[lane] = static_cast<float>((p.radius_to - p.radius_from) * scale_);
  g.tau[lane] = static_cast<float>(p.radius * scale_);
  g.length[lane] = static_cast<float>(p.length * scale_);
  g.thinnest[lane] = g.tau[lane];
  g.lean[lane] = static_cast<float>(p.lean);
  some_lean_ = some_lean_ || p.lean != 0;
}

void NearGroups::add(const SourceNode& n) {
  const auto [g, lane] = next_lane();
  const Vec3d at = (n.center - center_) * scale_;
  for (std::size_t k = 0; k < 3; ++k) g.from[k][lane] = static_cast<float>(at[k]);
  const double tau = n.tau_mass / n.mass;
  g.share[lane] = static_cast<float>(n.mass / integer_power(tau, n.exponent));
  g.tau[lane] = static_cast<float>(tau * scale_);
  g.length[lane] = g.reach[lane] = static_cast<float>(n.radius * scale_);
  g.thinnest[lane] = static_cast<float>(n.thinnest * scale_);
}

}  // namespace marrow
