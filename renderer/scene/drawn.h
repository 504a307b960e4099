// What every primitive may say beside its skeleton: model, alpha, material.
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "field/description/field_node.h"
#include "renderer/scene/alpha_forms.h"
#include "renderer/scene/primitive_forms.h"
#include "renderer/scene/table.h"

namespace marrow {

/// A skeleton with what every primitive may say. The skeleton is a base so that its members can be bound as they are.
template <class Skeleton>
struct Drawn : Skeleton {
  std::optional<SkeletonModel> model;
  std::optional<double> alpha;
  std::optional<std::array<double, 2>> alpha_bounds;
  std::vector<Attribute> attributes;
  MaterialId material;
};

template <class Skeleton>
std::vector<Key<Drawn<Skeleton>>> with_common_keys(std::vector<Key<Drawn<Skeleton>>> keys) {
  using Owner = Drawn<Skeleton>;
  keys.push_back(key<Owner>("model", &Owner::model, skeleton_model(), "its field; the blend's when left out"));
  keys.push_back(key<Owner>("alpha", &Owner::alpha, primitive_alpha(),
                            "in radians, for `alpha: per_skeleton`; contact when left out"));
  keys.push_back(key<Owner>("alpha_bounds", &Owner::alpha_bounds, direction_bounds_form(),
                            "for `alpha: {direction: …}`; the blend's when left out"));
  keys.push_back(key<Owner>("attributes", &Owner::attributes, attributes_form(),
                            "numbers by name, one for all or one for each point, for `alpha: {attribute: …}`"));
  keys.push_back(key<Owner>("material", &Owner::material, material_name(), "the object's when left out"));
  return keys;
}

/// The primitive with this skeleton and what the author said about it.
template <class Skeleton, class Any>
Primitive primitive_with(Any skeleton, const Drawn<Skeleton>& drawn) {
  return {.skeleton = std::move(skeleton),
          .model = drawn.model,
          .alpha = drawn.alpha,
          .alpha_bounds = drawn.alpha_bounds,
          .attributes = drawn.attributes,
          .material = drawn.material};
}

}  // namespace marrow
