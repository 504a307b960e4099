// stress [--rays N] [--lines N] [--first SCENE] [--scenes N] [--varied N] [--odd N] [--threads N]: hard rays through
// hard scenes, every one judged. Prints what was counted, and exits 1 if a surface was missed or made up, or a start
// lies inside. Scene numbers are seeds; the scenes share the rays and the lines evenly.
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include "tests/stress/number_options.h"
#include "tests/stress/ray_families.h"
#include "tests/stress/verdict.h"

namespace {

using namespace marrow;
using namespace marrow::test;

struct Job {
  std::uint64_t rays = 100'000, lines = 10'000, first = 1, scenes = 100, varied = 20, odd = 24;
  std::uint64_t threads = 2;
};

struct Outcome {
  std::vector<Verdict> families = std::vector<Verdict>(family_count);
  std::vector<Parity> lines = std::vector<Parity>(family_count);
  std::vector<Verdict> kinds = std::vector<Verdict>(kind_names.size());
  std::vector<Parity> kind_lines = std::vector<Parity>(kind_names.size());
};

// Odd scenes are others for other first scenes.
std::uint64_t scene_number(const Job& job, std::uint64_t i) {
  if (i < job.scenes) return job.first + i;
  i -= job.scenes;
  return i < job.varied ? first_varied_scene + i : first_odd_scene + job.first + i - job.varied;
}

Outcome run_scene(const Job& job, std::uint64_t number) {
  Outcome out;
  const StressScene scene(number);
  Random random = Random::stream(number), company = Random::stream(~number);
  // A sample of a varying angle takes ten times as long, and the oracle's of many skeletons too.
  const std::uint64_t share = scene.has_varied_angle() || scene.is_odd() ? 10 : 1;
  const std::uint64_t rays = job.rays / job.scenes / share, lines = job.lines / job.scenes / share;
  for (std::uint64_t i = 0; i < rays; ++i) {
    if (i == rays / 8 || i == rays / 2) scene.surfaces().refine();
    const std::size_t f = i % family_count;
    judge(scene, ray_of(static_cast<Family>(f), random, scene), family_names[f], f < line_family_count,
          out.families[f]);
    if (i % 400 == 399 || i + 1 == rays) judge_company(scene, company_of(company, scene), out.families[f]);
  }
  for (const Verdict& v : out.families) out.kinds[scene.kind()].add(v);
  for (std::uint64_t i = 0; i < lines; ++i) {
    const std::size_t f = i % line_family_count;
    count_crossings(scene, ray_of(static_cast<Family>(f), random, scene), random, family_names[f], out.lines[f]);
  }
  for (const Parity& p : out.lines) out.kind_lines[scene.kind()].add(p);
  return out;
}

// Not held to 0 yet: rays from the exact surface of limbs that nearly touch (1 of 1.6 10^5 rays was lost, and said so),
// and single hits that are off by more than 4 ulp though sums in float would tell them (1 of 78,108).
// Room for chance: of 8 10^6 rays with one angle none was a phantom.
// Where directions give the angle its share is an estimate: see README.
bool is_held(std::size_t kind, const Verdict& v, const Parity& p) {
  if (v.missed + v.wrong_side + v.unlike > 0 || p.odd + p.odd_lost > 0 || v.lost > v.rays / 10'000) return false;
  const std::size_t off = v.conditioned - v.conditioned_within_4_ulp;
  if (StressScene::has_varied_angle(kind))
    return v.phantom <= v.rays / 20'000 && v.limits == 0 && off <= v.conditioned / 1'000 + 1;
  return v.far_phantom == 0 && v.phantom <= v.rays / 100'000 && v.limits == 0 && off <= v.conditioned / 10'000 + 1;
}

void print(const char* name, const Verdict& v) {
  fmt::print(
      "{:<16}{:>10} rays{:>10} hits: missed {}, lost {}, phantom {}, wrong side {}, unlike {}, limits {}; displaced "
      "{}, grazing "
      "{}, not certified {}; {} of {} beyond 4 ulp\n",
      name, v.rays, v.hits, v.missed, v.lost, v.phantom, v.wrong_side, v.unlike, v.limits, v.displaced, v.grazing,
      v.uncertified, v.conditioned - v.conditioned_within_4_ulp, v.conditioned);
}

void print(const char* name, const Parity& p) {
  fmt::print("{:<16}{:>10} lines{:>9} crossed, {} restarts between crossings: odd {}, lost {}; grazing {}\n", name,
             p.lines, p.crossed, p.restarts, p.odd, p.odd_lost, p.odd_grazing);
}

void print(const std::vector<std::string>& offenders) {
  for (const auto& line : offenders) fmt::print("  {}\n", line);
}

bool judged(const Outcome& all) {
  Verdict total;
  Parity lines;
  for (std::size_t f = 0; f < family_count; ++f) {
    print(family_names[f], all.families[f]);
    total.add(all.families[f]);
  }
  print("all", total);
  for (std::size_t k = 0; k < kind_names.size(); ++k) print(kind_names[k], all.kinds[k]);
  for (std::size_t f = 0; f < line_family_count; ++f) {
    print(family_names[f], all.lines[f]);
    lines.add(all.lines[f]);
  }
  print("all", lines);
  const auto share = [](std::uint64_t a, std::uint64_t b) { return b == 0 ? 0 : 100 * double(a) / double(b); };
  fmt::print("{} rays in company\n", total.in_company);
  fmt::print(
      "hits are off the exact surface by at most {:.3g} of the distance to the skeleton\n"
      "t within 4 ulp of float: {:.4f} % of {} hits at no grazing angle, {:.3g} ulp at most; {} of the {} where "
      "rounding "
      "of a float sum is not more\n",
      total.largest_displacement, share(total.within_4_ulp, total.measured), total.measured, total.largest_ulps,
      total.conditioned_within_4_ulp, total.conditioned);
  for (const auto* offenders : {&total.missed_rays, &total.lost_rays, &total.phantom_rays, &total.wrong_side_rays,
                                &total.limit_rays, &lines.odd_rays, &lines.lost_rays})
    print(*offenders);
  bool held = total.hits > total.rays / 10;
  for (std::size_t k = 0; k < kind_names.size(); ++k) held &= is_held(k, all.kinds[k], all.kind_lines[k]);
  return held;
}

bool parse(int argc, char** argv, Job& job) {
  const NumberOption options[] = {{"--rays", job.rays},      {"--lines", job.lines},   {"--first", job.first},
                                  {"--scenes", job.scenes},  {"--varied", job.varied}, {"--odd", job.odd},
                                  {"--threads", job.threads}};
  return read_numbers(argc, argv, options) && job.scenes > 0 && job.threads > 0;
}

}  // namespace

int main(int argc, char** argv) {
  Job job;
  if (!parse(argc, argv, job)) {
    std::fprintf(stderr,
                 "stress [--rays N] [--lines N] [--first SCENE] [--scenes N] [--varied N] [--odd N] [--threads N]\n");
    return 2;
  }
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, job.threads);
  std::vector<Outcome> outcomes(job.scenes + job.varied + job.odd);
  tbb::parallel_for(std::size_t{0}, outcomes.size(),
                    [&](std::size_t i) { outcomes[i] = run_scene(job, scene_number(job, i)); });
  Outcome all;
  for (const Outcome& o : outcomes)
    for (std::size_t f = 0; f < family_count; ++f) {
      all.families[f].add(o.families[f]);
      all.lines[f].add(o.lines[f]);
    }
  for (const Outcome& o : outcomes)
    for (std::size_t k = 0; k < kind_names.size(); ++k) {
      all.kinds[k].add(o.kinds[k]);
      all.kind_lines[k].add(o.kind_lines[k]);
    }
  fmt::print("scenes {} to {}, {} of varying angles from {} on, {} odd ones from {} on\n", job.first,
             job.first + job.scenes - 1, job.varied, first_varied_scene, job.odd, first_odd_scene + job.first);
  const bool held = judged(all);
  fmt::print("cpu {:.1f} s\n", static_cast<double>(std::clock()) / CLOCKS_PER_SEC);
  return held ? 0 : 1;
}
