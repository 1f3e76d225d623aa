#include "monitor/inputs/pose_batch.hpp"

namespace clearance {

const char* name(Reject cause) noexcept {
  switch (cause) {
    case Reject::kUnknownObject:
      return "unknown object";
    case Reject::kNonFinite:
      return "not finite";
    case Reject::kNotUnit:
      return "quaternion not of unit length";
    case Reject::kBackwards:
      return "time going backwards";
    case Reject::kFuture:
      return "stamp in the future";
    case Reject::kWrongRevision:
      return "made for another scene";
    case Reject::kOtherSource:
      return "another source sends it";
    case Reject::kTooFast:
      return "faster than it moves";
    case Reject::kFrozen:
      return "frozen, but with a twist";
    case Reject::kOtherWay:
      return "elsewhere than its twist leads";
    case Reject::kDisputed:
      return "another source contradicts it";
    case Reject::kOutsideLimits:
      return "outside its position limits";
    case Reject::kCount:
      break;
  }
  return "";
}

}  // namespace clearance
