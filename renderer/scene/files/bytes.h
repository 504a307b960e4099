// Numbers in binary files, of either byte order.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace marrow {

/// The caller sees to it that what is asked for lies in the file.
class Bytes {
 public:
  Bytes(std::string_view bytes, bool is_big_endian) : bytes_(bytes), is_big_(is_big_endian) {}

  std::size_t size() const { return bytes_.size(); }
  /// Of 1 to 8 bytes, without a sign.
  std::uint64_t whole(std::size_t at, std::size_t size) const {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i)
      value |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes_[at + i]))
               << 8 * (is_big_ ? size - 1 - i : i);
    return value;
  }
  double real32(std::size_t at) const { return std::bit_cast<float>(static_cast<std::uint32_t>(whole(at, 4))); }
  double real64(std::size_t at) const { return std::bit_cast<double>(whole(at, 8)); }

 private:
  std::string_view bytes_;
  bool is_big_;
};

}  // namespace marrow
