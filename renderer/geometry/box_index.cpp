#include "renderer/geometry/box_index.h"

#include <utility>

#include <embree3/rtcore.h>

#include "renderer/geometry/float_margin.h"

namespace marrow {
namespace {

// One after the other is sooner.
constexpr std::size_t few = 16;

// What Embree wants of boxes, while it builds its hierarchy.
struct PaddedBoxes {
  const std::vector<Box3>& boxes;
  Vec3d middle;
  double margin;
};

void bounds_callback(const RTCBoundsFunctionArguments* a) {
  const auto& [boxes, middle, margin] = *static_cast<const PaddedBoxes*>(a->geometryUserPtr);
  const Box3& box = boxes[a->primID];
  if (box.empty()) {
    *a->bounds_o = {1, 1, 1, 0, -1, -1, -1, 0};  // Embree leaves it out
    return;
  }
  const auto [lower, upper] = box_in_floats(box, middle, margin);
  *a->bounds_o = {lower[0], lower[1], lower[2], 0, upper[0], upper[1], upper[2], 0};
}

}  // namespace

struct BoxIndex::Search {
  const BoxIndex& index;
  const Vec3d& p;
  const Visit& visit;
  bool done = false;

  // Embree proposes boxes by floats. It cannot be stopped, only told nothing more.
  static bool propose(RTCPointQueryFunctionArguments* a) {
    constexpr bool smaller = false;  // the sphere that is searched
    Search& s = *static_cast<Search*>(a->userPtr);
    if (!s.done && s.index.boxes_[a->primID].contains(s.p)) s.done = !s.visit(a->primID);
    return smaller;
  }
};

Result<BoxIndex> BoxIndex::make(RTCDeviceTy* device, std::vector<Box3> boxes) {
  BoxIndex index;
  index.boxes_ = std::move(boxes);
  for (const Box3& b : index.boxes_) index.all_.include(b);
  if (index.boxes_.size() > few && !index.all_.empty()) index.build(device);
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE) return failure("Embree could not build its hierarchy of bodies");
  return index;
}

// Places that are asked for lie within all boxes.
void BoxIndex::build(RTCDeviceTy* device) {
  middle_ = all_.center();
  PaddedBoxes padded{boxes_, middle_, margin_of_floats(all_, middle_, 4)};
  margin_ = padded.margin;
  scene_.reset(rtcNewScene(device));
  RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(g, static_cast<unsigned>(boxes_.size()));
  rtcSetGeometryUserData(g, &padded);
  rtcSetGeometryBoundsFunction(g, bounds_callback, nullptr);
  rtcCommitGeometry(g);
  rtcAttachGeometry(scene_.get(), g);
  rtcReleaseGeometry(g);
  rtcCommitScene(scene_.get());
}

void BoxIndex::find(const Vec3d& p, const Visit& visit) const {
  if (!all_.contains(p)) return;
  if (scene_ == nullptr) {
    for (std::size_t i = 0; i < boxes_.size(); ++i)
      if (boxes_[i].contains(p) && !visit(i)) return;
    return;
  }
  Search search{*this, p, visit};
  const Vec3d q = p - middle_;
  RTCPointQuery query{.x = static_cast<float>(q.x),
                      .y = static_cast<float>(q.y),
                      .z = static_cast<float>(q.z),
                      .time = 0,
                      .radius = static_cast<float>(margin_)};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene_.get(), &query, &context, Search::propose, &search);
}

}  // namespace marrow
