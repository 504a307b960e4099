// A tracer asked cell by cell, without any hierarchy over them.
#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "field/trace/blend_tracer.h"
#include "tests/trace/far_space.h"

namespace marrow::test {

class AllCells {
 public:
  explicit AllCells(BlendField field, const TraceOptions& options = {}) {
    expect_far_space_is_dropped(field);
    auto made = BlendTracer::make(std::move(field), options);
    if (!made) throw std::runtime_error("no tracer");
    tracer_ = std::move(*made);
    for (std::size_t i = 0; i < tracer_->tile_count(); ++i) {
      boxes_.push_back(tracer_->tile_box(i));
      bounds_.include(boxes_.back());
    }
  }

  struct Hit {
    std::size_t cell;
    double t;
  };
  struct Answer {
    std::optional<Hit> hit;                                      ///< the nearest; of equal ones that of the first cell
    double undecided = std::numeric_limits<double>::infinity();  ///< t of the first undecided gap
    std::uint32_t evaluations = 0;                               ///< in all cells, those behind the hit too
  };
  Answer trace(const Ray& ray) const {
    Answer answer;
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      if (!meets(boxes_[i], ray)) continue;
      CellLog log;
      const auto hit = tracer_->first_hit(i, ray, false, log);
      answer.evaluations += log.evaluations;
      answer.undecided = std::min(answer.undecided, log.undecided);
      if (hit && (!answer.hit || hit->t < answer.hit->t)) answer.hit = Hit{i, hit->t};
    }
    return answer;
  }
  std::optional<Hit> first_hit(const Ray& ray) const { return trace(ray).hit; }
  const BlendTracer& tracer() const { return *tracer_; }
  const Box3& bounds() const { return bounds_; }

 private:
  // A sphere around the box, with room for rounding: the cell itself decides.
  static bool meets(const Box3& box, const Ray& ray) {
    const Vec3d to = box.center() - ray.origin;
    const Vec3d off = to - ray.direction * dot(to, ray.direction);
    return length_squared(off) <= 0.26 * length_squared(box.size());
  }

  std::unique_ptr<BlendTracer> tracer_;
  std::vector<Box3> boxes_;
  Box3 bounds_;
};

}  // namespace marrow::test
