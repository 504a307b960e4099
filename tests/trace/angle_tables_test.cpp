// Tables of a range of angles never say outside wrongly, and are on the curves of all its angles.
#include "field/trace/curve/angle_tables.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "field/blend/correction/correction.h"
#include "field/trace/curve/turned_curve.h"
#include "tests/trace/random_scene.h"

namespace marrow::test {
namespace {

// What kernels read where directions give the angle, in double.
class TablesOfAngles {
 public:
  TablesOfAngles(const Correction& like, double least, double most)
      : curves_(like, least, most, UpToGradient{usual_gradient(like)}),
        tables_(curves_.tables()),
        like_(like),
        least_(least),
        most_(most) {}

  int steps() const { return tables_.count; }
  int entries(int step) const { return static_cast<int>(tables_.last[step]); }

  // Places at an angle, -1/2 <= s <= 1/2 of a step of the range.
  struct AtAngle {
    const TablesOfAngles& of;
    int step;
    double s;
    Correction correction;

    double in_s(double a, double b, double c) const { return a + s * (b + s * c); }
    double sine() const { return static_cast<double>(of.tables_.sin_theta[step]); }
    double cosine() const { return static_cast<double>(of.tables_.cos_theta[step]); }
    double u(double place) const {
      const auto number = [&](const float* const(&p)[3]) {
        return in_s(static_cast<double>(p[0][step]), static_cast<double>(p[1][step]), static_cast<double>(p[2][step]));
      };
      return number(of.tables_.begin) + place / number(of.tables_.inverse_step);
    }
    const float* entry(int i) const { return of.tables_.entries + 4 * (step * of.tables_.stride + i); }
    // V, and V_lower.
    double value(int i, double fraction) const {
      const auto at = [&](const float* p) {
        return in_s(static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2]));
      };
      return std::lerp(at(entry(i)), at(entry(i + 1)), fraction);
    }
    double lower(int i, double fraction) const {
      return value(i, fraction) -
             std::lerp(static_cast<double>(entry(i)[3]), static_cast<double>(entry(i + 1)[3]), fraction);
    }
    double x(double u, double v) const { return v * sine() - u * cosine(); }
    double y(double u, double v) const { return u * sine() + v * cosine(); }
  };
  AtAngle at(int step, double s) const {
    const double alpha = least_ + (step + 0.5 + s) / tables_.count * (most_ - least_);
    return {*this, step, s,
            Correction(like_.degree(), std::clamp(alpha, least_, most_), like_.cavity(), like_.projection())};
  }

 private:
  AngleCurves curves_;
  AngleTables tables_;
  Correction like_;
  double least_, most_;
};

struct NamedTables {
  TablesOfAngles tables;
  std::string name;
};

// Of wide and narrow ranges. Some take a quarter of a second.
const std::vector<NamedTables>& all_tables() {
  struct Range {
    double least, most;
  };
  static const std::vector<NamedTables> all = [] {
    std::vector<NamedTables> made;
    for (const Projection projection : {Projection::Paper, Projection::Exact})
      for (const bool cavity : {true, false})
        for (int n = 3; n <= 6; ++n)
          for (const Range range : {Range{1.16, 1.57}, Range{0.02, std::numbers::pi / 2}, Range{0.4, 1.36},
                                    Range{0, 0.4}, Range{1.5, std::numbers::pi / 2}, Range{1.3, 1.3001},
                                    Range{-0.3, 1.2}, Range{-0.8, 0.1}, Range{-0.03, 0.02}, Range{-0.8, -0.7}}) {
            if (range.least < 0 && projection == Projection::Exact) continue;
            const Correction like(n, range.least, cavity, projection);
            if (!(critical_field_of(like) < 100)) continue;
            made.push_back(
                {TablesOfAngles(like, range.least, range.most), name_of({n, range.least, cavity, projection})});
          }
    return made;
  }();
  return all;
}

// Where V_lower is, C < 1, whatever f and the angle: at the entries, which lie on the kinks, and between them.
TEST(AngleCurves, LowerIsBelowTheCurvesOfAllAngles) {
  constexpr int angles = 3;
  Random random(38);
  int places = 0, certain = 0;
  for (const auto& [tables, name] : all_tables()) {
    for (int step = 0; step < tables.steps(); ++step)
      for (int k = 0; k < angles; ++k) {
        const auto angle = tables.at(step, k == 0 ? -0.5 : k == 1 ? 0.5 : random.between(-0.5, 0.5));
        for (int i = 0; i < tables.entries(step); ++i) {
          const double fraction = (i + k) % 3 == 0 ? 0 : random.between(0, 1), lower = angle.lower(i, fraction);
          const double u = angle.u(i + fraction), x = angle.x(u, lower), y = angle.y(u, lower);
          ++places;
          if (x < 0 || y < 0) continue;
          ++certain;
          ASSERT_LT(angle.correction.value(x, y), 1) << name << " step " << step << " s=" << angle.s << " entry " << i
                                                     << "+" << fraction << " x=" << x << " y=" << y;
        }
      }
  }
  EXPECT_GT(certain, 0.8 * places);
}

// Hits lie where the tables say. Without cavity the slope of C is not bounded where G is nearly 0.
TEST(AngleCurves, AreOnTheCurvesOfTheirAngles) {
  constexpr double least_field = 0.3, largest_gradient = 2.5, allowed = 1.5e-4, usual = 1.5e-5;
  constexpr int first_entries = 12;
  Random random(39);
  double largest = 0;
  for (const auto& [tables, name] : all_tables()) {
    int rough = 0, places = 0;
    for (int step = 0; step < tables.steps(); ++step) {
      const auto angle = tables.at(step, random.between(-0.5, 0.5));
      const double steepest = largest_gradient * (angle.correction.degree() - 1);
      for (int i = first_entries; i < tables.entries(step); ++i) {
        const double fraction = random.between(0, 1), v = angle.value(i, fraction), u = angle.u(i + fraction);
        const double x = angle.x(u, v), y = angle.y(u, v);
        if (x < least_field || x > 3 || y < 0 || y > steepest) continue;
        const double off = std::fabs(angle.correction.value(x, y) - 1);
        ++places;
        rough += off > usual;
        largest = std::max(largest, off);
        EXPECT_LT(off, allowed) << name << " step " << step << " s=" << angle.s << " x=" << x << " y=" << y;
      }
    }
    EXPECT_LE(rough, 0.01 * places) << name;
  }
  std::cout << "  C is off by up to " << largest << '\n';
}

// The f from least_field on at which a curve has places, and its G, from the axis G = 0 on.
std::vector<std::pair<double, double>> places_on(const TurnedCurve& curve, double least_field) {
  constexpr int count = 600;
  std::vector<std::pair<double, double>> places;
  for (int i = 0; i <= count; ++i) {
    const TurnedLine line = curve.line_of(std::lerp(curve.begin(), curve.end(), static_cast<double>(i) / count));
    const double v = curve.value(line.u);
    if (line.x(v) < least_field) break;
    places.emplace_back(line.x(v), line.y(v));
  }
  return places;
}

// Below 0: up to the crest curves rise over f, no steeper than the tables say, and fall behind it.
TEST(AngleCurves, CrestsLieWhereTheTablesSay) {
  constexpr double least_field = 0.1, rounding = 1e-9;
  Random random(40);
  int crests = 0;
  for (const int n : {3, 4, 6, 9, 14, 20})
    for (const double least : {-0.8, -0.35, -0.02}) {
      const double most = least + 0.1;
      const Correction like(n, least, true, Projection::Paper);
      const AngleCurves curves(like, least, most, UpToGradient{usual_gradient(like)});
      const AngleTables tables = curves.tables();
      for (int step = 0; step < tables.count; ++step) {
        const double alpha = std::lerp(least, most, (step + random.between(0, 1)) / tables.count);
        const Correction correction(n, alpha, true, Projection::Paper);
        const TurnedCurve curve(correction, critical_field_of(correction), turn_for(alpha, alpha),
                                UpToGradient{usual_gradient(like)});
        const double from = static_cast<double>(tables.crest_from[step]),
                     to = static_cast<double>(tables.crest_to[step]), rise = static_cast<double>(tables.rise[step]);
        const auto places = places_on(curve, least_field);
        for (std::size_t i = 1; i < places.size(); ++i) {
          const auto [x, y] = places[i];
          const auto [x_behind, y_behind] = places[i - 1];
          if (x > to) { EXPECT_GE(y, y_behind - rounding) << "n=" << n << " alpha=" << alpha << " f=" << x; }
          if (x_behind < from) { EXPECT_LE(y, y_behind + rounding) << "n=" << n << " alpha=" << alpha << " f=" << x; }
          EXPECT_LE(y_behind - y, rise * (x_behind - x) + rounding) << "n=" << n << " alpha=" << alpha << " f=" << x;
        }
        // Near 0, where curves hardly rise at all, the crest moves far.
        EXPECT_LT(to - from, alpha < -0.05 ? 0.25 : 10) << "n=" << n << " alpha=" << alpha;
        EXPECT_LT(rise, 7) << "n=" << n << " alpha=" << alpha;
        crests += to > least_field;
      }
    }
  std::cout << "  " << crests << " crests\n";
  EXPECT_GT(crests, 50);
}

}  // namespace
}  // namespace marrow::test
