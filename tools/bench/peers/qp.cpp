// The benchmark rows of active_set_qp.hpp: warm-started while tracked, otherwise started from the
// bodies' centres.
#include "tools/bench/peers/active_set_qp.hpp"
#include "tools/bench/peers/peers.hpp"
#include "tools/bench/solver_rows.hpp"

namespace clearance::bench {
namespace {

class Qp {
 public:
  struct Shape {
    QpRows rows;
    Vec3 middle;
  };
  static Shape shape(const ConvexBody& body) {
    const auto n = static_cast<Eigen::Index>(body.facets.size());
    Shape shape{{{n, 3}, Eigen::VectorXd(n)}, body.interior};
    for (Eigen::Index i = 0; i < n; ++i) {
      shape.rows.normals.row(i) = body.facets[static_cast<std::size_t>(i)].normal;
      shape.rows.offsets[i] = body.facets[static_cast<std::size_t>(i)].offset;
    }
    return shape;
  }

  Qp(const Shape& a, const Shape& b)
      : middle_of_a_(a.middle), middle_of_b_(b.middle), qp_(a.rows, b.rows) {
    forget();
  }
  void forget() { qp_.start(middle_of_a_, middle_of_b_); }
  Answer query(const Pose& world_from_a, const Pose& world_from_b) {
    const Mat3 to_a = world_from_a.orientation.toRotationMatrix().transpose();
    const QpEnd end = qp_.solve(to_a * world_from_b.orientation.toRotationMatrix(),
                                to_a * (world_from_b.position - world_from_a.position));
    return {end.distance, end.ok, end.iterations};
  }

 private:
  const Vec3 middle_of_a_, middle_of_b_;
  ActiveSetQp qp_;
};

}  // namespace

// A quadratic programme has no curved constraints.
void register_qp(RowSet set) {
  if (set == RowSet::kBench) {
    register_rows<Qp>("peer/qp/");
  } else {
    register_facet_balls<Qp>("peer/qp/");
    register_intervals<Qp>("peer/qp/");
  }
}

}  // namespace clearance::bench
