// The convex hull of points as a solid: facets, edges and vertices straight from the hull's faces.
#include <algorithm>
#include <cmath>
#include <string>

#include "core/construction/convex_hull.hpp"
#include "core/construction/exact_polyhedron.hpp"

namespace clearance::exact {
namespace {

Integer4 homogeneous(const Vec3& point) {
  return integer_multiple({point.x(), point.y(), point.z(), 1.0});
}

// A point near the middle of the bounding box, with 24 bits a coordinate, so that numbers stay
// short.
Integer4 middle(std::span<const Vec3> points) {
  constexpr int kBits = 24;
  Vec3 low = points[0];
  Vec3 high = points[0];
  for (const Vec3& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  Vec3 centre = 0.5 * low + 0.5 * high;
  for (double& coordinate : centre) {
    int exponent = 0;
    const double fraction = std::frexp(coordinate, &exponent);
    coordinate = std::ldexp(std::nearbyint(std::ldexp(fraction, kBits)), exponent - kBits);
  }
  return homogeneous(centre);
}

// Relative to `origin`, so that the hull's filters need not cancel a common offset.
std::vector<Integer4> relative_to(const Integer4& origin, std::span<const Vec3> points) {
  std::vector<Integer4> result;
  result.reserve(points.size());
  for (const Vec3& point : points) {
    Integer4 p = homogeneous(point);
    for (std::size_t i = 0; i < 3; ++i) p[i] = p[i] * origin[3] - origin[i] * p[3];
    p[3] *= origin[3];
    reduce(p);
    result.push_back(std::move(p));
  }
  return result;
}

// h.(x - origin) <= 0 as n.x <= d.
Integer4 facet_plane(const Integer4& h, const Integer4& origin) {
  Integer4 plane;
  for (std::size_t i = 0; i < 3; ++i) plane[i] = h[i] * origin[3];
  plane[3] = dot(head(h), head(origin)) - h[3] * origin[3];
  reduce(plane);
  return plane;
}

// The mean of three vertices of a face and one vertex off its plane.
Integer4 inner_point(std::span<const Vec3> points, const PointSet& relative,
                     const std::vector<HullFace>& faces) {
  std::vector<int> vertices(faces[0].vertex.begin(), faces[0].vertex.begin() + 3);
  for (std::size_t f = 1; vertices.size() < 4; ++f) {
    for (const int vertex : faces[f].vertex) {
      if (sgn(dot(faces[0].plane, relative.exact(vertex))) == 0) continue;
      vertices.push_back(vertex);
      break;
    }
  }
  Integer4 sum{0, 0, 0, 1};
  for (const int vertex : vertices) {
    const Integer4 point = homogeneous(points[at(vertex)]);
    for (std::size_t i = 0; i < 3; ++i) sum[i] = sum[i] * point[3] + point[i] * sum[3];
    sum[3] *= point[3];
  }
  sum[3] *= 4;
  reduce(sum);
  return sum;
}

// Numbers the vertices in the order of the input; the rest is kNone.
std::vector<int> number_vertices(std::span<const Vec3> points, const std::vector<HullFace>& faces,
                                 std::vector<Integer4>& nodes) {
  std::vector<int> node(points.size(), kNone);
  for (const HullFace& face : faces) {
    for (const int vertex : face.vertex) node[at(vertex)] = 0;
  }
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (node[p] == kNone) continue;
    node[p] = static_cast<int>(nodes.size());
    nodes.push_back(homogeneous(points[p]));
  }
  return node;
}

}  // namespace

std::variant<Solid, ShapeError> hull_of(std::span<const Vec3> points) {
  const Integer4 origin = middle(points);
  const std::vector<Integer4> moved = relative_to(origin, points);
  const PointSet relative(moved);
  const std::vector<HullFace> faces = hull_faces(relative, convex_hull(relative));
  if (faces.empty()) {
    return ShapeError{"the points enclose no volume: all " + std::to_string(points.size()) +
                      " lie in one plane"};
  }
  Solid solid;
  const std::vector<int> node = number_vertices(points, faces, solid.nodes);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const HullFace& face = faces[f];
    solid.planes.push_back(facet_plane(face.plane, origin));
    for (std::size_t i = 0; i < face.vertex.size(); ++i) {
      const int from = face.vertex[i];
      const int to = face.vertex[(i + 1) % face.vertex.size()];
      // Each edge belongs to two faces, which run along it in opposite directions.
      if (from > to) continue;
      solid.edges.push_back({node[at(from)], node[at(to)], static_cast<int>(f), face.neighbor[i]});
    }
  }
  // Four affinely independent points of the hull, and so their mean is strictly inside.
  solid.interior = inner_point(points, relative, faces);
  return solid;
}

}  // namespace clearance::exact
