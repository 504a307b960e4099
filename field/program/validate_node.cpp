#include "field/program/validate_node.h"

#include <cmath>

#include <fmt/format.h>

namespace marrow {
namespace {

// Called by a node's keys() with each of its parameters.
template <class Owner>
class KeyCheck {
 public:
  KeyCheck(const Owner& owner, std::vector<NodeProblem>& found) : owner_(owner), found_(found) {}

  template <class Member, class Form>
  void operator()(const char* name, Member member, const Form& form, const char*) const {
    check(name, owner_.*member, form);
  }

 private:
  void add(const char* name, const std::string& value, const std::string& hint) const {
    found_.push_back({fmt::format("`{}` is {}", name, value), hint});
  }
  void range(const char* name, double x, double min, double max, bool min_open) const {
    if ((min_open ? x > min : x >= min) && x <= max) return;
    add(name, fmt::format("{}", x),
        fmt::format("it is {} {} and at most {}", min_open ? "above" : "at least", min, max));
  }
  void check(const char* name, double x, const form::Real& r) const { range(name, x, r.min, r.max, r.min_open); }
  void check(const char* name, double x, const form::Angle& a) const {
    constexpr double degree = 3.14159265358979323846 / 180;
    range(name, x / degree * (1 - 0x1p-51), a.min_deg, a.max_deg, false);  // a limit in degrees was rounded twice
  }
  void check(const char* name, int x, const form::Whole& w) const { range(name, x, w.min, w.max, false); }
  void check(const char*, bool, const form::Switch&) const {}
  void check(const char* name, const Vec3d& p, const form::Position&) const {
    if (!is_finite(p)) add(name, "not finite", "coordinates are finite numbers");
  }
  void check(const char* name, const UnitVec3& d, const form::Direction&) const {
    if (!(std::fabs(length(d.vec()) - 1) < 1e-9)) add(name, "no unit vector", "a direction has length 1");
  }
  void check(const char* name, const Vec3d& s, const form::Sizes&) const {
    for (std::size_t i = 0; i < 3; ++i) range(name, s[i], 0, form::largest, true);
  }
  void check(const char* name, const std::vector<Vec3d>& points, const form::Points& p) const {
    if (points.size() < p.min_count)
      add(name, fmt::format("a list of {}", points.size()), fmt::format("it has at least {} points", p.min_count));
    for (const Vec3d& q : points)
      if (!is_finite(q)) return add(name, "not finite", "coordinates are finite numbers");
  }
  void check(const char* name, const std::vector<double>& list, const form::Reals& r) const {
    for (const double x : list) range(name, x, r.min, r.max, r.min_open);
  }
  void check(const char* name, const std::vector<std::vector<double>>& rows, const form::Rows& r) const {
    for (const auto& row : rows)
      for (const double x : row) range(name, x, r.min, r.max, false);
  }
  template <class Enum>
  void check(const char*, const Enum&, const form::Word&) const {}
  template <class Choice>
  void check(const char*, const Choice& choice, const form::OneOf&) const {
    std::visit([&]<class Kind>(const Kind& kind) { Kind::keys(KeyCheck<Kind>(kind, found_)); }, choice);
  }

  const Owner& owner_;
  std::vector<NodeProblem>& found_;
};

std::string children_of(const NodeInfo& info) {
  if (info.max_children == 0) return "it takes no children";
  if (info.min_children == info.max_children) return fmt::format("it takes {} under `of:`", info.min_children);
  if (info.max_children == any_number_of_children)
    return fmt::format("it takes at least {} under `of:`", info.min_children);
  return fmt::format("it takes {} to {} under `of:`", info.min_children, info.max_children);
}

}  // namespace

std::vector<NodeProblem> problems_of(const AnyNode& node, std::size_t children) {
  std::vector<NodeProblem> found;
  std::visit(
      [&]<class Kind>(const Kind& kind) {
        constexpr NodeInfo info = Kind::info;
        if (children < info.min_children || children > info.max_children)
          found.push_back({fmt::format("{} of {} children", info.name, children), children_of(info)});
        Kind::keys(KeyCheck<Kind>(kind, found));
        if constexpr (requires { kind.problem(children); })
          if (const std::string wrong = kind.problem(children); found.empty() && !wrong.empty())
            found.push_back({fmt::format("{}: {}", info.name, wrong), ""});
      },
      node);
  return found;
}

}  // namespace marrow
