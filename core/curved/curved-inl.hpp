// The query of a pair with a curved body, once per vector width: defined in newton.cpp.
#if defined(CLEARANCE_CORE_CURVED) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_CURVED
#undef CLEARANCE_CORE_CURVED
#else
#define CLEARANCE_CORE_CURVED
#endif

#include "core/model/relative_pose-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// Any state and any pose are accepted.
void curved_distance(const Query4& query, DistanceResult& result);

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
