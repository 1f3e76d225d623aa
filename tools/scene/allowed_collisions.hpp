// A proposal which pairs of a robot's links need not be watched, as setup assistants make it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "config/urdf/urdf.hpp"
#include "tools/scene/sampled_contacts.hpp"

namespace clearance {

// In the words of SRDFs, in their order of weight; kWatch: it is to be watched.
enum class AllowedReason : std::uint8_t { kWatch, kAdjacent, kDefault, kAlways, kNever };

// Adjacent; touching at zero; touching in 19 of 20 samples or more; in none.
[[nodiscard]] AllowedReason reason_to_allow(const SampledPair& pair, std::uint64_t samples);

// <disable_collisions> lines of an SRDF, with the counts as comments.
[[nodiscard]] std::string as_srdf(const Scene& scene, const std::vector<SampledPair>& pairs,
                                  std::uint64_t samples);
// The `allowed_collisions` of a cell.
[[nodiscard]] std::string as_cell(const Scene& scene, const std::vector<SampledPair>& pairs,
                                  std::uint64_t samples);

// What both have, and what only one of them has, with the counts.
[[nodiscard]] std::string agreement(const Scene& scene, const std::vector<SampledPair>& pairs,
                                    std::uint64_t samples, const Srdf& srdf);

}  // namespace clearance
