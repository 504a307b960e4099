#include "renderer/output/exr_zip.h"

#include <new>

#include <libdeflate.h>

namespace marrow {
namespace {

// Of 1 to 12; files are 2 % smaller than at zlib's fastest level, in three fifths of the time. Level 1 takes longer.
constexpr int level = 2;

// Each second byte, as its difference to the one before: vectors are made of this loop.
std::byte* differences(const unsigned char* from, std::size_t count, std::byte* to) {
  for (std::size_t i = 0; i < count; ++i) to[i] = static_cast<std::byte>(from[2 * i] - from[2 * i - 2] + 128);
  return to + count;
}

// Bytes of even place before those of odd place, and all but the first as differences.
//   [https://openexr.com/en/latest/OpenEXRFileLayout.html, and ImfZip.cpp]
void rearrange(std::span<const std::byte> samples, std::span<std::byte> to) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(samples.data());
  const std::size_t even = (samples.size() + 1) / 2, odd = samples.size() / 2;
  to[0] = samples[0];
  std::byte* next = differences(bytes + 2, even - 1, to.data() + 1);
  if (odd == 0) return;
  *next = static_cast<std::byte>(bytes[1] - bytes[2 * (even - 1)] + 128);
  differences(bytes + 3, odd - 1, next + 1);
}

}  // namespace

void ExrZip::Free::operator()(libdeflate_compressor* deflate) const { libdeflate_free_compressor(deflate); }

ExrZip::ExrZip() : deflate_(libdeflate_alloc_compressor(level)) {
  if (!deflate_) throw std::bad_alloc();
}

std::vector<std::byte> ExrZip::compress(std::span<const std::byte> samples) {
  rearranged_.resize(samples.size());
  compressed_.resize(samples.size() - 1);  // no more than what is shorter
  rearrange(samples, rearranged_);
  const std::size_t size = libdeflate_zlib_compress(deflate_.get(), rearranged_.data(), rearranged_.size(),
                                                    compressed_.data(), compressed_.size());
  if (size == 0) return {samples.begin(), samples.end()};
  return {compressed_.begin(), compressed_.begin() + static_cast<std::ptrdiff_t>(size)};
}

}  // namespace marrow
