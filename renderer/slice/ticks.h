// Round numbers for axes, colour bars and scale bars.
#pragma once

#include <string>
#include <vector>

namespace marrow {

/// The largest of 1, 2, 5 times a power of ten that is at most `length` > 0.
double round_length(double length);

/// Multiples of 1, 2 or 5 times a power of ten in [low, high], at most `most` >= 2 of them.
std::vector<double> ticks(double low, double high, int most);

/// As few digits as tell `value` from its neighbours `step` away, with a true minus sign.
std::string label(double value, double step);

}  // namespace marrow
