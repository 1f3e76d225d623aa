#include "tools/bench/peers/welded.hpp"

#include <algorithm>

namespace clearance::bench {
namespace {

constexpr double kSame = 1e-12;  // of the bounding radius

// [vertex]: the first vertex that is joined to it by edges too short to count.
std::vector<int> representatives(const ConvexBody& body) {
  std::vector<int> first(body.vertices.size());
  for (std::size_t i = 0; i < first.size(); ++i) first[i] = static_cast<int>(i);
  for (bool changed = true; changed;) {
    changed = false;
    for (const Edge& e : body.edges) {
      int& p = first[static_cast<std::size_t>(e.vertex[0])];
      int& q = first[static_cast<std::size_t>(e.vertex[1])];
      if (e.end > kSame * body.bounding_radius || p == q) continue;
      p = q = std::min(p, q);
      changed = true;
    }
  }
  return first;
}

}  // namespace

Welded welded(const ConvexBody& body) {
  const std::vector<int> first = representatives(body);
  Welded mesh;
  std::vector<int> point(first.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    const auto representative = static_cast<std::size_t>(first[i]);
    if (representative == i) {
      point[i] = static_cast<int>(mesh.points.size());
      mesh.points.push_back(body.vertices[i].position);
    } else {
      point[i] = point[representative];
    }
  }
  for (const Facet& facet : body.facets) {
    std::vector<int> face;
    for (int i = facet.first_side; i < facet.first_side + facet.sides; ++i) {
      const EdgeUse& use = body.facet_edges[i];
      // A facet to the left of its edge passes it forwards, one to the right backwards.
      const int corner = point[static_cast<std::size_t>(body.edges[use.edge].vertex[use.side])];
      if (face.empty() || (face.back() != corner && face.front() != corner)) face.push_back(corner);
    }
    if (face.size() > 2) mesh.faces.push_back(face);
  }
  return mesh;
}

std::optional<Vec3> box_half_extents(const ConvexBody& body) {
  if (body.vertices.size() != 8 || body.facets.size() != 6 || body.radius > 0.0) return {};
  const Vec3 half = body.vertices[0].position.cwiseAbs();
  const auto is_corner = [&](const Vertex& v) { return v.position.cwiseAbs() == half; };
  if (!std::all_of(body.vertices.begin(), body.vertices.end(), is_corner)) return {};
  return half;
}

}  // namespace clearance::bench
