// clearance-bench: how fast, and how exact, on this machine. Google Benchmark's own options apply.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <string_view>

#include "tools/bench/adjacency.hpp"
#include "tools/bench/cells.hpp"
#include "tools/bench/ours.hpp"
#include "tools/bench/peers/peers.hpp"
#include "tools/bench/variants.hpp"

namespace {

constexpr const char* kHelp =
    "clearance-bench: times the core and the tick. All times are thread CPU time.\n"
    "\n"
    "  tracked/f2 ... v40 one query of two facet-balls (f) or their duals (v) of that order;\n"
    "                     also boxes, parallel-boxes and links\n"
    "  cold/f2 ... links  the same without what the last query left\n"
    "  interval/N/f2      the same with a cold start every N queries\n"
    "  variant/WHICH/...  the thesis's loop without certificates: base, dual, consistent,\n"
    "                     aggressive, all-facets, moved\n"
    "  adjacency/WHO/f2   adjacency from half-spaces: walk (the thesis's), core, qhull\n"
    "  peer/WHO/...       the same by other solvers: fcl, fcl-tight, fcl-gjk, bullet, libccd, qp\n"
    "  cell/tracked/NAME  one distance query of the cell's pairs along its simulated motion, "
    "tracked\n"
    "  cell/cold/NAME     the same without what the last query left\n"
    "  cell/tick/NAME     one Monitor::tick; counters p50, p99.9 and max in ns\n"
    "\n"
    "Counters: ns a query; max_error in m against a reference in long doubles; failures (flag,\n"
    "NaN, or error above 1e-6 m) among the 4,000 queries; iterations, mean; truth_gap, how far "
    "the\n"
    "reference itself may be off; overlapping, how many pairs are.\n"
    "\n"
    "example: clearance-bench --benchmark_filter='tracked/(f|v)' --benchmark_repetitions=5\n"
    "\n"
    "Options of Google Benchmark:\n";

}  // namespace

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    if (std::string_view(argv[i]) == "--help" || std::string_view(argv[i]) == "-h") {
      std::fputs(kHelp, stdout);
    }
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  clearance::bench::register_ours();
  clearance::bench::register_variants();
  clearance::bench::register_adjacency();
  clearance::bench::register_peers();
  clearance::bench::register_cells(CLEARANCE_CELLS);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
