#include "tests/golden/compare.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace marrow {
namespace {

bool stands_for(const std::string& name, const std::string& channel) {
  return channel == name || channel.starts_with(name + ".");
}

bool chosen(const std::string& channel, std::span<const std::string> names) {
  return std::any_of(names.begin(), names.end(), [&](const std::string& n) { return stands_for(n, channel); });
}

std::vector<double> as_doubles(const Channel& c) {
  return std::visit([](const auto& samples) { return std::vector<double>(samples.begin(), samples.end()); }, c.samples);
}

const Channel* find(const std::vector<Channel>& channels, const std::string& name) {
  const auto found = std::find_if(channels.begin(), channels.end(), [&](const Channel& c) { return c.name == name; });
  return found == channels.end() ? nullptr : &*found;
}

// got - want, where equal infinities are equal and a NaN is infinitely far from everything.
double difference_of(double got, double want) {
  if (got == want) return 0;
  const double d = got - want;
  return std::isnan(d) ? Thresholds::any : d;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

double relative_mean(double got, double want) {
  const double d = std::fabs(difference_of(got, want));
  return d == 0 ? 0 : d / std::fabs(want);
}

void judge(ChannelDifference& c, const Thresholds& t) {
  c.passed = c.failed_percent <= t.fail_percent && c.largest <= t.hard_fail && c.relative_mse <= t.relative_mse &&
             c.relative_mean <= t.relative_mean;
}

// `differences` receives got - want of each pixel.
ChannelDifference compare_channel(const std::string& name, const std::vector<double>& got,
                                  const std::vector<double>& want, int width, const Thresholds& thresholds,
                                  std::vector<float>& differences) {
  ChannelDifference c{.name = name};
  const double count = static_cast<double>(want.size());
  for (std::size_t i = 0; i < want.size(); ++i) {
    const double d = difference_of(got[i], want[i]), size = std::fabs(d);
    differences.push_back(static_cast<float>(d));
    if (size > c.largest) {
      c.largest = size;
      c.worst_x = static_cast<int>(i) % width;
      c.worst_y = static_cast<int>(i) / width;
    }
    c.mean += size / count;
    if (size > 0) c.relative_mse += d * d / (want[i] * want[i] + 0.01) / count;
    if (size > thresholds.fail) c.failed_percent += 100 / count;
  }
  if (std::isnan(c.relative_mse)) c.relative_mse = Thresholds::any;  // infinity against a number, over infinity
  c.relative_mean = relative_mean(mean_of(got), mean_of(want));
  judge(c, thresholds);
  return c;
}

Status check_names(const Picture& got, const Picture& want, std::span<const std::string> names) {
  if (names.empty()) return failure("no channels to compare");
  if (got.display != want.display || got.data != want.data)
    return failure(fmt::format("the windows differ: got {} x {} at ({}, {}), want {} x {} at ({}, {})",
                               got.data.width(), got.data.height(), got.data.x0, got.data.y0, want.data.width(),
                               want.data.height(), want.data.x0, want.data.y0));
  for (const std::string& name : names)
    if (select_channels(want, {&name, 1}).empty()) return failure("the reference has no channel " + name);
  for (const Channel& c : want.channels)
    if (chosen(c.name, names) && !find(got.channels, c.name)) return failure("the picture has no channel " + c.name);
  for (const Channel& c : got.channels)
    if (chosen(c.name, names) && !find(want.channels, c.name)) return failure("the reference has no channel " + c.name);
  return Done{};
}

}  // namespace

bool Comparison::passed() const {
  return !channels.empty() && std::all_of(channels.begin(), channels.end(), [](const auto& c) { return c.passed; });
}

std::vector<Channel> select_channels(const Picture& picture, std::span<const std::string> names) {
  std::vector<Channel> selected;
  for (const Channel& c : picture.channels)
    if (chosen(c.name, names)) selected.push_back(c);
  return selected;
}

Result<Comparison> compare(const Picture& got, const Picture& want, std::span<const std::string> names,
                           const Thresholds& thresholds) {
  if (Status fine = check_names(got, want, names); !fine) return fine.why();
  Comparison comparison;
  comparison.difference = {.display = want.display, .data = want.data, .channels = {}, .metadata = {}};
  for (const Channel& c : want.channels) {
    if (!chosen(c.name, names)) continue;
    const std::vector<double> a = as_doubles(*find(got.channels, c.name)), b = as_doubles(c);
    if (a.size() != b.size()) return failure("channel " + c.name + " has another number of samples");
    std::vector<float> differences;
    comparison.channels.push_back(compare_channel(c.name, a, b, want.data.width(), thresholds, differences));
    comparison.difference.channels.push_back({c.name, std::move(differences)});
  }
  return comparison;
}

std::string report(const Comparison& comparison, const Thresholds& t) {
  std::string text = fmt::format("{:<5} {:<14} {:>11} {:>11} {:>11} {:>11} {:>9}  worst at\n", "", "channel", "max|d|",
                                 "mean|d|", "relMSE", "rel. mean", "failed %");
  for (const ChannelDifference& c : comparison.channels)
    text += fmt::format("{:<5} {:<14} {:>11.4g} {:>11.4g} {:>11.4g} {:>11.4g} {:>9.4g}  ({}, {})\n",
                        c.passed ? "ok" : "FAIL", c.name, c.largest, c.mean, c.relative_mse, c.relative_mean,
                        c.failed_percent, c.worst_x, c.worst_y);
  return text + fmt::format(
                    "limits: fail {:g}, fail_percent {:g}, hard_fail {:g}, relative_mse {:g}, "
                    "relative_mean {:g}\n",
                    t.fail, t.fail_percent, t.hard_fail, t.relative_mse, t.relative_mean);
}

}  // namespace marrow
