// The watched pairs that two names stand for.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"

namespace clearance {

// Returns the watched pairs of two objects or groups, or of the zone `a` if `b` is empty, as
// ascending indices into Scene::pairs. Empty: a name is none of these, or no such pair is watched.
[[nodiscard]] std::vector<std::uint32_t> pairs_between(const Scene& scene, const std::string& a,
                                                       const std::string& b);

// Why there is none: which name the cell does not have, or that no rule watches such a pair.
[[nodiscard]] std::string why_no_pairs_between(const Scene& scene, const std::string& a,
                                               const std::string& b);

}  // namespace clearance
