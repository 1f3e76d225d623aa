// Qhull on the dual points n / d: its hull's ridges are the edges of the intersection.
#include <libqhull_r/qhull_ra.h>

#include <algorithm>
#include <vector>

#include "tools/bench/thesis/adjacency.hpp"

namespace clearance::bench {
namespace {

Neighbours qhull_neighbours(std::span<const HalfSpace> rows) {
  std::vector<double> points;
  for (const HalfSpace& row : rows) {
    for (int i = 0; i < 3; ++i) points.push_back(row.normal[i] / row.offset);
  }
  qhT memory;
  qhT* qh = &memory;
  qh_zero(qh, nullptr);
  char options[] = "qhull";
  Neighbours found;
  const int count = static_cast<int>(rows.size());
  if (qh_new_qhull(qh, 3, count, points.data(), False, options, nullptr, stderr) == 0) {
    for (facetT* facet = qh->facet_list; facet && facet->next; facet = facet->next) {
      qh_makeridges(qh, facet);
      ridgeT *ridge, **ridgep;
      FOREACHridge_(facet->ridges) {
        const int a = qh_pointid(qh, SETfirstt_(ridge->vertices, vertexT)->point);
        const int b = qh_pointid(qh, SETsecondt_(ridge->vertices, vertexT)->point);
        found.emplace(std::min(a, b), std::max(a, b));
      }
    }
  }
  qh_freeqhull(qh, qh_ALL);
  return found;
}

}  // namespace

void register_qhull() { register_adjacency("qhull", qhull_neighbours); }

}  // namespace clearance::bench
