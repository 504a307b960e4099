// Light from an image of all directions, sampled by its brightness.
#include "renderer/transport/lights/environment.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "field/math/elementary.h"

namespace marrow {
namespace {

constexpr double pi = std::numbers::pi;

struct Interval1 {
  std::size_t index;
  double probability, within;
};

// The step of a cumulative table that u falls on, and where in it. Steps of no height are never met.
Interval1 find_step(std::span<const float> cumulative, double u) {
  const auto above = std::upper_bound(cumulative.begin() + 1, cumulative.end() - 1, u);
  const auto i = static_cast<std::size_t>(above - cumulative.begin()) - 1;
  const double low = cumulative[i], height = double(cumulative[i + 1]) - low;
  return {i, height, std::clamp((u - low) / height, 0.0, 1.0)};
}

// Writes the running sums of `weights`, from 0 to 1, and returns the whole. A sum of 0 gives zeros.
double accumulate_into(std::span<float> cumulative, std::span<const double> weights) {
  double total = 0;
  for (const double w : weights) total += w;
  double sum = 0;
  cumulative[0] = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    sum += weights[i];
    cumulative[i + 1] = total > 0 ? static_cast<float>(sum / total) : 0.0f;
  }
  if (total > 0) cumulative[weights.size()] = 1;
  return total;
}

}  // namespace

struct Environment::Tables {
  std::size_t width, height;
  std::vector<float> rgb;
  Rgb scale, mean;
  double turn;  // of the image, in widths
  bool z_up;
  std::vector<double> cos_edge;  // of the upper edge of each row, and of the last lower one
  std::vector<float> rows;       // cumulative over rows
  std::vector<float> columns;    // cumulative along each row, width + 1 a row

  Rgb texel(std::size_t x, std::size_t y) const {
    const std::size_t i = 3 * (y * width + x);
    return Rgb(rgb[i], rgb[i + 1], rgb[i + 2]) * scale;
  }
  std::span<const float> columns_of(std::size_t row) const {
    return std::span(columns).subspan(row * (width + 1), width + 1);
  }
  double solid_angle(std::size_t row) const { return 2 * pi / double(width) * (cos_edge[row] - cos_edge[row + 1]); }

  double mean_luminance(std::size_t x, std::size_t y) const;
  void build();
  Sample2 place(const UnitVec3& w) const;
  UnitVec3 direction(double u, double cos_theta) const;
};

// Of the interpolated image over a pixel: along each axis 1/8, 6/8, 1/8 of the neighbours.
double Environment::Tables::mean_luminance(std::size_t x, std::size_t y) const {
  const std::array<std::size_t, 3> xs{(x + width - 1) % width, x, (x + 1) % width};
  const std::array<std::size_t, 3> ys{y == 0 ? 0 : y - 1, y, std::min(y + 1, height - 1)};
  constexpr std::array<double, 3> share{0.125, 0.75, 0.125};
  double sum = 0;
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 3; ++i) sum += share[i] * share[j] * luminance(texel(xs[i], ys[j]));
  return std::max(sum, 0.0);
}

void Environment::Tables::build() {
  for (std::size_t y = 0; y <= height; ++y) cos_edge.push_back(cos(pi * double(y) / double(height)));
  rows.resize(height + 1);
  columns.resize(height * (width + 1));
  std::vector<double> row_weights(height), weights(width);
  for (std::size_t y = 0; y < height; ++y) {
    Rgb row;
    for (std::size_t x = 0; x < width; ++x) {
      weights[x] = mean_luminance(x, y);
      row += texel(x, y);
    }
    mean += row * (solid_angle(y) / (4 * pi));
    row_weights[y] = accumulate_into(std::span(columns).subspan(y * (width + 1), width + 1), weights) * solid_angle(y);
  }
  accumulate_into(rows, row_weights);
}

// Place in the image, both in [0, 1): u along the row from the left, v down.
Sample2 Environment::Tables::place(const UnitVec3& w) const {
  const double up = z_up ? w.z() : w.y(), back = z_up ? -w.y() : w.z();
  const double u = 0.5 + atan2(w.x(), -back) / (2 * pi) + turn;
  const double v = acos(std::clamp(up, -1.0, 1.0)) / pi;
  constexpr double below_one = 1 - 0x1p-53;
  return {std::min(u - std::floor(u), below_one), std::min(v, below_one)};
}

UnitVec3 Environment::Tables::direction(double u, double cos_theta) const {
  const double sin_theta = std::sqrt(std::max(0.0, 1 - cos_theta * cos_theta));
  const SinCos phi = sincos(2 * pi * (u - turn - 0.5));
  const double right = sin_theta * phi.sin, back = -sin_theta * phi.cos;
  return UnitVec3::unchecked(z_up ? Vec3d{right, -back, cos_theta} : Vec3d{right, cos_theta, back});
}

Environment::Environment(EnvironmentImage image, Rgb scale, double rotate_deg, bool z_up) {
  auto tables = std::make_shared<Tables>();
  tables->width = static_cast<std::size_t>(image.width);
  tables->height = static_cast<std::size_t>(image.height);
  tables->rgb = std::move(image.rgb);
  tables->scale = scale;
  tables->turn = rotate_deg / 360;
  tables->z_up = z_up;
  tables->build();
  tables_ = std::move(tables);
}

std::optional<LightSample> Environment::sample(Sample2 u) const {
  const Tables& t = *tables_;
  if (t.rows.back() == 0) return std::nullopt;
  const Interval1 row = find_step(t.rows, u.y);
  const Interval1 column = find_step(t.columns_of(row.index), u.x);
  const double cos_theta = t.cos_edge[row.index] + (t.cos_edge[row.index + 1] - t.cos_edge[row.index]) * row.within;
  const UnitVec3 wi = t.direction((double(column.index) + column.within) / double(t.width), cos_theta);
  return LightSample{.wi = wi,
                     .radiance = escaped(wi),
                     .distance = std::numeric_limits<double>::infinity(),
                     .pdf = row.probability * column.probability / t.solid_angle(row.index),
                     .delta = false};
}

double Environment::pdf(const UnitVec3& wi) const {
  const Tables& t = *tables_;
  const Sample2 p = t.place(wi);
  const auto x = static_cast<std::size_t>(p.x * double(t.width)), y = static_cast<std::size_t>(p.y * double(t.height));
  const std::span<const float> columns = t.columns_of(y);
  const double row = double(t.rows[y + 1]) - t.rows[y], column = double(columns[x + 1]) - columns[x];
  return row * column / t.solid_angle(y);
}

Rgb Environment::escaped(const UnitVec3& direction) const {
  const Tables& t = *tables_;
  const Sample2 p = t.place(direction);
  const double x = p.x * double(t.width) - 0.5, y = p.y * double(t.height) - 0.5;
  const double fx = x - std::floor(x), fy = y - std::floor(y);
  const std::size_t x0 = x < 0 ? t.width - 1 : static_cast<std::size_t>(x), x1 = (x0 + 1) % t.width;
  const std::size_t y0 = y < 0 ? 0 : static_cast<std::size_t>(y);
  const std::size_t y1 = y < 0 ? 0 : std::min(y0 + 1, t.height - 1);
  return (t.texel(x0, y0) * (1 - fx) + t.texel(x1, y0) * fx) * (1 - fy) +
         (t.texel(x0, y1) * (1 - fx) + t.texel(x1, y1) * fx) * fy;
}

Rgb Environment::mean() const { return tables_->mean; }

}  // namespace marrow
