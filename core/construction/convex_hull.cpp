#include "core/construction/convex_hull.hpp"

#include <numeric>
#include <random>
#include <utility>

namespace clearance::exact {
namespace {

constexpr int kNoIndex = -1;

struct Triangle {
  HullTriangle link;
  FilteredPlane plane;
  int first_conflict = kNoIndex;  // head of the list of points that remember this triangle
  int seen_in_round = kNoIndex;   // the insertion for which `seen` holds
  bool seen = false;
  bool alive = true;
};

// A horizon edge: the triangle outside stays, and the one on this side is removed.
struct HorizonEdge {
  int from, to;
  int outside;
};

// Fisher-Yates from a fixed seed: std::shuffle may differ between standard libraries.
std::vector<int> shuffled(int count) {
  std::vector<int> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  std::mt19937_64 random(20240229);
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  return order;
}

class HullBuilder {
 public:
  explicit HullBuilder(const PointSet& points)
      : points_(points),
        next_conflict_(static_cast<std::size_t>(points.size()), kNoIndex),
        sees_(static_cast<std::size_t>(points.size()), kNoIndex),
        triangle_from_(static_cast<std::size_t>(points.size()), kNoIndex) {}

  std::vector<HullTriangle> build() {
    const std::vector<int> order = shuffled(points_.size());
    if (!make_simplex(order)) return {};
    for (const int point : order) {
      if (sees_[at(point)] != kNoIndex) insert(point);
    }
    return finished();
  }

 private:
  // Takes the first four points of the order that span space.
  bool make_simplex(const std::vector<int>& order) {
    std::array<int, 4> vertex{order.empty() ? 0 : order[0], kNoIndex, kNoIndex, kNoIndex};
    int found = order.empty() ? 0 : 1;
    Integer4 plane;
    for (const int point : order) {
      if (found == 1 && distinct(vertex[0], point)) {
        vertex[1] = point;
        found = 2;
      } else if (found == 2) {
        plane =
            plane_through(points_.exact(vertex[0]), points_.exact(vertex[1]), points_.exact(point));
        if (is_zero(plane)) continue;
        vertex[2] = point;
        found = 3;
      } else if (found == 3) {
        const int side = sgn(dot(plane, points_.exact(point)));
        if (side == 0) continue;
        vertex[3] = point;
        if (side > 0) std::swap(vertex[1], vertex[2]);
        found = 4;
        break;
      }
    }
    if (found < 4) return false;
    // The fourth vertex lies below the first three.
    const auto& [a, b, c, d] = vertex;
    add_triangle({a, b, c}, {3, 1, 2});
    add_triangle({b, d, c}, {3, 2, 0});
    add_triangle({c, d, a}, {1, 3, 0});
    add_triangle({a, d, b}, {2, 1, 0});
    const std::array<int, 4> all{0, 1, 2, 3};
    for (const int point : order) remember_one_seen(point, all);
    return true;
  }

  bool distinct(int a, int b) const {
    const Integer4& p = points_.exact(a);
    const Integer4& q = points_.exact(b);
    for (std::size_t i = 0; i < 3; ++i) {
      if (p[i] * q[3] != q[i] * p[3]) return true;
    }
    return false;
  }

  int add_triangle(const std::array<int, 3>& vertex, const std::array<int, 3>& neighbor) {
    Triangle triangle{{vertex, neighbor}, FilteredPlane(points_, vertex)};
    if (free_.empty()) {
      triangles_.push_back(std::move(triangle));
      return static_cast<int>(triangles_.size()) - 1;
    }
    const int slot = free_.back();
    free_.pop_back();
    triangles_[at(slot)] = std::move(triangle);
    return slot;
  }

  // Puts the point into the list of the first candidate that it sees. If it sees none, it is in the
  // hull.
  template <typename Candidates>
  void remember_one_seen(int point, const Candidates& candidates) {
    sees_[at(point)] = kNoIndex;
    for (const int t : candidates) {
      Triangle& triangle = triangles_[at(t)];
      if (triangle.plane.side(points_, point) <= 0) continue;
      sees_[at(point)] = t;
      next_conflict_[at(point)] = triangle.first_conflict;
      triangle.first_conflict = point;
      return;
    }
  }

  // Each plane is evaluated only once per insertion, although a triangle is reached from up to
  // three sides.
  bool is_seen(int t, int point) {
    Triangle& triangle = triangles_[at(t)];
    if (triangle.seen_in_round != point) {
      triangle.seen_in_round = point;
      triangle.seen = triangle.plane.side(points_, point) > 0;
    }
    return triangle.seen;
  }

  void insert(int point) {
    find_horizon(point);
    fill_horizon(point);
    // A point that saw a removed triangle sees a new one or is inside. The reason: the plane
    // through a horizon edge and the new point is a non-negative combination of the two old planes
    // that met there.
    for (const int gone : going_) {
      int other = triangles_[at(gone)].first_conflict;
      while (other != kNoIndex) {
        const int next = next_conflict_[at(other)];
        if (other != point) remember_one_seen(other, coming_);
        other = next;
      }
      triangles_[at(gone)].first_conflict = kNoIndex;
    }
    sees_[at(point)] = kNoIndex;
    free_.insert(free_.end(), going_.begin(), going_.end());
  }

  // The triangles that `point` sees are connected, so the search spreads from the one that it
  // remembers.
  void find_horizon(int point) {
    going_.clear();
    horizon_.clear();
    const int start = sees_[at(point)];
    triangles_[at(start)].seen_in_round = point;
    triangles_[at(start)].seen = true;
    going_.push_back(start);
    triangles_[at(start)].alive = false;
    for (std::size_t next = 0; next < going_.size(); ++next) {
      const HullTriangle link = triangles_[at(going_[next])].link;
      for (std::size_t i = 0; i < 3; ++i) {
        const int across = link.neighbor[i];
        if (!is_seen(across, point)) {
          horizon_.push_back({link.vertex[i], link.vertex[(i + 1) % 3], across});
        } else if (triangles_[at(across)].alive) {
          triangles_[at(across)].alive = false;
          going_.push_back(across);
        }
      }
    }
  }

  // A fan of new triangles from the horizon to `point`.
  void fill_horizon(int point) {
    coming_.clear();
    for (const HorizonEdge& edge : horizon_) {
      const int fresh =
          add_triangle({edge.from, edge.to, point}, {edge.outside, kNoIndex, kNoIndex});
      coming_.push_back(fresh);
      triangle_from_[at(edge.from)] = fresh;
      HullTriangle& outside = triangles_[at(edge.outside)].link;
      for (std::size_t i = 0; i < 3; ++i) {
        if (outside.vertex[i] == edge.to) outside.neighbor[i] = fresh;  // `edge.from` follows
      }
    }
    for (std::size_t i = 0; i < horizon_.size(); ++i) {
      const int following = triangle_from_[at(horizon_[i].to)];
      triangles_[at(coming_[i])].link.neighbor[1] = following;
      triangles_[at(following)].link.neighbor[2] = coming_[i];
    }
  }

  // The triangles that are left, numbered without gaps.
  std::vector<HullTriangle> finished() const {
    std::vector<int> number(triangles_.size(), kNoIndex);
    int count = 0;
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (triangles_[t].alive) number[t] = count++;
    }
    std::vector<HullTriangle> result;
    result.reserve(at(count));
    for (const Triangle& triangle : triangles_) {
      if (!triangle.alive) continue;
      result.push_back(triangle.link);
      for (int& neighbor : result.back().neighbor) neighbor = number[at(neighbor)];
    }
    return result;
  }

  const PointSet& points_;
  std::vector<Triangle> triangles_;
  std::vector<int> next_conflict_;  // a point: the next one in its triangle's list
  std::vector<int> sees_;  // a point: the triangle whose list it is in; kNoIndex: in the hull
  std::vector<int>
      triangle_from_;      // a horizon vertex: the new triangle whose horizon edge starts there
  std::vector<int> free_;  // slots of removed triangles
  std::vector<int> going_, coming_;
  std::vector<HorizonEdge> horizon_;
};

}  // namespace

std::vector<HullTriangle> convex_hull(const PointSet& points) {
  return HullBuilder(points).build();
}

}  // namespace clearance::exact
