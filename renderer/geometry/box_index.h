// Which of many boxes hold a place.
#pragma once

#include <cstddef>
#include <vector>

#include "field/base/result.h"
#include "field/math/box3.h"
#include "renderer/geometry/embree_handles.h"

namespace marrow {

/// Safe to use from many threads.
class BoxIndex {
 public:
  BoxIndex() = default;
  /// Errors: Embree could not build its hierarchy. The device must outlive it. An empty box holds nothing.
  static Result<BoxIndex> make(RTCDeviceTy*, std::vector<Box3>);

  /// use(index) of those that hold p, in any order; it says whether to go on.
  template <class Use>
  void for_each_at(const Vec3d& p, const Use& use) const {
    find(p, {&use, [](const void* what, std::size_t i) -> bool { return (*static_cast<const Use*>(what))(i); }});
  }

 private:
  struct Visit {
    const void* what;
    bool (*call)(const void* what, std::size_t index);
    bool operator()(std::size_t index) const { return call(what, index); }
  };
  struct Search;
  void find(const Vec3d&, const Visit&) const;
  void build(RTCDeviceTy*);

  std::vector<Box3> boxes_;
  Box3 all_;
  Vec3d middle_;       // Embree's origin
  double margin_ = 0;  // that Embree's boxes are padded by
  EmbreeScene scene_;  // none where boxes are few
};

}  // namespace marrow
