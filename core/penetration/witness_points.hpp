// The witness points of two bodies that penetrate each other.
#pragma once

#include "core/model/query.hpp"
#include "core/penetration/depth.hpp"

namespace clearance {

// Finds the points that meet when B has been moved by the depth `found`, clear of A. Writes them to
// `answer`, in frame A, whose distance and normal are known, and to the state, which holds the last
// features.
void place_witnesses(const Query& query, const Depth& found, Answer& answer) noexcept;

}  // namespace clearance
