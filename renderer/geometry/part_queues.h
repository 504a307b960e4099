// Rays that wait at parts until they are traced there together.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace marrow {

/// Parts and rays are numbers from 0 on. A ray waits at one part at a time.
class PartQueues {
 public:
  /// For as many parts and rays; nobody waits.
  void start(std::size_t parts, std::size_t rays) {
    for (; served_ < parts_.size(); ++served_) first_[parts_[served_]] = nobody;
    parts_.clear();
    served_ = 0;
    if (first_.size() < parts) first_.resize(parts, nobody);
    if (behind_.size() < rays) behind_.resize(rays);
  }

  void wait(std::uint32_t ray, std::uint32_t part) {
    if (first_[part] == nobody) parts_.push_back(part);
    behind_[ray] = first_[part];
    first_[part] = ray;
  }

  /// Nobody waits.
  bool empty() const { return served_ == parts_.size(); }

  /// Takes all rays from the part where they have waited longest; false when none waits anywhere.
  bool next(std::uint32_t& part, std::vector<std::uint32_t>& rays) {
    if (empty()) return false;
    part = parts_[served_++];
    rays.clear();
    for (std::uint32_t ray = first_[part]; ray != nobody; ray = behind_[ray]) rays.push_back(ray);
    first_[part] = nobody;
    return true;
  }

 private:
  static constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> first_;   // of each part
  std::vector<std::uint32_t> behind_;  // of each ray: the next at the same part
  std::vector<std::uint32_t> parts_;   // as rays came to them; a part is twice in it only when served in between
  std::size_t served_ = 0;
};

}  // namespace marrow
