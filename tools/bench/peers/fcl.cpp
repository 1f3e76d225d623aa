#include <fcl/geometry/shape/convex.h>
#include <fcl/narrowphase/detail/gjk_solver_indep.h>
#include <fcl/narrowphase/detail/gjk_solver_libccd.h>

#include "tools/bench/intervals.hpp"
#include "tools/bench/measure.hpp"
#include "tools/bench/peers/peers.hpp"
#include "tools/bench/peers/welded.hpp"

namespace clearance::bench {
namespace {

using Hull = fcl::Convex<double>;

// Its faces as FCL wants them: the number of corners, then the corners counter-clockwise.
std::shared_ptr<Hull> hull(const ConvexPolyhedron& body) {
  const Welded mesh = welded(body);
  const auto points =
      std::make_shared<std::vector<fcl::Vector3d>>(mesh.points.begin(), mesh.points.end());
  const auto faces = std::make_shared<std::vector<int>>();
  for (const std::vector<int>& face : mesh.faces) {
    faces->push_back(static_cast<int>(face.size()));
    faces->insert(faces->end(), face.begin(), face.end());
  }
  return std::make_shared<Hull>(points, static_cast<int>(mesh.faces.size()), faces);
}

fcl::Transform3d transform_of(const Pose& pose) {
  fcl::Transform3d t = fcl::Transform3d::Identity();
  t.linear() = pose.orientation.toRotationMatrix();
  t.translation() = pose.position;
  return t;
}

class Pair {
 public:
  using Shape = std::shared_ptr<Hull>;
  static Shape shape(const ConvexPolyhedron& body) { return hull(body); }
  Pair(Shape a, Shape b) : a_(std::move(a)), b_(std::move(b)) {}

 protected:
  template <class Gjk>
  Answer ask(const Gjk& gjk, const Pose& world_from_a, const Pose& world_from_b) {
    double apart = 0.0;
    fcl::Vector3d on_a, on_b;
    gjk.shapeDistance(*a_, transform_of(world_from_a), *b_, transform_of(world_from_b), &apart,
                      &on_a, &on_b);
    return {.distance = apart};
  }
  Shape a_, b_;
};

template <int kDigits>
class WithLibccd : public Pair {
 public:
  WithLibccd(Shape a, Shape b) : Pair(std::move(a), std::move(b)) {
    gjk_.distance_tolerance = std::pow(10.0, -kDigits);
  }
  void forget() {}
  Answer query(const Pose& a, const Pose& b) { return ask(gjk_, a, b); }

 private:
  fcl::detail::GJKSolver_libccd<double> gjk_;
};

// FCL starts from minus its guess and hands back its last ray with the sign as it was, so that a
// guess passed on untouched points away from the other body; turned round here, it is as fast as it
// can be.
class WithOwnGjk : public Pair {
 public:
  WithOwnGjk(Shape a, Shape b) : Pair(std::move(a), std::move(b)) { gjk_.gjk_tolerance = 1e-12; }
  void forget() { gjk_.enableCachedGuess(false); }
  Answer query(const Pose& a, const Pose& b) {
    const bool tracked = gjk_.enable_cached_guess;
    gjk_.enableCachedGuess(true);
    if (tracked) {
      gjk_.setCachedGuess(-gjk_.getCachedGuess());
    } else {  // the line of centres, better than FCL's own first guess, the x axis
      gjk_.setCachedGuess(a.orientation.conjugate() * (b.position - a.position));
    }
    return ask(gjk_, a, b);
  }

 private:
  fcl::detail::GJKSolver_indep<double> gjk_;
};

}  // namespace

void register_fcl() {
  register_rows<WithLibccd<6>>("peer/fcl/");
  register_rows<WithLibccd<12>>("peer/fcl-tight/");
  register_rows<WithOwnGjk>("peer/fcl-gjk/");
  register_intervals<WithOwnGjk>("peer/fcl-gjk/");
}

}  // namespace clearance::bench
