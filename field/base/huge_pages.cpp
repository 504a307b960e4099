#include "field/base/huge_pages.h"

#include <cstdint>
#include <cstdlib>
#include <mutex>

#include <sys/mman.h>

namespace marrow {
namespace {

// Hands out chunks, from large ones that it keeps; chunks of a size of their own are freed when they come back.
class Chunks : public std::pmr::memory_resource {
  static constexpr std::size_t kept = 4 * huge_page, large = huge_page / 2;

  void* do_allocate(std::size_t bytes, std::size_t align) override {
    if (bytes > large) return allocate_huge((bytes + huge_page - 1) / huge_page * huge_page);
    const std::lock_guard lock(mutex_);
    auto at = (next_ + align - 1) / align * align;
    if (at + bytes > end_) {
      at = reinterpret_cast<std::uintptr_t>(allocate_huge(kept));
      end_ = at + kept;
    }
    next_ = at + bytes;
    return reinterpret_cast<void*>(at);
  }
  void do_deallocate(void* p, std::size_t bytes, std::size_t) override {
    if (bytes > large) std::free(p);
  }
  bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }

  std::mutex mutex_;
  std::uintptr_t next_ = 0, end_ = 0;
};

}  // namespace

void* allocate_huge(std::size_t bytes) {
  void* const p = std::aligned_alloc(huge_page, bytes);
  if (p == nullptr) throw std::bad_alloc();
  madvise(p, bytes, MADV_HUGEPAGE);  // a hint: without huge pages all works, with more page faults
  return p;
}

std::pmr::memory_resource& huge_pages() {
  // Never destroyed: objects of static lifetime may outlive any order.
  static Chunks& chunks = *new Chunks;
  static auto& pools = *new std::pmr::synchronized_pool_resource(&chunks);
  return pools;
}

}  // namespace marrow
