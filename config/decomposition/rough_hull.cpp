#include "config/decomposition/rough_hull.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace clearance {
namespace {

// Designed parts often have four or more points in one plane. To avoid that, points are moved by up
// to this share of the extent (Qhull's option QJ). For a link that is a few hundredths of a
// millimetre.
constexpr double kJoggle = 1e-4;
constexpr double kFlat = 1e-12;  // of the extent: points nearer to a plane lie in it

// Returns a number from -1 to 1 that depends on `number` alone (splitmix64; G. Steele and others,
// 2014).
double scattered(std::uint64_t number) {
  std::uint64_t x = (number + 1) * 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((x ^ (x >> 31)) >> 11) * 0x1p-52 - 1.0;
}

struct Face {
  std::array<std::size_t, 3> corners;  // counter-clockwise when viewed from outside
  HalfSpace plane;
};

class RoughHull {
 public:
  explicit RoughHull(std::span<const Vec3> points) : points_(points.begin(), points.end()) {
    if (points.empty()) return;
    Eigen::AlignedBox3d box;
    for (const Vec3& point : points) box.extend(point);
    const double extent = box.diagonal().norm();
    slack_ = kFlat * extent;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        points_[i][static_cast<Eigen::Index>(k)] += kJoggle * extent * scattered(3 * i + k);
      }
    }
  }

  std::vector<HalfSpace> planes() {
    if (!begin()) return {};
    for (std::size_t i = 0; i < points_.size(); ++i) add(i);
    std::vector<HalfSpace> planes;
    for (const Face& face : faces_) planes.push_back(face.plane);
    return planes;
  }

 private:
  // Returns the index of the point with the largest `distance`.
  template <class Distance>
  std::size_t farthest(const Distance& distance) const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < points_.size(); ++i) {
      if (distance(points_[i]) > distance(points_[best])) best = i;
    }
    return best;
  }

  // Begins with a tetrahedron of points that are far from each other.
  bool begin() {
    if (points_.size() < 4) return false;
    const std::size_t a = farthest([](const Vec3& p) { return -p.x(); });
    const Vec3 from = points_[a];
    const std::size_t b = farthest([&](const Vec3& p) { return (p - from).squaredNorm(); });
    const Vec3 along = points_[b] - from;
    if (along.norm() <= slack_) return false;
    const auto aside = [&](const Vec3& p) { return along.cross(p - from).norm(); };
    const std::size_t c = farthest(aside);
    if (aside(points_[c]) <= slack_ * along.norm()) return false;
    const Vec3 normal = along.cross(points_[c] - from).normalized();
    const auto above = [&](const Vec3& p) { return std::abs(normal.dot(p - from)); };
    const std::size_t d = farthest(above);
    if (above(points_[d]) <= slack_) return false;
    const bool behind = normal.dot(points_[d] - from) < 0.0;
    const std::size_t second = behind ? b : c, third = behind ? c : b;
    for (const auto& corners :
         {std::array{a, second, third}, {a, third, d}, {third, second, d}, {second, a, d}}) {
      append(corners);
    }
    return true;
  }

  void append(const std::array<std::size_t, 3>& corners) {
    const Vec3& a = points_[corners[0]];
    const Vec3 normal = (points_[corners[1]] - a).cross(points_[corners[2]] - a);
    const double length = normal.norm();
    if (!(length > 0.0)) return;
    faces_.push_back({corners, {normal / length, normal.dot(a) / length}});
  }

  // Removes the faces that see the point, and joins their outline to it.
  void add(std::size_t i) {
    const Vec3& point = points_[i];
    const auto hidden = std::partition(faces_.begin(), faces_.end(), [&](const Face& face) {
      return face.plane.normal.dot(point) <= face.plane.offset + slack_;
    });
    if (hidden == faces_.end()) return;
    outline_.clear();
    for (auto face = hidden; face != faces_.end(); ++face) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::array<std::size_t, 2> edge = {face->corners[k], face->corners[(k + 1) % 3]};
        const auto back = std::ranges::find(outline_, std::array{edge[1], edge[0]});
        if (back != outline_.end()) {
          *back = outline_.back();
          outline_.pop_back();
        } else {
          outline_.push_back(edge);
        }
      }
    }
    faces_.erase(hidden, faces_.end());
    for (const auto& [start, end] : outline_) append({start, end, i});
  }

  std::vector<Vec3> points_;
  double slack_ = 0.0;
  std::vector<Face> faces_;
  std::vector<std::array<std::size_t, 2>> outline_;
};

}  // namespace

std::vector<HalfSpace> rough_hull(std::span<const Vec3> points) {
  return RoughHull(points).planes();
}

}  // namespace clearance
