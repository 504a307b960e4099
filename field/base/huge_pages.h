// Memory in huge pages, for what rays come to in no order.
//
// Tiles, blocks and parts of a picture are hundreds of thousands of small objects. In pages of 4 KB each visit has to
// look up where its page is, which on some virtual machines takes a good part of the visit.
#pragma once

#include <cstddef>
#include <memory_resource>
#include <new>

namespace marrow {

/// Pools of memory, safe to use from many threads; what is given back serves again, but stays with the process.
std::pmr::memory_resource& huge_pages();

/// What derives from this lives there when it is made by `new`.
class InHugePages {
 public:
  static void* operator new(std::size_t size, std::align_val_t align) {
    return huge_pages().allocate(size, static_cast<std::size_t>(align));
  }
  static void* operator new(std::size_t size) { return huge_pages().allocate(size); }
  static void operator delete(void* p, std::size_t size, std::align_val_t align) {
    huge_pages().deallocate(p, size, static_cast<std::size_t>(align));
  }
  static void operator delete(void* p, std::size_t size) { huge_pages().deallocate(p, size); }
};

/// A chunk of its own, a multiple of `huge_page` bytes, aligned to that; freed by std::free(). Throws std::bad_alloc.
void* allocate_huge(std::size_t bytes);
inline constexpr std::size_t huge_page = std::size_t{1} << 21;

}  // namespace marrow
