#include "tools/bench/peers/peers.hpp"

#include <cstdio>

#include "monitor/app/print.hpp"

namespace clearance::bench {
namespace {

void left_out [[maybe_unused]] (const char* who, const char* package) {
  print(stderr, "{} is left out: it needs {} (tools/setup --bench)\n", who, package);
}

}  // namespace

void register_peers(RowSet set) {
#ifdef CLEARANCE_BENCH_FCL
  register_fcl(set);
#else
  left_out("fcl", "libfcl-dev");
#endif
#ifdef CLEARANCE_BENCH_BULLET
  register_bullet(set);
#else
  left_out("bullet", "libbullet-dev");
#endif
#ifdef CLEARANCE_BENCH_LIBCCD
  register_libccd(set);
#else
  left_out("libccd", "libccd-dev");
#endif
  register_qp(set);
}

}  // namespace clearance::bench
