// Sine and cosine that have the same bits on every machine.
//
// The C library selects among several implementations by the processor, and versions differ in the
// last bit. A replay must reproduce every distance, so these functions use only sums and products.
#pragma once

namespace clearance {

struct SineCosine {
  double sine = 0.0, cosine = 1.0;
};

// The largest error of either value, for |angle| <= kLargestJoint.
inline constexpr double kSineError = 0x1p-51;

[[nodiscard]] SineCosine sine_cosine(double angle) noexcept;  // rad

}  // namespace clearance
