#include "tools/bench/thesis/facet_walk.hpp"

#include <Eigen/LU>
#include <vector>

namespace clearance::bench {
namespace {

constexpr double kSpread = 0.05;  // of (3.6.2): a vertex with less is too flat
constexpr double kInside = 1e-12;

struct Corner {
  int f1, f2;
  Vec3 at;
};

// (3.6.3)
Vec3 meeting_point(const HalfSpace& a, const HalfSpace& b, const HalfSpace& c) {
  Mat3 m;
  m << a.normal.transpose(), b.normal.transpose(), c.normal.transpose();
  return m.partialPivLu().solve(Vec3(a.offset, b.offset, c.offset));
}

double spread(std::span<const HalfSpace> rows, int i, int j, int k) {
  return std::abs(rows[i].normal.cross(rows[j].normal).dot(rows[k].normal));
}

// Finds two facets that meet k in a vertex.
bool first_guess(std::span<const HalfSpace> rows, int k, int& j1, int& j2) {
  const int n = static_cast<int>(rows.size());
  for (j1 = 0; j1 < n; ++j1) {
    if (rows[k].normal.cross(rows[j1].normal).squaredNorm() < kSpread) continue;
    for (j2 = 0; j2 < n; ++j2) {
      if (spread(rows, k, j1, j2) > kSpread) return true;
    }
  }
  return false;
}

// Moves from there to a true vertex: the most violated half-space (3.6.4) replaces the facet whose
// removal leaves the better vertex. No half-space is used twice.
bool first_corner(std::span<const HalfSpace> rows, int k, Corner& corner) {
  int j1 = 0, j2 = 0;
  if (!first_guess(rows, k, j1, j2)) return false;
  std::vector<bool> taken(rows.size(), false);
  for (;;) {
    const Vec3 x = meeting_point(rows[k], rows[j1], rows[j2]);
    double worst = kInside;
    int j3 = -1;
    for (int j = 0; j < static_cast<int>(rows.size()); ++j) {
      const double beyond = rows[j].normal.dot(x) - rows[j].offset;
      if (beyond > worst && !taken[j]) {
        worst = beyond;
        j3 = j;
      }
    }
    if (j3 < 0) {
      corner = {j1, j2, x};
      return true;
    }
    taken[j3] = true;
    (spread(rows, k, j1, j3) > spread(rows, k, j2, j3) ? j2 : j1) = j3;
  }
}

// Along the edge of k and f2, away from f1, to the half-space that is met first: as in alpha.
bool next_corner(std::span<const HalfSpace> rows, int k, Corner& corner) {
  Vec3 along = rows[k].normal.cross(rows[corner.f2].normal);
  if (rows[corner.f1].normal.dot(along) > 0.0) along = -along;
  double nearest = kInfinity;
  int met = -1;
  for (int j = 0; j < static_cast<int>(rows.size()); ++j) {
    if (j == k || j == corner.f2) continue;
    const double speed = rows[j].normal.dot(along);
    if (speed <= kInside) continue;
    const double length = (rows[j].offset - rows[j].normal.dot(corner.at)) / speed;
    if (length < nearest) {
      nearest = length;
      met = j;
    }
  }
  if (met < 0) return false;
  corner = {corner.f2, met, meeting_point(rows[k], rows[corner.f2], rows[met])};
  return true;
}

}  // namespace

Neighbours walk_facets(std::span<const HalfSpace> rows) {
  Neighbours found;
  for (int k = 0; k < static_cast<int>(rows.size()); ++k) {
    Corner corner{};
    if (!first_corner(rows, k, corner)) continue;
    std::vector<bool> visited(rows.size(), false);
    while (!visited[corner.f2]) {
      visited[corner.f2] = true;
      found.emplace(std::min(k, corner.f2), std::max(k, corner.f2));
      if (!next_corner(rows, k, corner)) break;
    }
  }
  return found;
}

}  // namespace clearance::bench
