// The batch: benchmarks batch/boxes ..., the same pairs by single queries, and each vector width.
#pragma once

namespace clearance::bench {

void register_batches();

}  // namespace clearance::bench
