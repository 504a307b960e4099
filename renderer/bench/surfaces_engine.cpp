// The surfaces of this project as an engine to be measured.
#include "renderer/bench/ray_engine.h"

namespace marrow {
namespace {

class SurfacesEngine final : public RayEngine {
 public:
  explicit SurfacesEngine(const Surfaces& surfaces) : surfaces_(surfaces) {}

  bool first_hit(const Ray& ray, EngineHit& hit, RayCounts&) const override {
    const auto found = surfaces_.first_hit(ray);
    if (found) hit = *found;
    return found.has_value();
  }
  bool occluded(const Ray& ray) const override { return surfaces_.occluded(ray); }
  void first_hits(std::span<const Ray> rays, std::span<std::optional<EngineHit>> hits, RayCounts&) const override {
    surfaces_.first_hits(rays, hits);
  }
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> hidden) const override {
    surfaces_.occluded(rays, hidden);
  }
  void refine() const override { surfaces_.refine(); }

 private:
  const Surfaces& surfaces_;
};

class RecordingEngine final : public RayEngine {
 public:
  explicit RecordingEngine(const Surfaces& surfaces) : surfaces_(surfaces) {}

  bool first_hit(const Ray& ray, EngineHit& hit, RayCounts& counts) const override {
    RayRecord record;
    const auto found = surfaces_.first_hit(ray, record);
    counts.evaluations += record.evaluations;
    counts.uncertified += record.certified ? 0 : 1;
    if (found) hit = *found;
    return found.has_value();
  }
  bool occluded(const Ray& ray) const override { return surfaces_.occluded(ray); }

 private:
  const Surfaces& surfaces_;
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
