// Every byte is read through bounds that were checked before; nothing is allocated before the sizes are known to fit.
#include "renderer/scene/files/cyhair.h"

#include <cmath>
#include <cstdint>
#include <utility>

#include <fmt/core.h>

#include "renderer/scene/files/bytes.h"
#include "renderer/scene/files/node_list.h"
#include "renderer/scene/files/text_scan.h"

namespace marrow {
namespace {

// The layout of the header: "HAIR", then these at their offsets, then 88 bytes for people.
constexpr std::size_t header_bytes = 128, strands_at = 4, points_at = 8, arrays_at = 12, segments_at = 16,
                      thickness_at = 20;
enum Array : std::uint32_t { Segments = 1, Points = 2, Thickness = 4, Transparency = 8, Colours = 16, AllArrays = 31 };

// Bits of the array word stand in its lowest byte; in the wrong byte order they would stand in the highest.
bool is_big_endian(std::string_view bytes) {
  return Bytes(bytes, false).whole(arrays_at, 4) > AllArrays && Bytes(bytes, true).whole(arrays_at, 4) <= AllArrays;
}

class HairReader {
 public:
  HairReader(std::string_view text, const SkeletonOptions& options, const std::string& name)
      : bytes_(text, is_big_endian(text)), options_(options), problems_({}, name), list_(options, problems_) {}

  Result<SkeletonFile> read() {
    read_header();
    if (problems_.none()) read_strands();
    SkeletonFile made;
    if (problems_.none()) made = std::move(list_).finish();
    if (!problems_.none()) return problems_.take();
    return made;
  }

 private:
  void read_header() {
    strands_ = bytes_.whole(strands_at, 4);
    points_ = bytes_.whole(points_at, 4);
    arrays_ = static_cast<std::uint32_t>(bytes_.whole(arrays_at, 4));
    segments_ = bytes_.whole(segments_at, 4);
    thickness_ = bytes_.real32(thickness_at);
    if (arrays_ > AllArrays)
      return problems_.complain_of_file(fmt::format("the header names unknown arrays ({:#x})", arrays_));
    if (!(arrays_ & Points)) return problems_.complain_of_file("the file has no array of points");
    if (strands_ == 0 || points_ == 0) return problems_.complain_of_file("the file has no strands");
    if (points_ > NodeList::max_nodes)
      return problems_.complain_of_file(
          fmt::format("the file has {} points; the limit is {}", points_, NodeList::max_nodes));
    const std::uint64_t segment_bytes = arrays_ & Segments ? 2 * strands_ : 0, point_bytes = 12 * points_;
    first_point_ = header_bytes + segment_bytes;
    first_thickness_ = first_point_ + point_bytes;
    const std::uint64_t needed = first_thickness_ + (arrays_ & Thickness ? 4 * points_ : 0);
    if (needed > bytes_.size())
      return problems_.complain_of_file(fmt::format("the file has {} bytes, but {} strands with {} points need {}",
                                                    bytes_.size(), strands_, points_, needed),
                                        "it was cut, or is not what its header says");
    if (!(arrays_ & Thickness) && !options_.radius && !(std::isfinite(thickness_) && thickness_ > 0))
      problems_.complain_of_file("the hair has no thickness", "give the skeleton a `radius`");
  }

  std::uint64_t segments_of(std::uint64_t strand) const {
    return arrays_ & Segments ? bytes_.whole(header_bytes + 2 * strand, 2) : segments_;
  }

  void read_strands() {
    std::uint64_t sum = 0;
    for (std::uint64_t strand = 0; strand < strands_ && sum <= points_; ++strand) sum += segments_of(strand) + 1;
    if (sum != points_)
      return problems_.complain_of_file(fmt::format("the strands have {}{} points together, but the header says {}",
                                                    sum > points_ ? "at least " : "", sum, points_));
    list_.reserve(points_);
    std::uint64_t point = 0;
    for (std::uint64_t strand = 0; strand < strands_ && !problems_.is_full(); ++strand)
      for (std::uint64_t i = 0, count = segments_of(strand) + 1; i < count && !problems_.is_full(); ++i)
        read_point(strand, point++, i > 0);
  }

  void read_point(std::uint64_t strand, std::uint64_t point, bool has_parent) {
    const std::size_t at = first_point_ + 12 * point;
    const Vec3d position{bytes_.real32(at), bytes_.real32(at + 4), bytes_.real32(at + 8)};
    const double thickness = arrays_ & Thickness ? bytes_.real32(first_thickness_ + 4 * point) : thickness_;
    const double radius = options_.radius ? *options_.radius : thickness / 2;
    if (!is_finite(position) || !std::isfinite(radius) || radius < 0)
      return problems_.complain_of_file(
          fmt::format("point {} of strand {} is not finite, or thinner than nothing (byte {})", point, strand, at));
    list_.add(position, radius, has_parent ? list_.next_index() - 1 : -1);
  }

  Bytes bytes_;
  const SkeletonOptions& options_;
  FileProblems problems_;
  NodeList list_;
  std::uint64_t strands_ = 0, points_ = 0, segments_ = 0;
  std::uint32_t arrays_ = 0;
  double thickness_ = 0;
  std::size_t first_point_ = 0, first_thickness_ = 0;
};

}  // namespace

Result<SkeletonFile> read_cyhair(std::string_view bytes, const SkeletonOptions& options, const std::string& name) {
  if (!bytes.starts_with("HAIR")) return failure("not a cyHair file: it does not begin with HAIR", name);
  if (bytes.size() < header_bytes)
    return failure(fmt::format("the file has {} bytes; a cyHair header alone has 128", bytes.size()), name);
  return HairReader(bytes, options, name).read();
}

}  // namespace marrow
