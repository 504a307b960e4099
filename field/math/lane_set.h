// Which lanes of a packet of rays. Kernels of all instruction sets use it, too: nothing here is left to the linker,
// which would keep the copy of any one of them for all.
#pragma once

#include <cstddef>
#include <cstdint>

namespace marrow {

inline constexpr int packet_size = 256;  ///< rays of a packet, a multiple of 64

/// Some lanes of a packet: a bit for each, the lowest that of lane 0.
class LaneSet {
 public:
  [[gnu::always_inline]] constexpr LaneSet() : words_{} {}
  /// `count` lanes from `first` on.
  [[gnu::always_inline]] static constexpr LaneSet range(std::size_t first, std::size_t count) {
    LaneSet set;
    for (int w = 0; w < words; ++w) set.words_[w] = before(first + count, w) & ~before(first, w);
    return set;
  }

  [[gnu::always_inline]] constexpr bool empty() const {
    for (const std::uint64_t word : words_)
      if (word != 0) return false;
    return true;
  }
  [[gnu::always_inline]] constexpr int count() const {
    int n = 0;
    for (const std::uint64_t word : words_) n += __builtin_popcountll(word);
    return n;
  }
  [[gnu::always_inline]] constexpr bool has(std::size_t lane) const { return words_[lane / 64] >> lane % 64 & 1; }
  [[gnu::always_inline]] constexpr void add(std::size_t lane) { words_[lane / 64] |= std::uint64_t{1} << lane % 64; }
  [[gnu::always_inline]] constexpr void remove(std::size_t lane) {
    words_[lane / 64] &= ~(std::uint64_t{1} << lane % 64);
  }

  /// Of a set that is not empty.
  [[gnu::always_inline]] constexpr int lowest() const {
    int w = 0;
    while (words_[w] == 0) ++w;
    return 64 * w + __builtin_ctzll(words_[w]);
  }
  /// Takes away the lowest ones, no more than `most`, and calls visit(lane) for each.
  template <class Visit>
  [[gnu::always_inline]] constexpr void take(int most, const Visit& visit) {
    for (int w = 0; w < words && most > 0; ++w) {
      std::uint64_t left = words_[w];
      for (; left != 0 && most > 0; left &= left - 1, --most) visit(64 * w + __builtin_ctzll(left));
      words_[w] = left;
    }
  }

  /// Of a group of Width lanes, which begins at a multiple of Width, as bits.
  template <int Width>
  [[gnu::always_inline]] constexpr unsigned group(std::size_t first) const {
    return static_cast<unsigned>(words_[first / 64] >> first % 64 & bits_of<Width>);
  }
  [[gnu::always_inline]] constexpr void add_group(std::size_t first, unsigned bits) {
    words_[first / 64] |= static_cast<std::uint64_t>(bits) << first % 64;
  }

  /// Calls visit(lane) for each of them, upwards.
  template <class Visit>
  [[gnu::always_inline]] constexpr void for_each(const Visit& visit) const {
    for (int w = 0; w < words; ++w)
      for (std::uint64_t left = words_[w]; left != 0; left &= left - 1) visit(64 * w + __builtin_ctzll(left));
  }
  /// Calls visit(first) for each group of Width lanes of which there are any.
  template <int Width, class Visit>
  [[gnu::always_inline]] constexpr void for_each_group(const Visit& visit) const {
    for (int w = 0; w < words; ++w)
      for (std::uint64_t left = words_[w]; left != 0;) {
        const int first = __builtin_ctzll(left) & -Width;
        left &= ~(bits_of<Width> << first);
        visit(64 * w + first);
      }
  }

  [[gnu::always_inline]] constexpr LaneSet& operator|=(const LaneSet& other) {
    for (int w = 0; w < words; ++w) words_[w] |= other.words_[w];
    return *this;
  }
  [[gnu::always_inline]] constexpr LaneSet& operator&=(const LaneSet& other) {
    for (int w = 0; w < words; ++w) words_[w] &= other.words_[w];
    return *this;
  }
  [[gnu::always_inline]] friend constexpr LaneSet operator~(LaneSet a) {
    for (std::uint64_t& word : a.words_) word = ~word;
    return a;
  }
  [[gnu::always_inline]] friend constexpr LaneSet operator|(LaneSet a, const LaneSet& b) { return a |= b; }
  [[gnu::always_inline]] friend constexpr LaneSet operator&(LaneSet a, const LaneSet& b) { return a &= b; }

 private:
  static constexpr int words = packet_size / 64;
  static_assert(packet_size % 64 == 0);
  template <int Width>
  static constexpr std::uint64_t bits_of = (std::uint64_t{1} << Width) - 1;

  // The lanes of a word before this one.
  [[gnu::always_inline]] static constexpr std::uint64_t before(std::size_t lane, int word) {
    const int end = static_cast<int>(lane) - 64 * word;
    return end <= 0 ? 0 : end >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << end) - 1;
  }

  std::uint64_t words_[words];
};

}  // namespace marrow
