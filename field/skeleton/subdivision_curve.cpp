// Refines joints with their radii, level by level.
#include "field/skeleton/subdivision_curve.h"

#include <utility>
#include <vector>

namespace marrow {
namespace {

struct Joint {
  Vec3d at;
  double radius;
  bool sticks;
};

// Written so that equal values stay equal.
Joint between(const Joint& a, const Joint& b, double share) {
  return {a.at + (b.at - a.at) * share, a.radius + (b.radius - a.radius) * share, false};
}

// The joints before and after joint i, around the end of a closed curve.
const Joint& before(const std::vector<Joint>& joints, std::size_t i) {
  return joints[i > 0 ? i - 1 : joints.size() - 1];
}
const Joint& after(const std::vector<Joint>& joints, std::size_t i) {
  return joints[i + 1 < joints.size() ? i + 1 : 0];
}

std::vector<Joint> cut_corners(const std::vector<Joint>& joints) {
  std::vector<Joint> finer;
  finer.reserve(2 * joints.size());
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].sticks) {
      finer.push_back(joints[i]);
    } else {
      finer.push_back(between(joints[i], before(joints, i), 0.25));
      finer.push_back(between(joints[i], after(joints, i), 0.25));
    }
  }
  return finer;
}

// 1/8, 6/8, 1/8: half way to the middle of the two middles of its edges.
Joint smoothed(const Joint& previous, const Joint& joint, const Joint& next) {
  return between(joint, between(previous, next, 0.5), 0.25);
}

std::vector<Joint> smooth(const std::vector<Joint>& joints, bool closed) {
  std::vector<Joint> finer;
  finer.reserve(2 * joints.size());
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Joint &previous = before(joints, i), &next = after(joints, i);
    if (i > 0 || closed) finer.push_back(between(previous, joints[i], 0.5));
    finer.push_back(joints[i].sticks ? joints[i] : smoothed(previous, joints[i], next));
  }
  return finer;
}

}  // namespace

PolylineSkeleton subdivide(const CurveSkeleton& curve) {
  std::vector<Joint> joints;
  joints.reserve(curve.points.size());
  for (std::size_t i = 0; i < curve.points.size(); ++i) joints.push_back({curve.points[i], curve.radii[i], false});
  if (!curve.closed) joints.front().sticks = joints.back().sticks = true;
  for (const int i : curve.sticking) joints[static_cast<std::size_t>(i)].sticks = true;
  for (int level = 0; level < curve.levels; ++level)
    joints = curve.subdivision == Subdivision::Chaikin ? cut_corners(joints) : smooth(joints, curve.closed);
  if (curve.closed) joints.push_back(joints.front());
  PolylineSkeleton line;
  line.points.reserve(joints.size());
  line.radii.reserve(joints.size());
  for (const Joint& joint : joints) {
    line.points.push_back(joint.at);
    line.radii.push_back(joint.radius);
  }
  return line;
}

}  // namespace marrow
