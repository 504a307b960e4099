// The compression that EXR calls ZIP.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

struct libdeflate_compressor;

namespace marrow {

/// Compresses chunks one after the other; not for two threads at once.
class ExrZip {
 public:
  ExrZip();

  /// The samples of a chunk as they stand in the file: compressed, or as they are where that is no shorter.
  std::vector<std::byte> compress(std::span<const std::byte> samples);

 private:
  struct Free {
    void operator()(libdeflate_compressor*) const;
  };
  std::unique_ptr<libdeflate_compressor, Free> deflate_;
  std::vector<std::byte> rearranged_, compressed_;
};

}  // namespace marrow
