// Owning handles for Embree's objects.
#pragma once

#include <memory>
#include <type_traits>

struct RTCDeviceTy;
struct RTCSceneTy;

namespace marrow {

struct EmbreeRelease {
  void operator()(RTCDeviceTy*) const;
  void operator()(RTCSceneTy*) const;
};

using EmbreeDevice = std::unique_ptr<RTCDeviceTy, EmbreeRelease>;
using EmbreeScene = std::unique_ptr<RTCSceneTy, EmbreeRelease>;

}  // namespace marrow
