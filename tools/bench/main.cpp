// clearance-bench: how fast, and how exact, on this machine. Google Benchmark's own options apply.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "monitor/app/print.hpp"
#include "monitor/files/build_info.hpp"
#include "tools/bench/adjacency.hpp"
#include "tools/bench/batches.hpp"
#include "tools/bench/cells.hpp"
#include "tools/bench/chapter5/rows.hpp"
#include "tools/bench/nearness.hpp"
#include "tools/bench/ours.hpp"
#include "tools/bench/peers/peers.hpp"
#include "tools/bench/report/report.hpp"
#include "tools/bench/robots.hpp"
#include "tools/bench/ticks.hpp"
#include "tools/bench/variants.hpp"

namespace {

constexpr const char* kHelp =
    "clearance-bench measures the core and the tick. Queries are timed in thread CPU time, ticks "
    "on "
    "the wall.\n"
    "\n"
    "  tracked/f2 ... v40 one query of two facet-balls (f) or their duals (v) of that order;\n"
    "                     also boxes, parallel-boxes and links\n"
    "  cold/f2 ... links  the same without what the last query left\n"
    "  curved/tracked/A-B one query of two bodies of these kinds, of which one is curved: "
    "ellipsoid,\n"
    "                     cylinder, cone, truncated_cone with one of these, box, link, capsule,\n"
    "                     sphere or rounded_box; pair/tracked/A-B of two that are not; "
    ".../cold/...\n"
    "  ellipsoids/HOW/D   the thesis's crossed ellipsoids D m apart: ours, ours-tracked, its "
    "methods\n"
    "                     (alternating, facet-balls, refinement-4, refinement-7, hybrid,\n"
    "                     polyhedron-ellipsoid), free-margin, gjk, fcl, bullet ...;\n"
    "                     ellipsoids/HOW/to-1e-4/D the same up to that error of both points\n"
    "  facet-ball/HOW/15  DQP3 on facet-balls around them: cold, tracked, neighbours-...\n"
    "  point/HOW/FAMILY   the nearest point of an ellipsoid: dominant, as-printed, newton; errors "
    "are\n"
    "                     shares of the size\n"
    "  nearness/cold/KIND/GAP  60 pairs of a curved kind just so far apart, in larger semi-axes; "
    "also\n"
    "                     nearness/tracked/...\n"
    "  interval/N/f2      the same with a cold start every N queries\n"
    "  batch/f2 ...       512 tracked pairs at once; batch/single/... the same pairs one by one,\n"
    "                     batch/AVX2/... with that instruction set; batch/own/... 1,024 bodies\n"
    "                     no two of which have a shape in common, batch/own/single/... one by one\n"
    "                     batch/curved/A-B, batch/curved/single/A-B of curved bodies\n"
    "  overlap/tracked/KIND/HOW, overlap/cold/...  how deep: boxes, links, f10, v10, f40, v40;\n"
    "                     shallow, half, near, nearer, middle (tools/README.md); no reference\n"
    "  variant/WHICH/...  the thesis's active-set iteration, uncertified: base, dual, consistent,\n"
    "                     aggressive, all-facets, moved (its tables, at every query);\n"
    "                     moved-before and base-repeated: what a query takes without that, and\n"
    "                     base in the same way, each query 64 times\n"
    "  adjacency/WHO/f2   adjacency from half-spaces: walk (the facet walk of the\n"
    "                     thesis), core, qhull\n"
    "  peer/WHO/...       the same by other solvers: fcl, fcl-tight, fcl-gjk, bullet, libccd, qp\n"
    "  cell/tracked/NAME  one distance query of the cell's pairs along its simulated motion, "
    "tracked\n"
    "  cell/cold/NAME     the same without what the last query left\n"
    "  cell/batch/NAME    a round of all the cell's part pairs at once\n"
    "  tick/NAME          one Monitor::tick: the shipped cells, and generated ones of thousands "
    "to\n"
    "                     millions of pairs; control_..._us: the machine's own noise, plain\n"
    "                     arithmetic that takes as long as the tick's median, timed as often;\n"
    "                     own_..._us: the tick's own, each tick at its best of own_runs runs\n"
    "  tick/NAME/plain    the same evaluating every pair; tick/NAME/fcl the minimum alone, by "
    "FCL's\n"
    "                     DynamicAABBTreeCollisionManager\n"
    "  robot/kinematics/NAME  all joints of a cell's robots in, all links placed; joints: how "
    "many\n"
    "  robot/tick/HOW/NAME  one Monitor::tick of them: poses, told by the links' poses; joints, "
    "by\n"
    "                     joints; gradients, with the gradients of distances\n"
    "  sweep/WHAT/VALUE   the same of 300 moving bodies at other speeds (m/s) and spacings (m), "
    "and of\n"
    "                     other numbers of objects; counters objects, speed (m/s) and density\n"
    "                     (objects a cubic metre) say what was swept\n"
    "\n"
    "Counters: ns a query; max_error in m against a reference in long doubles, of the queries\n"
    "that did not say themselves that they failed (libccd has no distance and no max_error);\n"
    "failures (flag, NaN, or error above 1e-6 m) among the 4,000 queries, of a batch 102,400, of\n"
    "overlaps 1,000; iterations, mean, 0 where not told; truth_gap, how far the reference itself\n"
    "may be off; overlapping, how many pairs are; widest_gap, m: of our bounds. The console\n"
    "shortens them: 4f is 4e-15, 4a 4e-18, and calls ns, a rate to it, s. `steps` is `iterations`\n"
    "under a name that Google's own counter does not have. Of batches: single, the part of the\n"
    "pairs that were evaluated one by one. Of adjacency: wrong, pairs of facets too many or\n"
    "missing. Of cells: ns and widest_gap; the poses are the cell's own, and nothing judges them.\n"
    "The warning of a DEBUG library is about how Debian builds Google Benchmark, not about ours.\n"
    "\n"
    "  --tick             runs the ticks alone, as --benchmark_filter=^tick/ does\n"
    "  --cell FILE        also the rows cell/ and robot/ of this cell; repeatable\n"
    "  --version          prints the version and the build\n"
    "  --report DIR       runs all but cells, ticks, sweeps, variants of all but\n"
    "                     facet-balls and variant/moved/cold, in two to four minutes,\n"
    "                     and writes\n"
    "                     DIR/report.md, the tables, and DIR/pareto.svg, error against time\n"
    "  --curved           runs curved/, pair/, ellipsoids/, facet-ball/, point/ and their peers\n"
    "  --tick --report DIR  runs ticks and sweeps, which takes as long, and writes DIR/ticks.md "
    "and\n"
    "                     DIR/ticks.svg, cost against the number of pairs, speed and density\n"
    "  --curved --report DIR  runs these and writes DIR/curved.md, every pair of shapes and the\n"
    "                     thesis's chapter 5, and DIR/curved.svg, error against time\n"
    "\n"
    "example: clearance-bench --benchmark_filter='^tracked/(f|v)' --benchmark_repetitions=5\n"
    "         clearance-bench --report build/report\n"
    "\n"
    "Options of Google Benchmark:\n";

void register_all(const std::vector<std::filesystem::path>& more_cells) {
  using namespace clearance::bench;
  register_ours();
  register_batches();
  register_variants();
  register_adjacency();
  register_chapter5();
  register_nearness();
  register_peers();
  std::vector<std::filesystem::path> cells = cells_in(CLEARANCE_CELLS);
  cells.insert(cells.end(), more_cells.begin(), more_cells.end());
  register_cells(cells);
  register_robots(cells);
  register_ticks();
}

// What can be measured and reported as one.
struct Part {
  const char* option;
  const char* rows;  // of the report
  bool (*write)(const std::filesystem::path& folder, const clearance::bench::Figures& figures);
};
constexpr Part kQueries{"", clearance::bench::kReportRows, clearance::bench::write_report};
constexpr Part kParts[] = {
    {"--tick", clearance::bench::kTickRows, clearance::bench::write_tick_report},
    {"--curved", clearance::bench::kCurvedRows, clearance::bench::write_curved_report},
};

// What a part asks of Google Benchmark, unless the caller asks for something else.
std::vector<std::string> options_of(const Part& part, bool report) {
  const bool ticks = part.write == clearance::bench::write_tick_report;
  if (ticks && !report) return {"--benchmark_filter=^tick/"};
  std::vector<std::string> options{std::string("--benchmark_filter=") + part.rows};
  if (report && !ticks) {
    options.insert(options.end(), {"--benchmark_min_time=0.02", "--benchmark_repetitions=3",
                                   "--benchmark_enable_random_interleaving=true"});
  }
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  std::optional<std::filesystem::path> report;
  std::vector<std::filesystem::path> cells;
  const Part* part = nullptr;
  std::vector<std::string> options, others;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--version") {
      clearance::print(stdout, "clearance {}\n", clearance::kBuild);
      return 0;
    }
    if (word == "--help" || word == "-h") std::fputs(kHelp, stdout);
    const Part* const named =
        std::find_if(std::begin(kParts), std::end(kParts),
                     [&](const Part& candidate) { return word == candidate.option; });
    if (named != std::end(kParts)) {
      part = named;
    } else if (word != "--report" && word != "--cell") {
      others.emplace_back(word);
    } else if (i + 1 == argc) {
      std::fputs(word == "--cell"
                     ? "--cell needs a cell file, as in: --cell cell.yaml\n"
                     : "--report needs the folder to write to, as in: --report build/report\n",
                 stderr);
      return 2;
    } else if (word == "--cell") {
      cells.emplace_back(argv[++i]);
    } else {
      report = argv[++i];
    }
  }
  if (report && part == nullptr) part = &kQueries;
  if (part != nullptr) options = options_of(*part, report.has_value());
  options.insert(options.end(), others.begin(), others.end());
  std::vector<char*> words{argv[0]};
  for (std::string& option : options) words.push_back(option.data());
  int count = static_cast<int>(words.size());
  benchmark::Initialize(&count, words.data());
  if (benchmark::ReportUnrecognizedArguments(count, words.data())) return 2;
  register_all(cells);
  if (report) {
    clearance::bench::Collector collector;
    if (benchmark::RunSpecifiedBenchmarks(&collector) == 0) return 1;
    if (!part->write(*report, collector.figures())) return 1;
  } else if (benchmark::RunSpecifiedBenchmarks() == 0) {
    return 1;
  }
  benchmark::Shutdown();
  return 0;
}
