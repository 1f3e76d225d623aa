// Proposes which pairs of a robot's links need not be watched, as setup assistants do.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "config/urdf/urdf.hpp"
#include "tools/scene/sampled_contacts.hpp"

namespace clearance {

// The reasons of SRDFs, by weight. kWatch: there is no reason, and the pair is watched.
enum class AllowedReason : std::uint8_t { kWatch, kAdjacent, kDefault, kAlways, kNever };

// Adjacent; in contact at zero; in contact in 19 of 20 samples or more; in contact in none.
[[nodiscard]] AllowedReason reason_to_allow(const SampledPair& pair, std::uint64_t samples);

// <disable_collisions> lines of an SRDF, with the counts as comments.
[[nodiscard]] std::string as_srdf(const Scene& scene, const std::vector<SampledPair>& pairs,
                                  std::uint64_t samples);
// The `allowed_collisions` of a cell.
[[nodiscard]] std::string as_cell(const Scene& scene, const std::vector<SampledPair>& pairs,
                                  std::uint64_t samples);

// Lists the pairs that both allow, and those that only one allows, with the counts.
[[nodiscard]] std::string agreement(const Scene& scene, const std::vector<SampledPair>& pairs,
                                    std::uint64_t samples, const Srdf& srdf);

}  // namespace clearance
