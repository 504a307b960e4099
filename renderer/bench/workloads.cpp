// The creature, the hair, the balls and the strands, by a fixed recipe and fixed seeds.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "field/math/elementary.h"
#include "renderer/bench/python_random.h"
#include "renderer/bench/workload.h"

namespace marrow {
namespace {

constexpr double pi = std::numbers::pi;

// A place along a limb.
struct Knot {
  Vec3d at;
  double radius;
};
using Limb = std::vector<Knot>;

// As text would have it: the product with 1e5 would round some ties the other way.
double five_decimals(double x) {
  const std::string text = fmt::format("{:.5f}", x);
  double rounded = 0;
  std::from_chars(text.data(), text.data() + text.size(), rounded);
  return rounded;
}
Vec3d five_decimals(const Vec3d& p) { return {five_decimals(p.x), five_decimals(p.y), five_decimals(p.z)}; }

Vec3d mix(const Vec3d& a, const Vec3d& b, double t) { return a * (1 - t) + b * t; }

double spline(double a, double b, double c, double d, double t) {
  return 0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t + (-a + 3 * b - 3 * c + d) * t * t * t);
}

// `count` + 1 knots on a Catmull-Rom spline through the given ones.
Limb smooth(const Limb& knots, int count) {
  const auto pieces = static_cast<int>(knots.size()) - 1;
  const auto knot = [&](int i) { return knots[static_cast<std::size_t>(std::clamp(i, 0, pieces))]; };
  Limb out;
  for (int k = 0; k <= count; ++k) {
    const double u = static_cast<double>(k) / count * pieces;
    const int i = std::min(static_cast<int>(u), pieces - 1);
    const double t = u - i;
    const Knot a = knot(i - 1), b = knot(i), c = knot(i + 1), d = knot(i + 2);
    Knot on;
    for (std::size_t x = 0; x < 3; ++x) on.at[x] = spline(a.at[x], b.at[x], c.at[x], d.at[x], t);
    on.radius = spline(a.radius, b.radius, c.radius, d.radius, t);
    out.push_back(on);
  }
  return out;
}

constexpr double thinnest = .03;

void add_segment(Workload& w, const Knot& a, const Knot& b) {
  w.segments.push_back({five_decimals(a.at), five_decimals(b.at), five_decimals(std::max(a.radius, thinnest)),
                        five_decimals(std::max(b.radius, thinnest))});
}

void add_chain(Workload& w, const Limb& limb) {
  for (std::size_t i = 1; i < limb.size(); ++i) add_segment(w, limb[i - 1], limb[i]);
}

// The sun of all workloads, with the six decimals of the text files.
Vec3d sun() {
  const Vec3d s = Vec3d{.45, .75, .55} / length(Vec3d{.45, .75, .55});
  return normalize(Vec3d{std::round(s.x * 1e6), std::round(s.y * 1e6), std::round(s.z * 1e6)});
}

void add_head(Workload& w) {
  add_chain(w, smooth({{{3.0, 2.5, .7}, .33}, {{3.5, 2.25, .85}, .28}, {{4.05, 2.0, 1.0}, .14}}, 6));
  add_chain(w, smooth({{{3.0, 2.4, .7}, .24}, {{3.4, 1.95, .8}, .16}, {{3.8, 1.6, .9}, .08}}, 6));
  for (const double side : {-1, 1})  // horns
    add_chain(w, smooth({{{2.85, 2.7, .7 + .15 * side}, .13},
                         {{2.5, 3.2, .7 + .45 * side}, .1},
                         {{1.95, 3.45, .7 + .6 * side}, .07},
                         {{1.5, 3.3, .7 + .6 * side}, .03}},
                        8));
}

void add_leg(Workload& w, const Vec3d& hip, const Vec3d& knee, const Vec3d& ankle, const Vec3d& toe) {
  add_chain(w, smooth({{hip, .36}, {mix(hip, knee, .5), .33}, {knee, .22}}, 6));
  add_chain(w, smooth({{knee, .22}, {mix(knee, ankle, .5), .19}, {ankle, .14}}, 6));
  add_chain(w, smooth({{ankle, .14}, {mix(ankle, toe, .5), .15}, {toe, .13}}, 4));
  for (int k = 0; k < 4; ++k) {
    const double a = (k - 1.5) * .45;
    const Vec3d claw{cos(a) * .5, -.12, sin(a) * .5};
    add_chain(w, smooth({{toe, .12}, {toe + claw * .6, .09}, {toe + (claw + Vec3d{0, -.14, 0}), .03}}, 5));
  }
}

void add_legs(Workload& w) {
  add_leg(w, {-1.2, -1.2, .15}, {-1.0, -2.1, .9}, {-1.7, -2.9, .7}, {-1.15, -3.25, .9});
  add_leg(w, {-1.3, -1.4, -.6}, {-.35, -2.2, -1.2}, {-.75, -3.0, -1.0}, {-.2, -3.3, -1.0});
  add_leg(w, {1.0, .2, .4}, {1.9, -.55, 1.1}, {1.55, -1.55, 1.0}, {2.1, -1.9, 1.2});
  add_leg(w, {1.2, .3, -.3}, {2.5, -.1, -1.1}, {2.6, -1.2, -.9}, {3.15, -1.45, -.9});
}

// An arm, seven fingers, and a web of short segments between them.
void add_wing(Workload& w, double side, const Vec3d& root, const Vec3d& wrist) {
  add_chain(w, smooth({{root, .26}, {mix(root, wrist, .5), .2}, {wrist, .17}}, 14));
  std::vector<Limb> fingers;
  for (int k = 0; k < 7; ++k) {
    const double a = ((62 + side * 12) + k * (26 - 2 * side)) * (pi / 180);
    const double reach = side > 0 ? 2.75 - .1 * k : 2.2 - .05 * k;
    const Vec3d middle = wrist + Vec3d{cos(a - .12) * reach * .55, sin(a - .12) * reach * .55, side * .45};
    const Vec3d end = wrist + Vec3d{cos(a) * reach, sin(a) * reach, side * .15};
    fingers.push_back(smooth({{wrist, .17}, {middle, .15}, {end, .06}}, 14));
    add_chain(w, fingers.back());
  }
  for (std::size_t k = 0; k < 6; ++k)
    for (std::size_t level = 0; level < 6; ++level) {
      const std::size_t i = level < 5 ? 3 + 2 * level : 13;
      const Vec3d a = fingers[k][i].at, b = fingers[k + 1][i].at;
      add_chain(w, {{a, .13}, {mix(mix(a, b, .5), wrist, .05), .10}, {b, .13}});
    }
}

// One segment each along the back, until there are `total`.
void add_spikes(Workload& w, const Limb& back, std::size_t total) {
  PythonRandom random(867);
  const std::size_t count = total - w.segments.size();
  for (std::size_t k = 0; k < count; ++k) {
    const auto i = static_cast<std::size_t>((static_cast<double>(k) + .5) / static_cast<double>(count) *
                                            static_cast<double>(back.size() - 2));
    const Knot& here = back[i];
    const Vec3d along = normalize(back[i + 1].at - here.at);
    const Vec3d up = normalize(cross(Vec3d{0, 0, 1}, along) + Vec3d{0, 0, random.uniform(-.35, .35)});
    const Vec3d tip = here.at + up * (here.radius * 1.15 + .22 + random.uniform(0, .1));
    add_segment(w, {here.at + up * (here.radius * .7), std::max(.05, .3 * here.radius)}, {tip, .03});
  }
}

// A strand that starts along `direction` and bends down, with curls around it.
struct Strand {
  Vec3d root, direction;
  double step, curl, turn, phase;
};

void add_strand(Workload& w, PythonRandom& random, const Strand& s, double size) {
  Vec3d direction = s.direction, center = s.root;
  Limb limb{{s.root, .04 * size}};
  for (int j = 1; j <= 20; ++j) {
    const double dx = random.uniform(-.06, .06), dz = random.uniform(-.06, .06);
    direction = normalize(direction + Vec3d{dx, -.30, dz});
    center += direction * s.step;
    const Vec3d u = normalize(cross(direction, Vec3d{.31, .2, .93})), v = cross(direction, u);
    const double wide = s.curl * std::min(1.0, j / 4.0), angle = s.phase + s.turn * j;
    limb.push_back({center + (u * (wide * cos(angle)) + v * (wide * sin(angle))), (.04 - .01 * j / 20) * size});
  }
  for (std::size_t i = 1; i < limb.size(); ++i)
    w.segments.push_back({five_decimals(limb[i - 1].at), five_decimals(limb[i].at), five_decimals(limb[i - 1].radius),
                          five_decimals(limb[i].radius)});
}

Vec3d in_ball(PythonRandom& random, double radius) {
  Vec3d p;
  do
    for (std::size_t i = 0; i < 3; ++i) p[i] = random.uniform(-radius, radius);
  while (length(p) > radius);
  return p;
}

// What fills a ball of radius 4.
Workload seen_from_front(std::string name, std::string about) {
  return {.name = std::move(name),
          .about = std::move(about),
          .eye = {0, 0, 20},
          .tan_half_fov = .238,
          .toward_light = sun(),
          .segments = {},
          .points = {},
          .places = {}};
}

}  // namespace

Workload creature() {
  Workload w{.name = "w1",
             .about = "a creature of 867 segments",
             .eye = {-.12, .66, 20},
             .tan_half_fov = .219,
             .toward_light = sun(),
             .segments = {},
             .points = {},
             .places = {}};
  const Limb body = smooth({{{-1.55, -1.35, -.5}, .40},
                            {{-.7, -1.05, .1}, .47},
                            {{.25, -.55, .3}, .5},
                            {{1.1, .2, .1}, .46},
                            {{1.5, 1.1, -.1}, .36}},
                           30);
  add_chain(w, body);
  const Limb tail = smooth({{{-1.55, -1.35, -.5}, .40},
                            {{-2.6, -1.75, -.6}, .34},
                            {{-3.6, -1.5, 0}, .28},
                            {{-4.1, -.4, .5}, .23},
                            {{-3.5, .55, .4}, .19},
                            {{-2.5, .5, .1}, .15},
                            {{-2.2, -.25, .2}, .11},
                            {{-2.8, -.6, .5}, .07},
                            {{-3.2, -.2, .7}, .03}},
                           70);
  add_chain(w, tail);
  const Limb neck =
      smooth({{{1.5, 1.1, -.1}, .36}, {{1.5, 2.1, .2}, .29}, {{2.2, 2.75, .5}, .25}, {{3.0, 2.5, .7}, .27}}, 24);
  add_chain(w, neck);
  add_head(w);
  add_legs(w);
  add_wing(w, 1, {.7, .5, .6}, {-.3, 2.2, 1.6});
  add_wing(w, -1, {1.0, .6, -.4}, {1.3, 2.9, -1.9});
  Limb back = body;
  back.insert(back.end(), tail.begin(), tail.end());
  back.insert(back.end(), neck.begin(), neck.end());
  add_spikes(w, back, 867);
  return w;
}

Workload hair() {
  Workload w{.name = "w2",
             .about = "10,000 segments in 500 curls",
             .eye = {0, .15, 20},
             .tan_half_fov = .197,
             .toward_light = sun(),
             .segments = {},
             .points = {},
             .places = {}};
  PythonRandom random(10000);
  const double golden_angle = pi * (3 - std::sqrt(5.0));
  for (int k = 0; k < 500; ++k) {  // the scalp is the upper 72 % of a sphere
    const double z = 1 - 2 * (k + .5) / 500 * .72, around = golden_angle * k, s = std::sqrt(1 - z * z);
    const Vec3d normal{s * cos(around), z, s * sin(around)};
    Strand strand{
        .root = normal * 1.5 + Vec3d{0, 1.2, 0}, .direction = normal, .step = 0, .curl = 0, .turn = 0, .phase = 0};
    strand.step = random.uniform(3.0, 4.6) / 20;
    strand.curl = random.uniform(.10, .22);
    strand.turn = random.uniform(.75, 1.05);
    if (!random.choose_second()) strand.turn = -strand.turn;
    strand.phase = random.uniform(0, 6.28);
    add_strand(w, random, strand, 1);
  }
  return w;
}

Workload balls() {
  Workload w = seen_from_front("w3", "200 points");
  PythonRandom random(200);
  while (w.points.size() < 200) {
    const Vec3d p = in_ball(random, 4);
    w.points.push_back({five_decimals(p), five_decimals(random.uniform(.25, .6))});
  }
  return w;
}

Workload strands(std::size_t count) {
  Workload w = seen_from_front("strands-" + std::to_string(count), std::to_string(count) + " segments in a ball");
  PythonRandom random(static_cast<std::uint32_t>(count));
  const double size = std::sqrt(2000.0 / static_cast<double>(count));
  while (w.segments.size() < count) {
    const Vec3d root = in_ball(random, 4);
    Vec3d direction;
    for (std::size_t i = 0; i < 3; ++i) direction[i] = random.uniform(-1, 1);
    add_strand(w, random, {root, normalize(direction), .19 * size, .15 * size, .9, random.uniform(0, 6.28)}, size);
  }
  return w;
}

Workload tufts(std::size_t count) {
  constexpr std::size_t in_one = 1000;
  Workload w = seen_from_front("tufts-" + std::to_string(count), std::to_string(count) + " segments in tufts of 1000");
  PythonRandom random(static_cast<std::uint32_t>(count + 1));
  const double size = std::sqrt(2000.0 / static_cast<double>(count));
  while (w.segments.size() < in_one)
    add_strand(w, random,
               {in_ball(random, .5 * size), normalize(in_ball(random, 1)), .19 * size, .15 * size, .9,
                random.uniform(0, 6.28)},
               size);
  while (w.places.size() * in_one < count) w.places.push_back(five_decimals(in_ball(random, 4)));
  return w;
}

}  // namespace marrow
