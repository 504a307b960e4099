#include "field/trace/cells/block_arena.h"

#include <algorithm>
#include <cstdlib>
#include <new>

#include "field/base/huge_pages.h"

namespace marrow {
namespace {

// The first chunks are small: a scene may have thousands of blends of a few cells each, and touching a huge page takes
// as long as tracing some of them.
constexpr std::size_t first_bytes = std::size_t{1} << 16, most_bytes = 4 * huge_page;
std::size_t bytes_of_chunk(std::size_t number) {
  std::size_t bytes = first_bytes;
  for (std::size_t i = 0; i < number && bytes < most_bytes; ++i) bytes *= 4;
  return std::min(bytes, most_bytes);
}

void* allocate_chunk(std::size_t bytes) {
  if (bytes % huge_page == 0) return allocate_huge(bytes);
  void* const p = std::aligned_alloc(64, bytes);
  if (p == nullptr) throw std::bad_alloc();
  return p;
}

}  // namespace

void BlockArena::Free::operator()(void* p) const { std::free(p); }

float* BlockArena::allocate(std::size_t float_count) {
  const std::size_t bytes = (float_count * sizeof(float) + 63) / 64 * 64;
  const std::lock_guard lock(mutex_);
  if (bytes > left_) {
    const std::size_t usual = bytes_of_chunk(chunks_.size());
    const std::size_t size = bytes <= usual ? usual : (bytes + huge_page - 1) / huge_page * huge_page;
    Chunk chunk(allocate_chunk(size));
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
