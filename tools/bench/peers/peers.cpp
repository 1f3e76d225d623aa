#include "tools/bench/peers/peers.hpp"

#include <cstdio>

#include "monitor/app/print.hpp"
#include "tools/bench/adjacency.hpp"

namespace clearance::bench {
namespace {

void left_out [[maybe_unused]] (const char* who, const char* package) {
  print(stderr, "{} is left out: it needs {} (tools/setup --bench)\n", who, package);
}

}  // namespace

void register_peers() {
#ifdef CLEARANCE_BENCH_FCL
  register_fcl();
#else
  left_out("fcl", "libfcl-dev");
#endif
#ifdef CLEARANCE_BENCH_BULLET
  register_bullet();
#else
  left_out("bullet", "libbullet-dev");
#endif
#ifdef CLEARANCE_BENCH_LIBCCD
  register_libccd();
#else
  left_out("libccd", "libccd-dev");
#endif
#ifdef CLEARANCE_BENCH_QHULL
  register_qhull();
#else
  left_out("qhull", "libqhull-dev");
#endif
  register_qp();
}

}  // namespace clearance::bench
