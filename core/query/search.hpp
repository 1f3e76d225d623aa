// Queries that feature tracking leaves open: the active-set iteration, GJK in double-double
// arithmetic, and the penetration depth (core/README.md).
#pragma once

#include "core/model/query.hpp"

namespace clearance {

// Starts from the features of the state. Bodies that touched or penetrated each other in the last
// query begin with their depth. Requires a good pose and bodies that are not curved.
[[nodiscard]] Answer search(const Query& query) noexcept;

}  // namespace clearance
