#include "config/decomposition/triangle_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace clearance {
namespace {

constexpr std::uint32_t kLeaf = 4;  // triangles

double squared_distance_to_segment(const Vec3& a, const Vec3& b, const Vec3& point) {
  const Vec3 along = b - a;
  const double length = along.squaredNorm();
  const double at = length > 0.0 ? std::clamp((point - a).dot(along) / length, 0.0, 1.0) : 0.0;
  return (a + at * along - point).squaredNorm();
}

Vec3 middle(const Triangle& t) { return (t[0] + t[1] + t[2]) / 3.0; }

}  // namespace

double distance_to(const Triangle& t, const Vec3& point) {
  const Vec3 ab = t[1] - t[0], ac = t[2] - t[0], ap = point - t[0];
  const double bb = ab.squaredNorm(), bc = ab.dot(ac), cc = ac.squaredNorm();
  const double pb = ap.dot(ab), pc = ap.dot(ac);
  const double area = bb * cc - bc * bc, v = cc * pb - bc * pc, w = bb * pc - bc * pb;
  if (area > 0.0 && v >= 0.0 && w >= 0.0 && v + w <= area) {
    return (ap - (v / area) * ab - (w / area) * ac).norm();
  }
  return std::sqrt(std::min({squared_distance_to_segment(t[0], t[1], point),
                             squared_distance_to_segment(t[1], t[2], point),
                             squared_distance_to_segment(t[2], t[0], point)}));
}

TriangleTree::TriangleTree(const TriangleMesh& mesh) {
  triangles_.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) triangles_.push_back(mesh.triangle(i));
  nodes_.reserve(mesh.triangles.size());
  nodes_.emplace_back();
  build(0, 0, static_cast<std::uint32_t>(triangles_.size()));
}

void TriangleTree::build(std::size_t node, std::uint32_t first, std::uint32_t last) {
  Eigen::AlignedBox3d box, middles;
  for (std::uint32_t i = first; i < last; ++i) {
    for (const Vec3& corner : triangles_[i]) box.extend(corner);
    middles.extend(middle(triangles_[i]));
  }
  nodes_[node].box = box;
  if (last - first <= kLeaf) {
    nodes_[node].first = first;
    nodes_[node].count = last - first;
    return;
  }
  Eigen::Index axis = 0;
  middles.sizes().maxCoeff(&axis);
  const std::uint32_t half = first + (last - first) / 2;
  std::nth_element(
      triangles_.begin() + first, triangles_.begin() + half, triangles_.begin() + last,
      [axis](const Triangle& a, const Triangle& b) { return middle(a)[axis] < middle(b)[axis]; });
  const std::size_t child = nodes_.size();
  nodes_[node].first = static_cast<std::uint32_t>(child);
  nodes_.resize(child + 2);
  build(child, first, half);
  build(child + 1, half, last);
}

TriangleTree::Nearest TriangleTree::nearest(const Vec3& point) const {
  Nearest best{0, std::numeric_limits<double>::infinity()};
  double squared = std::numeric_limits<double>::infinity();
  std::array<std::pair<double, std::uint32_t>, 64> open;  // the depth is the logarithm of the count
  std::size_t count = 0;
  open[count++] = {nodes_[0].box.squaredExteriorDistance(point), 0};
  while (count > 0) {
    const auto [far, index] = open[--count];
    if (far >= squared) continue;
    const Node& node = nodes_[index];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const double distance = distance_to(triangles_[i], point);
      if (distance >= best.distance) continue;
      best = {i, distance};
      squared = distance * distance;
    }
    if (node.count > 0) continue;
    const double left = nodes_[node.first].box.squaredExteriorDistance(point);
    const double right = nodes_[node.first + 1].box.squaredExteriorDistance(point);
    const bool left_first = left <= right;
    if (std::max(left, right) < squared)
      open[count++] = {std::max(left, right), node.first + (left_first ? 1 : 0)};
    if (std::min(left, right) < squared)
      open[count++] = {std::min(left, right), node.first + (left_first ? 0 : 1)};
  }
  return best;
}

}  // namespace clearance
