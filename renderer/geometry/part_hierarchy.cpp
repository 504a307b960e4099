#include "renderer/geometry/part_hierarchy.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <embree3/rtcore.h>

namespace marrow {

void EmbreeRelease::operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
void EmbreeRelease::operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }

namespace {

// Rides with the ray through Embree and keeps everything in double.
struct Query : RTCIntersectContext {
  explicit Query(const Ray& r) : ray(r), inverse{1 / r.direction.x(), 1 / r.direction.y(), 1 / r.direction.z()} {
    rtcInitIntersectContext(this);
  }
  const Ray& ray;
  Vec3d inverse;       // of the direction
  double t_start = 0;  // where Embree's ray begins on ours
  PartHierarchy::Hit best;
  double outside_from = std::numeric_limits<double>::infinity();  // ElementLog's, of this solid
  const Solid* outside_of = nullptr;
  std::vector<ElementLog>* visits = nullptr;
};

// Whether the ray comes into a box before t: Embree asks for all boxes of a leaf when it has met one. A ray exactly in
// the plane of a padded face gives NaN and may count either way; what the box is padded for is not there.
bool enters(const Query& q, const Box3& box, double t) {
  double enter = q.ray.t_min, exit = t;
  for (std::size_t i = 0; i < 3; ++i) {
    const double a = (box.lower[i] - q.ray.origin[i]) * q.inverse[i],
                 b = (box.upper[i] - q.ray.origin[i]) * q.inverse[i];
    enter = std::max(enter, std::min(a, b));
    exit = std::min(exit, std::max(a, b));
  }
  return enter <= exit;
}

// Embree's t of a hit, never before the hit itself: a box that holds a nearer one must not be skipped.
float embree_t(const Query& q, double t) {
  return std::nextafter(static_cast<float>((t - q.t_start) * (1 + 1e-6)), std::numeric_limits<float>::infinity());
}

const PartsOfSolid& parts_of(void* user_data) { return *static_cast<const PartsOfSolid*>(user_data); }

float below(double v) { return std::nextafter(static_cast<float>(v), -std::numeric_limits<float>::infinity()); }
float above(double v) { return std::nextafter(static_cast<float>(v), std::numeric_limits<float>::infinity()); }

void bounds_callback(const RTCBoundsFunctionArguments* a) {
  const PartsOfSolid& p = parts_of(a->geometryUserPtr);
  const Box3& box = p.parts[a->primID].box;
  *a->bounds_o = {below(box.lower.x), below(box.lower.y), below(box.lower.z), 0,
                  above(box.upper.x), above(box.upper.y), above(box.upper.z), 0};
}

constexpr float done = -std::numeric_limits<float>::infinity();  // nothing more is asked of a ray

void intersect_callback(const RTCIntersectFunctionNArguments* a) {
  if (a->valid[0] == 0) return;
  auto& q = *static_cast<Query*>(a->context);
  const PartsOfSolid& solid = parts_of(a->geometryUserPtr);
  const SolidPart& part = solid.parts[a->primID];
  if (!enters(q, part.box, q.best.t)) return;
  auto* rayhit = reinterpret_cast<RTCRayHit*>(a->rayhit);
  ElementLog log;
  if (q.outside_of == solid.solid) log.outside_from = q.outside_from;
  const auto t = solid.solid->hit_in_part(part, q.ray, false, log);
  q.outside_of = solid.solid;
  q.outside_from = log.outside_from;
  if (q.visits != nullptr && log.evaluations > 0) q.visits->push_back(log);
  q.best.undecided = std::min(q.best.undecided, log.undecided);
  if (log.begins_inside) {
    q.best.begins_inside = true;
    rayhit->ray.tfar = done;
  }
  if (!t || *t > q.best.t) return;
  const std::size_t index = a->geomID;
  if (*t == q.best.t &&
      std::tuple(index, part.element, log.enter) > std::tuple(q.best.solid, q.best.element, q.best.enter))
    return;
  q.best.t = *t;
  q.best.solid = index;
  q.best.element = part.element;
  q.best.enter = log.enter;
  q.best.place = log.place;
  q.best.found = true;
  rayhit->ray.tfar = embree_t(q, *t);
  rayhit->hit.geomID = a->geomID;
  rayhit->hit.primID = a->primID;
}

void occluded_callback(const RTCOccludedFunctionNArguments* a) {
  if (a->valid[0] == 0) return;
  const auto& q = *static_cast<const Query*>(a->context);
  const PartsOfSolid& solid = parts_of(a->geometryUserPtr);
  ElementLog log;
  if (solid.solid->hit_in_part(solid.parts[a->primID], q.ray, true, log))
    reinterpret_cast<RTCRay*>(a->ray)->tfar = done;
}

// The part of a ray inside a box; false when it misses.
bool clip(const Box3& box, const Ray& ray, double& t0, double& t1) {
  t0 = ray.t_min;
  t1 = ray.t_max;
  for (std::size_t i = 0; i < 3; ++i) {
    const double o = ray.origin[i], d = ray.direction.vec()[i];
    if (d == 0) {
      if (o < box.lower[i] || o > box.upper[i]) return false;
      continue;
    }
    const double a = (box.lower[i] - o) / d, b = (box.upper[i] - o) / d;
    t0 = std::max(t0, std::min(a, b));
    t1 = std::min(t1, std::max(a, b));
  }
  return t0 <= t1;
}

RTCRay to_embree(const Query& q, double t_end) {
  const Vec3d origin = q.ray.at(q.t_start);
  RTCRay r{};
  r.org_x = static_cast<float>(origin.x);
  r.org_y = static_cast<float>(origin.y);
  r.org_z = static_cast<float>(origin.z);
  r.dir_x = static_cast<float>(q.ray.direction.x());
  r.dir_y = static_cast<float>(q.ray.direction.y());
  r.dir_z = static_cast<float>(q.ray.direction.z());
  r.tnear = 0;
  r.tfar = embree_t(q, t_end);
  r.mask = ~0U;
  return r;
}

void attach(RTCDevice device, RTCScene scene, PartsOfSolid& p) {
  RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(g, static_cast<unsigned>(p.parts.size()));
  rtcSetGeometryUserData(g, &p);
  rtcSetGeometryBoundsFunction(g, bounds_callback, nullptr);
  rtcSetGeometryIntersectFunction(g, intersect_callback);
  rtcSetGeometryOccludedFunction(g, occluded_callback);
  rtcCommitGeometry(g);
  rtcAttachGeometry(scene, g);
  rtcReleaseGeometry(g);
}

}  // namespace

Result<std::unique_ptr<PartHierarchy>> PartHierarchy::make(RTCDeviceTy* device, std::vector<PartsOfSolid> solids) {
  std::unique_ptr<PartHierarchy> h(new PartHierarchy(std::move(solids)));
  h->scene_.reset(rtcNewScene(device));
  rtcSetSceneBuildQuality(h->scene_.get(), RTC_BUILD_QUALITY_HIGH);
  Box3 bounds;
  for (const PartsOfSolid& s : h->solids_)
    for (const SolidPart& p : s.parts) bounds.include(p.box);
  const double margin = bounds.empty() ? 0 : std::ldexp(8 * largest_coordinate(bounds), -24);
  h->padded_bounds_ = bounds.padded(margin);
  for (PartsOfSolid& s : h->solids_) {
    for (SolidPart& p : s.parts) p.box = p.box.padded(margin);
    attach(device, h->scene_.get(), s);
  }
  rtcCommitScene(h->scene_.get());
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE) return failure("Embree could not build its hierarchy");
  return h;
}

PartHierarchy::Hit PartHierarchy::first_hit(const Ray& ray, std::vector<ElementLog>* visits) const {
  Query q(ray);
  q.visits = visits;
  double t_end = 0;
  if (!clip(padded_bounds_, ray, q.t_start, t_end)) return {};
  RTCRayHit rayhit{};
  rayhit.ray = to_embree(q, t_end);
  rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_.get(), &q, &rayhit);
  return q.best;
}

bool PartHierarchy::occluded(const Ray& ray) const {
  Query q(ray);
  double t_end = 0;
  if (!clip(padded_bounds_, ray, q.t_start, t_end)) return false;
  RTCRay r = to_embree(q, t_end);
  rtcOccluded1(scene_.get(), &q, &r);
  return r.tfar < 0;
}

std::size_t PartHierarchy::part_count() const {
  std::size_t sum = 0;
  for (const PartsOfSolid& s : solids_) sum += s.parts.size();
  return sum;
}

}  // namespace marrow
