#include "tools/bench/suite/rivals.hpp"

#include <iterator>

namespace clearance::bench {

std::vector<Rival> all_rivals() {
  std::vector<Rival> all = clearance_rivals();
  [[maybe_unused]] const auto add = [&](std::vector<Rival> more) {
    all.insert(all.end(), std::make_move_iterator(more.begin()),
               std::make_move_iterator(more.end()));
  };
#ifdef CLEARANCE_BENCH_FCL
  add(fcl_rivals());
#endif
#ifdef CLEARANCE_BENCH_BULLET
  add(bullet_rivals());
#endif
#ifdef CLEARANCE_BENCH_LIBCCD
  add(libccd_rivals());
#endif
#ifdef CLEARANCE_BENCH_COAL
  add(coal_rivals());
#endif
#ifdef CLEARANCE_BENCH_OPENGJK
  add(opengjk_rivals());
#endif
#ifdef CLEARANCE_BENCH_VCLIP
  add(vclip_rivals());
#endif
#ifdef CLEARANCE_BENCH_JOLT
  add(jolt_rivals());
#endif
#ifdef CLEARANCE_BENCH_BOX3D
  add(box3d_rivals());
#endif
#ifdef CLEARANCE_BENCH_MUJOCO
  add(mujoco_rivals());
#endif
  return all;
}

}  // namespace clearance::bench
