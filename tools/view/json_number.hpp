// JSON has no infinities: null takes their place.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

namespace clearance::view {

[[nodiscard]] inline nlohmann::json number(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

}  // namespace clearance::view
