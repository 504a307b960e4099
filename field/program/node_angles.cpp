// Reads attributes, the radius among them.
#include "field/program/node_angles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <variant>

#include "field/base/overloaded.h"
#include "field/skeleton/subdivision_curve.h"

namespace marrow {
namespace {

std::vector<double> radii_of(const Primitive& primitive) {
  return std::visit(
      Overloaded{[](const PointSkeleton& s) { return std::vector<double>{s.radius}; },
                 [](const SegmentSkeleton& s) {
                   return std::vector<double>{s.radius_from, s.radius_to};
                 },
                 [](const ArcSkeleton& s) {
                   return std::vector<double>{s.radius_from, s.radius_to};
                 },
                 [](const TriangleSkeleton& s) { return std::vector<double>(s.radii.begin(), s.radii.end()); },
                 [](const SharedSkeletonGraph& s) { return s->radii; }, [](const auto& s) { return s.radii; }},
      primitive.skeleton);
}

std::vector<double> values_of(const Primitive& primitive, const std::string& name) {
  for (const Attribute& attribute : primitive.attributes)
    if (attribute.name == name) return attribute.values;
  return name == "radius" ? radii_of(primitive) : std::vector<double>{};
}

// Radii are subdivided linearly, and so is what takes their place.
std::vector<double> subdivided(const CurveSkeleton& curve, const std::vector<double>& values) {
  CurveSkeleton carrier = curve;
  carrier.radii = values;
  return subdivide(carrier).radii;
}

// A value that is no angle becomes the nearest one.
double as_angle(const AlphaAttribute& rule, double value) {
  return std::clamp(rule.ramp ? (*rule.ramp)(value) : value, -1.0, std::numbers::pi / 2);
}

}  // namespace

bool has_attribute(const Primitive& primitive, const std::string& name) { return !values_of(primitive, name).empty(); }

NodeAngles::NodeAngles(const Primitive& primitive, const Alpha& rule, double otherwise) {
  if (std::holds_alternative<AlphaPerSkeleton>(rule)) angles_ = {primitive.alpha.value_or(otherwise)};
  if (const auto* attribute = std::get_if<AlphaAttribute>(&rule)) {
    angles_ = values_of(primitive, attribute->name);
    const auto* curve = std::get_if<CurveSkeleton>(&primitive.skeleton);
    if (curve != nullptr && angles_.size() > 1) angles_ = subdivided(*curve, angles_);
    for (double& angle : angles_) angle = as_angle(*attribute, angle);
  }
  if (angles_.empty()) angles_ = {otherwise};
}

std::size_t node_count(const Primitive& primitive) { return radii_of(primitive).size(); }

}  // namespace marrow
