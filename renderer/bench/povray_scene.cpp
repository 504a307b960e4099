// A workload as POV-Ray's blob.
#include "renderer/bench/povray_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ostream.h>

#include "field/math/elementary.h"

namespace marrow {
namespace {

constexpr double threshold = 0.5625;  // (1 - 1/4)^2: one primitive alone has its surface at half its reach

double square_distance(const Vec3d& p, const SegmentSkeleton& s) {
  const Vec3d along = s.to - s.from;
  const double length2 = length_squared(along);
  const double t = length2 == 0 ? 0 : std::clamp(dot(p - s.from, along) / length2, 0.0, 1.0);
  return length_squared(p - (s.from + along * t));
}

// Four places around the middle of a segment, at its radius.
std::array<Vec3d, 4> around_middle(const SegmentSkeleton& s) {
  const Vec3d along = normalize(s.to - s.from), u = normalize(cross(along, Vec3d{.31, .2, .93}));
  const Vec3d v = cross(along, u), middle = lerp(s.from, s.to, 0.5);
  const double radius = (s.radius_from + s.radius_to) / 2;
  return {middle + u * radius, middle + v * radius, middle - u * radius, middle - v * radius};
}

// The field there, of the segments that stand near this one in the list: its own chain.
double field_around(const std::vector<SegmentSkeleton>& segments, const std::vector<double>& strengths, std::size_t i) {
  constexpr std::size_t window = 12;
  const std::size_t first = i > window ? i - window : 0, last = std::min(segments.size(), i + window + 1);
  double sum = 0;
  for (const Vec3d& p : around_middle(segments[i]))
    for (std::size_t j = first; j < last; ++j) {
      const double reach = segments[j].radius_from + segments[j].radius_to;
      const double q = square_distance(p, segments[j]) / (reach * reach);
      if (q < 1) sum += strengths[j] * (1 - q) * (1 - q);
    }
  return sum / 4;
}

std::vector<double> fitted_strengths(const std::vector<SegmentSkeleton>& segments) {
  constexpr int rounds = 12;
  constexpr double damping = 0.7, least = 0.02;
  std::vector<double> strengths(segments.size(), 1.0), next = strengths;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < segments.size(); ++i)
      next[i] = std::max(least, strengths[i] * pow(threshold / field_around(segments, strengths, i), damping));
    strengths = next;
  }
  return strengths;
}

std::string text(const Vec3d& p) { return fmt::format("<{:.5f},{:.5f},{:.5f}>", p.x, p.y, p.z); }

}  // namespace

Status write_povray_blob(const Workload& w, const std::filesystem::path& path) {
  std::ofstream out(path);
  fmt::print(out,
             "#version 3.7;\nglobal_settings {{ assumed_gamma 1.0 }}\nbackground {{ rgb <.25,.3,.4> }}\n"
             "camera {{ location {} direction <0,0,{:.6f}> up <0,1,0> right <1,0,0> }}\n"
             "light_source {{ {} rgb 1 parallel point_at <0,0,0> }}\nblob {{ threshold {}\n",
             text(w.eye), -1 / (2 * w.tan_half_fov), text(w.toward_light * 1000), threshold);
  const auto strengths = fitted_strengths(w.segments);
  for (std::size_t i = 0; i < w.segments.size(); ++i) {
    const SegmentSkeleton& s = w.segments[i];
    fmt::print(out, " cylinder {{ {},{},{:.5f}, {:.5f} }}\n", text(s.from), text(s.to), s.radius_from + s.radius_to,
               strengths[i]);
  }
  for (const auto& p : w.points) fmt::print(out, " sphere {{ {},{:.5f}, 1 }}\n", text(p.at), 2 * p.radius);
  fmt::print(out, " texture {{ pigment {{ rgb 1 }} finish {{ ambient .1 diffuse .8 }} }} }}\n");
  out.close();
  if (out) return Done{};
  return failure("cannot write " + path.string());
}

}  // namespace marrow
