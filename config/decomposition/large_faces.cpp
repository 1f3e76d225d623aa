#include "config/decomposition/large_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace clearance {
namespace {

constexpr std::size_t kMostFaces = 48;
constexpr double kNormals = 50.0;  // steps from 0 to 1: a degree

}  // namespace

std::vector<HalfSpace> large_faces(const TriangleMesh& mesh, double tolerance) {
  std::map<std::array<long, 4>, std::pair<double, HalfSpace>> planes;  // by area
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle t = mesh.triangle(i);
    Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
    const double area = 0.5 * normal.norm();
    if (!(area > 0.0)) continue;
    normal.normalize();
    Eigen::Index axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    if (normal[axis] < 0.0) normal = -normal;
    const double offset = normal.dot(t[0]);
    const auto rounded = [](double x) { return std::lround(x); };
    const std::array key = {rounded(kNormals * normal.x()), rounded(kNormals * normal.y()),
                            rounded(kNormals * normal.z()), rounded(2.0 * offset / tolerance)};
    auto& [sum, plane] = planes.try_emplace(key, 0.0, HalfSpace{normal, offset}).first->second;
    sum += area;
  }
  std::vector<std::pair<double, HalfSpace>> by_area;
  for (const auto& [key, plane] : planes) by_area.push_back(plane);
  std::ranges::stable_sort(by_area, [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<HalfSpace> faces;
  for (std::size_t i = 0; i < std::min(kMostFaces, by_area.size()); ++i) {
    faces.push_back(by_area[i].second);
  }
  return faces;
}

}  // namespace clearance
