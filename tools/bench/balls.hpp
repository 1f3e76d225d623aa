// The core on the thesis's workload: benchmarks tracked/f2 ... cold/v40.
#pragma once

namespace clearance::bench {

void register_balls();

}  // namespace clearance::bench
