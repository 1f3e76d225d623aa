#include <ccd/ccd.h>

#include "tools/bench/measure.hpp"
#include "tools/bench/peers/peers.hpp"

namespace clearance::bench {
namespace {

// A body where libccd's callbacks find it: its vertices, its pose, and where the last climb ended.
struct Placed {
  const ConvexPolyhedron* body;
  Mat3 rotation;
  Vec3 position;
  std::int32_t last = 0;
};

std::int32_t climb(const ConvexPolyhedron& body, std::int32_t from, const Vec3& towards) {
  double best = body.vertices[from].position.dot(towards);
  for (bool higher = true; higher;) {
    higher = false;
    const Vertex& v = body.vertices[from];
    for (std::int32_t i = v.first_edge; i < v.first_edge + v.edges; ++i) {
      const EdgeUse& use = body.vertex_edges[i];
      const std::int32_t other = body.edges[use.edge].vertex[1 - use.side];
      const double value = body.vertices[other].position.dot(towards);
      if (value > best) {
        best = value;
        from = other;
        higher = true;
      }
    }
  }
  return from;
}

void support(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* farthest) {
  // The callback's object is const, but the one registered is not: it is Libccd's own member.
  auto& placed = *static_cast<Placed*>(const_cast<void*>(object));
  const Vec3 d(direction->v[0], direction->v[1], direction->v[2]);
  placed.last = climb(*placed.body, placed.last, placed.rotation.transpose() * d);
  const Vec3 p = placed.rotation * placed.body->vertices[placed.last].position + placed.position;
  ccdVec3Set(farthest, p.x(), p.y(), p.z());
}

class Libccd {
 public:
  using Shape = const ConvexPolyhedron*;
  static Shape shape(const ConvexPolyhedron& body) { return &body; }

  Libccd(Shape a, Shape b) : a_{a, {}, {}, 0}, b_{b, {}, {}, 0} {
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
