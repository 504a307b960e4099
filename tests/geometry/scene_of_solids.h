// Scenes of placed blends for the tests of geometry, and the field they are judged by.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "field/program/field_program.h"
#include "renderer/geometry/embree_surfaces.h"
#include "renderer/geometry/field_solid.h"
#include "tests/trace/far_space.h"
#include "tests/trace/random_rays.h"

namespace marrow::test {

inline PlacedBlend placed(BlendField blend, const Affine& world_from_local = {}) {
  return {std::move(blend), world_from_local, world_from_local.inverse()};
}

inline BlendField ball(const Vec3d& at, double radius) {
  BlendField blend;
  blend.points.add({at, radius}, {});
  return blend;
}

/// Solids under Embree, and the same ones asked one element after the other.
class SolidScene {
 public:
  explicit SolidScene(std::vector<PlacedBlend> parts, const std::string& isa = "") : program_(std::move(parts)) {
    std::vector<PlacedSolid> solids;
    for (const PlacedBlend& part : program_.parts()) {
      expect_far_space_is_dropped(part.blend);
      auto solid = FieldSolid::make(part, MaterialId{}, {.instruction_set = isa});
      if (!solid) throw std::runtime_error("no solid");
      solids.push_back({std::move(*solid), ObjectId{solids.size()}});
    }
    auto made = EmbreeSurfaces::make(std::move(solids), {}, "threads=1");
    if (!made) throw std::runtime_error("no surfaces");
    surfaces_ = std::move(*made);
    for (std::size_t s = 0; s < surfaces_->solids().size(); ++s)
      for (std::size_t i = 0; i < surfaces_->solids()[s].solid->element_count(); ++i)
        elements_.push_back({s, i, surfaces_->solids()[s].solid->element_box(i)});
  }

  const EmbreeSurfaces& surfaces() const { return *surfaces_; }
  double value(const Vec3d& p) const { return marrow::value(program_, p); }
  FieldSample sample(const Vec3d& p) const { return evaluate(program_, p); }

  /// Without Embree; boxes are only skipped when the ray misses a ball around them.
  std::optional<double> brute_force(const Ray& ray) const {
    std::optional<double> best;
    for (const Element& e : elements_) {
      const Vec3d to = e.box.center() - ray.origin, off = to - ray.direction * dot(to, ray.direction);
      if (length_squared(off) > 0.26 * length_squared(e.box.size())) continue;
      ElementLog log;
      const auto t = surfaces_->solids()[e.solid].solid->hit(e.element, ray, false, log);
      if (t && (!best || *t < *best)) best = t;
    }
    return best;
  }
  const Box3& random_box(Random& random) const {
    return elements_[static_cast<std::size_t>(random.whole(0, static_cast<int>(elements_.size()) - 1))].box;
  }

 private:
  struct Element {
    std::size_t solid, element;
    Box3 box;
  };
  FieldProgram program_;
  std::unique_ptr<EmbreeSurfaces> surfaces_;
  std::vector<Element> elements_;
};

inline BlendField moved(BlendField blend, const Vec3d& by) {
  for (auto& s : blend.points.skeletons) s.at += by;
  for (auto& s : blend.segments.skeletons) {
    s.from += by;
    s.to += by;
  }
  return blend;
}

inline Ray moved(Ray ray, const Vec3d& by) {
  ray.origin += by;
  return ray;
}

}  // namespace marrow::test
