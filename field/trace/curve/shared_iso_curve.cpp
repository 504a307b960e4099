#include "field/trace/curve/shared_iso_curve.h"

#include <map>
#include <mutex>
#include <tuple>

#include "field/blend/correction/correction.h"

namespace marrow {
namespace {

using Key = std::tuple<int, bool, Projection, double, double, double, double>;

std::shared_ptr<const IsoCurve> made(const Correction& correction, double least, double most, UpToGradient up_to) {
  if (least < most) return std::make_shared<const IsoCurve>(correction, least, most, up_to);
  return std::make_shared<const IsoCurve>(correction, least, up_to);
}

}  // namespace

// Made outside of the lock: two threads may both make one; one copy is kept.
std::shared_ptr<const IsoCurve> shared_iso_curve(const Correction& correction, double least, double most,
                                                 UpToGradient up_to) {
  static std::mutex mutex;
  static std::map<Key, std::weak_ptr<const IsoCurve>> known;
  const Key key{correction.degree(), correction.cavity(), correction.projection(), correction.alpha(), least, most,
                up_to.largest};
  {
    const std::lock_guard lock(mutex);
    if (const auto found = known[key].lock()) return found;
  }
  auto curve = made(correction, least, most, up_to);
  const std::lock_guard lock(mutex);
  auto& kept = known[key];
  if (const auto found = kept.lock()) return found;
  kept = curve;
  return curve;
}

}  // namespace marrow
