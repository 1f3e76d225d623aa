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

struct AllowRule {
  std::uint64_t samples = 0;   // how many positions the pairs were sampled in
  double never_margin = 0.05;  // m: 'Never' needs a greater least distance
};

// A pair may touch if it is adjacent, in contact with all joints at zero, or in contact in at least
// 19 of 20 samples. It may also touch if it is farther apart than the margin in all samples. More
// samples meet smaller distances, so a pair that came near may well touch.
[[nodiscard]] AllowedReason reason_to_allow(const SampledPair& pair, const AllowRule& rule);

// <disable_collisions> lines of an SRDF, with the counts as comments.
[[nodiscard]] std::string as_srdf(const Scene& scene, const std::vector<SampledPair>& pairs,
                                  const AllowRule& rule);
// The `allowed_collisions` of a cell.
[[nodiscard]] std::string as_cell(const Scene& scene, const std::vector<SampledPair>& pairs,
                                  const AllowRule& rule);

// Lists the pairs that touched in no sample but came within the margin, with their least distances;
// empty if there are none.
[[nodiscard]] std::string near_misses(const Scene& scene, const std::vector<SampledPair>& pairs,
                                      const AllowRule& rule);

// Lists the pairs that both allow, and those that only one allows, with the counts.
[[nodiscard]] std::string agreement(const Scene& scene, const std::vector<SampledPair>& pairs,
                                    const AllowRule& rule, const Srdf& srdf);

}  // namespace clearance
