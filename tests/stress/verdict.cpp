// What rays found, held against the exact field.
#include "tests/stress/verdict.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "tests/stress/hits.h"
#include "tests/stress/ulp_of_float.h"

namespace marrow::test {
namespace {

constexpr std::size_t most_offenders = 4;

std::string text(const StressScene& scene, const Ray& ray, const char* family, const char* what, double amount) {
  char line[640];
  std::snprintf(line, sizeof line, "%s by %.3g: scene %s, %s ray from {%a, %a, %a} along {%a, %a, %a}", what, amount,
                scene.name().c_str(), family, ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x(),
                ray.direction.y(), ray.direction.z());
  return line;
}

void note(std::vector<std::string>& offenders, std::string line) {
  if (offenders.size() < most_offenders) offenders.push_back(std::move(line));
}

void merge(std::vector<std::string>& into, const std::vector<std::string>& more) {
  for (const std::string& line : more) note(into, line);
}

// The part of a ray near the cells: there is nothing elsewhere, as tests of the cells hold.
Ray near_cells(const StressScene& scene, Ray ray) {
  const double size = length(scene.cells().size()), middle = dot(scene.cells().center() - ray.origin, ray.direction);
  ray.t_min = std::max(ray.t_min, middle - size);
  ray.t_max = std::min(ray.t_max, middle + size);
  return ray;
}

// Nearer to a skeleton than this no surface is but at the point of a cone: only its place can be judged there.
double point_size(const StressScene& scene) { return 1e-5 * scene.size(); }

// Whether what is met at t is the very point of a cone, where the field is infinite, and nothing behind it.
bool is_bare_point(const StressScene& scene, const Ray& ray, double t) {
  const double size = point_size(scene);
  return scene.oracle().skeleton_distance(ray.at(t)) < size &&
         scene.oracle().largest_excess(ray, t + size, t + 2 * size) < scene.grazing_excess();
}

// Sums in float are known to this, whatever the tracer does.
constexpr double field_rounding = 5e-7;

void judge_limits(const StressScene& scene, const Ray& ray, const SurfaceHit& hit, double along, const char* family,
                  Verdict& v) {
  const auto ending = [&](double t_max) {
    Ray r = ray;
    r.t_max = t_max;
    return r;
  };
  const double slack = 4 * ulp_of_float(hit.t) + 2 * field_rounding / along;
  const auto at = scene.surfaces().first_hit(ending(hit.t));
  const auto before = scene.surfaces().first_hit(ending(std::nextafter(hit.t, 0)));
  const auto hidden_from = [&](double steps) { return scene.surfaces().occluded(ending(hit.t + steps * slack)); };
  const bool holds = at && at->t == hit.t && !before && !hidden_from(-1) && hidden_from(1) && hidden_from(3) &&
                     hidden_from(10) && hidden_from(30);
  if (holds) return;
  ++v.limits;
  note(v.limit_rays, text(scene, ray, family, "limits not kept at", hit.t));
}

// The hit itself: on the exact surface, in its place on the ray, with a start for further rays that is outside.
void judge_hit(const StressScene& scene, const Ray& ray, const SurfaceHit& hit, const BlendSample& exact,
               const char* family, bool from_afar, Verdict& v) {
  const Vec3d p = ray.at(hit.t);
  const double slope = length(exact.corrected_gradient), distance = scene.oracle().skeleton_distance(p);
  if (distance < point_size(scene)) {
    ++v.points;
    return;
  }
  const double displacement = std::fabs(exact.corrected - 1) / (slope * distance);
  if (displacement < allowed_displacement) {
    v.largest_displacement = std::max(v.largest_displacement, displacement);
  } else if (std::fabs(exact.corrected - 1) < scene.grazing_excess()) {
    ++v.displaced;
  } else {
    ++v.phantom;
    v.far_phantom += std::fabs(exact.corrected - 1) > far_off;
    note(v.phantom_rays, text(scene, ray, family, "phantom hit off", displacement));
  }
  if (const double excess = scene.oracle().value(hit.outside) - 1; !(excess < 0)) {
    ++v.wrong_side;
    note(v.wrong_side_rays, text(scene, ray, family, "further rays start inside", excess));
  }
  const double along = dot(exact.corrected_gradient, ray.direction);
  if (!from_afar || !(along > 0.1 * slope)) return;
  judge_limits(scene, ray, hit, along, family, v);
  ++v.measured;
  const double ulp = ulp_of_float(hit.t), ulps = std::fabs(1 - exact.corrected) / along / ulp;
  v.within_4_ulp += ulps <= 4;
  const bool conditioned = field_rounding / along < 4 * ulp;
  v.conditioned += conditioned;
  v.conditioned_within_4_ulp += conditioned && ulps <= 4;
  v.largest_ulps = std::max(v.largest_ulps, ulps);
}

// Most ways are, and a few places prove it: the oracle would find no root there, or none that is deep enough to count.
bool is_proved_free(const StressScene& scene, const Ray& way, const SurfaceHit* hit) {
  if (!hit || !(hit->t > way.t_max)) return scene.proof().is_outside(way, way.t_min, way.t_max, nullptr);
  const Place there = scene.proof().place(way, hit->t);
  return scene.proof().is_outside(way, way.t_min, way.t_max, &there);
}

// Nothing worth mentioning may be inside before `end`.
void judge_free_way(const StressScene& scene, const Ray& ray, double end, const SurfaceHit* hit, bool certified,
                    const char* family, Verdict& v) {
  Ray before = near_cells(scene, ray);
  before.t_max = std::min(before.t_max, end);
  if (!(before.t_min < before.t_max)) return;
  if (is_proved_free(scene, before, hit)) return;
  const auto root = scene.oracle().first_root(before);
  if (!root) return;
  const double radius = scene.oracle().skeleton_distance(ray.at(*root));
  if (end - *root < std::max(1e-4 * radius, point_size(scene))) return;  // the hit itself
  const double excess = scene.oracle().largest_excess(ray, *root, std::min(end, *root + 4 * radius));
  if (excess < scene.grazing_excess()) {
    ++v.grazing;
    return;
  }
  // Through the very point of a cone, where its radius is 0 and its field infinite, or beside it by a rounding, and not
  // into anything behind it.
  const double behind = *root + point_size(scene);
  if (radius < point_size(scene) &&
      (std::isinf(excess) || !(behind < end) ||
       scene.oracle().largest_excess(ray, behind, std::min(end, behind + 4 * radius + point_size(scene))) <
           scene.grazing_excess())) {
    ++v.points;
    return;
  }
  ++(certified ? v.missed : v.lost);
  note(certified ? v.missed_rays : v.lost_rays, text(scene, ray, family, certified ? "missed" : "lost", excess));
}

// A ray that begins inside meets the surface where it leaves: nothing worth mentioning may be outside before. Where it
// leaves along the surface the field may rise and fall; only of a beginning that is nearly on the surface that tells
// which way the ray came.
bool leaves_from_inside(const StressScene& scene, const Ray& ray, const BlendSample& at_hit) {
  const double depth = scene.oracle().value(ray.at(ray.t_min)) - 1;
  return depth >= scene.grazing_excess() || (depth >= 0 && dot(at_hit.corrected_gradient, ray.direction) < 0);
}

void judge_way_inside(const StressScene& scene, const Ray& ray, double end, bool certified, const char* family,
                      Verdict& v) {
  if (!(ray.t_min < end)) return;
  if (scene.proof().is_inside(ray, ray.t_min, end)) return;
  const double deficit = scene.oracle().largest_deficit(ray, ray.t_min, end);
  if (deficit < scene.grazing_excess()) return;
  ++(certified ? v.missed : v.lost);
  note(certified ? v.missed_rays : v.lost_rays, text(scene, ray, family, "an exit missed", deficit));
}

// How deep the surface is that a ray found at t: of a line that only one way met, whether it is more than a touch.
double depth_after(const StressScene& scene, const Ray& ray, double t, double end) {
  const double radius = scene.oracle().skeleton_distance(ray.at(t));
  return scene.oracle().largest_excess(ray, std::max(0.0, t - 1e-3 * radius), std::min(t + radius, end));
}

}  // namespace

void Verdict::add(const Verdict& b) {
  rays += b.rays;
  hits += b.hits;
  missed += b.missed;
  lost += b.lost;
  phantom += b.phantom;
  far_phantom += b.far_phantom;
  displaced += b.displaced;
  grazing += b.grazing;
  uncertified += b.uncertified;
  wrong_side += b.wrong_side;
  limits += b.limits;
  unlike += b.unlike;
  in_company += b.in_company;
  points += b.points;
  measured += b.measured;
  within_4_ulp += b.within_4_ulp;
  conditioned += b.conditioned;
  conditioned_within_4_ulp += b.conditioned_within_4_ulp;
  evaluations += b.evaluations;
  largest_displacement = std::max(largest_displacement, b.largest_displacement);
  largest_ulps = std::max(largest_ulps, b.largest_ulps);
  merge(missed_rays, b.missed_rays);
  merge(lost_rays, b.lost_rays);
  merge(phantom_rays, b.phantom_rays);
  merge(wrong_side_rays, b.wrong_side_rays);
  merge(limit_rays, b.limit_rays);
}

void judge(const StressScene& scene, const Ray& ray, const char* family, bool from_afar, Verdict& v) {
  RayRecord record;
  const auto hit = scene.surfaces().first_hit(ray, record);
  if (!same(hit, scene.surfaces().first_hit(ray))) {
    ++v.unlike;
    note(v.limit_rays, text(scene, ray, family, "another answer without a record at", hit ? hit->t : 0));
  }
  ++v.rays;
  v.evaluations += record.evaluations;
  v.uncertified += !record.certified;
  if (!hit)
    return judge_free_way(scene, ray, std::numeric_limits<double>::infinity(), nullptr, record.certified, family, v);
  ++v.hits;
  const BlendSample exact = evaluate(scene.blend(), ray.at(hit->t));
  judge_hit(scene, ray, *hit, exact, family, from_afar, v);
  // Just before the hit the steps would creep up to it; what is nearer to it than this is part of the hit.
  const double end = hit->t - 1e-4 * scene.oracle().skeleton_distance(ray.at(hit->t));
  if (leaves_from_inside(scene, ray, exact)) judge_way_inside(scene, ray, end, record.certified, family, v);
  else judge_free_way(scene, ray, end, &*hit, record.certified, family, v);
}

void judge_company(const StressScene& scene, std::span<const Ray> rays, Verdict& v) {
  std::vector<std::optional<SurfaceHit>> hits(rays.size()), recorded(rays.size());
  std::vector<RayRecord> records(rays.size());
  std::vector<std::uint8_t> hidden(rays.size());
  scene.surfaces().first_hits(rays, hits);
  scene.surfaces().first_hits(rays, recorded, records);
  scene.surfaces().occluded(rays, hidden);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    RayRecord record;
    const auto alone = scene.surfaces().first_hit(rays[i], record);
    const bool is_like = same(alone, hits[i]) && same(alone, recorded[i]) &&
                         record.evaluations == records[i].evaluations && record.certified == records[i].certified &&
                         scene.surfaces().occluded(rays[i]) == (hidden[i] != 0);
    ++v.in_company;
    if (is_like) continue;
    ++v.unlike;
    note(v.limit_rays, text(scene, rays[i], "any", "another answer in company at", alone ? alone->t : 0));
  }
}

void Parity::add(const Parity& b) {
  lines += b.lines;
  crossed += b.crossed;
  restarts += b.restarts;
  odd += b.odd;
  odd_lost += b.odd_lost;
  odd_grazing += b.odd_grazing;
  points += b.points;
  merge(odd_rays, b.odd_rays);
  merge(lost_rays, b.lost_rays);
}

void count_crossings(const StressScene& scene, const Ray& line, Random& random, const char* family, Parity& p) {
  const double reach = near_cells(scene, line).t_max;
  const Ray there{line.origin, line.direction, 0, reach}, back = reversed(line, reach);
  if (scene.oracle().value(there.origin) >= 1 || scene.oracle().value(back.origin) >= 1) return;
  RayRecord going, coming;
  const auto entry = scene.surfaces().first_hit(there, going), exit = scene.surfaces().first_hit(back, coming);
  ++p.lines;
  // `ray` met surface at t; the record is that of the ray that met nothing the other way, from `end` on: a mere touch
  // at t is no crossing because of what lies behind `end`.
  const auto one_way_only = [&](const Ray& ray, double t, double end, const RayRecord& empty_handed) {
    if (is_bare_point(scene, ray, t)) {
      ++p.points;
      return;
    }
    const double depth = depth_after(scene, ray, t, end);
    if (depth < scene.grazing_excess()) {
      ++p.odd_grazing;
      return;
    }
    ++(empty_handed.certified ? p.odd : p.odd_lost);
    note(empty_handed.certified ? p.odd_rays : p.lost_rays,
         text(scene, ray, family, "met only one way, inside", depth));
  };
  if (!entry && !exit) return;
  ++p.crossed;
  if (!exit) return one_way_only(there, entry->t, reach, coming);
  if (!entry) return one_way_only(back, exit->t, reach, going);
  const double first = entry->t, last = reach - exit->t;
  for (int i = 0; i < 3; ++i) {
    const double t = random.between(first, last);
    if (!(scene.oracle().value(line.at(t)) < 1 - scene.grazing_excess())) continue;
    ++p.restarts;
    const Ray onward{line.at(t), line.direction, 0, reach - t}, backward{line.at(t), -line.direction, 0, t};
    if (!scene.surfaces().first_hit(onward, going)) one_way_only(back, exit->t, reach - t, going);
    if (!scene.surfaces().first_hit(backward, coming)) one_way_only(there, entry->t, t, coming);
  }
}

}  // namespace marrow::test
