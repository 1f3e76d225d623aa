// overlap/tracked/KIND/HOW and overlap/cold/KIND/HOW: what a depth costs (core/OVERLAP.md). KIND is
// a workload's kind of bodies; HOW says how far their origins are apart, as a part of what they are
// when they touch: shallow 97 %, half 50 %, near 10 %, nearer 1 %, middle 0.
#pragma once

namespace clearance::bench {

void register_overlaps();

}  // namespace clearance::bench
