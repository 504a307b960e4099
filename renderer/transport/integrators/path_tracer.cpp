// Path tracing with next-event estimation.
#include "renderer/transport/integrators/path_tracer.h"

#include <cstdint>
#include <limits>
#include <vector>

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
        around(hit.around),
        frame(Frame::around(hit.normal)),
        wo(UnitVec3::unchecked(frame.to_local(-arriving.vec()))),
        material(scene.materials[hit.material.index()]),
        bsdf(material.bsdf_at(hit.position)),
        emitted(material.emitted_at(hit.position)) {}

  UnitVec3 to_local(const UnitVec3& w) const { return UnitVec3::unchecked(frame.to_local(w)); }

  // The vertex must outlive the ray.
  Ray leaving(const UnitVec3& direction, double t_max = infinity) const {
    return {receiver.position, direction, 0, t_max, &around};
  }

  Receiver receiver;
  FieldAround around;
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

// Asks one light, picked at random; nothing when no light can come.
std::optional<AskedLight> asked_light(const RenderScene& scene, const Vertex& at, Sampler& sampler, Strategy strategy) {
  if (scene.lights.empty()) return {};
  const LightSet::Pick pick = scene.lights.pick(scene.lights.size() == 1 ? 0 : sampler.next_1d());
  const auto light = pick.light->sample(at.receiver, sampler.next_2d());
  if (!light || is_black(light->radiance)) return {};
  if (strategy == Strategy::SurfacesOnly && !light->delta) return {};
  const Scattered scattered = at.bsdf.evaluate(at.wo, at.to_local(light->wi));
  if (is_black(scattered.f_cos)) return {};
  const double pdf = pick.probability * light->pdf;
  const bool rivals = !light->delta && strategy == Strategy::Both;
  return AskedLight{at.leaving(light->wi, light->distance * reach),
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

// A path from the camera on, surface by surface. What it asks on its way, whoever walks it answers.
class Path {
 public:
  Path(const RenderScene& scene, int max_depth, Strategy strategy, const Ray& camera_ray,
       const std::optional<SurfaceHit>& first, Sampler& sampler)
      : scene_(scene), max_depth_(max_depth), strategy_(strategy), sampler_(sampler) {
    arrive(camera_ray, first, {});
  }
  bool ended() const { return !at_.has_value(); }
  Rgb radiance() const { return radiance_; }

  /// Preconditions of these, which take turns: not ended.
  std::optional<AskedLight> ask() { return asked_light(scene_, *at_, sampler_, strategy_); }
  void receive(const Rgb& light) { radiance_ += throughput_ * light; }
  /// Where to; nothing when it ends here.
  std::optional<Ray> go_on();
  /// At the end of that ray.
  void arrive(const std::optional<SurfaceHit>& hit) {
    const Receiver start = at_->receiver;
    arrive(next_, hit, {&start, next_pdf_});
  }

 private:
  std::optional<BsdfSample> drawn_direction();
  void arrive(const Ray&, const std::optional<SurfaceHit>&, const Departure&);
  void end() { at_.reset(); }

  const RenderScene& scene_;
  const int max_depth_;
  const Strategy strategy_;
  Sampler& sampler_;
  int depth_ = 0;  // surfaces so far
  Rgb radiance_;
  Rgb throughput_{1};
  std::optional<Vertex> at_;  // nothing when the path has ended
  Ray next_;                  // where it goes on, drawn with this density
  double next_pdf_ = 0;
};

// Light that the ray has met comes first; the surface that it has met may be its last.
void Path::arrive(const Ray& ray, const std::optional<SurfaceHit>& hit, const Departure& from) {
  radiance_ += throughput_ * met_light(scene_, ray, hit ? hit->t : infinity, from, strategy_);
  end();
  if (!hit) return;
  at_.emplace(*hit, ray.direction, scene_);
  radiance_ += throughput_ * at_->emitted;
  if (++depth_ > max_depth_) end();
}

// In a direction that the surface draws.
std::optional<Ray> Path::go_on() {
  const auto drawn = drawn_direction();
  if (!drawn) {
    end();
    return {};
  }
  next_pdf_ = drawn->pdf;
  next_ = at_->leaving(UnitVec3::unchecked(at_->frame.to_world(drawn->wi)));
  // A last ray matters only for light that it meets itself
  if (depth_ == max_depth_ && !scene_.has_emission &&
      is_black(met_light(scene_, next_, infinity, {&at_->receiver, next_pdf_}, strategy_))) {
    end();
    return {};
  }
  return next_;
}

// Nothing when the path ends here.
std::optional<BsdfSample> Path::drawn_direction() {
  if (depth_ == max_depth_ && !scene_.lights.can_be_met() && !scene_.has_emission) return {};
  const auto drawn = at_->bsdf.sample(at_->wo, sampler_.next_3d());
  if (!drawn) return {};
  throughput_ *= drawn->weight;
  if (depth_ > surfaces_before_roulette && !survives(throughput_, sampler_)) return {};
  return drawn;
}

// Neighbours go to the same light, and leave from the same surfaces: whatever paths ask, they ask together.
void ask_for_light(std::span<Path* const> paths, const Surfaces& surfaces) {
  struct Waiting {
    Path* path;
    Rgb light;
  };
  std::vector<Waiting> waiting;
  std::vector<Ray> shadow_rays;
  for (Path* path : paths) {
    const auto asked = path->ask();
    if (asked) shadow_rays.push_back(asked->shadow_ray);
    if (asked) waiting.push_back({path, asked->radiance});
    else path->receive({});
  }
  std::vector<std::uint8_t> hidden(shadow_rays.size());
  surfaces.occluded(shadow_rays, hidden);
  for (std::size_t i = 0; i < waiting.size(); ++i) waiting[i].path->receive(hidden[i] != 0 ? Rgb{} : waiting[i].light);
}

void go_on(std::span<Path* const> paths, const Surfaces& surfaces) {
  std::vector<Path*> under_way;
  std::vector<Ray> rays;
  for (Path* path : paths)
    if (const auto ray = path->go_on()) {
      under_way.push_back(path);
      rays.push_back(*ray);
    }
  std::vector<std::optional<SurfaceHit>> hits(rays.size());
  surfaces.first_hits(rays, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) under_way[i]->arrive(hits[i]);
}

// To the ends of all paths.
void walk(std::span<Path> paths, const Surfaces& surfaces) {
  std::vector<Path*> open;
  for (Path& path : paths) open.push_back(&path);
  for (;;) {
    std::erase_if(open, [](const Path* path) { return path->ended(); });
    if (open.empty()) return;
    ask_for_light(open, surfaces);
    go_on(open, surfaces);
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
  std::vector<Path> paths;
  paths.reserve(of.rays.size());
  for (std::size_t i = 0; i < of.rays.size(); ++i)
    paths.emplace_back(scene, max_depth_, strategy_, of.rays[i], of.first[i], of.samplers[i]);
  walk(paths, *scene.surfaces);
  for (std::size_t i = 0; i < paths.size(); ++i) radiances[i] = paths[i].radiance();
}

}  // namespace marrow
