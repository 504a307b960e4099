// Which material has most of a blend's field at a place, by bounds of groups of its sources.
#pragma once

#include <cstdint>
#include <vector>

#include "field/base/id.h"
#include "field/math/vec3.h"
#include "field/trace/sources/source_tree.h"

namespace marrow {

struct BlendField;

/// Refers to what it is made of.
class MaterialSearch {
 public:
  /// The tree is of all pieces of the blend.
  MaterialSearch(const BlendField&, const SourceTree&);

  /// That of strongest_material() of the blend, to rounding. Groups of sources are opened, and pieces are summed, only
  /// as far as it takes to tell: a few, but for places where two materials have nearly the same share.
  MaterialId at(const Vec3d& p) const;

 private:
  using Label = std::uint32_t;  // index into materials_
  static constexpr Label mixed = UINT32_MAX;
  // What a group or a piece adds to the field, with bounds.
  struct Share {
    SourceRef source;
    Label label;
    double low, high;

    double doubt() const { return label == mixed ? high : high - low; }
  };
  struct Verdict {
    Label lead;
    double missing;  // for it to be certain; not positive where it is
  };

  void label_pieces(const BlendField&);
  void label_nodes();
  void add(SourceRef, const Vec3d& p, std::vector<Share>&) const;
  void open(const Share&, const Vec3d& p, std::vector<Share>&) const;
  Share share_of(std::uint32_t piece, const Vec3d& p) const;
  Share exact_share_of(std::uint32_t piece, const Vec3d& p) const;
  static Verdict judge(const std::vector<Share>&);

  const SourceTree& tree_;
  int degree_;
  std::vector<MaterialId> materials_;      // in the order of points, then segments
  std::vector<Label> of_piece_, of_node_;  // empty where there is one material alone
};

}  // namespace marrow
