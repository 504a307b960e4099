// The surfaces of this project as an engine to be measured.
#include "renderer/bench/ray_engine.h"

namespace marrow {
namespace {

class SurfacesEngine : public RayEngine {
 public:
  explicit SurfacesEngine(const Surfaces& surfaces) : surfaces_(surfaces) {}

  bool first_hit(const Ray& ray, EngineHit& hit, RayCounts& counts) const final {
    const auto found = traced(ray, counts);
    if (!found) return false;
    hit = {found->position, found->normal.vec(), found->outside};
    return true;
  }
  bool occluded(const Ray& ray) const final { return surfaces_.occluded(ray); }
  void refine() const final { surfaces_.refine(); }

 protected:
  virtual std::optional<SurfaceHit> traced(const Ray& ray, RayCounts&) const { return surfaces_.first_hit(ray); }
  const Surfaces& surfaces_;
};

class RecordingEngine final : public SurfacesEngine {
 public:
  using SurfacesEngine::SurfacesEngine;

 private:
  std::optional<SurfaceHit> traced(const Ray& ray, RayCounts& counts) const override {
    RayRecord record;
    const auto found = surfaces_.first_hit(ray, record);
    counts.evaluations += record.evaluations;
    counts.uncertified += record.certified ? 0 : 1;
    return found;
  }
};

}  // namespace

std::unique_ptr<RayEngine> engine_of(const Surfaces& surfaces) { return std::make_unique<SurfacesEngine>(surfaces); }

std::unique_ptr<RayEngine> recording_engine_of(const Surfaces& surfaces) {
  return std::make_unique<RecordingEngine>(surfaces);
}

RayCounts& RayCounts::operator+=(const RayCounts& b) {
  rays += b.rays;
  hits += b.hits;
  shadow_rays += b.shadow_rays;
  evaluations += b.evaluations;
  uncertified += b.uncertified;
  light += b.light;
  return *this;
}

}  // namespace marrow
