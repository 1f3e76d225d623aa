// clearance-thesis: the tables of the thesis's chapters 2 to 5 as rows of a benchmark. Google
// Benchmark's own options apply.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <string_view>

#include "monitor/app/print.hpp"
#include "monitor/files/build_info.hpp"
#include "tools/bench/peers/peers.hpp"
#include "tools/bench/rows.hpp"
#include "tools/bench/thesis/adjacency.hpp"
#include "tools/bench/thesis/rows.hpp"

namespace {

constexpr const char* kHelp =
    R"(clearance-thesis measures the methods of the thesis beside ours and general ones, in thread CPU time.

Usage: clearance-thesis [OPTIONS]
  --version          print the version and the build
Options of Google Benchmark apply as well; its list stands at the end.

Rows:
  variant/WHICH/tracked/f2 ...  the active-set iteration of the thesis, uncertified (Tables 3.3, 3.4 and 4.1): base,
                     dual, consistent, aggressive, all-facets, moved (its tables, at every query)
  variant/moved-before/..., variant/base-repeated/...  a query without the time for moving the tables, and base
                     measured in the same way, each query 64 times (Table 4.2)
  interval/N/f2      queries with a cold start every N queries (Table 4.5)
  adjacency/WHO/f2   adjacency from half-spaces (Table 4.8): walk (the thesis's facet walk), core, qhull
  ellipsoids/HOW/D   the crossed ellipsoids D m apart (Table 5.2): ours, ours-tracked, the thesis's methods
                     (alternating, facet-balls, refinement-4, refinement-7, hybrid, polyhedron-ellipsoid),
                     free-margin, gjk, fcl, bullet ...
  ellipsoids/HOW/to-1e-4/D  the same up to this error of both points
  facet-ball/HOW/15  DQP3 on facet-balls around them (Table 5.1): cold, tracked, neighbours-...
  point/HOW/FAMILY   the nearest point of an ellipsoid (5.1): dominant, as-printed, newton; errors are shares of the
                     size
  tracked/f2, cold/f2, peer/WHO/tracked/f2, ...  ours and general solvers on the same bodies
`clearance-bench --help` explains the counters.

Examples:
  clearance-thesis --benchmark_filter='^variant/.*/tracked/f2$'
  tools/bench/report build/report thesis

Options of Google Benchmark:
)";

void register_all() {
  using namespace clearance::bench;
  register_ours(RowSet::kThesis);
  register_variants();
  register_adjacency();
  register_chapter5();
  register_peers(RowSet::kThesis);
#ifdef CLEARANCE_BENCH_QHULL
  register_qhull();
#else
  clearance::print(stderr, "qhull is left out: it needs libqhull-dev (tools/setup --bench)\n");
#endif
}

}  // namespace

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--version") {
      clearance::print(stdout, "clearance {}\n", clearance::kBuild);
      return 0;
    }
    if (word == "--help" || word == "-h") std::fputs(kHelp, stdout);
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::AddCustomContext("clearance", clearance::kBuild);
  register_all();
  const bool any = benchmark::RunSpecifiedBenchmarks() > 0;
  benchmark::Shutdown();
  return any ? 0 : 1;
}
