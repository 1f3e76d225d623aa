// Finds the first field in which a recorded message of a tick differs from the replayed one.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "config/scene/scene.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// Options of a comparison.
struct DifferenceOptions {
  std::uint64_t cycle_offset = 0;  // recorded cycle numbers are ahead of replayed ones by this
  // Fields that the recording's build did not have, "Distances.queries": they are not compared.
  const std::set<std::string>* not_recorded = nullptr;
  // The names of the two messages in the text.
  std::string_view first = "recorded", second = "replayed";
};

// The first field that differs, with both values: "pairs[2] (hand - box).lower: recorded 0.5,
// replayed 0.25"; none when the messages agree to the bit. Every field is compared except those of
// Meaning::kDelivery, which no tick determines. Message: Distances, Separation, Gradients or
// ZoneState.
template <class Message>
[[nodiscard]] std::optional<std::string> message_difference(const Scene& scene,
                                                            const Message& recorded,
                                                            const Message& replayed,
                                                            const DifferenceOptions& options = {});

// The first pair whose bounds do not overlap. Bounds of one pair contain the same true distance, so
// they must overlap, whichever build computed them.
[[nodiscard]] std::optional<std::string> bounds_difference(const Scene& scene,
                                                           const clearance_msg_Distances& recorded,
                                                           const clearance_msg_Distances& replayed);

}  // namespace clearance
