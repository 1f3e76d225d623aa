// Includes the file that HWY_TARGET_INCLUDE names once per vector width, in a namespace each.
// Vectors have two doubles at the x86-64 baseline and on Arm, four with AVX2. The choice is made at
// run time.
#define HWY_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#include <hwy/foreach_target.h>
