// clearance-bench measures speed and accuracy on this machine. Google Benchmark's own options
// apply.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "monitor/app/print.hpp"
#include "monitor/files/build_info.hpp"
#include "monitor/loop/realtime.hpp"
#include "tools/bench/beside_person.hpp"
#include "tools/bench/cells.hpp"
#include "tools/bench/peers/fcl_motions.hpp"
#include "tools/bench/peers/peers.hpp"
#include "tools/bench/rows.hpp"
#include "tools/bench/suite/suite.hpp"
#include "tools/bench/ticks.hpp"

namespace {

constexpr const char* kHelp =
    R"(clearance-bench measures the core and the tick. Queries are timed in thread CPU time, ticks on the wall.
Its memory is locked, as the daemon's is, where that is allowed.

Usage: clearance-bench [OPTIONS]
       clearance-bench --suite [...]  all rivals on one set of cases with exact answers; --suite --help has its options
       clearance-bench --ask [...]    whole motions, certified, beside FCL; --ask --help has its options
       clearance-bench --stops [...]  an arm beside a walking person, by zones, S_p and stops; --stops --help
  --queries       the rows that tools/bench/report shows in report.md
  --curved        the rows of curved bodies and of every pair of kinds, with their peers
  --tick          the rows tick/
  --sweeps        the rows tick/ and sweep/
  --parts         the rows parts/
  --clouds        the rows cloud/
  --cell FILE     also the rows cell/ and robot/ of this cell; repeatable
  --mesh FILE     also the row parts/ of this mesh; repeatable
  --version       print the version and the build
Options of Google Benchmark apply as well; its list stands at the end.

Rows:
  tracked/f2 ... v40 one query of two facet-balls (f) or their duals (v) of that order; also boxes,
                     parallel-boxes and links
  cold/f2 ... links  the same without the state of the last query
  relative/tracked/f2    the same with B's place in A's frame given; also f40, boxes, parallel-boxes, links
  curved/tracked/A-B one query of two bodies of these kinds, at least one of them curved: ellipsoid, cylinder,
                     cone, truncated_cone with one of these, box, link, capsule, sphere or rounded_box;
                     pair/tracked/A-B of two bodies that are not curved; .../cold/...
  nearness/cold/KIND/GAP  60 pairs of a curved kind at this gap, in units of the larger semi-axis; also
                     nearness/tracked/...
  overlap/tracked/KIND/HOW, overlap/cold/...  penetration depth: boxes, links, f10, v10, f40, v40; shallow, half,
                     near, nearer, middle; no reference
  peer/WHO/...       the same by other solvers: fcl, fcl-tight, fcl-gjk, bullet, libccd, qp
  cell/tracked/NAME  one distance query of the cell's pairs along its simulated motion, each joint of a robot swinging
                     through its range; counter nearest, m; cell/cold/NAME;
                     cell/batch/NAME: a round of all part pairs of the cell at once
  tick/NAME          one Monitor::tick: the shipped cells, and generated cells of thousands to millions of pairs.
                     control_..._us: the machine's noise, arithmetic that takes as long as the tick's median,
                     timed as often; own_..._us: the tick alone, each tick at its best of own_runs runs
  tick/NAME/plain    the same with every pair evaluated; tick/NAME/fcl: the minimum alone, by FCL's
                     DynamicAABBTreeCollisionManager
  cloud/build/...    a depth image of 640 x 480 pixels as slabs (16UC1, 32FC1) or balls; cloud/cold/slabs, cloud/tracked/slabs:
                     the slab nearest to a box; also balls; cloud/brute_force/balls: every ball, one by one. cloud/tick/with, cloud/tick/without: a tick
                     of an arm of 20 parts with and without such a camera. cloud/deep/balls/PART, cloud/deep/slabs/PART: cold
                     queries of a box or cylinder deep in a cloud; cloud/tick/deep/boxes, .../cylinders: ticks of
                     that arm deep in balls. cloud/PEER/build, cloud/PEER/cold: nanoflann,
                     nanoflann-spheres, octomap-15mm, octomap-25mm (FCL); counters max_error, mean_error, m
  parts/NAME         splitting a mesh into convex parts; counters parts, error_mm, triangles; CPU time of all threads
  sweep/WHAT/VALUE   the same of 300 moving bodies at other speeds (m/s) and spacings (m), and of other numbers of
                     objects; counters objects, speed (m/s) and density (objects a cubic metre)
  robot/kinematics/NAME  all joints of a cell's robots in, all links placed; counter joints
  robot/tick/HOW/NAME    one Monitor::tick of them: poses, joints, or gradients (with gradients of distances)

Counters:
  ns           per query
  max_error    m, against a reference in long doubles; only queries that report no failure count
  failures     queries that report a failure, return NaN or are wrong by more than 1e-6 m, of 4,000 (overlap:
               1,000)
  steps        mean iterations of the solver; 0: unknown
  truth_gap    m, error bound of the reference; overlapping: number of overlapping pairs
  widest_gap   m, largest upper - lower
The warning about a DEBUG library concerns Debian's build of Google Benchmark, not ours.

Examples:
  clearance-bench --benchmark_filter='^tracked/(f|v)' --benchmark_repetitions=5
  clearance-bench --tick
  tools/bench/report build/report        # all tables and pictures; clearance-thesis has the thesis's tables

Options of Google Benchmark:
)";

[[nodiscard]] bool register_all(const std::vector<std::filesystem::path>& more_cells,
                                const std::vector<std::filesystem::path>& meshes) {
  using namespace clearance::bench;
  register_ours(RowSet::kBench);
  register_nearness();
  register_peers(RowSet::kBench);
  std::vector<std::filesystem::path> cells = cells_in(CLEARANCE_CELLS);
  cells.insert(cells.end(), more_cells.begin(), more_cells.end());
  register_cells(cells);
  register_robots(cells);
  register_ticks();
  register_clouds();
  return register_splits(meshes);
}

// Options that stand for a filter.
struct Part {
  std::string_view option;
  const char* rows;
};
constexpr Part kParts[] = {
    {"--queries", "^(tracked|cold|relative|overlap|peer/[^/]+/(tracked|cold))/"},
    {"--curved", "^(peer/[^/]+/)?(curved|pair)/"},
    {"--tick", "^tick/"},
    {"--parts", "^parts/"},
    {"--clouds", "^cloud/"},
    {"--sweeps", "^(tick|sweep)/"},
};

int run(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "--suite") {
    return clearance::bench::run_suite(std::vector<std::string>(argv + 2, argv + argc));
  }
  if (argc > 1 && std::string_view(argv[1]) == "--stops")
    return clearance::bench::run_stops(argc - 1, argv + 1);
#ifdef CLEARANCE_BENCH_FCL
  if (argc > 1 && std::string_view(argv[1]) == "--ask")
    return clearance::bench::run_ask(argc - 1, argv + 1);
#endif
  std::vector<std::filesystem::path> cells, meshes;
  std::vector<std::string> options;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--version") {
      clearance::print(stdout, "clearance {}\n", clearance::kBuild);
      return 0;
    }
    if (word == "--help" || word == "-h") std::fputs(kHelp, stdout);
    const Part* const part = std::ranges::find(kParts, word, &Part::option);
    if (part != std::end(kParts)) {
      options.insert(options.begin(), std::string("--benchmark_filter=") + part->rows);
    } else if (word != "--cell" && word != "--mesh") {
      options.emplace_back(word);
    } else if (i + 1 < argc) {
      (word == "--cell" ? cells : meshes).emplace_back(argv[++i]);
    } else {
      clearance::print(stderr, "{} needs a file, as in: --cell cell.yaml --mesh link.stl\n", word);
      return 2;
    }
  }
  std::vector<char*> words{argv[0]};
  for (std::string& option : options) words.push_back(option.data());
  int count = static_cast<int>(words.size());
  benchmark::Initialize(&count, words.data());
  if (benchmark::ReportUnrecognizedArguments(count, words.data())) return 2;
  benchmark::AddCustomContext("clearance", clearance::kBuild);
  if (!register_all(cells, meshes)) return 1;
  const bool any = benchmark::RunSpecifiedBenchmarks() > 0;
  benchmark::Shutdown();
  return any ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (const clearance::Refusal refusal = clearance::lock_memory())
      clearance::print(stderr, "clearance-bench: {}\n", *refusal);
    return run(argc, argv);
  } catch (const std::exception& error) {
    clearance::print(stderr, "clearance-bench: {}\n", error.what());
    return 1;
  }
}
