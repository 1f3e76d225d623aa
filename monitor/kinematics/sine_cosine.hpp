// Sine and cosine that are the same bits on every machine.
//
// The C library's are not: it chooses among several by the processor, and versions differ in the
// last bit. A replay has to find every distance again, so these are made of nothing but sums and
// products.
#pragma once

namespace clearance {

struct SineCosine {
  double sine = 0.0, cosine = 1.0;
};

// Each is off by at most this, for |angle| <= kLargestJoint.
inline constexpr double kSineError = 0x1p-51;

[[nodiscard]] SineCosine sine_cosine(double angle) noexcept;  // rad

}  // namespace clearance
