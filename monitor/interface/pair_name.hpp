// The name of a pair in all programs: "hand - box". If an object has several parts, the name
// contains the part: "hand.finger - box".
#pragma once

#include <cstdint>
#include <string>

#include "config/scene/scene.hpp"
#include "monitor/interface/report.hpp"

namespace clearance {

[[nodiscard]] inline std::string pair_name(const std::string& a, const std::string& b) {
  return a + " - " + b;
}

// `pair` is an index into Scene::pairs. A pair that does not exist is named by its number.
[[nodiscard]] std::string pair_name(const Scene& scene, std::uint32_t pair);

// The name with the closest parts.
[[nodiscard]] std::string pair_name(const Scene& scene, const PairReport& pair);

}  // namespace clearance
