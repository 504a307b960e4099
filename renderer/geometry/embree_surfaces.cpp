#include "renderer/geometry/embree_surfaces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <embree3/rtcore.h>

#include "renderer/geometry/mesh_solid.h"

namespace marrow {

void EmbreeRelease::operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
void EmbreeRelease::operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }

namespace {

// Rides with the ray through Embree and keeps everything in double.
struct Query : RTCIntersectContext {
  explicit Query(const Ray& r) : ray(r) { rtcInitIntersectContext(this); }
  Ray ray;
  double t_start = 0;  // where Embree's ray begins on ours
  double best = std::numeric_limits<double>::infinity();
  const Solid* solid = nullptr;
  unsigned geometry = RTC_INVALID_GEOMETRY_ID, element = 0;
  const void* place = nullptr;
  double undecided = std::numeric_limits<double>::infinity();
  std::vector<ElementLog>* visits = nullptr;  // of a thread, reused from ray to ray

  // Elements that begin behind the hit are visited or not as the traversal happens to go: they do not count.
  RayRecord record(double hit_t) const {
    RayRecord r{.evaluations = 0, .certified = !(undecided < hit_t)};
    for (const ElementLog& v : *visits)
      if (v.enter <= hit_t) r.evaluations += v.evaluations;
    return r;
  }
};

// Embree's t of a hit, never before the hit itself: a box that holds a nearer one must not be skipped.
float embree_t(const Query& q, double t) {
  return std::nextafter(static_cast<float>((t - q.t_start) * (1 + 1e-6)), std::numeric_limits<float>::infinity());
}

const PlacedSolid& placed(void* user_data) { return *static_cast<const PlacedSolid*>(user_data); }

float below(double v) { return std::nextafter(static_cast<float>(v), -std::numeric_limits<float>::infinity()); }
float above(double v) { return std::nextafter(static_cast<float>(v), std::numeric_limits<float>::infinity()); }

void bounds_callback(const RTCBoundsFunctionArguments* a) {
  const PlacedSolid& p = placed(a->geometryUserPtr);
  const Box3 box = p.solid->element_box(a->primID).padded(p.padding);
  *a->bounds_o = {below(box.lower.x), below(box.lower.y), below(box.lower.z), 0,
                  above(box.upper.x), above(box.upper.y), above(box.upper.z), 0};
}

// The smallest t wins; at equal t the lower geometry, then the lower element, whatever the order of visits.
void intersect_callback(const RTCIntersectFunctionNArguments* a) {
  if (a->valid[0] == 0) return;
  auto& q = *static_cast<Query*>(a->context);
  const Solid& solid = *placed(a->geometryUserPtr).solid;
  ElementLog log;
  const auto t = solid.hit(a->primID, q.ray, false, log);
  if (log.evaluations > 0) q.visits->push_back(log);
  q.undecided = std::min(q.undecided, log.undecided);
  if (!t || *t > q.best) return;
  if (*t == q.best && std::pair(a->geomID, a->primID) > std::pair(q.geometry, q.element)) return;
  q.best = *t;
  q.solid = &solid;
  q.geometry = a->geomID;
  q.element = a->primID;
  q.place = log.place;
  auto* rayhit = reinterpret_cast<RTCRayHit*>(a->rayhit);
  rayhit->ray.tfar = embree_t(q, *t);
  rayhit->hit.geomID = a->geomID;
  rayhit->hit.primID = a->primID;
}

void occluded_callback(const RTCOccludedFunctionNArguments* a) {
  if (a->valid[0] == 0) return;
  const auto& q = *static_cast<const Query*>(a->context);
  const Solid& solid = *placed(a->geometryUserPtr).solid;
  ElementLog log;
  if (solid.hit(a->primID, q.ray, true, log))
    reinterpret_cast<RTCRay*>(a->ray)->tfar = -std::numeric_limits<float>::infinity();
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

void attach(RTCDevice device, RTCScene scene, PlacedSolid& p) {
  RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(g, static_cast<unsigned>(p.solid->element_count()));
  rtcSetGeometryUserData(g, &p);
  rtcSetGeometryBoundsFunction(g, bounds_callback, nullptr);
  rtcSetGeometryIntersectFunction(g, intersect_callback);
  rtcSetGeometryOccludedFunction(g, occluded_callback);
  rtcCommitGeometry(g);
  rtcAttachGeometry(scene, g);
  rtcReleaseGeometry(g);
}

}  // namespace

Result<std::unique_ptr<EmbreeSurfaces>> EmbreeSurfaces::make(std::vector<PlacedSolid> solids,
                                                             std::vector<PlacedPlane> planes,
                                                             const std::string& config) {
  std::unique_ptr<EmbreeSurfaces> s(new EmbreeSurfaces(std::move(solids), std::move(planes)));
  s->device_.reset(rtcNewDevice(config.c_str()));
  if (!s->device_) return failure("Embree cannot make a device with \"" + config + "\"");
  s->scene_.reset(rtcNewScene(s->device_.get()));
  rtcSetSceneBuildQuality(s->scene_.get(), RTC_BUILD_QUALITY_HIGH);
  Box3 elements;
  for (const PlacedSolid& p : s->solids_) {
    s->extent_.include(p.solid->extent());
    for (std::size_t i = 0; i < p.solid->element_count(); ++i) elements.include(p.solid->element_box(i));
  }
  const double largest = elements.empty() ? 0 : largest_coordinate(elements);
  const double margin = std::ldexp(8 * largest, -24);
  s->padded_bounds_ = elements.padded(margin);
  for (PlacedSolid& p : s->solids_) {
    p.padding = margin;
    attach(s->device_.get(), s->scene_.get(), p);
  }
  rtcCommitScene(s->scene_.get());
  if (rtcGetDeviceError(s->device_.get()) != RTC_ERROR_NONE) return failure("Embree could not build its hierarchy");
  return s;
}

const PlacedPlane* EmbreeSurfaces::nearest_plane(const Ray& ray, double& t) const {
  const PlacedPlane* best = nullptr;
  for (const PlacedPlane& p : planes_) {
    const double slope = dot(p.normal, ray.direction);
    if (slope == 0) continue;
    const double at = dot(p.point - ray.origin, p.normal) / slope;
    if (at >= ray.t_min && at <= ray.t_max && at < t) {
      t = at;
      best = &p;
    }
  }
  return best;
}

std::optional<SurfaceHit> EmbreeSurfaces::first_hit(const Ray& ray, RayRecord& record) const {
  thread_local std::vector<ElementLog> visits;
  visits.clear();
  double plane_t = std::numeric_limits<double>::infinity();
  const PlacedPlane* plane = nearest_plane(ray, plane_t);
  Query q(ray);
  q.visits = &visits;
  double t_end = 0;
  if (clip(padded_bounds_, ray, q.t_start, t_end) && q.t_start < plane_t) {
    q.ray.t_max = std::min(ray.t_max, plane_t);
    RTCRayHit rayhit{};
    rayhit.ray = to_embree(q, std::min(t_end, plane_t));
    rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_.get(), &q, &rayhit);
  }
  record = q.record(std::min(q.best, plane_t));
  if (q.solid == nullptr && plane == nullptr) return {};
  SurfaceHit hit;
  if (q.solid != nullptr) {
    hit.t = q.best;
    hit.position = ray.at(q.best);
    hit.object = solids_[q.geometry].object;
    q.solid->describe(q.element, q.place, ray, hit);
    return hit;
  }
  hit.t = plane_t;
  hit.position = ray.at(plane_t);
  hit.normal = dot(plane->normal, ray.direction) <= 0 ? plane->normal : -plane->normal;
  hit.outside = lifted(hit.position, hit.normal);
  hit.object = plane->object;
  hit.material = plane->material;
  return hit;
}

bool EmbreeSurfaces::occluded(const Ray& ray) const {
  double plane_t = std::numeric_limits<double>::infinity();
  if (nearest_plane(ray, plane_t) != nullptr) return true;
  Query q(ray);
  double t_end = 0;
  if (!clip(padded_bounds_, ray, q.t_start, t_end)) return false;
  RTCRay r = to_embree(q, t_end);
  rtcOccluded1(scene_.get(), &q, &r);
  return r.tfar < 0;
}

}  // namespace marrow
