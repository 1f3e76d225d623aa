#include "config/decomposition/shells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

namespace clearance {
namespace {

constexpr double kSameAngle = 1e-6;  // rad; more than the rounding of coordinates

// A triangle's use of the edge between two vertices.
struct EdgeOfTriangle {
  std::uint32_t low, high;  // the vertices of the edge, low < high
  std::uint32_t triangle;
  bool is_forward;  // the triangle runs from low to high: its inside is clockwise of it
  double angle = 0.0;
};

// Sets of triangles that are joined by and by (union-find).
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count), turned_(count, false) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  // The lowest member is the set's number.
  [[nodiscard]] std::uint32_t of(std::uint32_t i) const {
    while (parent_[i] != i) i = parent_[i];
    return i;
  }
  // Tells whether the triangle faces away from the set's first one.
  [[nodiscard]] bool is_turned(std::uint32_t i) const {
    bool turned = false;
    for (; parent_[i] != i; i = parent_[i]) turned ^= turned_[i];
    return turned;
  }
  // `turned`: the two face different sides. A ring that cannot be made to agree stays as it is.
  void join(std::uint32_t a, std::uint32_t b, bool turned) {
    turned ^= is_turned(a) ^ is_turned(b);
    a = of(a);
    b = of(b);
    if (a == b) return;
    parent_[std::max(a, b)] = std::min(a, b);
    turned_[std::max(a, b)] = turned;
  }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<bool> turned_;  // against the parent
};

bool before(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

// Returns for each vertex the number of the first one at its place.
std::vector<std::uint32_t> welded(const std::vector<Vec3>& vertices) {
  std::vector<std::uint32_t> order(vertices.size()), first(vertices.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(
      order, [&](std::uint32_t a, std::uint32_t b) { return before(vertices[a], vertices[b]); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && vertices[order[i]] == vertices[order[i - 1]];
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  return first;
}

class Shells {
 public:
  explicit Shells(const TriangleMesh& mesh)
      : mesh_(mesh), vertex_(welded(mesh.vertices)), sets_(mesh.triangles.size()) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      is_segment_.push_back(is_segment(mesh.triangles[t]));
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t from = vertex_[mesh.triangles[t][k]];
        const std::uint32_t to = vertex_[mesh.triangles[t][(k + 1) % 3]];
        if (from != to) edges_.push_back({std::min(from, to), std::max(from, to), t, from < to});
      }
    }
    std::ranges::stable_sort(edges_, {},
                             [](const EdgeOfTriangle& e) { return std::tuple(e.low, e.high); });
  }

  // Edges of two triangles come first: what they join is certain. So it is at an edge of more where
  // all but two are joined in pairs. Elsewhere the angles decide.
  std::vector<TriangleMesh> meshes() {
    for (bool joined = true; joined;) {
      joined = false;
      each_edge([&](std::span<EdgeOfTriangle> uses) {
        const std::vector<EdgeOfTriangle> left = without_pairs(uses);
        if (left.size() != 2) return;
        sets_.join(left[0].triangle, left[1].triangle, left[0].is_forward == left[1].is_forward);
        joined = true;
      });
    }
    face_outwards();
    each_edge([&](std::span<EdgeOfTriangle> uses) { join_around(without_pairs(uses)); });
    return separated();
  }

 private:
  // A triangle with two vertices in one place is a segment: it joins nothing, but belongs to the
  // first triangle at its edge.
  [[nodiscard]] bool is_segment(const std::array<std::uint32_t, 3>& t) const {
    return vertex_[t[0]] == vertex_[t[1]] || vertex_[t[1]] == vertex_[t[2]] ||
           vertex_[t[2]] == vertex_[t[0]];
  }

  // Returns the uses of an edge without segments, and without two of one set: these are joined.
  std::vector<EdgeOfTriangle> without_pairs(std::span<const EdgeOfTriangle> uses) {
    std::vector<EdgeOfTriangle> left;
    for (const EdgeOfTriangle& use : uses) {
      if (is_segment_[use.triangle]) {
        const auto whole = std::ranges::find_if(
            uses, [&](const EdgeOfTriangle& other) { return !is_segment_[other.triangle]; });
        const EdgeOfTriangle& first = whole == uses.end() ? uses.front() : *whole;
        sets_.join(first.triangle, use.triangle, false);
        continue;
      }
      const auto own = std::ranges::find_if(left, [&](const EdgeOfTriangle& other) {
        return sets_.of(other.triangle) == sets_.of(use.triangle);
      });
      if (own == left.end()) {
        left.push_back(use);
      } else {
        left.erase(own);
      }
    }
    return left;
  }

  template <class Visit>
  void each_edge(const Visit& visit) {
    for (std::size_t i = 0; i < edges_.size();) {
      std::size_t end = i + 1;
      while (end < edges_.size() && edges_[end].low == edges_[i].low &&
             edges_[end].high == edges_[i].high) {
        ++end;
      }
      visit(std::span(edges_).subspan(i, end - i));
      i = end;
    }
  }

  // Turns triangles so that those of a set agree, and enclose a positive volume. A set that is
  // not closed faces away from the middle of the mesh.
  void face_outwards() {
    Vec3 middle = Vec3::Zero();
    for (const Vec3& v : mesh_.vertices) middle += v / static_cast<double>(mesh_.vertices.size());
    std::vector<double> volume(mesh_.triangles.size(), 0.0);
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      const Triangle corners = mesh_.triangle(t);
      const Vec3 a = corners[0] - middle, b = corners[1] - middle, c = corners[2] - middle;
      const double six = a.dot(b.cross(c));
      volume[sets_.of(t)] += sets_.is_turned(t) ? -six : six;
    }
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      is_turned_.push_back(sets_.is_turned(t) != (volume[sets_.of(t)] < 0.0));
    }
    for (EdgeOfTriangle& use : edges_) use.is_forward ^= is_turned_[use.triangle];
  }

  // The angle of a triangle around its edge.
  [[nodiscard]] double angle_of(const EdgeOfTriangle& use) const {
    const Vec3& low = mesh_.vertices[use.low];
    const Vec3 along = (mesh_.vertices[use.high] - low).normalized();
    const Vec3 x = along.unitOrthogonal(), y = along.cross(x);
    for (const std::uint32_t corner : mesh_.triangles[use.triangle]) {
      if (vertex_[corner] == use.low || vertex_[corner] == use.high) continue;
      const Vec3 aside = mesh_.vertices[corner] - low;
      return std::atan2(y.dot(aside), x.dot(aside));
    }
    return 0.0;
  }

  // Joins each triangle that begins a solid, counter-clockwise, to the one that ends it.
  void join_around(std::vector<EdgeOfTriangle> uses) {
    std::vector<EdgeOfTriangle> starts, ends;
    for (EdgeOfTriangle& use : uses) {
      use.angle = angle_of(use);
      (use.is_forward ? ends : starts).push_back(use);
    }
    std::ranges::stable_sort(starts, {}, &EdgeOfTriangle::angle);
    for (const EdgeOfTriangle& start : starts) {
      const auto turn = [&](const EdgeOfTriangle& end) {
        const double angle = end.angle - start.angle;
        return angle > kSameAngle ? angle : angle + 2.0 * std::numbers::pi;
      };
      const auto next = std::ranges::min_element(ends, {}, turn);
      if (next == ends.end()) return;
      sets_.join(start.triangle, next->triangle, false);
      ends.erase(next);
    }
  }

  std::vector<TriangleMesh> separated() {
    constexpr std::uint32_t kNone = ~0u;
    std::vector<std::uint32_t> shell_of_set(mesh_.triangles.size(), kNone);
    std::vector<std::uint32_t> shell_of_vertex(mesh_.vertices.size(), kNone);
    std::vector<std::uint32_t> number(mesh_.vertices.size());
    std::vector<std::vector<std::uint32_t>> members;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      std::uint32_t& shell = shell_of_set[sets_.of(t)];
      if (shell == kNone) {
        shell = static_cast<std::uint32_t>(members.size());
        members.emplace_back();
      }
      members[shell].push_back(t);
    }
    std::vector<TriangleMesh> shells(members.size());
    for (std::uint32_t s = 0; s < members.size(); ++s) {
      TriangleMesh& shell = shells[s];
      for (const std::uint32_t t : members[s]) {
        std::array<std::uint32_t, 3> corners{};
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint32_t v = vertex_[mesh_.triangles[t][k]];
          if (std::exchange(shell_of_vertex[v], s) != s) {
            number[v] = static_cast<std::uint32_t>(shell.vertices.size());
            shell.vertices.push_back(mesh_.vertices[v]);
          }
          corners[k] = number[v];
        }
        if (is_turned_[t]) std::swap(corners[1], corners[2]);
        shell.triangles.push_back(corners);
      }
    }
    return shells;
  }

  const TriangleMesh& mesh_;
  std::vector<std::uint32_t> vertex_;
  Sets sets_;
  std::vector<bool> is_segment_;  // by triangle
  std::vector<bool> is_turned_;   // by triangle: its vertices are taken in the other order
  std::vector<EdgeOfTriangle> edges_;
};

}  // namespace

std::vector<TriangleMesh> shells_of(const TriangleMesh& mesh) { return Shells(mesh).meshes(); }

}  // namespace clearance
