// The penetration depth of two bodies as an answer, tracked.
#pragma once

#include <optional>

#include "core/model/query.hpp"
#include "core/penetration/depth.hpp"

namespace clearance {

// For bodies that touched or penetrated each other in the last query: answers this query if they
// certainly penetrate. False: that is not certified; `answer` is not touched, and the features of
// the state are where a search should begin. `found` gets the depth if it was looked for.
[[nodiscard]] bool track_penetration(const Query& query, Answer& answer,
                                     std::optional<Depth>& found) noexcept;

// For an answer whose lower bound is not positive. Bounds it from below, and finds the depth if the
// bodies penetrate. The state holds the last features and gets the new ones. `known`: the depth, if
// it is known already.
void measure_penetration(const Query& query, const std::optional<Depth>& known,
                         Answer& answer) noexcept;

}  // namespace clearance
