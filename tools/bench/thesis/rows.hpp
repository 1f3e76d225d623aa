// The rows of clearance-thesis, by the file that registers them.
#pragma once

namespace clearance::bench {

// Tables 3.3, 3.4, 4.1 and 4.2: variant/WHICH/tracked/f2 ... with WHICH one of
//   base, dual, consistent, aggressive   the release rules of §4.1, alpha over neighbours
//   all-facets                           base with alpha over all facets, as in §3.3
//   moved                                base on tables that are moved to the poses first
// and for facet-balls variant/moved-before/tracked/f2 ..., the same without the time for moving,
// and variant/base-repeated/tracked/f2 ..., base measured likewise.
void register_variants();

// Chapter 5:
//   ellipsoids/METHOD/D           the crossed ellipsoids D m apart, until the method ends by itself
//   ellipsoids/METHOD/to-1e-4/D   until (5.2.1) is below 1e-4, as in Table 5.2; no such row where
//   that
//                                 never happens
//   facet-ball/HOW/ORDER          Table 5.1: cold, tracked; neighbours-cold, neighbours-tracked
//   point/METHOD/FAMILY           §5.1 on 1,000 points: dominant, as-printed, newton
void register_chapter5();

}  // namespace clearance::bench
