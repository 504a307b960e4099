// Embree's own primitives: the limit that an exact tracer of these skeletons is held against, and the meshed rival.
#include <cstring>
#include <limits>
#include <string>

#include <embree3/rtcore.h>

#include "renderer/bench/ray_engine.h"
#include "renderer/geometry/embree_handles.h"

namespace marrow {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

RTCRay to_embree(const Ray& ray) {
  RTCRay r{};
  r.org_x = static_cast<float>(ray.origin.x);
  r.org_y = static_cast<float>(ray.origin.y);
  r.org_z = static_cast<float>(ray.origin.z);
  r.dir_x = static_cast<float>(ray.direction.x());
  r.dir_y = static_cast<float>(ray.direction.y());
  r.dir_z = static_cast<float>(ray.direction.z());
  r.tfar = infinity;
  r.mask = ~0U;
  return r;
}

class EmbreeEngine final : public RayEngine {
 public:
  /// Rays leave at a distance, as is usual for float geometry.
  EmbreeEngine(int threads, double offset)
      : offset_(offset),
        device_(rtcNewDevice(("threads=" + std::to_string(threads)).c_str())),
        scene_(rtcNewScene(device_.get())) {
    rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_HIGH);
  }

  bool first_hit(const Ray& ray, EngineHit& hit, RayCounts&) const override {
    RTCRayHit query{};
    query.ray = to_embree(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene_.get(), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    Vec3d normal{query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z};
    normal *= 1 / length(normal);
    if (dot(normal, ray.direction) > 0) normal = -normal;
    hit.position = ray.at(static_cast<double>(query.ray.tfar));
    hit.normal = UnitVec3::unchecked(normal);
    hit.outside = hit.position + normal * offset_;
    return true;
  }
  bool occluded(const Ray& ray) const override {
    RTCRay query = to_embree(ray);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene_.get(), &context, &query);
    return query.tfar < 0;
  }

  RTCGeometry geometry(RTCGeometryType type) { return rtcNewGeometry(device_.get(), type); }
  void attach(RTCGeometry g) {
    rtcCommitGeometry(g);
    rtcAttachGeometry(scene_.get(), g);
    rtcReleaseGeometry(g);
  }
  bool commit() {
    rtcCommitScene(scene_.get());
    return rtcGetDeviceError(device_.get()) == RTC_ERROR_NONE;
  }

 private:
  double offset_;
  EmbreeDevice device_;
  EmbreeScene scene_;
};

struct Sphere {
  float x, y, z, radius;
};
Sphere sphere(const Vec3d& p, double radius) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z), static_cast<float>(radius)};
}

// Embree's own memory, so that no buffer of ours has to outlive the scene.
template <class T>
void fill(RTCGeometry g, RTCBufferType type, RTCFormat format, const std::vector<T>& values) {
  void* buffer = rtcSetNewGeometryBuffer(g, type, 0, format, sizeof(T), values.size());
  std::memcpy(buffer, values.data(), values.size() * sizeof(T));
}

void attach_cones(EmbreeEngine& engine, const std::vector<SegmentSkeleton>& segments) {
  std::vector<Sphere> ends;
  std::vector<unsigned> first;
  for (const SegmentSkeleton& s : segments) {
    first.push_back(static_cast<unsigned>(ends.size()));
    ends.push_back(sphere(s.from, s.radius_from));
    ends.push_back(sphere(s.to, s.radius_to));
  }
  RTCGeometry g = engine.geometry(RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE);
  fill(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, ends);
  fill(g, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT, first);
  fill(g, RTC_BUFFER_TYPE_FLAGS, RTC_FORMAT_UCHAR, std::vector<unsigned char>(first.size()));
  engine.attach(g);
}

void attach_spheres(EmbreeEngine& engine, const std::vector<PointSkeleton>& points) {
  std::vector<Sphere> spheres;
  for (const PointSkeleton& p : points) spheres.push_back(sphere(p.at, p.radius));
  RTCGeometry g = engine.geometry(RTC_GEOMETRY_TYPE_SPHERE_POINT);
  fill(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, spheres);
  engine.attach(g);
}

}  // namespace

std::unique_ptr<RayEngine> embree_round_cones(const Workload& workload, int threads) {
  auto engine = std::make_unique<EmbreeEngine>(threads, workload.thinnest_radius() / 20);
  if (!workload.segments.empty()) attach_cones(*engine, workload.segments);
  if (!workload.points.empty()) attach_spheres(*engine, workload.points);
  if (!engine->commit()) return nullptr;
  return engine;
}

std::unique_ptr<RayEngine> embree_triangles(const TriangleMesh& mesh, double offset, int threads) {
  auto engine = std::make_unique<EmbreeEngine>(threads, offset);
  RTCGeometry g = engine->geometry(RTC_GEOMETRY_TYPE_TRIANGLE);
  fill(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.vertices);
  fill(g, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles);
  engine->attach(g);
  if (!engine->commit()) return nullptr;
  return engine;
}

}  // namespace marrow
