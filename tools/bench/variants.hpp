// Tables 3.3, 3.4, 4.1 and 4.2: benchmarks variant/WHICH/tracked/f2 ... with WHICH one of
//   base, dual, consistent, aggressive   the release rules of §4.1, alpha over neighbours
//   all-facets                           base with alpha over all facets, as in §3.3
//   moved                                base on tables that are moved to the poses first
// and, of facet-balls only, variant/moved-before/tracked/f2 ..., the same without the time for
// transforming, and variant/base-repeated/tracked/f2 ..., base measured in the same way.
#pragma once

namespace clearance::bench {

void register_variants();

}  // namespace clearance::bench
