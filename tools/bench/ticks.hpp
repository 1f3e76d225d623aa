// Whole ticks of generated cells, up to millions of pairs.
#pragma once

namespace clearance::bench {

void register_ticks();

}  // namespace clearance::bench
