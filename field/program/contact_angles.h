// Angles and rules of contact, computed once for all blends alike; internal to program/.
#pragma once

#include <map>
#include <memory>
#include <tuple>

#include "field/blend/angle/contact.h"
#include "field/blend/angle/local_contact.h"
#include "field/description/field_node.h"

namespace marrow {

/// contact_angle() takes some microseconds, too many for each of 10^5 blends alike.
class ContactAngles {
 public:
  const ContactAngle& of(const Blend& blend) {
    const Kernel& k = blend.kernel;
    const Key key{k.family, k.degree, k.shape, blend.cavity, blend.projection};
    const auto known = angles_.find(key);
    if (known != angles_.end()) return known->second;
    return angles_[key] = contact_angle(k, blend.cavity, blend.projection);
  }
  std::shared_ptr<const LocalContact> local(const Blend& blend, const AlphaLocalContact& rule) {
    const Kernel& k = blend.kernel;
    auto& known = local_[{k.family, k.degree, k.shape, blend.cavity, blend.projection, rule.radii, rule.density}];
    if (!known)
      known = std::make_shared<const LocalContact>(k, blend.cavity, blend.projection, rule.radii, rule.density);
    return known;
  }

 private:
  std::map<std::tuple<KernelFamily, int, double, bool, Projection, bool, bool>, std::shared_ptr<const LocalContact>>
      local_;
  using Key = std::tuple<KernelFamily, int, double, bool, Projection>;
  std::map<Key, ContactAngle> angles_;
};

}  // namespace marrow
