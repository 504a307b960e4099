#include "field/trace/cells/block_arena.h"

#include <algorithm>
#include <cstdlib>

#include "field/base/huge_pages.h"

namespace marrow {
namespace {
constexpr std::size_t chunk_bytes = 4 * huge_page;
}  // namespace

void BlockArena::Free::operator()(void* p) const { std::free(p); }

float* BlockArena::allocate(std::size_t float_count) {
  const std::size_t bytes = (float_count * sizeof(float) + 63) / 64 * 64;
  const std::lock_guard lock(mutex_);
  if (bytes > left_) {
    const std::size_t size = std::max(chunk_bytes, (bytes + huge_page - 1) / huge_page * huge_page);
    Chunk chunk(allocate_huge(size));
    next_ = static_cast<std::byte*>(chunk.get());
    left_ = size;
    total_ += size;
    all_ += size;
    chunks_.push_back(std::move(chunk));
  }
  auto* result = reinterpret_cast<float*>(next_);
  next_ += bytes;
  left_ -= bytes;
  return result;
}

std::size_t BlockArena::bytes() const {
  const std::lock_guard lock(mutex_);
  return total_;
}

}  // namespace marrow
