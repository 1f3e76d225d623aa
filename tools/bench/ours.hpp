// The core on every workload: benchmarks tracked/f2 ... cold/v40, and interval/N/f2 ...
#pragma once

namespace clearance::bench {

void register_ours();

}  // namespace clearance::bench
