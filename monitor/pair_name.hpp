// How every program names a pair: "hand - box", with the part where an object has several:
// "hand.finger - box".
#pragma once

#include <cstdint>
#include <string>

#include "config/scene/scene.hpp"
#include "monitor/report.hpp"

namespace clearance {

[[nodiscard]] inline std::string pair_name(const std::string& a, const std::string& b) {
  return a + " - " + b;
}

// `pair`: index into Scene::pairs; one that is not there is named by its number.
[[nodiscard]] std::string pair_name(const Scene& scene, std::uint32_t pair);

// With the closest parts.
[[nodiscard]] std::string pair_name(const Scene& scene, const PairReport& pair);

}  // namespace clearance
