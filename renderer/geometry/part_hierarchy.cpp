#include "renderer/geometry/part_hierarchy.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include <embree3/rtcore.h>

#include "renderer/geometry/box_kernels.h"
#include "renderer/geometry/float_margin.h"
#include "renderer/geometry/ray_in_boxes.h"

namespace marrow {

void EmbreeRelease::operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
void EmbreeRelease::operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }

namespace {

// Embree's t of a place on the ray, behind the place itself, also where that is the ray's beginning: a box that holds a
// nearer hit, or is entered at the same place, must not be skipped.
float embree_t(double t_start, double t) {
  return static_cast<float>((t - t_start) * (1 + float_share)) + std::numeric_limits<float>::min();
}

// A single ray asks each part that it comes to.
struct SingleRay {
  PartVisit visit;
  RayInBoxes boxes{};
  double t_start = 0;  // where the search of boxes begins
};

// Rays of a stream only note them.
struct RaysTogether {
  explicit RaysTogether(const BoxKernels& k) : kernels(k) {}
  const BoxKernels& kernels;
  RaysAmongBoxes rays;  // Embree names them by their lanes
};

// Rides with rays through Embree.
struct Query : RTCIntersectContext {
  explicit Query(SingleRay& ray) : single(&ray) { rtcInitIntersectContext(this); }
  explicit Query(RaysTogether& rays) : together(&rays) { rtcInitIntersectContext(this); }
  SingleRay* single = nullptr;
  RaysTogether* together = nullptr;
  ObjectId left_out;
};

const PartsOfSolid& parts_of(void* user_data) { return *static_cast<const PartsOfSolid*>(user_data); }

void bounds_callback(const RTCBoundsFunctionArguments* a) {
  const PartsOfSolid& p = parts_of(a->geometryUserPtr);
  const auto [lower, upper] = box_in_floats(p.parts[a->primID].box, p.middle, p.margin);
  *a->bounds_o = {lower[0], lower[1], lower[2], 0, upper[0], upper[1], upper[2], 0};
}

constexpr float done = -std::numeric_limits<float>::infinity();  // nothing more is asked of a ray

double t_or_infinity(const std::optional<double>& t) { return t.value_or(std::numeric_limits<double>::infinity()); }

void ask(const RTCIntersectFunctionNArguments* a, const PartsOfSolid& of, const SolidPart& part, SingleRay& ray) {
  if (ray.boxes.in(part.box).empty()) return;
  PartVisit& visit = ray.visit;
  float& t_far = RTCRayN_tfar(RTCRayHitN_RayN(a->rayhit, a->N), a->N, 0);
  ElementLog log = visit.before(*of.solid);
  const auto t = of.solid->hit_in_part(part, *visit.ray, false, log);
  if (visit.take(a->geomID, *of.solid, part, t_or_infinity(t), log)) {
    ray.boxes.end_at(visit.last());
    t_far = embree_t(ray.t_start, visit.best.reached());
  }
  if (log.begins_inside) t_far = done;
}

// What the kernel does for each of a packet.
void note_alone(const Box3& box, long long key, RaysAmongBoxes& rays, std::size_t lane, float& t_far) {
  constexpr std::size_t last = RaysAmongBoxes::most - 1;
  StretchInBox inside{rays.t_min[lane], rays.last[lane]};
  for (std::size_t k = 0; k < 3; ++k)
    inside.clip(box.lower[k], box.upper[k], rays.origin[k][lane], rays.inverse[k][lane]);
  const PartEntry entry{inside.enter, key};
  const auto at = [&](std::size_t i) { return PartEntry{rays.enter[i][lane], rays.key[i][lane]}; };
  const auto put = [&](std::size_t i, const PartEntry& e) {
    rays.enter[i][lane] = e.enter;
    rays.key[i][lane] = e.key;
  };
  if (inside.empty() || entry <= PartEntry{rays.taken_enter[lane], rays.taken_key[lane]} || at(last) < entry) return;
  std::size_t i = last;
  for (; i > 0 && entry < at(i - 1); --i) put(i, at(i - 1));
  put(i, entry);
  t_far = std::min(t_far, embree_t(rays.t_start[lane], rays.enter[last][lane] + rays.late[lane]));
}

void note(const RTCIntersectFunctionNArguments* a, const Box3& box, RaysTogether& together) {
  RTCRayN* rays = RTCRayHitN_RayN(a->rayhit, a->N);
  const long long key = PartEntry::key_of(a->geomID, a->primID);
  if (a->N == RaysAmongBoxes::count) {
    const double lower[3] = {box.lower.x, box.lower.y, box.lower.z}, upper[3] = {box.upper.x, box.upper.y, box.upper.z};
    together.kernels.note(lower, upper, key, a->valid, together.rays, &RTCRayN_tfar(rays, a->N, 0));
    return;
  }
  for (unsigned i = 0; i < a->N; ++i)
    if (a->valid[i] != 0) note_alone(box, key, together.rays, RTCRayN_id(rays, a->N, i), RTCRayN_tfar(rays, a->N, i));
}

void intersect_callback(const RTCIntersectFunctionNArguments* a) {
  const auto& q = *static_cast<const Query*>(a->context);
  const PartsOfSolid& of = parts_of(a->geometryUserPtr);
  const SolidPart& part = of.parts[a->primID];
  if (q.single != nullptr) return ask(a, of, part, *q.single);
  note(a, part.box, *q.together);
}

void occluded_callback(const RTCOccludedFunctionNArguments* a) {
  const auto& q = *static_cast<const Query*>(a->context);
  PartVisit& visit = q.single->visit;
  const PartsOfSolid& of = parts_of(a->geometryUserPtr);
  const SolidPart& part = of.parts[a->primID];
  if (of.object == q.left_out || q.single->boxes.in(part.box).empty()) return;
  ElementLog log = visit.before(*of.solid);
  visit.best.found |= of.solid->hit_in_part(part, *visit.ray, true, log).has_value();
  visit.note_side(*of.solid, log);
  if (visit.best.found || log.begins_inside) RTCRayN_tfar(a->ray, a->N, 0) = done;
}

// For Embree, which takes the inverse of what is smaller for that of +1e-18, also where it is negative: a packet with
// such a ray among others that go down along the axis would lose them all.
float embree_direction(double component) {
  return std::fabs(component) < smallest_component ? 0.0F : static_cast<float>(component);
}

// Makes the ray ready for Embree; false when it misses all boxes.
bool start(const Box3& bounds, const Vec3d& middle, SingleRay& single, RTCRay& out) {
  const Ray& ray = *single.visit.ray;
  single.boxes = {ray, single.visit.last()};
  const StretchInBox inside = single.boxes.in(bounds);
  if (inside.empty()) return false;
  single.t_start = inside.enter;
  const Vec3d origin = ray.at(inside.enter) - middle;
  out.org_x = static_cast<float>(origin.x);
  out.org_y = static_cast<float>(origin.y);
  out.org_z = static_cast<float>(origin.z);
  out.dir_x = embree_direction(ray.direction.x());
  out.dir_y = embree_direction(ray.direction.y());
  out.dir_z = embree_direction(ray.direction.z());
  out.tfar = embree_t(inside.enter, inside.exit);
  out.mask = ~0U;
  return true;
}

void set(RaysAmongBoxes& rays, std::size_t lane, const StreamedRay& of) {
  const Ray& ray = *of.visit.ray;
  for (std::size_t k = 0; k < 3; ++k) {
    rays.origin[k][lane] = ray.origin[k];
    rays.direction[k][lane] = ray.direction.vec()[k];
  }
  rays.t_min[lane] = ray.t_min;
  rays.last[lane] = of.visit.last();
  rays.taken_enter[lane] = of.ahead.taken().enter;
  rays.taken_key[lane] = of.ahead.taken().key;
}

// Behind those that there are their first one stands in, which then goes nowhere.
void set(RaysAmongBoxes& rays, std::span<StreamedRay* const> of) {
  for (std::size_t i = 0; i < of.size(); ++i) set(rays, i, *of[i]);
  for (std::size_t i = of.size(); i < RaysAmongBoxes::count; ++i) {
    set(rays, i, *of[0]);
    rays.last[i] = -std::numeric_limits<double>::infinity();
  }
}

// All that Embree reads of rays that only note parts, but what FloatRays holds.
void set_rest(RTCRayHit16& r) {
  constexpr int count = RaysAmongBoxes::count;
  std::fill_n(r.ray.time, count, 0.0F);
  std::fill_n(r.ray.mask, count, ~0U);
  std::fill_n(r.ray.flags, count, 0U);
  for (unsigned i = 0; i < count; ++i) r.ray.id[i] = i;
  std::fill_n(r.hit.geomID, count, RTC_INVALID_GEOMETRY_ID);
  std::fill_n(r.hit.instID[0], count, RTC_INVALID_GEOMETRY_ID);
}

// One of sixteen.
RTCRayHit alone(RTCRayHit16& all, unsigned lane) {
  RTCRayHit one{};
  one.ray = rtcGetRayFromRayN(reinterpret_cast<RTCRayN*>(&all.ray), RaysAmongBoxes::count, lane);
  one.hit.geomID = one.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return one;
}

// Fewer do not share enough boxes.
constexpr std::size_t worth_a_packet = 3;

const BoxKernels& kernels_beside(RTCDevice device) {
  const auto has = [device](RTCDeviceProperty property) { return rtcGetDeviceProperty(device, property) != 0; };
  return box_kernels(has(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)  ? 16
                     : has(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) ? 8
                                                                      : 4);
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
  std::unique_ptr<PartHierarchy> h(new PartHierarchy(kernels_beside(device), std::move(solids)));
  h->scene_.reset(rtcNewScene(device));
  rtcSetSceneBuildQuality(h->scene_.get(), RTC_BUILD_QUALITY_HIGH);
  Box3 bounds;
  for (const PartsOfSolid& s : h->solids_)
    for (const SolidPart& p : s.parts) bounds.include(p.box);
  if (!bounds.empty()) h->middle_ = bounds.center();
  const double margin = margin_of_floats(bounds, h->middle_, 8);
  h->margin_ = margin;
  h->padded_bounds_ = bounds.padded(margin);
  for (PartsOfSolid& s : h->solids_) {
    for (SolidPart& p : s.parts) p.box = p.box.padded(margin_of_doubles(p.box, margin));
    s.middle = h->middle_;
    s.margin = margin;
    attach(device, h->scene_.get(), s);
  }
  rtcCommitScene(h->scene_.get());
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE) return failure("Embree could not build its hierarchy");
  return h;
}

PartHierarchy::PartHierarchy(const BoxKernels& kernels, std::vector<PartsOfSolid> solids)
    : kernels_(kernels), solids_(std::move(solids)), first_part_{0} {
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
  if (!start(padded_bounds_, middle_, single, rayhit.ray)) return {};
  Query q(single);
  rtcIntersect1(scene_.get(), &q, &rayhit);
  return single.visit.best;
}

PartHierarchy::Hit PartHierarchy::any_hit(const Ray& ray, ObjectId but) const {
  SingleRay single{PartVisit(ray)};
  RTCRay r{};
  if (!start(padded_bounds_, middle_, single, r)) return {};
  Query q(single);
  q.left_out = but;
  rtcOccluded1(scene_.get(), &q, &r);
  return single.visit.best;
}

// Where Embree has no packets of sixteen it takes rays by their intervals, whatever `valid` says: those that are not to
// be asked have none.
void PartHierarchy::find_parts(std::span<StreamedRay* const> rays) const {
  RaysTogether together(kernels_);
  set(together.rays, rays);
  RTCRayHit16 rayhits;
  set_rest(rayhits);
  RTCRay16& r = rayhits.ray;
  const Box3& b = padded_bounds_;
  const BoxKernels::Bounds bounds{
      {b.lower.x, b.lower.y, b.lower.z}, {b.upper.x, b.upper.y, b.upper.z}, {middle_.x, middle_.y, middle_.z}, margin_};
  const auto [in_bounds, neighbours] = kernels_.start(
      bounds, together.rays, {{r.org_x, r.org_y, r.org_z}, {r.dir_x, r.dir_y, r.dir_z}, r.tnear, r.tfar});
  Query q(together);
  if (neighbours && rays.size() >= worth_a_packet) {
    // Boxes are met in the order of the whole packet, which suits neighbours. What a frustum of rays misses each of
    // them misses, up to the same rounding.
    q.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    alignas(64) std::array<int, most_together> valid;
    for (unsigned i = 0; i < most_together; ++i) valid[i] = -static_cast<int>(in_bounds >> i & 1);
    rtcIntersect16(valid.data(), scene_.get(), &q, &rayhits);
  } else {
    for (std::uint32_t left = in_bounds; left != 0; left &= left - 1) {
      RTCRayHit one = alone(rayhits, static_cast<unsigned>(std::countr_zero(left)));
      rtcIntersect1(scene_.get(), &q, &one);
    }
  }
  for (std::size_t i = 0; i < rays.size(); ++i) rays[i]->ahead.set(together.rays, i);
}

}  // namespace marrow
