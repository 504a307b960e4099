// Path tracing with next-event estimation.
#include "renderer/transport/integrators/path_tracer.h"

#include <limits>

namespace marrow {
namespace {

using Strategy = PathTracer::Strategy;

constexpr double infinity = std::numeric_limits<double>::infinity();
// A surface that lies within this share of the distance to a light does not hide it: lights may lie on surfaces, and
// surfaces may be known in single precision.
constexpr double reach = 1 - 1e-5;
constexpr int surfaces_before_roulette = 3;

// A surface met from outside, and how it scatters toward where the path came from.
struct Vertex {
  Vertex(const SurfaceHit& hit, const UnitVec3& arriving, const RenderScene& scene)
      : receiver{hit.outside, hit.normal},
        frame(Frame::around(hit.normal)),
        wo(UnitVec3::unchecked(frame.to_local(-arriving.vec()))),
        material(scene.materials[hit.material.index()]),
        bsdf(material.bsdf_at(hit.position)),
        emitted(material.emitted_at(hit.position)) {}

  UnitVec3 to_local(const UnitVec3& w) const { return UnitVec3::unchecked(frame.to_local(w)); }

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

// Light that one light, picked at random, sends to the vertex and the vertex sends on.
Rgb asked_light(const RenderScene& scene, const Vertex& at, Sampler& sampler, Strategy strategy) {
  if (scene.lights.empty()) return {};
  const LightSet::Pick pick = scene.lights.pick(scene.lights.size() == 1 ? 0 : sampler.next_1d());
  const auto light = pick.light->sample(at.receiver, sampler.next_2d());
  if (!light || is_black(light->radiance)) return {};
  if (strategy == Strategy::SurfacesOnly && !light->delta) return {};
  const Scattered scattered = at.bsdf.evaluate(at.wo, at.to_local(light->wi));
  if (is_black(scattered.f_cos)) return {};
  if (scene.surfaces->occluded(
          {.origin = at.receiver.position, .direction = light->wi, .t_min = 0, .t_max = light->distance * reach}))
    return {};
  const double pdf = pick.probability * light->pdf;
  const bool rivals = !light->delta && strategy == Strategy::Both;
  return scattered.f_cos * light->radiance * ((rivals ? power_heuristic(pdf, scattered.pdf) : 1) / pdf);
}

// Ends the path with a probability that its throughput gives, and pays those that go on. Returns whether it goes on.
bool survives(Rgb& throughput, Sampler& sampler) {
  const double probability = max_channel(throughput);
  if (probability >= 1) return true;
  if (!(sampler.next_1d() < probability)) return false;
  throughput *= 1 / probability;
  return true;
}

}  // namespace

Rgb PathTracer::radiance(const Ray& camera_ray, const std::optional<SurfaceHit>& first, const RenderScene& scene,
                         Sampler& sampler) const {
  Rgb radiance = met_light(scene, camera_ray, first ? first->t : infinity, {}, strategy_);
  Rgb throughput(1);
  Ray ray = camera_ray;
  std::optional<SurfaceHit> hit = first;
  for (int depth = 1; hit; ++depth) {
    const Vertex at(*hit, ray.direction, scene);
    radiance += throughput * at.emitted;
    if (depth > max_depth_) break;
    radiance += throughput * asked_light(scene, at, sampler, strategy_);
    if (depth == max_depth_ && !scene.lights.can_be_met() && !scene.has_emission) break;

    // Go on in a direction that the surface draws
    const auto drawn = at.bsdf.sample(at.wo, sampler.next_3d());
    if (!drawn) break;
    throughput *= drawn->weight;
    if (depth > surfaces_before_roulette && !survives(throughput, sampler)) break;
    ray = {.origin = at.receiver.position, .direction = UnitVec3::unchecked(at.frame.to_world(drawn->wi))};

    // A last ray matters only for light that it meets itself
    const Departure from{&at.receiver, drawn->pdf};
    if (depth == max_depth_ && !scene.has_emission && is_black(met_light(scene, ray, infinity, from, strategy_))) break;
    hit = scene.surfaces->first_hit(ray);
    radiance += throughput * met_light(scene, ray, hit ? hit->t : infinity, from, strategy_);
  }
  return radiance;
}

}  // namespace marrow
