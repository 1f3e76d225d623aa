// Other solvers in the same process on the same poses: benchmarks peer/WHO/tracked/f2 ... Each runs
// at its best setting for this use that does not change its code. This means double precision, no
// margins, and its own warm start where it has one. Its solver is called directly rather than
// through its scene.
#pragma once

#include <functional>
#include <string>

#include "tools/bench/crowd.hpp"
#include "tools/bench/solver_rows.hpp"

namespace clearance::bench {

// FCL 0.7. 'fcl' is its default solver at its default tolerance, 1e-6: libccd's simplex with FCL's
// repairs. This climbs along edges from 33 vertices, and has no warm start, so tracked equals cold.
// 'fcl-tight' is the same at 1e-12, which costs hardly any time here. 'fcl-gjk' is FCL's own GJK at
// 1e-12, which costs no extra time. While tracked, it starts from a cached guess. It searches all
// vertices for a support point.
void register_fcl(RowSet set);
// Bullet 3 with doubles: btGjkEpaSolver2 on hulls, starting from the last separation while tracked.
void register_bullet(RowSet set);
// libccd 2: only answers whether the bodies touch, so only its failures can be judged, as wrong
// answers. Its supports are ours: they climb along edges from the last vertex.
void register_libccd(RowSet set);
// A general primal active-set QP; see qp.cpp.
void register_qp(RowSet set);

// The minimum over all pairs of a crowd by FCL's DynamicAABBTreeCollisionManager; see
// fcl_manager.cpp.
void register_fcl_manager(const std::string& name, int ticks, const std::function<Crowd()>& make);

// Registers all of them, and names on stderr those that are left out because they are not
// installed.
void register_peers(RowSet set);

}  // namespace clearance::bench
