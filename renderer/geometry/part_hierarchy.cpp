#include "renderer/geometry/part_hierarchy.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include <embree3/rtcore.h>

#include "renderer/geometry/rays_in_boxes.h"

namespace marrow {

void EmbreeRelease::operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
void EmbreeRelease::operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }

namespace {

// Embree's t of a place on the ray, behind the place itself, also where that is the ray's beginning: a box that holds a
// nearer hit, or is entered at the same place, must not be skipped.
float embree_t(double t_start, double t) {
  return static_cast<float>((t - t_start) * (1 + 1e-6)) + std::numeric_limits<float>::min();
}

// A single ray asks each part that it comes to.
struct SingleRay {
  PartVisit visit;
  RaysInBoxes<1> boxes{};
  double t_start = 0;  // where the search of boxes begins
};

// Rays of a stream only note them.
struct RaysTogether {
  static constexpr std::size_t count = PartHierarchy::most_together;
  RaysInBoxes<count> boxes;
  std::array<double, count> t_start;
  std::array<double, count> late;  // floats may come into a box, or out of it, by so much off from doubles
  std::array<NearestParts*, count> ahead;

  // Behind what is found by now nothing more need be found: as floats come into boxes, or a nearer part would be lost
  // that they come into too late.
  void note(std::size_t ray, const PartEntry& entry, float& t_far) const {
    NearestParts& parts = *ahead[ray];
    parts.add(entry);
    if (parts.full()) t_far = std::min(t_far, embree_t(t_start[ray], parts.end() + late[ray]));
  }
};

// Rides with rays through Embree.
struct Query : RTCIntersectContext {
  explicit Query(SingleRay& ray) : single(&ray) { rtcInitIntersectContext(this); }
  explicit Query(const RaysTogether& rays) : together(&rays) { rtcInitIntersectContext(this); }
  SingleRay* single = nullptr;
  const RaysTogether* together = nullptr;  // Embree names a ray by its place here
  ObjectId left_out;
};

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

double t_or_infinity(const std::optional<double>& t) { return t.value_or(std::numeric_limits<double>::infinity()); }

void ask(const RTCIntersectFunctionNArguments* a, const PartsOfSolid& of, const SolidPart& part, SingleRay& ray) {
  if (ray.boxes.in(part.box, 0).empty()) return;
  PartVisit& visit = ray.visit;
  float& t_far = RTCRayN_tfar(RTCRayHitN_RayN(a->rayhit, a->N), a->N, 0);
  ElementLog log = visit.before(*of.solid);
  const auto t = of.solid->hit_in_part(part, *visit.ray, false, log);
  if (visit.take(a->geomID, *of.solid, part, t_or_infinity(t), log)) {
    ray.boxes.end_at(0, visit.last());
    t_far = embree_t(ray.t_start, visit.best.t);
  }
  if (log.begins_inside) t_far = done;
}

// Neighbours in a packet are all asked for, for most of them come into the box.
void note_all(const RTCIntersectFunctionNArguments* a, const Box3& box, const RaysTogether& rays, RTCRayN* of_embree) {
  const auto entries = rays.boxes.in(box);
  for (std::uint32_t left = entries.in_box; left != 0; left &= left - 1) {
    const auto i = static_cast<unsigned>(std::countr_zero(left));
    if (a->valid[i] != 0)
      rays.note(i, {.enter = entries.enter[i], .solid = a->geomID, .part = a->primID},
                RTCRayN_tfar(of_embree, a->N, i));
  }
}

void note_one_by_one(const RTCIntersectFunctionNArguments* a, const Box3& box, const RaysTogether& rays,
                     RTCRayN* of_embree) {
  for (unsigned i = 0; i < a->N; ++i) {
    if (a->valid[i] == 0) continue;
    const unsigned ray = RTCRayN_id(of_embree, a->N, i);
    const StretchInBox inside = rays.boxes.in(box, ray);
    if (!inside.empty())
      rays.note(ray, {.enter = inside.enter, .solid = a->geomID, .part = a->primID}, RTCRayN_tfar(of_embree, a->N, i));
  }
}

void intersect_callback(const RTCIntersectFunctionNArguments* a) {
  const auto& q = *static_cast<const Query*>(a->context);
  const PartsOfSolid& of = parts_of(a->geometryUserPtr);
  const SolidPart& part = of.parts[a->primID];
  if (q.single != nullptr) return ask(a, of, part, *q.single);
  RTCRayN* rays = RTCRayHitN_RayN(a->rayhit, a->N);
  if (a->N == RaysTogether::count) note_all(a, part.box, *q.together, rays);
  else note_one_by_one(a, part.box, *q.together, rays);
}

void occluded_callback(const RTCOccludedFunctionNArguments* a) {
  const auto& q = *static_cast<const Query*>(a->context);
  PartVisit& visit = q.single->visit;
  const PartsOfSolid& of = parts_of(a->geometryUserPtr);
  const SolidPart& part = of.parts[a->primID];
  if (of.object == q.left_out || q.single->boxes.in(part.box, 0).empty()) return;
  ElementLog log = visit.before(*of.solid);
  visit.best.found |= of.solid->hit_in_part(part, *visit.ray, true, log).has_value();
  visit.note_side(*of.solid, log);
  if (visit.best.found || log.begins_inside) RTCRayN_tfar(a->ray, a->N, 0) = done;
}

// For Embree, which takes the inverse of what is smaller for that of +1e-18, also where it is negative: a packet with
// such a ray among others that go down along the axis would lose them all.
float embree_direction(double component) {
  constexpr double smallest = 1.01e-18;
  return std::fabs(component) < smallest ? 0.0F : static_cast<float>(component);
}

// Makes the ray ready for Embree, as the given one of `count`, where it is in the bounds of all boxes.
void start(const Ray& ray, const StretchInBox& inside, RTCRayN* rays, unsigned count, unsigned lane) {
  const Vec3d origin = ray.at(inside.enter);
  RTCRayN_org_x(rays, count, lane) = static_cast<float>(origin.x);
  RTCRayN_org_y(rays, count, lane) = static_cast<float>(origin.y);
  RTCRayN_org_z(rays, count, lane) = static_cast<float>(origin.z);
  RTCRayN_dir_x(rays, count, lane) = embree_direction(ray.direction.x());
  RTCRayN_dir_y(rays, count, lane) = embree_direction(ray.direction.y());
  RTCRayN_dir_z(rays, count, lane) = embree_direction(ray.direction.z());
  RTCRayN_tfar(rays, count, lane) = embree_t(inside.enter, inside.exit);
  RTCRayN_mask(rays, count, lane) = ~0U;
  RTCRayN_id(rays, count, lane) = lane;
}

// False when it misses all boxes.
bool start(const Box3& bounds, SingleRay& single, RTCRayN* rays) {
  single.boxes.set(0, *single.visit.ray, single.visit.last());
  const StretchInBox inside = single.boxes.in(bounds, 0);
  if (inside.empty()) return false;
  single.t_start = inside.enter;
  start(*single.visit.ray, inside, rays, 1, 0);
  return true;
}

// The margin of boxes as a way along the ray: before a place that is within a box, floats are in its padded one.
double margin_along(const UnitVec3& direction, double margin) {
  double least = 1;
  for (const double d : {direction.x(), direction.y(), direction.z()})
    if (d != 0) least = std::min(least, std::fabs(d));
  return margin / least;
}

// The same of a ray that may have been through some parts. The float search of boxes must not lose those that it comes
// into at the same place.
bool start(const Box3& bounds, double margin, StreamedRay& streamed, RaysTogether& together, RTCRayN* rays,
           unsigned count, unsigned lane) {
  const Ray& ray = *streamed.visit.ray;
  together.boxes.set(lane, ray, streamed.visit.last());
  const StretchInBox inside = together.boxes.in(bounds, lane);
  if (inside.empty()) return false;
  start(ray, inside, rays, count, lane);
  together.ahead[lane] = &streamed.ahead;
  together.t_start[lane] = inside.enter;
  together.late[lane] = margin_along(ray.direction, margin);
  const double gone = (streamed.ahead.beginning() - inside.enter) * (1 - 1e-6) - together.late[lane];
  if (gone > 0) RTCRayN_tnear(rays, count, lane) = static_cast<float>(gone);
  return true;
}

// Neighbours of one direction: then a packet shares most of its boxes.
bool go_together(std::span<StreamedRay* const> rays) {
  constexpr std::size_t worth_a_packet = 3;
  constexpr double least_cosine = 0.99;
  return rays.size() >= worth_a_packet && std::ranges::all_of(rays, [&](const StreamedRay* r) {
           return dot(r->visit.ray->direction, rays[0]->visit.ray->direction) >= least_cosine;
         });
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
  h->margin_ = margin;
  h->padded_bounds_ = bounds.padded(margin);
  for (PartsOfSolid& s : h->solids_) {
    for (SolidPart& p : s.parts) p.box = p.box.padded(margin);
    attach(device, h->scene_.get(), s);
  }
  rtcCommitScene(h->scene_.get());
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE) return failure("Embree could not build its hierarchy");
  return h;
}

PartHierarchy::PartHierarchy(std::vector<PartsOfSolid> solids) : solids_(std::move(solids)), first_part_{0} {
  for (const PartsOfSolid& s : solids_) {
    first_part_.push_back(first_part_.back() + static_cast<std::uint32_t>(s.parts.size()));
    traces_packets_ |= s.solid->traces_packets();
  }
}

PartHierarchy::Hit PartHierarchy::first_hit(const Ray& ray, std::vector<RayVisit>* visits) const {
  SingleRay single{PartVisit(ray)};
  single.visit.visits = visits;
  RTCRayHit rayhit{};
  rayhit.hit.geomID = rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  if (!start(padded_bounds_, single, reinterpret_cast<RTCRayN*>(&rayhit.ray))) return {};
  Query q(single);
  rtcIntersect1(scene_.get(), &q, &rayhit);
  return single.visit.best;
}

PartHierarchy::Hit PartHierarchy::any_hit(const Ray& ray, ObjectId but) const {
  SingleRay single{PartVisit(ray)};
  RTCRay r{};
  if (!start(padded_bounds_, single, reinterpret_cast<RTCRayN*>(&r))) return {};
  Query q(single);
  q.left_out = but;
  rtcOccluded1(scene_.get(), &q, &r);
  return single.visit.best;
}

void PartHierarchy::find_parts(std::span<StreamedRay* const> rays) const {
  RaysTogether together;
  Query q(together);
  if (!go_together(rays)) {
    for (StreamedRay* streamed : rays) {
      RTCRayHit rayhit{};
      auto* ray = reinterpret_cast<RTCRayN*>(&rayhit.ray);
      rayhit.hit.geomID = rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      if (start(padded_bounds_, margin_, *streamed, together, ray, 1, 0)) rtcIntersect1(scene_.get(), &q, &rayhit);
    }
    return;
  }
  // Boxes are met in the order of the whole packet, which suits neighbours. What a frustum of rays misses each of them
  // misses, up to the same rounding.
  q.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(64) std::array<int, most_together> valid{};
  RTCRayHit16 rayhits{};
  // Where Embree has no packets of sixteen it takes rays by their intervals, whatever `valid` says: those that are not
  // to be asked get none.
  std::fill_n(rayhits.ray.tfar, most_together, done);
  std::fill_n(rayhits.hit.geomID, most_together, RTC_INVALID_GEOMETRY_ID);
  std::fill_n(rayhits.hit.instID[0], most_together, RTC_INVALID_GEOMETRY_ID);
  for (unsigned i = 0; i < rays.size(); ++i)
    if (start(padded_bounds_, margin_, *rays[i], together, reinterpret_cast<RTCRayN*>(&rayhits.ray), most_together, i))
      valid[i] = -1;
  for (std::size_t i = rays.size(); i < most_together; ++i) together.boxes.set(i, *rays[0]->visit.ray, 0);
  rtcIntersect16(valid.data(), scene_.get(), &q, &rayhits);
}

}  // namespace marrow
