#include "renderer/geometry/part_hierarchy.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include <embree3/rtcore.h>

namespace marrow {

void EmbreeRelease::operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
void EmbreeRelease::operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }

namespace {

// Below so many rays a packet costs more than it shares.
constexpr int worth_a_packet = 3;

// Rides with the rays through Embree; a single ray is in lane 0 of no packet. Embree names a ray by its lane.
struct Query : RTCIntersectContext {
  Query(PartVisit* of_lanes, const RayPacket* of_rays) : visits(of_lanes), packet(of_rays) {
    rtcInitIntersectContext(this);
    // Boxes are met in the order of the whole packet, which suits neighbours: rays are asked of 5 % more parts than
    // alone instead of 20 %. What a frustum of rays misses each of them misses, up to the same rounding.
    if (packet != nullptr) flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  }
  PartVisit* visits;
  const RayPacket* packet;
};

// Embree's t of a hit, never before the hit itself: a box that holds a nearer one must not be skipped.
float embree_t(const PartVisit& v, double t) {
  return std::nextafter(static_cast<float>((t - v.t_start) * (1 + 1e-6)), std::numeric_limits<float>::infinity());
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

// Embree has met the box of a leaf and asks for all parts in it: which rays come into this one, and where each of them
// is in Embree's arrays, which may be those of the packet or of a single ray of it.
struct Asked {
  unsigned lanes = 0;
  std::array<unsigned, RayPacket::size> at;
};

Asked asked_of(const Query& q, const SolidPart& part, const int* valid, RTCRayN* rays, unsigned count) {
  Asked asked;
  for (unsigned i = 0; i < count; ++i) {
    if (valid[i] == 0) continue;
    const unsigned lane = RTCRayN_id(rays, count, i);
    if (!q.visits[lane].enters(part.box)) continue;
    asked.lanes |= 1U << lane;
    asked.at[lane] = i;
  }
  return asked;
}

// Asks a part for some lanes; `take` gets lane, t (infinity: no hit) and log of each.
template <class Take>
void ask(const Query& q, const Solid& solid, const SolidPart& part, unsigned lanes, bool any, const Take& take) {
  if (std::has_single_bit(lanes)) {
    const int lane = std::countr_zero(lanes);
    const PartVisit& visit = q.visits[lane];
    ElementLog log = visit.before(solid);
    const auto t = solid.hit_in_part(part, visit.ray, any, log);
    take(static_cast<std::size_t>(lane), t.value_or(std::numeric_limits<double>::infinity()), log);
    return;
  }
  PacketLog log;
  for_each_lane(lanes, [&](std::size_t lane) { log.lanes[lane] = q.visits[lane].before(solid); });
  solid.hits_in_part(part, *q.packet, lanes, any, log);
  for_each_lane(lanes, [&](std::size_t lane) { take(lane, log.t[lane], log.lanes[lane]); });
}

void intersect_callback(const RTCIntersectFunctionNArguments* a) {
  const auto& q = *static_cast<const Query*>(a->context);
  const PartsOfSolid& solid = parts_of(a->geometryUserPtr);
  const SolidPart& part = solid.parts[a->primID];
  RTCRayN* rays = RTCRayHitN_RayN(a->rayhit, a->N);
  const Asked asked = asked_of(q, part, a->valid, rays, a->N);
  if (asked.lanes == 0) return;
  ask(q, *solid.solid, part, asked.lanes, false, [&](std::size_t lane, double t, const ElementLog& log) {
    PartVisit& visit = q.visits[lane];
    float& t_far = RTCRayN_tfar(rays, a->N, asked.at[lane]);
    if (visit.take(a->geomID, *solid.solid, part, t, log)) t_far = embree_t(visit, t);
    if (log.begins_inside) t_far = done;
  });
}

void occluded_callback(const RTCOccludedFunctionNArguments* a) {
  const auto& q = *static_cast<const Query*>(a->context);
  const PartsOfSolid& solid = parts_of(a->geometryUserPtr);
  const SolidPart& part = solid.parts[a->primID];
  const Asked asked = asked_of(q, part, a->valid, a->ray, a->N);
  if (asked.lanes == 0) return;
  ask(q, *solid.solid, part, asked.lanes, true, [&](std::size_t lane, double t, const ElementLog&) {
    if (t < std::numeric_limits<double>::infinity()) RTCRayN_tfar(a->ray, a->N, asked.at[lane]) = done;
  });
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

// Makes the ray ready for Embree, as the given one of N; false when it misses all boxes.
bool start(const Box3& bounds, PartVisit& visit, RTCRayN* rays, unsigned count, unsigned lane) {
  double t_end = 0;
  if (!clip(bounds, visit.ray, visit.t_start, t_end)) return false;
  const Vec3d origin = visit.ray.at(visit.t_start);
  RTCRayN_org_x(rays, count, lane) = static_cast<float>(origin.x);
  RTCRayN_org_y(rays, count, lane) = static_cast<float>(origin.y);
  RTCRayN_org_z(rays, count, lane) = static_cast<float>(origin.z);
  RTCRayN_dir_x(rays, count, lane) = static_cast<float>(visit.ray.direction.x());
  RTCRayN_dir_y(rays, count, lane) = static_cast<float>(visit.ray.direction.y());
  RTCRayN_dir_z(rays, count, lane) = static_cast<float>(visit.ray.direction.z());
  RTCRayN_tfar(rays, count, lane) = embree_t(visit, t_end);
  RTCRayN_mask(rays, count, lane) = ~0U;
  RTCRayN_id(rays, count, lane) = lane;
  return true;
}

// A packet of rays on their way. Where Embree has no packets of sixteen it takes rays by their intervals, whatever
// `valid` says: those that are not to be asked get none.
struct Starts {
  Starts(const Box3& bounds, const RayPacket& packet, unsigned lanes, RTCRay16& rays) {
    auto* of_any_count = reinterpret_cast<RTCRayN*>(&rays);
    std::fill_n(rays.tfar, RayPacket::size, done);
    for_each_lane(lanes, [&](std::size_t lane) {
      visits[lane] = PartVisit(packet.ray(lane));
      if (start(bounds, visits[lane], of_any_count, RayPacket::size, static_cast<unsigned>(lane))) valid[lane] = -1;
    });
  }
  alignas(64) std::array<int, RayPacket::size> valid{};
  std::array<PartVisit, RayPacket::size> visits;
};

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

PartHierarchy::Hit PartHierarchy::first_hit(const Ray& ray, std::vector<ElementLog>* logs) const {
  PartVisit visit(ray);
  visit.logs = logs;
  RTCRayHit rayhit{};
  if (!start(padded_bounds_, visit, reinterpret_cast<RTCRayN*>(&rayhit.ray), 1, 0)) return {};
  rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  Query q(&visit, nullptr);
  rtcIntersect1(scene_.get(), &q, &rayhit);
  return visit.best;
}

bool PartHierarchy::occluded(const Ray& ray) const {
  PartVisit visit(ray);
  RTCRay r{};
  if (!start(padded_bounds_, visit, reinterpret_cast<RTCRayN*>(&r), 1, 0)) return false;
  Query q(&visit, nullptr);
  rtcOccluded1(scene_.get(), &q, &r);
  return r.tfar < 0;
}

void PartHierarchy::first_hits(const RayPacket& packet, unsigned lanes, Hits& hits, Logs* logs) const {
  const auto log_of = [logs](std::size_t lane) { return logs == nullptr ? nullptr : &(*logs)[lane]; };
  if (std::popcount(lanes) < worth_a_packet) {
    for_each_lane(lanes, [&](std::size_t lane) { hits[lane] = first_hit(packet.ray(lane), log_of(lane)); });
    return;
  }
  RTCRayHit16 rayhits{};
  Starts starts(padded_bounds_, packet, lanes, rayhits.ray);
  std::fill_n(rayhits.hit.geomID, RayPacket::size, RTC_INVALID_GEOMETRY_ID);
  std::fill_n(rayhits.hit.instID[0], RayPacket::size, RTC_INVALID_GEOMETRY_ID);
  for_each_lane(lanes, [&](std::size_t lane) { starts.visits[lane].logs = log_of(lane); });
  Query q(starts.visits.data(), &packet);
  rtcIntersect16(starts.valid.data(), scene_.get(), &q, &rayhits);
  for_each_lane(lanes, [&](std::size_t lane) { hits[lane] = starts.visits[lane].best; });
}

unsigned PartHierarchy::occluded(const RayPacket& packet, unsigned lanes) const {
  unsigned hidden = 0;
  if (std::popcount(lanes) < worth_a_packet) {
    for_each_lane(lanes,
                  [&](std::size_t lane) { hidden |= static_cast<unsigned>(occluded(packet.ray(lane))) << lane; });
    return hidden;
  }
  RTCRay16 rays{};
  Starts starts(padded_bounds_, packet, lanes, rays);
  Query q(starts.visits.data(), &packet);
  rtcOccluded16(starts.valid.data(), scene_.get(), &q, &rays);
  for_each_lane(lanes, [&](std::size_t lane) {
    hidden |= static_cast<unsigned>(starts.valid[lane] != 0 && rays.tfar[lane] < 0) << lane;
  });
  return hidden;
}

std::size_t PartHierarchy::part_count() const {
  std::size_t sum = 0;
  for (const PartsOfSolid& s : solids_) sum += s.parts.size();
  return sum;
}

}  // namespace marrow
