// What rays found in a scene of a general tree, held against samples of the exact field.
#include "tests/stress/tree_verdict.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

#include "field/program/field_program.h"
#include "tests/stress/change_search.h"
#include "tests/stress/hits.h"
#include "tests/stress/ulp_of_float.h"

namespace marrow::test {
namespace {

constexpr std::size_t most_offenders = 40;

void note(TreeVerdict& v, const TreeScene& scene, const Ray& ray, const char* family, const char* what, double amount) {
  if (v.offenders.size() >= most_offenders) return;
  char line[640];
  std::snprintf(line, sizeof line, "%s %.3g: %s, %s ray from {%a, %a, %a} along {%a, %a, %a}", what, amount,
                scene.name().c_str(), family, ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x(),
                ray.direction.y(), ray.direction.z());
  v.offenders.emplace_back(line);
}

// The part of a ray around the cells, and as much again.
Interval way_of(const TreeScene& scene, const Ray& ray) {
  const double middle = dot(scene.center() - ray.origin, ray.direction), reach = 2 * scene.size();
  return {std::max(0.0, middle - reach), std::max(0.0, middle + reach)};
}

struct Slopes {
  double value, along, steepness;
};
Slopes slopes_at(const TreeScene& scene, const Ray& ray, double t) {
  const FieldSample f = value_and_gradient(scene.tree(), ray.at(t));
  return {f.value, std::fabs(dot(f.gradient, ray.direction.vec())), length(f.gradient)};
}

// By which places of a ray may be off.
double position_error(const TreeScene& scene, const Ray& ray) {
  return 16 * rounding::ulp * std::max(largest_coordinate(scene.cells()), max_component(abs(ray.origin)));
}

// Where a ray that begins on the surface, to within what sums and coordinates tell, is clearly on one side.
double decided_from(const TreeScene& scene, const Ray& ray) {
  const double moved = position_error(scene, ray);
  const auto is_decided = [&](double t) {
    const Slopes at = slopes_at(scene, ray, t);
    return std::fabs(at.value - 1) > scene.noticed() + moved * at.steepness;
  };
  if (is_decided(0)) return 0;
  double t = 1e-12 * scene.size();
  while (t < 0.1 * scene.size() && !is_decided(t)) t *= 2;
  return t;
}

// How far the errors of sums, of positions in double and of floats move a hit.
double slack_of(const TreeScene& scene, const Ray& ray, double t, const Slopes& at) {
  const double off = position_error(scene, ray);
  const double moved = at.along > 0 ? (scene.sum_error() + off * at.steepness) / at.along : 0;
  return std::min(4 * ulp_of_float(t) + moved + off, 1e-3 * scene.size());
}

bool changes_near(const ChangeSearch& along, double t, double slack) {
  const bool inside = along.is_inside(t);
  for (double step = slack; step > 0x1p-54 * std::fabs(t) && step > 1e-6 * slack; step /= 4)
    if (along.is_inside(t - step) != inside || along.is_inside(t + step) != inside) return true;
  return false;
}

void judge_limits(const TreeScene& scene, const Ray& ray, const SurfaceHit& hit, double slack, const char* family,
                  TreeVerdict& v) {
  const auto ending = [&](double t_max) {
    Ray r = ray;
    r.t_max = t_max;
    return r;
  };
  const auto at = scene.surfaces().first_hit(ending(hit.t));
  const auto before = scene.surfaces().first_hit(ending(std::nextafter(hit.t, 0)));
  // What is left again within the slack may be found or not.
  const ChangeSearch along(scene.tree(), ray);
  const bool is_deep = along.is_inside(hit.t + slack) && along.depth(hit.t, hit.t + slack) > scene.noticed();
  if (at && at->t == hit.t && !before && (!is_deep || scene.surfaces().occluded(ending(hit.t + slack))) &&
      !scene.surfaces().occluded(ending(hit.t - slack)))
    return;
  ++v.limits;
  note(v, scene, ray, family, "limits not kept at", hit.t);
}

void judge_ulps(const TreeScene& scene, const ChangeSearch& along, const SurfaceHit& hit, const Slopes& slopes,
                TreeVerdict& v) {
  const double ulp = ulp_of_float(hit.t);
  if (scene.sum_error() > 4 * ulp * slopes.along) return;
  ++v.conditioned;
  v.within_4_ulp += changes_near(along, hit.t, 4 * ulp);
}

void judge_hit(const TreeScene& scene, const Ray& ray, const SurfaceHit& hit, const char* family, bool from_afar,
               TreeVerdict& v) {
  const ChangeSearch along(scene.tree(), ray);
  const Slopes slopes = slopes_at(scene, ray, hit.t);
  const double slack = slack_of(scene, ray, hit.t, slopes);
  if (!changes_near(along, hit.t, slack)) {
    const double rounded = 16 * rounding::ulp * max_component(abs(hit.position)) * slopes.steepness;
    const bool is_off = !(std::fabs(slopes.value - 1) < scene.noticed() + rounded) &&
                        !(scene.value(hit.position - hit.normal * scene.noticed_beside()) >= 1);
    ++(is_off ? v.phantom : v.grazing);
    if (is_off) note(v, scene, ray, family, "phantom", slopes.value - 1);
  }
  if (!(scene.value(hit.outside) < 1)) {
    ++v.wrong_side;
    note(v, scene, ray, family, "starts inside by", scene.value(hit.outside) - 1);
  }
  if (!from_afar || !(slopes.along > 0.1 * slopes.steepness)) return;
  judge_limits(scene, ray, hit, slack, family, v);
  // Beside an edge the field may fall to both sides from just below 1, however steep: such hits are in `grazing`.
  if (has_traced_blends(scene.kind()) && !changes_near(along, hit.t, slack)) return;
  judge_ulps(scene, along, hit, slopes, v);
}

// Nothing worth mentioning may change sides before `end`.
void judge_way(const TreeScene& scene, const Ray& ray, const Interval& way, std::span<const double> places,
               bool certified, const char* family, TreeVerdict& v) {
  ChangeSearch search(scene.tree(), ray);
  const auto change = search.first(way.lo, way.hi, places);
  v.unjudged += search.gave_up();
  if (!change) return;
  const double depth = search.depth(*change, way.hi);
  if (depth < scene.noticed()) {
    ++v.grazing;
    return;
  }
  ++(certified ? v.missed : v.lost);
  note(v, scene, ray, family, certified ? "missed" : "lost", depth);
}

}  // namespace

void TreeVerdict::add(const TreeVerdict& b) {
  for (std::uint64_t TreeVerdict::*count :
       {&TreeVerdict::rays, &TreeVerdict::hits, &TreeVerdict::missed, &TreeVerdict::lost, &TreeVerdict::phantom,
        &TreeVerdict::wrong_side, &TreeVerdict::limits, &TreeVerdict::grazing, &TreeVerdict::uncertified,
        &TreeVerdict::unjudged, &TreeVerdict::conditioned, &TreeVerdict::within_4_ulp, &TreeVerdict::evaluations,
        &TreeVerdict::lines, &TreeVerdict::odd, &TreeVerdict::odd_lost})
    this->*count += b.*count;
  for (const std::string& line : b.offenders)
    if (offenders.size() < most_offenders) offenders.push_back(line);
}

void judge(const TreeScene& scene, const AimedRay& aimed, const char* family, bool from_afar, TreeVerdict& v) {
  const Ray& ray = aimed.ray;
  RayRecord record;
  const auto hit = scene.surfaces().first_hit(ray, record);
  ++v.rays;
  v.evaluations += record.evaluations;
  v.uncertified += !record.certified;
  if (!same(hit, scene.surfaces().first_hit(ray))) {
    ++v.limits;
    note(v, scene, ray, family, "another answer without a record at", hit ? hit->t : 0);
  }
  Interval way = way_of(scene, ray);
  way.lo = std::max(way.lo, decided_from(scene, ray));
  std::array<double, 3> places{aimed.aim, way.hi, way.hi};
  if (const auto back = scene.surfaces().first_hit(reversed(ray, way.hi))) places[1] = way.hi - back->t;
  if (hit) {
    ++v.hits;
    judge_hit(scene, ray, *hit, family, from_afar, v);
    places[2] = hit->t;
    way.hi = hit->t - slack_of(scene, ray, hit->t, slopes_at(scene, ray, hit->t));
  }
  judge_way(scene, ray, way, places, record.certified, family, v);
}

void judge_line(const TreeScene& scene, const AimedRay& line, Random& random, const char* family, TreeVerdict& v) {
  const double reach = way_of(scene, line.ray).hi;
  const Ray& there = line.ray;
  const Ray back = reversed(there, reach);
  if (scene.value(there.origin) >= 1 || scene.value(back.origin) >= 1) return;
  RayRecord going, coming;
  const auto entry = scene.surfaces().first_hit(there, going), exit = scene.surfaces().first_hit(back, coming);
  if (!entry && !exit) return;
  ++v.lines;
  // `ray` met surface at t; the record is that of the ray that met nothing the other way.
  const auto one_way_only = [&](const Ray& ray, double t, const RayRecord& empty_handed) {
    const ChangeSearch along(scene.tree(), ray);
    const double slack = slack_of(scene, ray, t, slopes_at(scene, ray, t));
    const double depth = along.is_inside(t + slack) ? along.depth(t + slack, t + 1e-2 * scene.size()) : 0;
    if (depth < scene.noticed()) return;
    ++(empty_handed.certified ? v.odd : v.odd_lost);
    note(v, scene, ray, family, empty_handed.certified ? "odd" : "odd, lost", depth);
  };
  if (!exit) return one_way_only(there, entry->t, coming);
  if (!entry) return one_way_only(back, exit->t, going);
  const double first = entry->t, last = reach - exit->t;
  for (int i = 0; i < 3; ++i) {
    const double t = random.between(first, last);
    if (!(scene.value(there.at(t)) < 1 - scene.noticed())) continue;
    const Ray onward{there.at(t), there.direction, 0, reach - t}, backward{there.at(t), -there.direction, 0, t};
    if (!scene.surfaces().first_hit(onward, going)) one_way_only(back, exit->t, going);
    if (!scene.surfaces().first_hit(backward, coming)) one_way_only(there, entry->t, coming);
  }
}

}  // namespace marrow::test
