#include "renderer/geometry/embree_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <embree3/rtcore.h>

#include "renderer/geometry/mesh_solid.h"
#include "renderer/geometry/ray_stream.h"

namespace marrow {
namespace {

std::vector<SolidPart> whole_elements(const Solid& solid) { return solid.Solid::parts(); }

double area_of(const Box3& box) {
  const Vec3d s = box.size();
  return s.x * s.y + s.y * s.z + s.z * s.x;
}

// Kept from call to call, and holding anything.
std::span<PartHierarchy::Hit> hits_of_thread(std::size_t count) {
  thread_local std::vector<PartHierarchy::Hit> hits;
  if (hits.size() < count) hits.resize(count);
  return std::span(hits).first(count);
}

Ray until(const Ray& ray, double t) {
  Ray shorter = ray;
  shorter.t_max = std::min(ray.t_max, t);
  return shorter;
}

}  // namespace

Result<std::unique_ptr<EmbreeSurfaces>> EmbreeSurfaces::make(std::vector<PlacedSolid> solids,
                                                             std::vector<PlacedPlane> planes,
                                                             const std::string& config) {
  std::unique_ptr<EmbreeSurfaces> s(new EmbreeSurfaces(std::move(solids), std::move(planes)));
  s->device_.reset(rtcNewDevice(config.c_str()));
  if (!s->device_) return failure("Embree cannot make a device with \"" + config + "\"");
  auto united = UnitedSolids::make(s->device_.get(), s->solids_);
  if (!united) return united.why();
  s->united_ = std::move(*united);
  std::vector<PartsOfSolid> elements;
  for (const PlacedSolid& p : s->solids_) {
    s->extent_.include(p.solid->extent());
    elements.emplace_back(p.solid.get(), p.object, whole_elements(*p.solid));
    for (const SolidPart& element : elements.back().parts)
      s->smallest_element_ = std::min(s->smallest_element_, longest_side(element.box));
    s->smallest_body_ = std::min(s->smallest_body_, p.solid->smallest_detail());
  }
  auto whole = PartHierarchy::make(s->device_.get(), std::move(elements));
  if (!whole) return whole.why();
  s->whole_ = std::move(*whole);
  s->finest_ = s->whole_.get();
  return s;
}

// Many placements of one blend would each list its parts, of 200 bytes with Embree's: beyond many of them elements stay
// whole. What is thin in its elements, such as neurons, gains so much that twice as many pay, as far as there is room.
void EmbreeSurfaces::refine() const {
  constexpr std::size_t many_parts = std::size_t{1} << 19, most_parts = 2 * many_parts;
  constexpr double thin = 0.375;  // of the area of elements, which is what rays come to; figures in docs/performance.md
  const std::lock_guard lock(refining_);
  std::vector<PartsOfSolid> solids;
  Division division, undivided;
  for (const PlacedSolid& p : solids_) {
    std::vector<SolidPart> parts = p.solid->parts(), whole = whole_elements(*p.solid);
    undivided.add(whole);
    if (division.parts + parts.size() > most_parts) parts = std::move(whole);
    division.add(parts);
    if (division.parts > many_parts && division.area > thin * undivided.area) return;
    solids.emplace_back(p.solid.get(), p.object, parts);
  }
  if (division.is_like(division_)) return;
  division_ = division;
  auto finer = PartHierarchy::make(device_.get(), std::move(solids));
  if (finer) finest_ = refined_.emplace_back(std::move(*finer)).get();
}

EmbreeSurfaces::PlaneHit EmbreeSurfaces::nearest_plane(const Ray& ray) const {
  PlaneHit best;
  for (const PlacedPlane& p : planes_) {
    const double slope = dot(p.normal, ray.direction);
    if (slope == 0) continue;
    const double at = dot(p.point - ray.origin, p.normal) / slope;
    if (at >= ray.t_min && at <= ray.t_max && at < best.t) best = {&p, at};
  }
  return best;
}

void EmbreeSurfaces::Division::add(const std::vector<SolidPart>& of_solid) {
  parts += of_solid.size();
  for (const SolidPart& p : of_solid) area += area_of(p.box);
}

bool EmbreeSurfaces::Division::is_like(const Division& b) const {
  constexpr double much = 0.05;
  return std::fabs(static_cast<double>(parts) - static_cast<double>(b.parts)) <= much * static_cast<double>(b.parts) &&
         std::fabs(area - b.area) <= much * b.area;
}

// Whether the surface of another object passes between a hit and the start of further rays. The ray has not met it, so
// that a plane has the hit on the side where the ray begins.
bool EmbreeSurfaces::is_cut_off(const Ray& ray, const SurfaceHit& hit) const {
  const Vec3d begin = ray.at(ray.t_min);
  for (const PlacedPlane& p : planes_)
    if (dot(p.normal, begin - p.point) * dot(p.normal, hit.outside - p.point) < 0) return true;
  const Vec3d way = hit.outside - hit.position;
  const double reach = length(way);
  if (!united_.may_part(hit.position, hit.outside, hit.object) || !(reach > 0)) return false;
  const PartHierarchy::Hit between =
      finest().any_hit({hit.position, UnitVec3::unchecked(way / reach), 0, reach}, hit.object);
  return between.found && !between.begins_inside;
}

// Where the ray came from nothing is in the way; else nearer to the surface.
void EmbreeSurfaces::uncover_start(std::size_t solid, const Ray& ray, SurfaceHit& hit) const {
  constexpr int most_halvings = 20;
  if (const auto back = united_.start_before(solid, ray, hit)) {
    hit.outside = *back;
    return;
  }
  SurfaceHit nearer = hit;
  for (int i = 0; i < most_halvings; ++i) {
    nearer.outside = hit.position + 0.5 * (nearer.outside - hit.position);
    if (!united_.is_outside(solid, nearer.outside)) return;
    if (is_cut_off(ray, nearer)) continue;
    hit.outside = nearer.outside;
    return;
  }
}

// Of a hit that its solid has described.
void EmbreeSurfaces::free_start(std::size_t solid, const Ray& ray, SurfaceHit& hit) const {
  united_.free_start(solid, ray, hit);
  if (united_.may_be_cut_off(solid) && is_cut_off(ray, hit)) uncover_start(solid, ray, hit);
}

// Hits of one solid that follow each other are described together.
class EmbreeSurfaces::Describing {
 public:
  explicit Describing(const EmbreeSurfaces& surfaces) : surfaces_(surfaces) {}
  Describing(const Describing&) = delete;
  Describing& operator=(const Describing&) = delete;
  ~Describing() { describe(); }

  // The hit must stay where it is until this ends, and the ray, too.
  void add(const PartHierarchy::Hit& found, const Ray& ray, SurfaceHit& hit) {
    const PlacedSolid& placed = surfaces_.solids_[found.solid];
    hit.t = found.t;
    hit.position = ray.at(found.t);
    hit.object = placed.object;
    if (found.solid != solid_ || count_ == waiting_.size()) describe();
    solid_ = found.solid;
    waiting_[count_++] = {found.element, found.place, &ray, &hit};
  }

 private:
  void describe() {
    if (count_ == 0) return;
    const auto hits = std::span(waiting_).first(count_);
    surfaces_.solids_[solid_].solid->describe(hits);
    for (const HitToDescribe& h : hits) surfaces_.free_start(solid_, *h.ray, *h.hit);
    count_ = 0;
  }

  const EmbreeSurfaces& surfaces_;
  std::size_t solid_ = 0;
  std::array<HitToDescribe, 16> waiting_;
  std::size_t count_ = 0;
};

std::optional<SurfaceHit> EmbreeSurfaces::hit_of(const PartHierarchy::Hit& found, const PlaneHit& behind,
                                                 const Ray& ray) const {
  std::optional<SurfaceHit> hit;
  describe(std::span(&found, 1), std::span(&behind, 1), std::span(&ray, 1), std::span(&hit, 1));
  return hit;
}

void EmbreeSurfaces::describe(std::span<const PartHierarchy::Hit> found, std::span<const PlaneHit> behind,
                              std::span<const Ray> rays, std::span<std::optional<SurfaceHit>> hits) const {
  Describing describing(*this);
  for (std::size_t i = 0; i < found.size(); ++i) {
    hits[i].reset();
    if (found[i].found) describing.add(found[i], rays[i], hits[i].emplace());
    else if (!behind.empty() && behind[i].plane != nullptr) describe(behind[i], rays[i], hits[i].emplace());
  }
}

void EmbreeSurfaces::describe(const PlaneHit& of, const Ray& ray, SurfaceHit& hit) {
  const auto& [plane, t] = of;
  hit.t = t;
  hit.position = ray.at(t);
  hit.normal = dot(plane->normal, ray.direction) <= 0 ? plane->normal : -plane->normal;
  hit.outside = lifted(hit.position, plane->point, hit.normal);
  hit.object = plane->object;
  hit.material = plane->material;
}

// Of a ray that begins inside only whole elements tell, and of one that is inside several solids these one by one.
void EmbreeSurfaces::ask_again(PartHierarchy::Hit& found, const Ray& ray, std::vector<RayVisit>* visits) const {
  if (found.begins_inside) {
    if (visits != nullptr) visits->clear();
    found = whole_->first_hit(ray, visits);
  }
  if (!united_.is_covered(found, ray)) return;
  if (visits != nullptr) visits->clear();
  found = united_.first_hit(ray, visits);
}

PartHierarchy::Hit EmbreeSurfaces::nearest_on(const Ray& ray, std::vector<RayVisit>* visits) const {
  PartHierarchy::Hit found = finest().first_hit(ray, visits);
  ask_again(found, ray, visits);
  return found;
}

// Whether the places of a ray are known as finely as surfaces are, in whatever it may come to before its end: to 1e-5
// of the local radius, of which an element has at most sixteen along its side. Else the smallest body may lie beside
// the ray as well as in its way. ray.at() rounds the origin, the way, and their sum.
bool EmbreeSurfaces::is_resolved(const PartHierarchy::Hit& found, double end, const Ray& ray) const {
  if (extent_.empty()) return true;
  constexpr double finest = 1e-5 / 16;
  const double through_all = length(ray.origin - extent_.center()) + 0.5 * length(extent_.size());
  const double rounding = 0x1p-52 * (max_component(abs(ray.origin)) + std::min(end, through_all));
  if (rounding <= finest * smallest_element_) return true;
  if (!(rounding <= finest * smallest_body_)) return false;
  return !found.found || rounding <= finest * longest_side(solids_[found.solid].solid->element_box(found.element));
}

// Whether no surface can have been missed before the end. Where a ray comes to the surface in the face between two
// cells the first of them has an undecided gap at its end, and the second one the hit at its beginning: they are one
// crossing.
bool EmbreeSurfaces::is_decided(const PartHierarchy::Hit& found, double end, const Ray& ray) const {
  if (!(found.undecided < end)) return true;
  if (!found.found || found.reached() != end || found.undecided_in != found.solid) return false;
  const Solid& solid = *solids_[found.solid].solid;
  // Gaps are 2e-5 of the distance at most: what is farther away than this is not worth asking all skeletons for.
  const double before = end - found.undecided;
  return before < 1e-3 * longest_side(solid.element_box(found.element)) &&
         before <= solid.crossing_length(found.element, ray, found.t);
}

// Visits that begin at the end or behind it are made or not as the traversal happens to go: they do not count.
RayRecord EmbreeSurfaces::record_of(const std::vector<RayVisit>& visits, const PartHierarchy::Hit& found,
                                    const PlaneHit& behind, const Ray& ray) const {
  const double end = std::min({found.reached(), behind.t, ray.t_max});
  RayRecord r{.evaluations = 0, .certified = is_decided(found, end, ray) && is_resolved(found, end, ray)};
  for (const RayVisit& v : visits)
    if (v.begin < end) r.evaluations += v.evaluations;
  return r;
}

std::optional<SurfaceHit> EmbreeSurfaces::first_hit(const Ray& ray) const {
  const PlaneHit plane = nearest_plane(ray);
  return hit_of(nearest_on(until(ray, plane.t), nullptr), plane, ray);
}

std::optional<SurfaceHit> EmbreeSurfaces::first_hit(const Ray& ray, RayRecord& record) const {
  thread_local std::vector<RayVisit> visits;
  visits.clear();
  const PlaneHit plane = nearest_plane(ray);
  const PartHierarchy::Hit found = nearest_on(until(ray, plane.t), &visits);
  record = record_of(visits, found, plane, ray);
  return hit_of(found, plane, ray);
}

// Inside a body all that is found before its exit is none of its surface, and any exit may be too far away.
bool EmbreeSurfaces::hides(const PartHierarchy::Hit& any, const Ray& ray) const {
  const bool inside = any.begins_inside || (any.found && united_.begins_inside(ray));
  return inside ? nearest_on(ray, nullptr).found : any.found;
}

bool EmbreeSurfaces::occluded(const Ray& ray) const {
  return nearest_plane(ray).plane != nullptr || hides(finest().any_hit(ray), ray);
}

EmbreeSurfaces::BeforePlanes::BeforePlanes(const EmbreeSurfaces& surfaces, std::span<const Ray> all) : rays(all) {
  if (surfaces.planes_.empty()) return;
  for (const Ray& ray : all) {
    planes_.push_back(surfaces.nearest_plane(ray));
    shorter_.push_back(until(ray, planes_.back().t));
  }
  rays = shorter_;
}

void EmbreeSurfaces::first_hits(std::span<const Ray> rays, std::span<std::optional<SurfaceHit>> hits) const {
  const BeforePlanes before(*this, rays);
  const auto found = hits_of_thread(rays.size());
  stream_first_hits(finest(), before.rays, found, {});
  for (std::size_t i = 0; i < rays.size(); ++i) ask_again(found[i], before.rays[i], nullptr);
  describe(found, before.planes(), rays, hits);
}

void EmbreeSurfaces::first_hits(std::span<const Ray> rays, std::span<std::optional<SurfaceHit>> hits,
                                std::span<RayRecord> records) const {
  thread_local std::vector<std::vector<RayVisit>> visits;
  visits.resize(std::max(visits.size(), rays.size()));
  for (std::size_t i = 0; i < rays.size(); ++i) visits[i].clear();
  const BeforePlanes before(*this, rays);
  const auto found = hits_of_thread(rays.size());
  stream_first_hits(finest(), before.rays, found, std::span(visits).first(rays.size()));
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ask_again(found[i], before.rays[i], &visits[i]);
    records[i] = record_of(visits[i], found[i], before.plane(i), rays[i]);
  }
  describe(found, before.planes(), rays, hits);
}

void EmbreeSurfaces::occluded(std::span<const Ray> rays, std::span<std::uint8_t> hidden) const {
  const auto any = hits_of_thread(rays.size());
  stream_any_hits(finest(), rays, any);
  for (std::size_t i = 0; i < rays.size(); ++i)
    hidden[i] = hides(any[i], rays[i]) || nearest_plane(rays[i]).plane != nullptr ? 1 : 0;
}

}  // namespace marrow
