#include "renderer/geometry/ray_stream.h"

#include <algorithm>
#include <limits>
#include <memory>

#include "renderer/geometry/part_queues.h"

namespace marrow {
namespace {

// Fewer rays share too little.
constexpr std::size_t worth_a_stream = 3;

template <class T>
std::span<T> piece_of(std::span<T> all, std::size_t first, std::size_t most) {
  return all.subspan(first, std::min(most, all.size() - first));
}

// What a thread keeps from stream to stream: rays on their way, and where they wait.
struct Memory {
  std::vector<StreamedRay> rays;
  std::vector<StreamedRay*> searching;
  std::vector<std::uint32_t> together;
  PartQueues queues;
  RayPacket packet;
  PacketLog log;
};
Memory& memory() {
  thread_local const auto own = std::make_unique<Memory>();
  return *own;
}

class Stream {
 public:
  Stream(const PartHierarchy& hierarchy, bool any, std::span<const Ray> rays)
      : hierarchy_(hierarchy), any_(any), memory_(memory()) {
    memory_.rays.clear();
    memory_.rays.reserve(rays.size());
    for (const Ray& ray : rays) memory_.rays.emplace_back(ray);
    memory_.queues.start(hierarchy.part_count(), rays.size());
  }
  std::span<StreamedRay> rays() { return memory_.rays; }

  // Until all rays have come to their hits or to their ends.
  void run() {
    std::vector<StreamedRay*>& searching = memory_.searching;
    searching.clear();
    for (StreamedRay& ray : memory_.rays) searching.push_back(&ray);
    while (!searching.empty()) {
      for (std::size_t i = 0; i < searching.size(); i += PartHierarchy::most_together)
        hierarchy_.find_parts(piece_of(std::span(searching), i, PartHierarchy::most_together));
      for (StreamedRay* ray : searching) advance(*ray);
      searching.clear();
      trace_waiting();
    }
  }

 private:
  // To the next part; or to be searched for more of them.
  void advance(StreamedRay& ray) {
    if (ray.finished) return;
    if (const PartEntry* next = ray.ahead.next()) {
      if (next->enter > ray.visit.last()) return;
      memory_.queues.wait(static_cast<std::uint32_t>(&ray - memory_.rays.data()), hierarchy_.number_of(*next));
    } else if (ray.ahead.full() && ray.ahead.end() <= ray.visit.last()) {
      ray.ahead.go_on();
      memory_.searching.push_back(&ray);
    }
  }

  void trace_waiting() {
    std::uint32_t part = 0;
    std::vector<std::uint32_t>& together = memory_.together;
    while (memory_.queues.next(part, together))
      for (std::size_t i = 0; i < together.size(); i += RayPacket::size)
        trace(piece_of(std::span(together), i, RayPacket::size));
  }

  // Rays that wait at the same part.
  void trace(std::span<const std::uint32_t> together) {
    const PartEntry at = *memory_.rays[together[0]].ahead.next();
    const PartsOfSolid& of = hierarchy_.solid(at.solid);
    if (together.size() == 1) {
      StreamedRay& ray = memory_.rays[together[0]];
      ElementLog log = ray.visit.before(*of.solid);
      const auto t = of.solid->hit_in_part(of.parts[at.part], ray.visit.ray, any_, log);
      take(ray, at, t.value_or(std::numeric_limits<double>::infinity()), log);
      return;
    }
    RayPacket& packet = memory_.packet;
    PacketLog& log = memory_.log;
    for (std::size_t lane = 0; lane < together.size(); ++lane) {
      const PartVisit& visit = memory_.rays[together[lane]].visit;
      packet.set(lane, visit.ray);
      log.lanes[lane] = visit.before(*of.solid);
    }
    of.solid->hits_in_part(of.parts[at.part], packet, first_lanes(together.size()), any_, log);
    for (std::size_t lane = 0; lane < together.size(); ++lane)
      take(memory_.rays[together[lane]], at, log.t[lane], log.lanes[lane]);
  }

  void take(StreamedRay& ray, const PartEntry& at, double t, const ElementLog& log) {
    const PartsOfSolid& of = hierarchy_.solid(at.solid);
    ray.ahead.take();
    ray.take(at.solid, *of.solid, of.parts[at.part], t, log, any_);
    advance(ray);
  }

  const PartHierarchy& hierarchy_;
  const bool any_;
  Memory& memory_;
};

bool worth_streaming(const PartHierarchy& hierarchy, std::span<const Ray> rays) {
  return hierarchy.traces_packets() && rays.size() >= worth_a_stream;
}

}  // namespace

void stream_first_hits(const PartHierarchy& hierarchy, std::span<const Ray> rays, std::span<PartHit> hits,
                       std::span<std::vector<RayVisit>> visits) {
  const auto visits_of = [visits](std::size_t i) { return visits.empty() ? nullptr : &visits[i]; };
  if (!worth_streaming(hierarchy, rays)) {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = hierarchy.first_hit(rays[i], visits_of(i));
    return;
  }
  Stream stream(hierarchy, false, rays);
  for (std::size_t i = 0; i < visits.size(); ++i) stream.rays()[i].visit.visits = visits_of(i);
  stream.run();
  for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = stream.rays()[i].visit.best;
}

void stream_any_hits(const PartHierarchy& hierarchy, std::span<const Ray> rays, std::span<PartHit> hits) {
  if (!worth_streaming(hierarchy, rays)) {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = hierarchy.any_hit(rays[i]);
    return;
  }
  Stream stream(hierarchy, true, rays);
  stream.run();
  for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = stream.rays()[i].visit.best;
}

}  // namespace marrow
