// Memory for levels that are not kept.
#pragma once

#include <cstddef>
#include <memory>
#include <new>

namespace marrow {

/// Room for one level after another, 64-byte aligned.
class LevelBuffer {
 public:
  /// What was in it before is lost.
  float* allocate(std::size_t float_count) {
    if (float_count > capacity_) {
      data_.reset(static_cast<float*>(::operator new(float_count * sizeof(float), alignment)));
      capacity_ = float_count;
    }
    return data_.get();
  }
  std::size_t bytes() const { return capacity_ * sizeof(float); }

 private:
  static constexpr std::align_val_t alignment{64};
  struct Free {
    void operator()(float* p) const { ::operator delete(p, alignment); }
  };
  std::unique_ptr<float, Free> data_;
  std::size_t capacity_ = 0;
};

}  // namespace marrow
