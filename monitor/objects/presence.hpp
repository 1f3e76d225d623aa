// An object that is known not to be there: absent, as distinct from one that was never heard of.
//
// An absent object has no pose, and samples of it are refused. When it is present again it is like
// an object that was never heard of: nothing from before its absence counts, except who sends its
// poses and how many of them were refused.
#pragma once

#include "monitor/objects/tracked_object.hpp"

namespace clearance {

// The object is a moving one, which is not absent already. Allocates nothing.
void make_absent(TrackedObject& state) noexcept;

// No pose is in use until the next sample comes.
inline void make_present(TrackedObject& state) noexcept { state.absent = false; }

}  // namespace clearance
