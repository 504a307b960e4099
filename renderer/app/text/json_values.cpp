#include "renderer/app/text/json_values.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace marrow {

std::string json(double x) {
  if (std::isnan(x)) return "null";
  if (std::isinf(x)) return x > 0 ? "1e999" : "-1e999";
  return fmt::format("{:.17g}", x);
}

std::string json(const Vec3d& v) { return fmt::format("[{}, {}, {}]", json(v.x), json(v.y), json(v.z)); }

std::string json(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace marrow
