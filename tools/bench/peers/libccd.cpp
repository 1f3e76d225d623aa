#include <ccd/ccd.h>

#include "tools/bench/measure.hpp"
#include "tools/bench/peers/peers.hpp"
#include "tools/bench/peers/welded.hpp"

namespace clearance::bench {
namespace {

// Points, and of each the points at the other ends of its edges.
struct Mesh {
  std::vector<Vec3> points;
  std::vector<std::vector<int>> neighbours;
};

std::shared_ptr<const Mesh> mesh_of(const ConvexPolyhedron& body) {
  const Welded welds = welded(body);
  const auto mesh = std::make_shared<Mesh>();
  mesh->points = welds.points;
  mesh->neighbours.resize(welds.points.size());
  // Every edge once in each direction: two faces pass it, one each way.
  for (const std::vector<int>& face : welds.faces) {
    for (std::size_t i = 0; i < face.size(); ++i) {
      mesh->neighbours[static_cast<std::size_t>(face[i])].push_back(face[(i + 1) % face.size()]);
    }
  }
  return mesh;
}

// A body where libccd's callbacks find it: its mesh, its pose, and where the last climb ended.
struct Placed {
  std::shared_ptr<const Mesh> mesh;
  Mat3 rotation;
  Vec3 position;
  std::size_t last = 0;
};

std::size_t climb(const Mesh& mesh, std::size_t from, const Vec3& towards) {
  double best = mesh.points[from].dot(towards);
  for (bool higher = true; higher;) {
    higher = false;
    for (const int other : mesh.neighbours[from]) {
      const double value = mesh.points[static_cast<std::size_t>(other)].dot(towards);
      if (value > best) {
        best = value;
        from = static_cast<std::size_t>(other);
        higher = true;
        break;
      }
    }
  }
  return from;
}

void support(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* farthest) {
  // The callback's object is const, but the one registered is not: it is Libccd's own member.
  auto& placed = *static_cast<Placed*>(const_cast<void*>(object));
  const Vec3 d(direction->v[0], direction->v[1], direction->v[2]);
  placed.last = climb(*placed.mesh, placed.last, placed.rotation.transpose() * d);
  const Vec3 p = placed.rotation * placed.mesh->points[placed.last] + placed.position;
  ccdVec3Set(farthest, p.x(), p.y(), p.z());
}

class Libccd {
 public:
  using Shape = std::shared_ptr<const Mesh>;
  static Shape shape(const ConvexPolyhedron& body) { return mesh_of(body); }

  Libccd(Shape a, Shape b) : a_{std::move(a), {}, {}, 0}, b_{std::move(b), {}, {}, 0} {
    CCD_INIT(&ccd_);
    ccd_.support1 = ccd_.support2 = support;
    ccd_.max_iterations = 1000;
  }
  void forget() { a_.last = b_.last = 0; }
  Answer query(const Pose& world_from_a, const Pose& world_from_b) {
    place(a_, world_from_a);
    place(b_, world_from_b);
    const bool touch = ccdGJKIntersect(&a_, &b_, &ccd_) != 0;
    return {.distance = touch ? 0.0 : kInfinity};
  }

 private:
  static void place(Placed& placed, const Pose& pose) {
    placed.rotation = pose.orientation.toRotationMatrix();
    placed.position = pose.position;
  }
  Placed a_, b_;
  ccd_t ccd_;
};

}  // namespace

void register_libccd() { register_rows<Libccd>("peer/libccd/"); }

}  // namespace clearance::bench
