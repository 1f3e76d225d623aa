#include "tools/bench/suite/planar_faces.hpp"

#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "core/vec.hpp"

namespace clearance::bench {
namespace {

constexpr double kSamePlane = 1e-9;  // rad between the normals

Vec3 normal_of(const std::vector<Numbers3>& points, const std::vector<int>& face) {
  const auto at = [&](std::size_t i) {
    const Numbers3& p = points[static_cast<std::size_t>(face[i])];
    return Vec3(p[0], p[1], p[2]);
  };
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 2; i < face.size(); ++i) {
    sum += (at(i - 1) - at(0)).cross(at(i) - at(0));
  }
  return sum.normalized();
}

// An edge from its first to its second corner, to the face on its left.
using Sides = std::map<std::pair<int, int>, std::size_t>;

Sides sides_of(const std::vector<std::vector<int>>& faces) {
  Sides sides;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t i = 0; i < faces[f].size(); ++i) {
      sides[{faces[f][i], faces[f][(i + 1) % faces[f].size()]}] = f;
    }
  }
  return sides;
}

}  // namespace

std::vector<std::vector<int>> planar_faces(const std::vector<Numbers3>& points,
                                           const std::vector<std::vector<int>>& faces) {
  const Sides sides = sides_of(faces);
  std::vector<Vec3> normals;
  for (const std::vector<int>& face : faces) normals.push_back(normal_of(points, face));

  // [face]: the first face of its plane.
  std::vector<std::size_t> plane(faces.size());
  std::iota(plane.begin(), plane.end(), std::size_t{0});
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& [edge, f] : sides) {
      const std::size_t g = sides.at({edge.second, edge.first});
      if (plane[f] == plane[g] || normals[f].cross(normals[g]).norm() > kSamePlane) continue;
      plane[f] = plane[g] = std::min(plane[f], plane[g]);
      changed = true;
    }
  }

  // The edges between two planes, one after another around each plane.
  std::map<std::size_t, std::map<int, int>> outlines;
  for (const auto& [edge, f] : sides) {
    const std::size_t g = sides.at({edge.second, edge.first});
    if (plane[f] != plane[g]) outlines[plane[f]][edge.first] = edge.second;
  }
  std::vector<std::vector<int>> merged;
  for (const auto& [_, next] : outlines) {
    std::vector<int>& face = merged.emplace_back();
    const int start = next.begin()->first;
    int corner = start;
    do {
      face.push_back(corner);
      corner = next.at(corner);
    } while (corner != start);
  }
  return merged;
}

}  // namespace clearance::bench
