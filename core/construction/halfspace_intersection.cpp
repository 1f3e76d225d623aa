// Converts half-spaces to facets, edges and vertices by polarity. About an interior point c, the
// rows n.x <= d become points n / (d - n.c). The facets of the hull of these points are the
// vertices of the intersection. A further point at the origin of the dual stands for the plane at
// infinity: hull faces that pass through it are rays.
#include <algorithm>
#include <string>

#include "core/construction/convex_hull.hpp"
#include "core/construction/exact_polyhedron.hpp"
#include "core/construction/strictly_inside.hpp"

namespace clearance::exact {
namespace {

Integer4 exact_plane(const HalfSpace& row) {
  return integer_multiple({row.normal.x(), row.normal.y(), row.normal.z(), row.offset});
}

ShapeError no_interior(const NoInterior& proof) {
  std::string rows = "rows ";
  for (std::size_t i = 0; i < proof.rows.size(); ++i) {
    if (i > 0) rows += i + 1 == proof.rows.size() ? " and " : ", ";
    rows += std::to_string(proof.rows[i] + 1);
  }
  if (proof.flat) {
    return {"the half-spaces have no common interior: " + rows +
            " leave only a flat piece between them"};
  }
  return {"the half-spaces have no common point: " + rows + " contradict each other"};
}

// The dual points: rows first, then the plane at infinity, then caps if the body has no vertex.
std::vector<Integer4> dual_points(const std::vector<Integer4>& planes, const Integer4& centre) {
  std::vector<Integer4> points;
  points.reserve(planes.size() + 3);
  for (const Integer4& plane : planes) {
    Integer4 point;
    for (std::size_t i = 0; i < 3; ++i) point[i] = centre[3] * plane[i];
    // d - n.c, positive: the centre is strictly inside.
    point[3] = centre[3] * plane[3] - dot(head(plane), head(centre));
    reduce(point);
    points.push_back(std::move(point));
  }
  points.push_back({0, 0, 0, 1});
  return points;
}

// The plane h of a dual face as a homogeneous point of the primal space: (h / -h_w) + centre. With
// w = 0 it is the direction of a ray.
Integer4 primal_point(const Integer4& plane, const Integer4& centre) {
  Integer4 point;
  const Integer weight = -plane[3];
  for (std::size_t i = 0; i < 3; ++i) point[i] = plane[i] * centre[3] + centre[i] * weight;
  point[3] = weight * centre[3];
  reduce(point);
  return point;
}

Integer4 midpoint(const Integer4& a, const Integer4& b) {
  Integer4 result;
  for (std::size_t i = 0; i < 3; ++i) result[i] = a[i] * b[3] + b[i] * a[3];
  result[3] = 2 * a[3] * b[3];
  reduce(result);
  return result;
}

// Collects the facets, edges and vertices from the dual hull.
class DualReader {
 public:
  DualReader(const std::vector<Integer4>& planes, const std::vector<HullFace>& faces,
             const Integer4& centre)
      : planes_(planes), faces_(faces), infinity_(static_cast<int>(planes.size())) {
    solid_.interior = centre;
    points_.reserve(faces.size());
    for (const HullFace& face : faces) points_.push_back(primal_point(face.plane, centre));
    number_facets();
  }

  // For a body with vertices: dual faces are its vertices and rays.
  Solid pointed() {
    number_nodes();
    for_each_edge([this](int left, int right, int from, int to) {
      const bool from_infinity = is_ray(from);
      const bool to_infinity = is_ray(to);
      if (from_infinity && to_infinity) return;  // an edge of the facet at infinity
      if (from_infinity) {
        solid_.edges.push_back({node_[at(to)], kNone, facet_[at(right)], facet_[at(left)]});
      } else {
        solid_.edges.push_back({node_[at(from)], to_infinity ? kNone : node_[at(to)],
                                facet_[at(left)], facet_[at(right)]});
      }
    });
    return std::move(solid_);
  }

  // For a body with lines along `direction`, cut off by two caps at equal distances: edges between
  // rows are full lines.
  Solid with_lines(const Integer3& direction) {
    for_each_edge([this](int left, int right, int from, int to) {
      const int node = static_cast<int>(solid_.nodes.size());
      solid_.nodes.push_back(midpoint(points_[at(from)], points_[at(to)]));
      solid_.edges.push_back({node, node, facet_[at(left)], facet_[at(right)], true});
    });
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (is_ray(static_cast<int>(f))) solid_.rays.push_back(head(points_[f]));
    }
    add_line(direction);
    return std::move(solid_);
  }

 private:
  bool is_ray(int face) const { return sgn(points_[at(face)][3]) == 0; }
  bool is_row(int dual) const { return dual < infinity_; }

  // The rows that have a facet, in their own order.
  void number_facets() {
    facet_.assign(planes_.size(), kNone);
    for (const HullFace& face : faces_) {
      for (const int vertex : face.vertex) {
        if (is_row(vertex)) facet_[at(vertex)] = 0;
      }
    }
    for (std::size_t row = 0; row < planes_.size(); ++row) {
      if (facet_[row] == kNone) continue;
      facet_[row] = static_cast<int>(solid_.planes.size());
      solid_.planes.push_back(planes_[row]);
    }
  }

  void number_nodes() {
    node_.assign(faces_.size(), kNone);
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (is_ray(static_cast<int>(f))) {
        solid_.rays.push_back(head(points_[f]));
      } else {
        node_[f] = static_cast<int>(solid_.nodes.size());
        solid_.nodes.push_back(points_[f]);
      }
    }
  }

  // Calls visit(left row, right row, dual face it comes from, dual face it goes to) once for each
  // dual edge between two rows. A dual face lies to the left of its boundary. So the primal edge
  // that crosses the dual edge vertex -> next from right to left has `vertex` on its left.
  template <typename Visit>
  void for_each_edge(const Visit& visit) {
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      const HullFace& face = faces_[f];
      for (std::size_t i = 0; i < face.vertex.size(); ++i) {
        const int left = face.vertex[i];
        const int right = face.vertex[(i + 1) % face.vertex.size()];
        if (left > right || !is_row(left) || !is_row(right)) continue;
        visit(left, right, face.neighbor[i], static_cast<int>(f));
      }
    }
  }

  void add_line(const Integer3& direction) {
    solid_.rays.push_back(direction);
    solid_.rays.push_back({-direction[0], -direction[1], -direction[2]});
  }

  const std::vector<Integer4>& planes_;
  const std::vector<HullFace>& faces_;
  int infinity_;                  // the dual point of the plane at infinity; caps come after it
  std::vector<Integer4> points_;  // a dual face: its point or ray
  std::vector<int> facet_;        // a row: its facet
  std::vector<int> node_;         // a dual face: its node
  Solid solid_;
};

// Half-space or slab: planes without edges.
Solid parallel_planes(const std::vector<Integer4>& planes, const Integer4& centre) {
  Solid solid;
  solid.interior = centre;
  const Integer3 up = head(planes[0]);
  // All planes are parallel. For each of the two senses of the normal, only the nearest plane is a
  // facet.
  std::array<int, 2> tightest{kNone, kNone};  // by side
  for (std::size_t row = 0; row < planes.size(); ++row) {
    int& best = tightest[sgn(dot(up, head(planes[row]))) > 0 ? 0 : 1];
    if (best != kNone) {
      // Parallel normals of one sense: compare d / |n| through the positive products with `up`.
      const Integer4& old = planes[at(best)];
      const Integer4& fresh = planes[row];
      const Integer a = fresh[3] * abs(dot(up, head(old)));
      const Integer b = old[3] * abs(dot(up, head(fresh)));
      if (a >= b) continue;
    }
    best = static_cast<int>(row);
  }
  std::array<int, 2> order = tightest;
  if (order[1] != kNone && order[1] < order[0]) std::swap(order[0], order[1]);
  for (const int row : order) {
    if (row != kNone) solid.planes.push_back(planes[at(row)]);
  }
  Integer3 across = head(solid.planes[0]);
  reduce(across);
  // Two directions within the plane, made of the normal's own components.
  std::size_t axis = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (abs(across[i]) > abs(across[axis])) axis = i;
  }
  for (std::size_t step = 1; step < 3; ++step) {
    const std::size_t other = (axis + step) % 3;
    Integer3 along;
    along[other] = across[axis];
    along[axis] = -across[other];
    solid.rays.push_back(along);
    solid.rays.push_back({-along[0], -along[1], -along[2]});
  }
  if (solid.planes.size() == 1) solid.rays.push_back({-across[0], -across[1], -across[2]});
  return solid;
}

}  // namespace

std::variant<Solid, ShapeError> intersection_of(std::span<const HalfSpace> rows) {
  std::variant<Integer4, NoInterior> inside = interior_point(rows);
  if (const NoInterior* proof = std::get_if<NoInterior>(&inside)) return no_interior(*proof);
  const Integer4& centre = std::get<Integer4>(inside);
  std::vector<Integer4> planes;
  planes.reserve(rows.size());
  for (const HalfSpace& row : rows) planes.push_back(exact_plane(row));
  const NormalSpan span = normal_span(rows);
  if (span.rank == 1) return parallel_planes(planes, centre);
  std::vector<Integer4> dual = dual_points(planes, centre);
  if (span.rank == 2) {
    // All normals lie in one plane, and so would the dual points. Two caps across the lines, at
    // equal distances from the centre, give their hull a volume.
    const Integer3& l = span.direction;
    dual.push_back({l[0], l[1], l[2], 1});
    dual.push_back({-l[0], -l[1], -l[2], 1});
  }
  const PointSet points(dual);
  const std::vector<HullFace> faces = hull_faces(points, convex_hull(points));
  DualReader reader(planes, faces, centre);
  return span.rank == 2 ? reader.with_lines(span.direction) : reader.pointed();
}

}  // namespace clearance::exact
