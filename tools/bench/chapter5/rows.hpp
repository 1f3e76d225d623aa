// Chapter 5's methods as rows of the benchmark:
//   ellipsoids/METHOD/D           the crossed ellipsoids D m apart, to the method's own end
//   ellipsoids/METHOD/to-1e-4/D   so many rounds that (5.2.1) is below 1e-4, as Table 5.2 has it;
//                                 no such row where that never happens
//   facet-ball/HOW/ORDER          Table 5.1: cold, tracked; neighbours-cold, neighbours-tracked
//   point/METHOD/FAMILY           §5.1 on 1,000 points: dominant, as-printed, newton
#pragma once

namespace clearance::bench {

void register_chapter5();

}  // namespace clearance::bench
