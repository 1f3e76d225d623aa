#include <algorithm>

#include "core/construction/convex_hull.hpp"

namespace clearance::exact {
namespace {

constexpr int kNoFace = -1;

// A directed edge: vertex[side] -> vertex[side + 1] of a triangle.
struct HalfEdge {
  int triangle;
  std::size_t side;
};

// The vertex of `triangle` that its neighbour `base` does not share.
int apex(const HullTriangle& triangle, const HullTriangle& base) {
  for (const int vertex : triangle.vertex) {
    if (std::find(base.vertex.begin(), base.vertex.end(), vertex) == base.vertex.end()) {
      return vertex;
    }
  }
  return triangle.vertex[0];
}

// The number of the face of every triangle: coplanar neighbours share one.
std::vector<int> face_numbers(const PointSet& points, std::span<const HullTriangle> triangles,
                              int& count) {
  std::vector<int> face(triangles.size(), kNoFace);
  std::vector<int> open;
  count = 0;
  for (std::size_t seed = 0; seed < triangles.size(); ++seed) {
    if (face[seed] != kNoFace) continue;
    FilteredPlane plane(points, triangles[seed].vertex);
    face[seed] = count;
    open.push_back(static_cast<int>(seed));
    while (!open.empty()) {
      const HullTriangle& triangle = triangles[at(open.back())];
      open.pop_back();
      for (const int neighbor : triangle.neighbor) {
        if (face[at(neighbor)] != kNoFace) continue;
        if (plane.side(points, apex(triangles[at(neighbor)], triangle)) != 0) continue;
        face[at(neighbor)] = count;
        open.push_back(neighbor);
      }
    }
    ++count;
  }
  return face;
}

// The next edge of the same face's boundary. The search turns about the head of `edge` through the
// face's triangles.
HalfEdge next_on_boundary(std::span<const HullTriangle> triangles, const std::vector<int>& face,
                          HalfEdge edge) {
  HalfEdge next{edge.triangle, (edge.side + 1) % 3};
  for (;;) {
    const HullTriangle& triangle = triangles[at(next.triangle)];
    const int across = triangle.neighbor[next.side];
    if (face[at(across)] != face[at(next.triangle)]) return next;
    const int pivot = triangle.vertex[next.side];
    const HullTriangle& other = triangles[at(across)];
    std::size_t side = 0;
    while (other.vertex[side] != pivot) ++side;
    next = {across, side};
  }
}

}  // namespace

std::vector<HullFace> hull_faces(const PointSet& points, std::span<const HullTriangle> triangles) {
  int count = 0;
  const std::vector<int> face = face_numbers(points, triangles, count);
  std::vector<HullFace> faces(at(count));
  const auto face_across = [&](HalfEdge edge) {
    return face[at(triangles[at(edge.triangle)].neighbor[edge.side])];
  };
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    HullFace& result = faces[at(face[t])];
    if (!result.vertex.empty()) continue;
    for (std::size_t side = 0; side < 3; ++side) {
      HalfEdge start{static_cast<int>(t), side};
      if (face_across(start) == face[t]) continue;
      // Advances to the place where the neighbour changes, so that the loop starts at a true
      // vertex.
      HalfEdge edge = next_on_boundary(triangles, face, start);
      while (face_across(edge) == face_across(start))
        edge = next_on_boundary(triangles, face, edge);
      start = edge;
      int last_face = kNoFace;
      do {
        if (face_across(edge) != last_face) {
          last_face = face_across(edge);
          result.vertex.push_back(triangles[at(edge.triangle)].vertex[edge.side]);
          result.neighbor.push_back(last_face);
        }
        edge = next_on_boundary(triangles, face, edge);
      } while (edge.triangle != start.triangle || edge.side != start.side);
      // No three true vertices of a face lie in one line.
      result.plane = plane_through(points.exact(result.vertex[0]), points.exact(result.vertex[1]),
                                   points.exact(result.vertex[2]));
      reduce(result.plane);
      break;
    }
  }
  return faces;
}

}  // namespace clearance::exact
