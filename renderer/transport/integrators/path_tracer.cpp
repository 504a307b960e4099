// Path tracing with next-event estimation.
#include "renderer/transport/integrators/path_tracer.h"

#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace marrow {
namespace {

using Strategy = PathTracer::Strategy;

constexpr double infinity = std::numeric_limits<double>::infinity();
// A surface that lies within this share of the distance to a light does not hide it: lights may lie on surfaces, and
// surfaces may be known in single precision.
constexpr double reach = 1 - 1e-5;
constexpr int surfaces_before_roulette = 3;

// A surface met from outside, and how it scatters toward where the path came from. Rays that leave refer to the hit.
struct Vertex {
  Vertex(const SurfaceHit& met, const UnitVec3& arriving, const RenderScene& scene)
      : hit(met),
        receiver{hit.outside, hit.normal},
        frame(Frame::around(hit.normal)),
        wo(UnitVec3::unchecked(frame.to_local(-arriving.vec()))),
        material(scene.materials[hit.material.index()]),
        bsdf(material.bsdf_at(hit.position)),
        emitted(material.emitted_at(hit.position)) {}

  UnitVec3 to_local(const UnitVec3& w) const { return UnitVec3::unchecked(frame.to_local(w)); }

  const SurfaceHit& hit;
  Receiver receiver;
  Frame frame;
  UnitVec3 wo;
  const Material& material;
  const Bsdf& bsdf;
  Rgb emitted;
};

// Where a ray comes from and with what density it was drawn there; a camera ray has none.
struct Departure {
  const Receiver* receiver = nullptr;
  double pdf = 0;
};

double power_heuristic(double chosen, double other) { return chosen * chosen / (chosen * chosen + other * other); }

double weight_of_met(const RenderScene& scene, std::size_t light, const Departure& from, const UnitVec3& direction,
                     Strategy strategy) {
  if (!from.receiver || strategy == Strategy::SurfacesOnly) return 1;
  if (strategy == Strategy::LightsOnly) return 0;
  return power_heuristic(from.pdf,
                         scene.lights.probability(light) * scene.lights[light].pdf(*from.receiver, direction));
}

// Light that the ray itself meets before a surface at t_surface. Lights do not hide each other.
Rgb met_light(const RenderScene& scene, const Ray& ray, double t_surface, const Departure& from, Strategy strategy) {
  Rgb sum;
  if (!scene.lights.can_be_met()) return sum;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    Rgb radiance;
    if (const auto hit = light.hit(ray); hit && hit->t * reach <= t_surface) radiance = hit->radiance;
    if (t_surface == infinity) radiance += light.escaped(ray.direction);
    if (!is_black(radiance)) sum += radiance * weight_of_met(scene, i, from, ray.direction, strategy);
  }
  return sum;
}

// What a light sends to a vertex and the vertex sends on, unless something is on the ray.
struct AskedLight {
  Ray shadow_ray;
  Rgb radiance;
};

// Lights of a single direction draw none.
Sample2 numbers_for(const Light& light, Sampler& sampler) {
  if (light.can_be_met()) return sampler.next_2d();
  sampler.skip_2d();
  return {};
}

// Asks one light, picked at random; nothing when no light can come.
std::optional<AskedLight> asked_light(const RenderScene& scene, const Vertex& at, Sampler& sampler, Strategy strategy) {
  if (scene.lights.empty()) return {};
  const LightSet::Pick pick = scene.lights.pick(scene.lights.size() == 1 ? 0 : sampler.next_1d());
  const auto light = pick.light->sample(at.receiver, numbers_for(*pick.light, sampler));
  if (!light || is_black(light->radiance)) return {};
  if (strategy == Strategy::SurfacesOnly && !light->delta) return {};
  const Scattered scattered = at.bsdf.evaluate(at.wo, at.to_local(light->wi));
  if (is_black(scattered.f_cos)) return {};
  const double pdf = pick.probability * light->pdf;
  const bool rivals = !light->delta && strategy == Strategy::Both;
  return AskedLight{at.hit.leaving(light->wi, light->distance * reach),
                    scattered.f_cos * light->radiance * ((rivals ? power_heuristic(pdf, scattered.pdf) : 1) / pdf)};
}

// Ends the path with a probability that its throughput gives, and pays those that go on. Returns whether it goes on.
bool survives(Rgb& throughput, Sampler& sampler) {
  const double probability = max_channel(throughput);
  if (probability >= 1) return true;
  if (!(sampler.next_1d() < probability)) return false;
  throughput *= 1 / probability;
  return true;
}

class Path;

// What a path asks where it arrives.
struct Questions {
  struct Light {
    Path* path;
    Rgb radiance;  // that comes back along the path unless something is on the shadow ray
  };
  std::vector<Ray> shadow_rays;
  std::vector<Light> lights;  // one a shadow ray
  std::vector<Ray> rays;      // where paths go on,
  std::vector<Path*> paths;   // one a ray

  void clear() {
    shadow_rays.clear();
    lights.clear();
    rays.clear();
    paths.clear();
  }
};

// What all paths of one call have in common.
struct Rules {
  const RenderScene& scene;
  const int max_depth;
  const Strategy strategy;
};

// A path from the camera on, surface by surface. It keeps little: there are many of them.
class Path {
 public:
  explicit Path(Sampler& sampler) : sampler_(&sampler) {}

  /// At the end of a ray. It has ended when it asks for no ray.
  void arrive(const Rules&, const Ray&, const std::optional<SurfaceHit>&, Questions&);
  /// Of what it asked for.
  void receive(const Rgb& light) { radiance_ += light; }
  Rgb radiance() const { return radiance_; }

 private:
  void ask_for_light(const Rules&, const Vertex&, Questions&);
  void go_on(const Rules&, const Vertex&, Questions&);
  std::optional<BsdfSample> drawn_direction(const Rules&, const Vertex&);

  Sampler* sampler_;
  int depth_ = 0;  // surfaces so far
  Rgb radiance_;
  Rgb throughput_{1};
  Receiver start_{};  // of the ray under way, drawn with this density
  double pdf_ = 0;
};

// Light that the ray has met comes first; the surface that it has met may be its last.
void Path::arrive(const Rules& rules, const Ray& ray, const std::optional<SurfaceHit>& hit, Questions& questions) {
  const Departure from = depth_ == 0 ? Departure{} : Departure{&start_, pdf_};
  radiance_ += throughput_ * met_light(rules.scene, ray, hit ? hit->t : infinity, from, rules.strategy);
  if (!hit) return;
  const Vertex at(*hit, ray.direction, rules.scene);
  radiance_ += throughput_ * at.emitted;
  if (++depth_ > rules.max_depth) return;
  ask_for_light(rules, at, questions);
  go_on(rules, at, questions);
}

void Path::ask_for_light(const Rules& rules, const Vertex& at, Questions& questions) {
  const auto asked = asked_light(rules.scene, at, *sampler_, rules.strategy);
  if (!asked) return;
  questions.shadow_rays.push_back(asked->shadow_ray);
  questions.lights.push_back({this, throughput_ * asked->radiance});
}

// In a direction that the surface draws.
void Path::go_on(const Rules& rules, const Vertex& at, Questions& questions) {
  const auto drawn = drawn_direction(rules, at);
  if (!drawn) return;
  start_ = at.receiver;
  pdf_ = drawn->pdf;
  const Ray ray = at.hit.leaving(UnitVec3::unchecked(at.frame.to_world(drawn->wi)));
  // A last ray matters only for light that it meets itself
  if (depth_ == rules.max_depth && !rules.scene.has_emission &&
      is_black(met_light(rules.scene, ray, infinity, {&start_, pdf_}, rules.strategy)))
    return;
  questions.rays.push_back(ray);
  questions.paths.push_back(this);
}

// Nothing when the path ends here.
std::optional<BsdfSample> Path::drawn_direction(const Rules& rules, const Vertex& at) {
  if (depth_ == rules.max_depth && !rules.scene.lights.can_be_met() && !rules.scene.has_emission) return {};
  const auto drawn = at.bsdf.sample(at.wo, sampler_->next_3d());
  if (!drawn) return {};
  throughput_ *= drawn->weight;
  if (depth_ > surfaces_before_roulette && !survives(throughput_, *sampler_)) return {};
  return drawn;
}

// What a thread keeps from call to call.
struct Memory {
  std::vector<Path> paths;
  Questions asked, answered;
  std::vector<std::uint8_t> hidden;
  std::vector<std::optional<SurfaceHit>> left, met;  // that rays under way refer to, and what they meet
};
Memory& memory() {
  thread_local const auto own = std::make_unique<Memory>();
  return *own;
}

void answer_lights(const Questions& asked, const Surfaces& surfaces, std::vector<std::uint8_t>& hidden) {
  hidden.resize(asked.shadow_rays.size());
  surfaces.occluded(asked.shadow_rays, hidden);
  for (std::size_t i = 0; i < hidden.size(); ++i)
    if (hidden[i] == 0) asked.lights[i].path->receive(asked.lights[i].radiance);
}

// To the ends of all paths. Neighbours go to the same light, and leave from the same surfaces: whatever paths ask, they
// ask together.
void walk(const Rules& rules, const CameraSamples& of, Memory& m) {
  const Surfaces& surfaces = *rules.scene.surfaces;
  m.asked.clear();
  for (std::size_t i = 0; i < of.rays.size(); ++i) m.paths[i].arrive(rules, of.rays[i], of.first[i], m.asked);
  for (;;) {
    answer_lights(m.asked, surfaces, m.hidden);
    if (m.asked.rays.empty()) return;
    m.met.resize(m.asked.rays.size());
    surfaces.first_hits(m.asked.rays, m.met);
    std::swap(m.asked, m.answered);
    std::swap(m.met, m.left);
    m.asked.clear();
    for (std::size_t i = 0; i < m.left.size(); ++i)
      m.answered.paths[i]->arrive(rules, m.answered.rays[i], m.left[i], m.asked);
  }
}

}  // namespace

Rgb PathTracer::radiance(const Ray& camera_ray, const std::optional<SurfaceHit>& first, const RenderScene& scene,
                         Sampler& sampler) const {
  Rgb radiance;
  radiances({std::span(&camera_ray, 1), std::span(&first, 1), std::span(&sampler, 1)}, scene, std::span(&radiance, 1));
  return radiance;
}

void PathTracer::radiances(const CameraSamples& of, const RenderScene& scene, std::span<Rgb> radiances) const {
  Memory& m = memory();
  m.paths.clear();
  for (Sampler& sampler : of.samplers) m.paths.emplace_back(sampler);
  walk({scene, max_depth_, strategy_}, of, m);
  for (std::size_t i = 0; i < radiances.size(); ++i) radiances[i] = m.paths[i].radiance();
}

}  // namespace marrow
