#include <ccd/ccd.h>

#include <cmath>

#include "tools/bench/peers/peers.hpp"
#include "tools/bench/peers/welded.hpp"
#include "tools/bench/solver_rows.hpp"
#include "tools/bench/suite/rivals.hpp"
#include "tools/bench/suite/solver_rival.hpp"

namespace clearance::bench {
namespace {

// Points, each with the points at the other ends of its edges; or a curved shape. Either has a
// radius around it.
struct Mesh {
  std::vector<Vec3> points;
  std::vector<std::vector<int>> neighbours;
  CurvedShape curved;
  double radius = 0.0;
};

std::shared_ptr<const Mesh> mesh_of(const ConvexBody& body) {
  const auto mesh = std::make_shared<Mesh>();
  mesh->curved = body.curved;
  mesh->radius = body.radius;
  if (body.is_curved()) return mesh;
  if (body.vertices.size() <= 2) {  // a sphere's centre, a capsule's ends
    for (const Vertex& v : body.vertices) mesh->points.push_back(v.position);
    mesh->neighbours = {{static_cast<int>(mesh->points.size()) - 1}, {0}};
    return mesh;
  }
  const Welded welds = welded(body);
  mesh->points = welds.points;
  mesh->neighbours.resize(welds.points.size());
  // Each edge occurs once in each direction, because its two faces pass it in opposite directions.
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

// Support functions as libccd's own examples write them: an ellipsoid scales the direction, a
// cylinder or a cone chooses the higher one of its discs.
Vec3 curved_support(const CurvedShape& shape, const Vec3& d) {
  if (shape.kind == CurvedShape::Kind::kEllipsoid) {
    const Vec3 scaled = shape.semi_axes.cwiseProduct(d);
    return shape.semi_axes.cwiseProduct(scaled) / scaled.norm();
  }
  const double across = std::hypot(d.x(), d.y());
  const auto height = [&](const Disc& disc) { return disc.height * d.z() + disc.radius * across; };
  const Disc& disc =
      height(shape.discs[0]) > height(shape.discs[1]) ? shape.discs[0] : shape.discs[1];
  const double scale = across > 0.0 ? disc.radius / across : 0.0;
  return {scale * d.x(), scale * d.y(), disc.height};
}

void support(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* support_point) {
  // The callback's object is const, but the one registered is not: it is Libccd's own member.
  auto& placed = *static_cast<Placed*>(const_cast<void*>(object));
  const Vec3 d =
      placed.rotation.transpose() * Vec3(direction->v[0], direction->v[1], direction->v[2]);
  const Mesh& mesh = *placed.mesh;
  Vec3 own;
  if (mesh.points.empty()) {
    own = curved_support(mesh.curved, d);
  } else {
    placed.last = climb(mesh, placed.last, d);
    own = mesh.points[placed.last];
  }
  if (mesh.radius > 0.0) own += mesh.radius / d.norm() * d;
  const Vec3 p = placed.rotation * own + placed.position;
  ccdVec3Set(support_point, p.x(), p.y(), p.z());
}

class Libccd {
 public:
  using Shape = std::shared_ptr<const Mesh>;
  static Shape shape(const ConvexBody& body) { return mesh_of(body); }

  Libccd(Shape a, Shape b) : a_{std::move(a), {}, {}, 0}, b_{std::move(b), {}, {}, 0} {
    CCD_INIT(&ccd_);
    ccd_.support1 = ccd_.support2 = support;
    ccd_.max_iterations = 1000;
    ccd_.epa_tolerance = 1e-6;
  }
  void forget() { a_.last = b_.last = 0; }
  Answer query(const Pose& world_from_a, const Pose& world_from_b) {
    place(a_, world_from_a);
    place(b_, world_from_b);
    const bool touch = ccdGJKIntersect(&a_, &b_, &ccd_) != 0;
    return {.distance = touch ? 0.0 : kInfinity};
  }

 protected:
  static void place(Placed& placed, const Pose& pose) {
    placed.rotation = pose.orientation.toRotationMatrix();
    placed.position = pose.position;
  }
  Placed a_, b_;
  ccd_t ccd_;
};

// Answers with the depth, by libccd's EPA, where the bodies overlap.
class WithDepth : public Libccd {
 public:
  using Libccd::Libccd;
  Answer query(const Pose& world_from_a, const Pose& world_from_b) {
    place(a_, world_from_a);
    place(b_, world_from_b);
    ccd_real_t depth = 0.0;
    ccd_vec3_t direction, position;
    const int found = ccdGJKPenetration(&a_, &b_, &ccd_, &depth, &direction, &position);
    return {.distance = found == 0 ? -depth : kInfinity, .ok = found != -2};
  }
};

}  // namespace

std::vector<Rival> libccd_rivals() {
  return {solver_rival<WithDepth>("libccd", "2, doubles; depth, otherwise yes or no", true)};
}

// libccd has no distance that the thesis's tables could compare.
void register_libccd(RowSet set) {
  if (set == RowSet::kBench) register_peer<Libccd>(set, "libccd");
}

}  // namespace clearance::bench
