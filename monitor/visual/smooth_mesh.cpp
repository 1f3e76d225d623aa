#include "monitor/visual/smooth_mesh.hpp"

#include <cstddef>
#include <numeric>
#include <vector>

namespace clearance {
namespace {

constexpr double kSmooth = 0.766;     // cosine of 40 degrees
constexpr double kSame = 1.0 - 1e-6;  // cosine of two normals that are drawn as one

struct Face {
  Vec3 area = Vec3::Zero();    // its normal, times twice its area, m^2
  Vec3 normal = Vec3::Zero();  // unit; zero: the face has no area
};

Face face_of(const Triangle& t) {
  Face face{.area = (t[1] - t[0]).cross(t[2] - t[0])};
  const double length = face.area.norm();
  if (length > 0.0) face.normal = face.area / length;
  return face;
}

// The faces around each vertex: those of vertex v are at first[v] .. first[v + 1].
struct FacesAround {
  std::vector<std::size_t> first, faces;

  explicit FacesAround(const TriangleMesh& mesh) : first(mesh.vertices.size() + 1, 0) {
    for (const auto& corners : mesh.triangles) {
      for (const std::uint32_t v : corners) ++first[v + 1];
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    faces.resize(first.back());
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
      for (const std::uint32_t v : mesh.triangles[f]) faces[next[v]++] = f;
    }
  }
};

}  // namespace

BodyMesh smooth_mesh(const TriangleMesh& mesh) {
  std::vector<Face> faces;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    faces.push_back(face_of(mesh.triangle(f)));
  }
  const FacesAround around(mesh);
  BodyMesh smooth;
  std::vector<std::vector<std::uint32_t>> made(mesh.vertices.size());  // by the mesh's vertex
  const auto vertex = [&](std::uint32_t v, const Face& face) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = around.first[v]; i < around.first[v + 1]; ++i) {
      const Face& other = faces[around.faces[i]];
      if (other.normal.dot(face.normal) >= kSmooth) sum += other.area;
    }
    const Vec3 normal = sum.normalized();
    for (const std::uint32_t known : made[v]) {
      if (smooth.normals[known].dot(normal) >= kSame) return known;
    }
    smooth.positions.push_back(mesh.vertices[v]);
    smooth.normals.push_back(normal);
    return made[v].emplace_back(static_cast<std::uint32_t>(smooth.positions.size() - 1));
  };
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    if (faces[f].normal.isZero(0.0)) continue;
    const auto& [a, b, c] = mesh.triangles[f];
    smooth.triangles.push_back({vertex(a, faces[f]), vertex(b, faces[f]), vertex(c, faces[f])});
  }
  return smooth;
}

}  // namespace clearance
