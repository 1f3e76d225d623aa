// Absence of an object: it is known not to be there. This differs from an object that was never
// heard of.
//
// An absent object has no pose, and its samples are refused. When it is present again it starts
// like an object that was never heard of. Only its owner and its refusal counts remain.
#pragma once

#include "monitor/bodies/tracked_object.hpp"

namespace clearance {

// Makes an object absent, which is not absent yet. Does not allocate.
void make_absent(TrackedObject& state) noexcept;

// Makes the object present. No pose is in use until the next sample comes.
inline void make_present(TrackedObject& state) noexcept { state.absent = false; }

}  // namespace clearance
