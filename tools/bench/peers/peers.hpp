// Other solvers in the same process on the same poses: benchmarks peer/WHO/tracked/f2 ... Each at
// its best setting for this use that does not change its code: double precision, no margins, its
// own warm start where it has one, its solver called directly rather than through its scene.
#pragma once

#include <functional>
#include <string>

#include "tools/bench/crowd.hpp"
#include "tools/bench/solver_rows.hpp"

namespace clearance::bench {

// FCL 0.7. 'fcl': its default solver (libccd's simplex with FCL's repairs; climbs along edges from
// 33 vertices; no warm start, so tracked is as cold) at its default tolerance, 1e-6. 'fcl-tight':
// the same at 1e-12, which costs hardly any time here. 'fcl-gjk': its own GJK (cached guess while
// tracked; supports by search of all vertices) at 1e-12, which costs none.
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

// All of them; says on stderr which are left out because they are not installed.
void register_peers(RowSet set);

}  // namespace clearance::bench
