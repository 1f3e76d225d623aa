// The cell's assumptions about the motion of one input, and the speed that is assumed without any.
#pragma once

#include <cstdint>

namespace clearance {

// The speed that is assumed during timing errors if the cell states none, m/s or rad/s.
inline constexpr double kUsualSpeed = 1.0;

// The cell's assumptions about the motion of one input. Speeds are in m/s, or in rad/s for angles.
struct MotionLimits {
  double fastest = 0.0;  // no faster
  double usual = 0.0;    // the speed that is assumed during timing errors
  std::int64_t age_limit_ns = 0;
  std::int64_t frozen_limit_ns = 0;  // a value may repeat for this long; 0: without limit
};

}  // namespace clearance
