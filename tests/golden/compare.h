// Compares a picture with its reference, in the words of idiff.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "field/base/result.h"
#include "renderer/output/picture.h"

namespace marrow {

/// What a channel may differ by. A pixel fails when |got - want| > fail.
struct Thresholds {
  static constexpr double any = std::numeric_limits<double>::infinity();
  double fail = 0;             ///< in the channel's own unit
  double fail_percent = 0;     ///< share of the pixels that may fail
  double hard_fail = any;      ///< no pixel may differ by more
  double relative_mse = any;   ///< mean of (got - want)^2 / (want^2 + 0.01)
  double relative_mean = any;  ///< |mean(got) - mean(want)| / |mean(want)|
};

/// How a channel differs. Equal infinities do not differ; a NaN differs by infinity from everything, itself too.
struct ChannelDifference {
  std::string name;
  double largest = 0, mean = 0, relative_mse = 0, relative_mean = 0;
  double failed_percent = 0;
  int worst_x = 0, worst_y = 0;
  bool passed = false;
};

struct Comparison {
  std::vector<ChannelDifference> channels;
  Picture difference;  ///< got - want
  bool passed() const;
};

/// Compares the channels with these names; "N" stands for all of "N.X", "N.Y", ... as well.
/// Errors: windows differ, a name meets no channel of the reference, a channel is missing in one of the two.
Result<Comparison> compare(const Picture& got, const Picture& want, std::span<const std::string> names,
                           const Thresholds&);

/// The channels of a picture that one of the names stands for.
std::vector<Channel> select_channels(const Picture&, std::span<const std::string> names);

/// A table for people: a line per channel, failures marked.
std::string report(const Comparison&, const Thresholds&);

}  // namespace marrow
