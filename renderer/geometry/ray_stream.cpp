#include "renderer/geometry/ray_stream.h"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>

#include "renderer/geometry/part_queues.h"

namespace marrow {
namespace {

// Fewer rays share too little.
constexpr std::size_t worth_a_stream = 3;
constexpr std::size_t worth_a_packet = 9;  // fewer go one by one: where many solids take turns there are few of each

template <class T>
std::span<T> piece_of(std::span<T> all, std::size_t first, std::size_t most) {
  return all.subspan(first, std::min(most, all.size() - first));
}

// Rays in the lanes of a packet, each in one of some parts of solids of one family.
struct RaysInLanes {
  RayPacket packet;
  PacketLog log;
  std::array<StreamedRay*, RayPacket::size> rays;
  std::vector<LanesInPart> parts;
  std::size_t count = 0;

  std::size_t room() const { return RayPacket::size - count; }
  bool takes(const Solid& solid) const { return count == 0 || parts[0].solid->family() == solid.family(); }
};

// What a thread keeps from stream to stream: rays on their way, and where they wait.
struct Memory {
  std::vector<StreamedRay> rays;
  std::vector<StreamedRay*> searching;
  std::vector<std::uint32_t> together;
  PartQueues queues;
  RaysInLanes in_lanes;
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
    do {
      while (memory_.queues.next(part, together)) seat_all(together);
      trace();
    } while (!memory_.queues.empty());
  }

  // Rays that wait at the same part.
  void seat_all(std::span<const std::uint32_t> waiting) {
    while (!waiting.empty()) {
      RaysInLanes& in_lanes = memory_.in_lanes;
      if (in_lanes.room() == 0 || !in_lanes.takes(solid_of(next_part(waiting[0])))) trace();
      const auto some = waiting.first(std::min(waiting.size(), in_lanes.room()));
      seat(some, in_lanes);
      waiting = waiting.subspan(some.size());
    }
  }

  PartEntry next_part(std::uint32_t ray) const { return *memory_.rays[ray].ahead.next(); }
  const Solid& solid_of(PartEntry at) const { return *hierarchy_.solid(at.solid()).solid; }

  // No more than there is room for.
  void seat(std::span<const std::uint32_t> together, RaysInLanes& in_lanes) {
    const PartEntry at = next_part(together[0]);
    const PartsOfSolid& of = hierarchy_.solid(at.solid());
    in_lanes.parts.push_back({of.solid, &of.parts[at.part()], LaneSet::range(in_lanes.count, together.size())});
    for (const std::uint32_t i : together) {
      StreamedRay& ray = memory_.rays[i];
      in_lanes.rays[in_lanes.count] = &ray;
      in_lanes.packet.set(in_lanes.count, *ray.visit.ray);
      in_lanes.log.lanes[in_lanes.count++] = ray.visit.before(*of.solid);
    }
  }

  void trace() {
    RaysInLanes& in_lanes = memory_.in_lanes;
    if (in_lanes.count == 0) return;
    const bool few = in_lanes.count < worth_a_packet;
    if (few) Solid::hits_one_by_one(in_lanes.parts, in_lanes.packet, any_, in_lanes.log);
    else in_lanes.parts[0].solid->hits_in_parts(in_lanes.parts, in_lanes.packet, any_, in_lanes.log);
    for (std::size_t lane = 0; lane < in_lanes.count; ++lane) {
      StreamedRay& ray = *in_lanes.rays[lane];
      take(ray, *ray.ahead.next(), in_lanes.log.t[lane], in_lanes.log.lanes[lane]);
    }
    in_lanes.parts.clear();
    in_lanes.count = 0;
  }

  void take(StreamedRay& ray, PartEntry at, double t, const ElementLog& log) {
    const PartsOfSolid& of = hierarchy_.solid(at.solid());
    ray.ahead.take();
    ray.take(at.solid(), *of.solid, of.parts[at.part()], t, log, any_);
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
