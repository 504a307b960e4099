#include "field/trace/iso_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <tbb/parallel_for.h>

#include "field/blend/correction.h"

namespace marrow {
namespace {

// Of angles. What cubic lines between such tables are off: a millionth in the mean, ten millionths for nine points of a
// curve in ten, but some thousandths beside the kink at the border of the cavity branch, which moves with the angle
// (n = 4, tables 0.024 apart).
constexpr double largest_step = 0.03;
constexpr int entry_count = 256, probe_count = 256;

// Tables for `count` angles, the first and the last at a given place in steps of `step`.
std::vector<IsoTable> tables_for(const Correction& c, double first, double step, std::size_t count, int entries) {
  std::vector<std::optional<IsoTable>> made(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    const double alpha = first + step * static_cast<double>(i);
    made[i].emplace(Correction(c.degree(), alpha, c.cavity(), c.projection()), alpha, entries);
  });
  std::vector<IsoTable> all;
  for (auto& table : made) all.push_back(std::move(*table));
  return all;
}

}  // namespace

// Lagrange's polynomials for the four tables around a share; of one table, that one.
struct IsoCurve::Place {
  std::span<const IsoTable> rows;
  std::array<double, 4> weight{1};

  Place(const std::vector<IsoTable>& all, double share) : rows(all) {
    if (all.size() == 1) return;
    const double steps = static_cast<double>(all.size() - 1), at = std::clamp(share, 0.0, 1.0) * steps;
    const double begin = std::clamp(std::floor(at) - 1, 0.0, static_cast<double>(all.size() - 4));
    rows = rows.subspan(static_cast<std::size_t>(begin), 4);
    const double a = at - begin, b = a - 1, c = a - 2, d = a - 3;
    weight = {b * c * d / -6, a * c * d / 2, a * b * d / -2, a * b * c / 6};
  }
  double nominal(double x, double y) const {
    double sum = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) sum += weight[i] * rows[i].nominal(x, y);
    return sum;
  }
};

IsoCurve::IsoCurve(const Correction& correction, double alpha) : least_(alpha), most_(alpha) {
  rows_.emplace_back(correction, alpha);
  views_.push_back(rows_.front().view());
}

IsoCurve::IsoCurve(const Correction& correction, double least, double most, Range range) : least_(least), most_(most) {
  if (range == Range::Skeletons) add_rows(correction);
  else rows_ = tables_for(correction, least, most - least, 2, entry_count);
  for (const IsoTable& row : rows_) views_.push_back(row.view());
  angles_ = AngleCurves(correction, least, most);
}

void IsoCurve::add_rows(const Correction& correction) {
  const double steps = std::max(8.0, std::ceil((most_ - least_) / largest_step)), step = (most_ - least_) / steps;
  const auto count = static_cast<std::size_t>(steps);
  rows_ = tables_for(correction, least_, step, count + 1, entry_count);
  const auto between = tables_for(correction, least_ + step / 2, step, count, probe_count);
  for (std::size_t k = 0; k < count; ++k)
    for (int i = 0; i < between[k].size(); ++i) {
      const IsoTable::Point p = between[k].point(i);
      const double off = 2 * Place(rows_, (static_cast<double>(k) + 0.5) / steps).nominal(p.x, p.y);
      if (!(off > 0) || !std::isfinite(off)) continue;  // beyond the end of a table V_lower says no
      for (std::size_t row = k > 0 ? k - 1 : 0; row <= std::min(k + 2, count); ++row) rows_[row].lower_around(p, off);
    }
}

bool IsoCurve::outside(double x_low, double x_high, double y_high) const {
  return rows_.front().outside(x_low, x_high, y_high) &&
         (rows_.size() == 1 || rows_.back().outside(x_low, x_high, y_high));
}

bool IsoCurve::inside(double x_low, double y_low) const {
  return rows_.front().inside(x_low, y_low) && (rows_.size() == 1 || rows_.back().inside(x_low, y_low));
}

double IsoCurve::margin(double x, double y, double share) const {
  if (rows_.size() == 1) return rows_.front().margin(x, y);
  const Place place(rows_, share);
  double sum = 0;
  for (std::size_t i = 0; i < place.rows.size(); ++i) {
    const auto [nominal, lower] = place.rows[i].margins(x, y);
    if (!std::isfinite(nominal)) return -std::numeric_limits<double>::infinity();
    sum += place.weight[i] * nominal - std::fabs(place.weight[i]) * (nominal - lower);
  }
  return sum;
}

}  // namespace marrow
